//! Group elements from the results of a step.

use crate::linear::{divided, function};
use crate::matrices::shifted;
use crate::{Error, Mask, Scalar};
use nalgebra::{Quaternion, SMatrix, SVector};

/// I + D.
pub fn from_increment<T: Scalar, const N: usize>(d: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    shifted(d, T::one())
}

/// The quaternion with these coordinates, in the order i, j, k, w in which it keeps them.
#[inline]
pub fn quaternion<T: Scalar>(coordinates: [T; 4]) -> Quaternion<T> {
    Quaternion::from(SVector::from(coordinates))
}

/// The unit quaternion 1 + d.
pub fn quaternion_from_increment<T: Scalar>(d: &Quaternion<T>) -> Quaternion<T> {
    let mut element = *d;
    element.coords[3] += T::one();
    element
}

/// The inverse of a matrix, by elimination with partial pivoting; NaN where the matrix is singular.
pub fn inverse<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    function(a, |a| divided(a, &SMatrix::identity()))
}

/// The solution `x` where the step exists, whose angle θ has this sin²θ: below one, it does. Lanes in which it does not are NaN.
///
/// # Errors
/// Where it exists in no lane: [`Error::Unsolvable`] with 1/|sin θ|, the fraction of the momentum that is solvable; [`Error::NotFinite`].
#[inline]
pub fn below_right_angle<T: Scalar, const M: usize>(x: SVector<T, M>, sine_squared: T) -> Result<SVector<T, M>, Error> {
    let exists = sine_squared.below(T::one());
    if exists.all() {
        return Ok(x);
    }
    if exists.any() {
        return Ok(x.map(|x| T::select(exists, x, T::zero() / T::zero())));
    }
    Err(beyond_right_angle(sine_squared))
}

/// The same of a solution that is affine in the momentum and need not rest without it, as with a constraint. `sine_squared`
/// is that of a solution, and `solution` the one of another momentum.
///
/// # Errors
/// As [`below_right_angle`]. The fraction of the momentum is 0 where none has a solution.
#[inline]
pub fn below_right_angle_from<T: Scalar, const M: usize, const K: usize>(
    x: SVector<T, M>,
    sine_squared: impl Fn(&SVector<T, M>) -> T,
    solution: impl FnOnce(&SVector<T, K>) -> SVector<T, M>,
) -> Result<SVector<T, M>, Error> {
    let square = sine_squared(&x);
    match below_right_angle(x, square) {
        Err(Error::Unsolvable { .. }) => {
            let rest = solution(&SVector::from_element(T::zero()));
            let half = (x + rest) * T::from_f64(0.5);
            Err(beyond_right_angle_from([sine_squared(&rest), sine_squared(&half), square]))
        }
        found => found,
    }
}

/// The error from sin²θ for no part of the momentum, for half of it, and for all of it: a quadratic polynomial of the part.
#[cold]
fn beyond_right_angle_from<T: Scalar>(squares: [T; 3]) -> Error {
    let lane = (0..T::LANES).find(|&lane| squares[2].lane(lane).is_finite()).unwrap_or(0);
    let [start, half, end] = squares.map(|square| square.lane(lane).to_f64());
    let bend = 2.0 * (start + end - 2.0 * half);
    let slope = end - start - bend;
    // the largest s with start + slope s + bend s² = 1
    let root = Scalar::sqrt(slope * slope - 4.0 * bend * (start - 1.0));
    let part = if slope > 0.0 { 2.0 * (1.0 - start) / (slope + root) } else { (root - slope) / (2.0 * bend) };
    // false for NaN
    Error::unsolvable(if part > 0.0 && part <= 1.0 { part } else { 0.0 })
}

/// 1/(1 + cos θ) = 1/(1 + √(1 − t)) of t = sin²θ ≤ 1, for |θ| ≤ π/2.
///
/// Below t = 2⁻⁷, angles of 5°, seven terms of the power series
///
/// ```text
/// 1/2 + t/8 + t²/16 + 5t³/128 + 7t⁴/256 + 21t⁵/1024 + 33t⁶/2048 + …,    the next of which is below 5·10⁻¹⁷ of the sum
/// ```
/// are half as long a chain of operations as a root and a division. Longer numbers, and derivatives, take the quotient. The relative error is below 1.5 ε.
#[inline]
pub fn per_one_plus_cosine<T: Scalar>(sine_squared: T) -> T {
    let quotient = || quotient_per_one_plus_cosine(sine_squared);
    let is_plain = T::DERIVATIVES == 0 && T::EPSILON.to_f64() >= f64::EPSILON;
    let is_small = if is_plain { sine_squared.below(T::from_ratio(1, 1 << 7)) } else { T::Mask::nowhere() };
    if !is_small.any() {
        return quotient();
    }
    let (t, square) = (sine_squared, sine_squared * sine_squared);
    let two = |a: T, b: T| a + b * t;
    let low = two(T::from_ratio(1, 2), T::from_ratio(1, 8));
    let middle = two(T::from_ratio(1, 16), T::from_ratio(5, 128));
    let high = two(T::from_ratio(7, 256), T::from_ratio(21, 1024)) + T::from_ratio(33, 2048) * square;
    let series = (low + square * middle) + (square * square) * high;
    if is_small.all() { series } else { T::select(is_small, series, quotient()) }
}

/// The same by a root and a division alone: fewer operations, and a longer chain of them.
#[inline]
pub fn quotient_per_one_plus_cosine<T: Scalar>(sine_squared: T) -> T {
    (T::one() + (T::one() - sine_squared).sqrt()).recip()
}

/// The error of the first lane whose momentum is finite, as the others have none of their own.
#[cold]
pub(crate) fn beyond_right_angle<T: Scalar>(sine_squared: T) -> Error {
    match (0..T::LANES).map(|lane| sine_squared.lane(lane)).find(|square| square.is_finite()) {
        Some(square) => Error::unsolvable(square.sqrt().recip()),
        None => Error::NotFinite { name: "the momentum" },
    }
}

#[cfg(test)]
mod tests;
