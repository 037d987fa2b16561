//! The time of a state: nothing for autonomous systems, a clock for the others.

use crate::sums::exact_sum;
use crate::{Scalar, Space};
use core::fmt::Debug;

/// The time of a state: [`Clock`] if the cost or the potential depends on it, or steps follow a monitor, else `()`, which costs nothing.
///
/// ```
/// use clebsch::{Clock, Time};
///
/// /// The time after so many steps.
/// fn after<C: Time<f64>>(steps: u32) -> f64 {
///     (0..steps).fold(C::at(2.0), |time, _| time.after_step(0.1)).now()
/// }
///
/// assert_eq!(after::<Clock<f64>>(10), 3.0);
/// assert_eq!(after::<()>(10), 0.0); // a system that does not depend on the time
/// ```
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
/// The rounding of each addition is carried along and added later, also for steps of changing sizes. Equal clocks show the same time.
///
/// ```
/// use clebsch::{Clock, Time};
///
/// let clock = (0..1_000_000).fold(Clock::at(0.0_f64), |clock, _| clock.after_step(0.1));
/// assert_eq!(clock.now(), 100_000.0);
/// let sum: f64 = (0..1_000_000).map(|_| 0.1).sum();
/// assert!((sum - 100_000.0).abs() > 1e-6); // plain sums drift
/// ```
///
/// Source: Knuth, *The Art of Computer Programming* 2, section 4.2.2, theorem B (the error of a sum).
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Clock<T> {
    now: T,
    /// The rounding error of `now`.
    carry: T,
}

impl<T: Scalar> Clock<T> {
    /// The time that it shows: seconds in SI units.
    #[inline]
    pub fn now(&self) -> T {
        self.now
    }

    /// The time t, with the rounding error of another that shows the same.
    #[inline]
    pub(crate) fn resumed(t: T, [now, carry]: [T; 2]) -> Self {
        Self { now: t, carry: T::select(now.equals(t), carry, T::zero()) }
    }

    /// The time, and its rounding error.
    #[inline]
    pub(crate) fn parts(&self) -> [T; 2] {
        [self.now, self.carry]
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
mod tests;
