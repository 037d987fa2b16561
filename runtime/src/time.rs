//! The time of a state: nothing for autonomous systems, a clock for the others.

use crate::summation::exact_sum;
use crate::{Scalar, Space};
use core::fmt::Debug;

/// What a state knows of the time: [`Clock`] where the cost or the potential depends on it, else `()`, which costs nothing.
pub trait Time<T: Scalar>: Copy + Debug + PartialEq {
    /// The time t.
    fn at(t: T) -> Self;
    /// The time as a number, 0 for `()`.
    fn now(&self) -> T;
    /// The time after a step of size h.
    fn after_step(&self, h: T) -> Self;
    /// Takes lane `lane` of `other`.
    fn take_lane(&mut self, lane: usize, other: &Self);
}

impl<T: Scalar> Time<T> for () {
    #[inline]
    fn at(_t: T) -> Self {}

    #[inline]
    fn now(&self) -> T {
        T::zero()
    }

    #[inline]
    fn after_step(&self, _h: T) -> Self {}

    #[inline]
    fn take_lane(&mut self, _lane: usize, _other: &Self) {}
}

/// A time to which steps are added without drift: after k steps of size h from t₀ it shows t₀ + kh to the last place.
///
/// What each addition rounds off is carried along and added later, so that this holds for steps of changing sizes too.
/// Two clocks are equal if they show the same time.
///
/// Source: Knuth, *The Art of Computer Programming* 2, section 4.2.2, theorem B (the error of a sum).
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Clock<T> {
    now: T,
    /// What rounding has taken from `now`.
    carry: T,
}

impl<T: Scalar> Clock<T> {
    /// The time that it shows, in the unit of the step size: seconds in SI units.
    #[inline]
    pub fn now(&self) -> T {
        self.now
    }
}

impl<T: Scalar> Time<T> for Clock<T> {
    #[inline]
    fn at(t: T) -> Self {
        Self { now: t, carry: T::zero() }
    }

    #[inline]
    fn now(&self) -> T {
        self.now
    }

    #[inline]
    fn after_step(&self, h: T) -> Self {
        let (sum, lost) = exact_sum(self.now, h);
        let (now, carry) = exact_sum(sum, self.carry + lost);
        Self { now, carry }
    }

    #[inline]
    fn take_lane(&mut self, lane: usize, other: &Self) {
        self.now.set_lane(lane, &Space::lane(&other.now, lane));
        self.carry.set_lane(lane, &Space::lane(&other.carry, lane));
    }
}

impl<T: PartialEq> PartialEq for Clock<T> {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.now == other.now
    }
}

#[cfg(test)]
mod tests {
    use super::{Clock, Time};

    /// 0.1 has no exact binary form: plain sums are off by 99 units in the last place after 1000 steps in double precision, and
    /// by 9 % after 10⁷ in single.
    #[test]
    fn clocks_do_not_drift() {
        let mut clock = Clock::at(0.0_f64);
        let steps = if cfg!(miri) { 100 } else { 100_000 };
        for k in 1..=steps {
            clock = clock.after_step(0.1);
            assert_eq!(clock.now(), f64::from(k) * 0.1, "step {k}");
        }
        if cfg!(miri) {
            return;
        }
        let mut clock = Clock::at(0.0_f32);
        for _ in 0..10_000_000 {
            clock = clock.after_step(0.1);
        }
        assert_eq!(clock.now(), 1_000_000.0);
    }

    /// Down and up again in steps of different sizes, from a start that none of them divides.
    #[test]
    fn clocks_return() {
        let start = 1.0_f64 / 3.0;
        let mut clock = Clock::at(start);
        let rounds = if cfg!(miri) { 100 } else { 10_000 };
        let sizes = [0.1, -0.7, 1e-9, 123.456, 1e3];
        for k in 0..rounds {
            clock = clock.after_step(sizes[k % 5]);
        }
        for k in (0..rounds).rev() {
            clock = clock.after_step(-sizes[k % 5]);
        }
        assert_eq!(clock.now(), start);
    }

    #[test]
    fn no_time_is_no_bytes() {
        assert_eq!(size_of::<()>(), 0);
        assert_eq!(Time::<f64>::now(&<() as Time<f64>>::at(3.0)), 0.0);
    }
}
