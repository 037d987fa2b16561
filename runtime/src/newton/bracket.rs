//! The zero of a slope between two limits, by the secant method inside a bracket.

use crate::Real;
use crate::space::larger;

/// A step size with the slope dV/dh there, and the sum of the sizes of its terms.
#[derive(Clone, Copy)]
pub(crate) struct Sample<T> {
    pub h: T,
    pub slope: T,
    pub size: T,
}

/// Where the zero of the slope is looked for.
#[derive(Clone, Copy)]
pub(crate) struct Bracket<T> {
    limits: (T, T),
    /// Step sizes that are too short and too long.
    short: Option<T>,
    long: Option<T>,
    /// A step size for which there is no plan.
    impossible: Option<T>,
    last: Option<Sample<T>>,
}

impl<T: Real> Bracket<T> {
    pub fn of(limits: (T, T)) -> Self {
        Self { limits, short: None, long: None, impossible: None, last: None }
    }

    /// The step size within the limits that is nearest to `h`.
    pub fn inside(&self, h: T) -> T {
        if h < self.limits.0 {
            self.limits.0
        } else if h > self.limits.1 {
            self.limits.1
        } else {
            h
        }
    }

    /// The size of the bracket, relative to the step size.
    pub fn width(&self) -> T {
        let (short, long) = (self.short.unwrap_or(self.limits.0), self.long.unwrap_or(self.limits.1));
        (long - short) / long
    }

    /// Whether the bracket is nothing to a person.
    pub fn is_narrow(&self) -> bool {
        self.width() <= T::EPSILON.sqrt()
    }

    /// The step size to try where there is no plan for `h`: halfway back. `None` where there was none before.
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
        match (self.short, self.long) {
            (Some(short), Some(long)) => {
                // Steps of the secant that do not at least halve are not trusted.
                let half = T::from_ratio(1, 2);
                let most = before.map_or(T::zero(), |b| (sample.h - b.h).abs() * half);
                match secant {
                    Some(next) if next > short && next < long && (next - sample.h).abs() <= most => next,
                    _ => (short + long) * half,
                }
            }
            _ => self.outwards(sample.h, is_short, secant),
        }
    }

    /// Along the secant, by at least an eighth and at most a factor two, as far as there are plans.
    fn outwards(&self, h: T, is_short: bool, secant: Option<T>) -> T {
        let (least, most) = (h * T::from_ratio(1, 8), if is_short { h } else { h * T::from_ratio(1, 2) });
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

#[cfg(test)]
mod tests {
    use super::{Bracket, Sample};

    /// The zero of h − 1/h³, and its limits.
    #[test]
    fn zeros_are_found_within_limits() {
        for (limits, expected) in [((0.1, 10.0), 1.0), ((2.0, 3.0), 2.0), ((0.1, 0.5), 0.5)] {
            let mut bracket = Bracket::of(limits);
            let (mut h, mut trials) = (bracket.inside(0.3), 0);
            loop {
                let slope: f64 = h - 1.0 / (h * h * h);
                let next = bracket.next(Sample { h, slope, size: h });
                trials += 1;
                if (next - h).abs() < 1e-14 {
                    break;
                }
                h = next;
            }
            assert!((h - expected).abs() < 1e-13 && trials < 25, "{h} after {trials}");
        }
    }

    /// Below 1 there are no values.
    #[test]
    fn impossible_step_sizes_are_kept_away_from() {
        let mut bracket = Bracket::of((0.1, 10.0));
        let mut h: f64 = bracket.inside(8.0);
        for _ in 0..60 {
            h = if h > 1.0 {
                bracket.next(Sample { h, slope: h - 1.01, size: h })
            } else {
                bracket.retreat(h).expect("the first step size is possible")
            };
        }
        assert!((h - 1.01).abs() < 1e-13, "{h}");
    }
}
