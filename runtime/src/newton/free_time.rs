//! Free final time: the step size at which the action or the price is critical.

use crate::space::larger;
use crate::{Error, Real};
use core::ops::RangeInclusive;
use num_traits::clamp;

/// Step sizes that are tried.
const TRIALS: usize = 60;
/// Doublings of a first step size for which there is no solution.
const DOUBLINGS: usize = 10;

/// A step size with the slope dV/dh there, and the sum of the sizes of its terms.
#[derive(Clone, Copy)]
pub(crate) struct Sample<T> {
    pub h: T,
    pub slope: T,
    pub size: T,
}

/// What one step size gives: the answer with its slope, found by so many sweeps.
pub(crate) struct Trial<T, A> {
    pub answer: A,
    pub sample: Sample<T>,
    pub sweeps: u32,
}

/// Where the zero of the slope is looked for, by the secant method.
#[derive(Clone, Copy)]
pub(crate) struct Bracket<T> {
    limits: [T; 2],
    /// Step sizes that are too short and too long.
    short: Option<T>,
    long: Option<T>,
    /// A step size for which there is no solution.
    impossible: Option<T>,
    last: Option<Sample<T>>,
}

impl<T: Real> Bracket<T> {
    /// # Errors
    /// [`Error::StepSize`] for limits that are not positive numbers in order.
    pub fn within(steps: &RangeInclusive<T>) -> Result<Self, Error> {
        let limits = [*steps.start(), *steps.end()];
        let is_valid = |limit: T| limit > T::zero() && limit.is_finite() && steps.start() <= steps.end();
        match limits.into_iter().find(|&limit| !is_valid(limit)) {
            Some(limit) => Err(Error::StepSize { value: limit.to_f64() }),
            None => Ok(Self { limits, short: None, long: None, impossible: None, last: None }),
        }
    }

    /// The answer at the step size at which the slope vanishes or falls beyond a limit, looked for from `first` on: until the next trial
    /// would be as near as `accuracy`, relative to it. With the sweeps of all trials.
    ///
    /// Where `retreats`, a trial that failed is followed by one nearer to a step size that has a solution.
    ///
    /// # Errors
    /// [`Error::NoExtremal`], and those of the trials.
    pub fn critical<A>(
        mut self,
        first: T,
        accuracy: T,
        retreats: bool,
        mut trial: impl FnMut(T) -> Result<Trial<T, A>, Error>,
    ) -> Result<(A, u32), Error> {
        let mut h = self.inside(first);
        let mut iterations = 0;
        for number in 1..=TRIALS {
            match trial(h) {
                Ok(Trial { answer, sample, sweeps }) => {
                    iterations += sweeps;
                    let next = self.next(sample);
                    let is_narrow = self.width() <= T::EPSILON.sqrt();
                    if (next - h).abs() <= accuracy * h || number == TRIALS && is_narrow {
                        return Ok((answer, iterations));
                    }
                    h = next;
                }
                Err(error) => {
                    let is_too_short = matches!(error, Error::Infeasible { .. } | Error::TargetMissed { .. });
                    let next = match self.retreat(h) {
                        Some(next) => next,
                        None if is_too_short && number <= DOUBLINGS => self.inside(h + h),
                        None => return Err(error),
                    };
                    if next == h || !retreats {
                        return Err(error);
                    }
                    h = next;
                }
            }
        }
        Err(Error::NoExtremal { correction: self.width().to_f64(), iterations })
    }

    /// The step size within the limits that is nearest to `h`.
    pub fn inside(&self, h: T) -> T {
        clamp(h, self.limits[0], self.limits[1])
    }

    /// The size of the bracket, relative to the step size.
    fn width(&self) -> T {
        let long = self.long.unwrap_or(self.limits[1]);
        (long - self.short.unwrap_or(self.limits[0])) / long
    }

    /// The step size to try where there is no solution for `h`: halfway back. `None` where there was none before.
    pub fn retreat(&mut self, h: T) -> Option<T> {
        self.impossible = Some(h);
        self.last.map(|last| (last.h + h) * T::from_ratio(1, 2))
    }

    /// The step size to try next; the same where the slope vanishes or falls beyond a limit.
    pub fn next(&mut self, sample: Sample<T>) -> T {
        let before = self.last.replace(sample);
        let is_short = sample.slope < T::zero();
        *(if is_short { &mut self.short } else { &mut self.long }) = Some(sample.h);
        if sample.slope.abs() <= T::from_f64(64.0) * T::EPSILON * sample.size {
            return sample.h;
        }
        let secant = before.map(|b| sample.h - sample.slope * (sample.h - b.h) / (sample.slope - b.slope));
        let (Some(short), Some(long)) = (self.short, self.long) else {
            return self.outwards(sample.h, is_short, secant);
        };
        // Steps of the secant that do not at least halve are not trusted.
        let half = T::from_ratio(1, 2);
        let most = before.map_or(T::zero(), |b| (sample.h - b.h).abs() * half);
        match secant {
            Some(next) if next > short && next < long && (next - sample.h).abs() <= most => next,
            _ => (short + long) * half,
        }
    }

    /// Along the secant, by at least an eighth and at most a factor two, as far as there are solutions.
    fn outwards(&self, h: T, is_short: bool, secant: Option<T>) -> T {
        let least = h * T::from_ratio(1, 8);
        let most = if is_short { h } else { h * T::from_ratio(1, 2) };
        let wanted = match secant {
            Some(next) if (next > h) == is_short => larger(least, (next - h).abs()),
            _ => least,
        };
        let far = if wanted > most { most } else { wanted };
        let next = self.inside(if is_short { h + far } else { h - far });
        match self.impossible {
            Some(impossible) if !is_short && next <= impossible && impossible < h => {
                (h + impossible) * T::from_ratio(1, 2)
            }
            _ => next,
        }
    }
}
