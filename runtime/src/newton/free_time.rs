//! Free final time: the step size at which the action or the price is critical.

use super::bracket::{Bracket, Sample};
use crate::{Error, Real};
use core::ops::RangeInclusive;

/// Step sizes that are tried.
const TRIALS: usize = 60;
/// Doublings of a first step size for which there is no solution.
const DOUBLINGS: usize = 10;

/// What one step size gives.
pub(crate) enum Trial<T, A> {
    /// The answer with its slope, found by so many sweeps.
    Found { answer: A, sample: Sample<T>, sweeps: u32 },
    /// No solution: nearer to one that has a solution there may be another.
    Lost(Error),
}

/// The answer at the step size within `limits` at which the slope vanishes or falls beyond a limit, looked for from `first` on: until the next trial would be
/// as near as `accuracy`, relative to it. With the sweeps of all trials.
///
/// # Errors
/// [`Error::StepSize`] for limits that are not positive numbers in order, [`Error::NoExtremal`], and those of the trials.
pub(crate) fn critical_step_size<T: Real, A>(
    limits: RangeInclusive<T>,
    first: T,
    accuracy: T,
    mut trial: impl FnMut(T) -> Result<Trial<T, A>, Error>,
) -> Result<(A, u32), Error> {
    let mut bracket = Bracket::of((*limits.start(), *limits.end()));
    let mut h = bracket.inside(first);
    let mut iterations = 0;
    for number in 0..TRIALS {
        match trial(h)? {
            Trial::Found { answer, sample, sweeps } => {
                iterations += sweeps;
                let next = bracket.next(sample);
                let is_last = number + 1 == TRIALS;
                if (next - h).abs() <= accuracy * h || is_last && bracket.is_narrow() {
                    return Ok((answer, iterations));
                }
                h = next;
            }
            Trial::Lost(error) => {
                let is_too_short = matches!(error, Error::Infeasible { .. } | Error::TargetMissed { .. });
                let next = match bracket.retreat(h) {
                    Some(next) => next,
                    None if is_too_short && number < DOUBLINGS => bracket.inside(h + h),
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

/// The limits are positive numbers in order.
///
/// # Errors
/// [`Error::StepSize`].
pub(crate) fn check_limits<T: Real>(limits: &RangeInclusive<T>) -> Result<(), Error> {
    for limit in [*limits.start(), *limits.end()] {
        if !(limit > T::zero() && limit.is_finite() && limits.start() <= limits.end()) {
            return Err(Error::StepSize { value: limit.to_f64() });
        }
    }
    Ok(())
}
