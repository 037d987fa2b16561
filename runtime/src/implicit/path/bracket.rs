//! The end of the path: s = 1 or the end of the branch, whichever comes first, lies between two points.

use super::point::{Homotopy, PathPoint};
use crate::implicit::Equation;
use crate::{Error, Real};
use nalgebra::SVector;

/// Narrows the bracket until the solution is found, or until s stays below 1 on all of the branch. `before` is on the branch with s < 1;
/// `after` has s ≥ 1 or is past the end of the branch. In a small bracket s is a concave function of the parameter, bounded by its tangent
/// at `before`. Evaluations are regular at the end of the branch too: s is exact to round-off there.
pub(super) fn decide<T: Real, E: Equation<T, M, N>, const M: usize, const N: usize>(
    homotopy: &mut Homotopy<'_, T, E, M, N>,
    mut before: PathPoint<T, M>,
    mut after: PathPoint<T, M>,
    parameter: usize,
) -> Result<SVector<T, M>, Error> {
    let half = T::from_ratio(1, 2);
    let round_off = T::from_f64(4.0) * T::EPSILON;
    let mut is_bisection = false;
    while homotopy.is_affordable() {
        if (T::one() - before.s).abs() <= round_off {
            return Ok(before.xi);
        }
        // Lengths are along the tangent at `before`.
        let width = (after.value(parameter) - before.value(parameter)) / before.slope(parameter);
        let rise = width * before.slope_s;
        if after.s < T::one() && rise <= T::from_ratio(1, 1000) * before.s && before.s + rise < T::one() {
            return Err(Error::unsolvable(before.s + rise * half));
        }
        if width <= round_off * homotopy.distance(&before.xi, before.s) {
            return Err(Error::unsolvable(before.s));
        }
        if let Some(xi) = homotopy.land(&before, width) {
            return Ok(xi);
        }
        let length = if is_bisection { width * half } else { before.guess(&after, parameter, width) };
        is_bisection = !is_bisection;
        let mut middle = homotopy.step(&before, parameter, length);
        if middle.is_none() {
            middle = homotopy.step(&before, parameter, length * T::from_ratio(1, 8));
        }
        match middle {
            Some(middle) if !middle.is_past && (middle.s - T::one()).abs() <= round_off => return Ok(middle.xi),
            Some(middle) if middle.is_past || middle.s > T::one() => after = middle,
            Some(middle) => before = middle,
            None => return Err(Error::unsolvable(before.s)),
        }
    }
    Err(homotopy.exhausted(&before))
}

impl<T: Real, const M: usize> PathPoint<T, M> {
    /// The value of an unknown.
    fn value(&self, parameter: usize) -> T {
        self.xi.as_slice().get(parameter).copied().unwrap_or(self.s)
    }

    /// Its change along the tangent.
    fn slope(&self, parameter: usize) -> T {
        self.slope_xi.as_slice().get(parameter).copied().unwrap_or(self.slope_s)
    }

    /// Where to look next: where the tangent reaches s = 1, else where the slope of s vanishes if it is linear between the ends.
    fn guess(&self, after: &Self, parameter: usize, width: T) -> T {
        let length = if after.s >= T::one() {
            (T::one() - self.s) / self.slope_s
        } else {
            let (first, last) = (self.slope_s / self.slope(parameter), after.slope_s / after.slope(parameter));
            width * first / (first - last)
        };
        if length > T::zero() && length < width { length } else { width * T::from_ratio(1, 2) }
    }
}
