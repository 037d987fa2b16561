//! Free final time: the step size is chosen too.

use super::sweep::Endpoints;
use super::{Boundary, Guess, Node};
use crate::newton::{Sample, Trial, check_limits, critical_step_size};
use crate::scheme::Scheme;
use crate::{Error, Real, Scalar, Variational};
use core::ops::RangeInclusive;
use num_traits::One;

impl<S: Variational<M, Scalar: Real>, const M: usize> Boundary<'_, S, M> {
    /// The step size in `steps`, and with it the final time, at which Σ ℓd + φ(t_N, q_N) of the extremal to `target`, or to anywhere, is
    /// critical: where the energy is ∂φ/∂t. It is looked for where the sum falls, from the step size of the stepper on, and at a limit
    /// the sum may fall beyond it.
    ///
    /// The nodes hold the extremal then: a stepper of that step size and [`Guess::Path`] give it with all that is known of it. By the
    /// envelope theorem the derivative by h is that at a fixed path, here a central difference, so that h has ten digits of an `f64` and
    /// the action all.
    ///
    /// # Errors
    /// [`Error::StepSize`] for limits that are not positive numbers in order, [`Error::NoExtremal`], and those of [`solve`](Self::solve).
    pub fn free_time(
        &self,
        start: &S::Configuration,
        target: Option<&S::Configuration>,
        steps: RangeInclusive<S::Scalar>,
        guess: Guess<S::Scalar, M>,
        path: &mut [Node<S, M>],
    ) -> Result<S::Scalar, Error> {
        check_limits(&steps)?;
        self.check(start, &guess, path.len())?;
        target.map_or(Ok(()), |target| self.stepper.check_configuration(target))?;
        let third = S::Scalar::EPSILON.powf(S::Scalar::from_ratio(1, 3));
        let accuracy = S::Scalar::from_f64(4.0) * third * third;
        let mut guess = guess;
        let trial = |h| {
            let system = &self.stepper.system;
            let constants = S::Scheme::constants(system, h)?;
            let sign = S::Scalar::one();
            let endpoints = Endpoints { system, h, constants: &constants, time: self.time, start, target, sign };
            let end = endpoints.prepare(path, &guess)?;
            let solved = endpoints.newton(path, end, guess != Guess::Geodesic)?;
            guess = Guess::Path;
            let sample = endpoints.slope(path, &solved.end, third * h)?;
            Ok(Trial::Found { answer: h, sample, sweeps: solved.sweeps })
        };
        let (h, _) = critical_step_size(steps, self.stepper.h, accuracy, trial)?;
        Ok(h)
    }
}

impl<S: Variational<M, Scalar: Real>, const M: usize> Endpoints<'_, S, M> {
    /// The derivative of the sum by h at a fixed path.
    fn slope(&self, path: &[Node<S, M>], end: &S::Configuration, step: S::Scalar) -> Result<Sample<S::Scalar>, Error> {
        let [longer, shorter] = [self.h + step, self.h - step].map(|h| -> Result<S::Scalar, Error> {
            let constants = S::Scheme::constants(self.system, h)?;
            let endpoints = Endpoints { h, constants: &constants, ..*self };
            Ok(endpoints.sum(path, end))
        });
        let (longer, shorter) = (longer?, shorter?);
        let size = (longer.abs() + shorter.abs()) / self.h;
        Ok(Sample { h: self.h, slope: (longer - shorter) / (step + step), size })
    }

    /// Σ ℓd + φ of a path as it is.
    fn sum(&self, path: &[Node<S, M>], end: &S::Configuration) -> S::Scalar {
        let ends = path.iter().skip(1).map(|node| &node.configuration).chain(core::iter::once(end));
        let edges = path.iter().zip(ends).enumerate();
        let price = self.system.endpoint(self.time_of_end(path.len()), end).price;
        edges.fold(price, |sum, (index, (node, next))| {
            sum + self.momenta(index, &node.configuration, &node.increment, next).lagrangian
        })
    }
}
