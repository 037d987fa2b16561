//! Steps that fail: the failure of one body while others go on, the quantity that is not finite, and the longest step
//! that succeeds.

use super::{Stepper, check_on_orbit, first_without, whole_or_lane};
use crate::parts::{T, U};
use crate::scheme::{At, AtOf, Constants, Held, Left, Scheme};
use crate::{Clebsch, Error, Mask, Method, Scalar, Space, State, Time};
use num_traits::Zero;

/// Step sizes that are tried to find the longest one that can be solved, at most.
const TRIALS: usize = 32;
/// The ratio of the shortest step that was found to have no solution to the longest that has one.
const WIDTH: f64 = 1.02;
/// Bytes of constants of a body up to which steps are tried, each with its own constants. Larger constants take much
/// stack: 45 KB for series of exact drifts.
const CONSTANTS: usize = 2048;
/// The name of the momentum in the errors of solvers.
const MOMENTUM: Error = Error::NotFinite { name: "the momentum" };

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// One step in each lane by itself, and the lanes in which it succeeded; in the others the state stays as it is. [`step`](Self::step) is
    /// this where all lanes succeed.
    #[inline]
    pub fn step_each(&self, state: &State<S, M>) -> (State<S, M>, <S::Scalar as Scalar>::Mask) {
        let Ok(next) = self.attempt(state, &S::Input::origin()) else {
            return (*state, <S::Scalar as Scalar>::Mask::nowhere());
        };
        let stepped = self.sound(&next);
        if stepped.all() { (next, stepped) } else { (Self::merged(&next, state, stepped), stepped) }
    }

    /// Why the step of a lane fails; `None` where it does not. The step is made once more, with the momenta of all
    /// other lanes NaN, so only this lane can fail.
    #[cold]
    pub fn failure(&self, state: &State<S, M>, lane: usize) -> Option<Error> {
        let mut alone = *state;
        alone.held = Held::<S, M>::filled(S::Scalar::zero() / S::Scalar::zero());
        alone.held.set_lane(lane, &state.held.lane(lane));
        // nothing is known of their motions
        alone.left = Left::<S, M>::filled(S::Scalar::zero());
        alone.left.set_lane(lane, &state.left.lane(lane));
        match self.attempt_again(&alone, &S::Input::origin()) {
            Err(error) => Some(self.refusal(&alone, &S::Input::origin(), lane, error)),
            Ok(next) if self.sound(&next).lane(lane) => None,
            Ok(next) => Some(self.overflow(&next, lane)),
        }
    }

    /// The error of a step from `state`, which is finite, in this lane.
    #[cold]
    #[inline(never)]
    pub(crate) fn refusal(&self, state: &State<S, M>, u: &S::Input, lane: usize, error: Error) -> Error {
        self.refusal_of(self.h, state, u, lane, error)
    }

    /// The same of a step of the size h.
    #[cold]
    #[inline(never)]
    pub(super) fn refusal_of(&self, h: T<S>, state: &State<S, M>, u: &U<S>, lane: usize, error: Error) -> Error {
        let State { time, configuration, held, left, .. } = state;
        self.explained(h, lane, error, |constants| {
            let at = At::new(&self.system, constants, time.now());
            let left = M::Scheme::left_after(at, configuration, &state.momentum(), left);
            let (q, mu, _) = M::Scheme::step(at, (configuration, held, &left), u)?;
            Ok((q.finite() & mu.finite()).lane(lane))
        })
    }

    /// The result of a computation at the time t. Where it fails, the error is that of the step; where it is not finite
    /// in a lane, it has this name.
    #[inline]
    pub(super) fn computed<V: Space<S::Scalar>>(
        &self,
        t: S::Scalar,
        name: impl Fn(&V, usize) -> &'static str,
        compute: impl Fn(AtOf<'_, S, M::Scheme, M>) -> Result<V, Error>,
    ) -> Result<V, Error> {
        match compute(self.at(t)) {
            Ok(value) if value.all_finite() => Ok(value),
            Ok(value) => {
                let lane = first_without::<S::Scalar>(value.finite());
                Err(whole_or_lane::<S::Scalar>(lane, Error::NotFinite { name: name(&value, lane) }))
            }
            Err(_) if S::Scalar::LANES > 1 => Err(Error::InLane { lane: 0 }),
            Err(error) => Err(self.explained(self.h, 0, error, |constants| {
                Ok(compute(At::new(&self.system, constants, t))?.finite().lane(0))
            })),
        }
    }

    /// The error of a step of the size h. Where that is too long, others are tried with their constants, and the error
    /// has the longest that can be solved.
    #[cold]
    #[inline(never)]
    fn explained(
        &self,
        h: T<S>,
        lane: usize,
        error: Error,
        stepped: impl Fn(&Constants<S, M>) -> Result<bool, Error>,
    ) -> Error {
        match error {
            // the one that was given is finite
            error if error == MOMENTUM => Error::NotFinite { name: "the momentum after the kick" },
            Error::Unsolvable { solvable_fraction, .. } => {
                let h = h.lane(lane).to_f64();
                if M::IS_FREE_MOTION || size_of::<Constants<S, M>>() > CONSTANTS * S::Scalar::LANES {
                    let solvable_step = M::IS_FREE_MOTION.then_some(h * solvable_fraction);
                    return Error::Unsolvable { solvable_fraction, step_size: Some(h), solvable_step };
                }
                let constants = |h: f64| M::Scheme::constants(&self.system, S::Scalar::from_f64(h));
                let solvable_step = longest(h, solvable_fraction, |h| stepped(&constants(h)?));
                if solvable_fraction <= 0.0 {
                    return Error::StepTooLong { step_size: h, solvable_step };
                }
                Error::Unsolvable { solvable_fraction, step_size: Some(h), solvable_step }
            }
            other => other,
        }
    }

    /// The error of a step to a state that is not finite in this lane, or off its orbit.
    #[cold]
    #[inline(never)]
    pub(crate) fn overflow(&self, next: &State<S, M>, lane: usize) -> Error {
        let State { time, configuration, .. } = next;
        if next.finite().lane(lane)
            && let Err(error) =
                check_on_orbit(&configuration.lane(lane), self.system.orbit_defect(configuration).lane(lane))
        {
            return error;
        }
        let name = if !configuration.finite().lane(lane) {
            "the configuration after the step"
        } else if !time.now().finite().lane(lane) {
            "the time after the step"
        } else if !self.has_gradient(time.now(), configuration, lane) {
            "the gradient of the potential after the step"
        } else {
            "the momentum after the step"
        };
        Error::NotFinite { name }
    }

    /// Whether the impulse at q, without momentum, is finite: that of the potential.
    pub(super) fn has_gradient(&self, t: S::Scalar, q: &S::Configuration, lane: usize) -> bool {
        M::Scheme::left(self.at(t), q, &S::Momentum::origin()).finite().lane(lane)
    }

    /// `next` in the lanes of `stepped`, `before` in the others.
    #[cold]
    fn merged(next: &State<S, M>, before: &State<S, M>, stepped: <S::Scalar as Scalar>::Mask) -> State<S, M> {
        let mut merged = *next;
        (0..S::Scalar::LANES).filter(|&lane| !stepped.lane(lane)).for_each(|lane| merged.take_lane(lane, before));
        merged
    }
}

/// The longest step that `tried` solves, to [`WIDTH`], given a step `h` without a solution and the fraction of its momentum that has one.
/// Where momenta alone count, the longest is that fraction of h. Where a potential or a force shows, the interval is halved.
fn longest(h: f64, fraction: f64, tried: impl Fn(f64) -> Result<bool, Error>) -> Option<f64> {
    let (mut refused, mut edge) = (h, h * fraction);
    let mut solved: Option<f64> = None;
    for _ in 0..TRIALS {
        let beyond = edge * 1.0095;
        let next = match solved {
            None if edge / refused > 0.0 && edge / refused < 0.99 => edge * 0.99,
            None => refused * 0.5,
            Some(longest) if refused / longest <= WIDTH => break,
            Some(longest) if beyond / longest > 1.0 && beyond / refused < 0.9 => beyond,
            Some(longest) => longest * Scalar::sqrt(refused / longest),
        };
        match tried(next) {
            Ok(true) => solved = Some(next),
            Err(Error::Unsolvable { solvable_fraction, .. }) => (refused, edge) = (next, next * solvable_fraction),
            Ok(false) | Err(_) => (refused, edge) = (next, 0.0),
        }
    }
    solved
}

#[cfg(test)]
mod tests;
