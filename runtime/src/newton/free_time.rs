//! Free final time: the step size at which the action or the price is critical.

use crate::space::larger;
use crate::{Error, Real};
use core::ops::RangeInclusive;
use num_traits::clamp;

/// Step sizes that are tried.
const TRIALS: usize = 60;
/// Doublings of a first step size for which there is no solution.
const DOUBLINGS: usize = 10;

/// The result for one step size: an answer and the sweeps that it took. With it come the slope dV/dh there, and the sum
/// of the sizes of its terms.
pub(crate) struct Trial<T, A> {
    pub answer: A,
    pub sweeps: u32,
    pub slope: T,
    pub size: T,
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
    /// The step size before, with its slope.
    last: Option<[T; 2]>,
}

impl<T: Real> Bracket<T> {
    /// Limits are positive numbers in order.
    pub fn within(steps: &RangeInclusive<T>) -> Result<Self, Error> {
        let limits = [*steps.start(), *steps.end()];
        let is_valid = |limit: T| limit > T::zero() && limit.is_finite() && steps.start() <= steps.end();
        match limits.into_iter().find(|&limit| !is_valid(limit)) {
            Some(limit) => Err(Error::StepSize { value: limit.to_f64() }),
            None => Ok(Self { limits, short: None, long: None, impossible: None, last: None }),
        }
    }

    /// The answer at the step size at which the slope vanishes or falls beyond a limit, to `accuracy`. The search
    /// begins with `first`, and counts the sweeps of all trials. Where `retreats`, a trial that failed is followed by
    /// one nearer to a step size that has a solution.
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
                Ok(Trial { answer, sweeps, slope, size }) => {
                    iterations += sweeps;
                    let next = self.next(h, slope, size);
                    let is_narrow = self.width() <= T::EPSILON.sqrt();
                    if (next - h).abs() <= accuracy * h || number == TRIALS && is_narrow {
                        return Ok((answer, iterations));
                    }
                    h = next;
                }
                Err(error) => {
                    let is_too_short = matches!(error, Error::Infeasible { .. } | Error::TargetMissed { .. });
                    let doubled = (is_too_short && number <= DOUBLINGS).then(|| self.inside(h + h));
                    h = match self.retreat(h).or(doubled) {
                        Some(next) if retreats && next != h => next,
                        _ => return Err(error),
                    };
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
        self.last.map(|[last, _]| (last + h) * T::from_ratio(1, 2))
    }

    /// The step size to try next; the same where the slope vanishes or falls beyond a limit.
    pub fn next(&mut self, h: T, slope: T, size: T) -> T {
        let before = self.last.replace([h, slope]);
        let is_short = slope < T::zero();
        *(if is_short { &mut self.short } else { &mut self.long }) = Some(h);
        if slope.abs() <= T::from_f64(64.0) * T::EPSILON * size {
            return h;
        }
        let secant = before.map(|[last, other]| h - slope * (h - last) / (slope - other));
        let (Some(short), Some(long)) = (self.short, self.long) else {
            return self.outwards(h, is_short, secant);
        };
        // Steps of the secant that do not at least halve are not trusted.
        let half = T::from_ratio(1, 2);
        let most = before.map_or(T::zero(), |[last, _]| (h - last).abs() * half);
        let is_trusted = |next: &T| *next > short && *next < long && (*next - h).abs() <= most;
        secant.filter(is_trusted).unwrap_or((short + long) * half)
    }

    /// Along the secant, by at least an eighth and at most a factor two, as far as there are solutions.
    fn outwards(&self, h: T, is_short: bool, secant: Option<T>) -> T {
        let least = h * T::from_ratio(1, 8);
        let most = if is_short { h } else { h * T::from_ratio(1, 2) };
        let outer = secant.filter(|next| (*next > h) == is_short);
        let wanted = outer.map_or(least, |next| larger(least, (next - h).abs()));
        let far = if wanted > most { most } else { wanted };
        let next = self.inside(if is_short { h + far } else { h - far });
        let nearest = self.impossible.filter(|impossible| !is_short && next <= *impossible && *impossible < h);
        nearest.map_or(next, |impossible| (h + impossible) * T::from_ratio(1, 2))
    }
}
