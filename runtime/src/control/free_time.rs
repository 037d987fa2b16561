//! Free final time: the step size at which the least price is least.
//!
//! By the envelope theorem the least price V of N steps changes with the step size as the Lagrangian does at the solution,
//! ```text
//! dV/dh = Σ d/dh (ℓ + p·f + z·a) + N ∂φ/∂t
//! ```
//! the multipliers kept. Its zero is bracketed and found by the secant method, with halvings where that does not contract (Brent, *Algorithms
//! for Minimization without Derivatives*, 1973, chapter 4); each plan is the guess of the next.

use super::newton::Solved;
use super::sweep::Problem;
use super::{Control, Optimum, Stage, Target};
use crate::bracket::{Bracket, Sample};
use crate::{Controlled, Error, Real, Scalar};
use core::ops::RangeInclusive;
use num_traits::Zero;

/// Step sizes that are tried.
const TRIALS: usize = 60;
/// Doublings of a first step size for which there is no plan.
const DOUBLINGS: usize = 10;

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
        let (zero, limits) = (S::Scalar::zero(), (*steps.start(), *steps.end()));
        for limit in [limits.0, limits.1] {
            if !(limit > zero && limit.is_finite() && limits.0 <= limits.1) {
                return Err(Error::StepSize { value: limit.to_f64() });
            }
        }
        self.check(start, &target, plan)?;
        let mut bracket = Bracket::of(limits);
        let mut iterations = 0;
        let mut h = bracket.inside(self.h);
        for trial in 0..TRIALS {
            match self.sample(start, &target, h, plan) {
                Ok((solved, sample)) => {
                    iterations += solved.sweeps;
                    let next = bracket.next(sample);
                    let near = S::Scalar::from_f64(64.0) * S::Scalar::EPSILON * h;
                    if (next - h).abs() <= near || trial + 1 == TRIALS && bracket.is_narrow() {
                        return Ok(Optimum::new(plan, Solved { sweeps: iterations, ..solved }, h));
                    }
                    h = next;
                }
                Err(error) => {
                    let too_short = matches!(error, Error::Infeasible { .. } | Error::TargetMissed { .. });
                    let next = match bracket.retreat(h) {
                        Some(next) => next,
                        None if too_short && trial < DOUBLINGS => bracket.inside(h + h),
                        None => return Err(error),
                    };
                    if next == h {
                        return Err(error);
                    }
                    h = next;
                }
            }
        }
        Err(Error::NoExtremal { correction: bracket.width().to_f64(), iterations })
    }

    /// The plan for a step size, and dV/dh there.
    fn sample(
        &self,
        start: &S::Place,
        target: &Target<S::Place>,
        h: S::Scalar,
        plan: &mut [Stage<S, D, U, C>],
    ) -> Result<(Solved<S, D, U, C>, Sample<S::Scalar>), Error> {
        let constants = self.system.prepare(h)?;
        let problem = self.problem(start, target, h, &constants);
        let solved = problem.attempt(plan)?;
        let sample = problem.slope(plan, &solved.last)?;
        Ok((solved, sample))
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
