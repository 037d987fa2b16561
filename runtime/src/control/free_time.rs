//! Free final time: the step size at which the least price is least.
//!
//! By the envelope theorem the least price V of N steps changes with the step size as the Lagrangian does at the solution,
//! ```text
//! dV/dh = Σ d/dh (ℓ + p·f + z·a) + N ∂φ/∂t
//! ```
//! the multipliers kept. Its zero is bracketed and found by the secant method, with halvings where that does not contract (Brent, *Algorithms
//! for Minimization without Derivatives*, 1973, chapter 4); each plan is the guess of the next.

use super::newton::CriticalPlan;
use super::sweep::Problem;
use super::{Control, Optimum, Stage, Target};
use crate::newton::{Bracket, Sample, Trial};
use crate::{Controlled, Error, Real, Scalar};
use core::ops::RangeInclusive;

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Control<S, D, U, C> {
    /// As [`solve`](Self::solve), with the step size in `steps` at which the least price is least, found from that of this control on:
    /// [`Optimum::step_size`]. At a limit the price may fall beyond it.
    ///
    /// # Errors
    /// [`Error::StepSize`] for limits that are not positive numbers in order, [`Error::NoExtremal`], and those of [`solve`](Self::solve).
    pub fn solve_free_time<'p>(
        &self,
        start: &S::Place,
        target: Target<S::Place>,
        steps: RangeInclusive<S::Scalar>,
        plan: &'p mut [Stage<S, D, U, C>],
    ) -> Result<Optimum<'p, S, D, U, C>, Error> {
        let bracket = Bracket::within(&steps)?;
        self.check(start, &target, plan)?;
        let accuracy = S::Scalar::from_f64(64.0) * S::Scalar::EPSILON;
        let trial = |h| {
            let constants = self.system.prepare(h)?;
            let problem = self.problem(start, &target, h, &constants);
            let solved = problem.attempt(plan)?;
            let sample = problem.slope(plan, &solved.last)?;
            Ok(Trial { sample, sweeps: solved.sweeps, answer: (solved, h) })
        };
        let ((solved, h), sweeps) = bracket.critical(self.h, accuracy, true, trial)?;
        Ok(Optimum::new(plan, CriticalPlan { sweeps, ..solved }, h))
    }
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// dV/dh of a solution.
    fn slope(&self, plan: &[Stage<S, D, U, C>], last: &S::Place) -> Result<Sample<S::Scalar>, Error> {
        let t = self.time_after(plan.len());
        let by_time = self.system.endpoint_expanded(t, last).by_time * S::Scalar::from_f64(plan.len() as f64);
        let (mut slope, mut size) = (by_time, by_time.abs());
        for (index, stage) in plan.iter().enumerate() {
            let (t, k) = (self.time_after(index), S::Scalar::from_f64(index as f64));
            let (x, u) = (&stage.place, &stage.input);
            let mut part = self.system.price_of_time(self.constants, t, k, x, u, &stage.next_costate)?;
            if C > 0 && index > 0 {
                part += k * self.bounds_by_time(stage, t);
            }
            slope += part;
            size += part.abs();
        }
        Ok(Sample { h: self.h, slope, size })
    }

    /// z·∂a/∂t, by central differences: bounds that depend on the time are rare, and the zero of dV/dh needs few digits.
    fn bounds_by_time(&self, stage: &Stage<S, D, U, C>, t: S::Scalar) -> S::Scalar {
        let step = S::Scalar::EPSILON.powf(S::Scalar::from_ratio(1, 3)) * (t.abs() + self.h);
        let after = self.system.bounds(t + step, &stage.place, &stage.input);
        let before = self.system.bounds(t - step, &stage.place, &stage.input);
        stage.multipliers.dot(&(after - before)) / (step + step)
    }
}
