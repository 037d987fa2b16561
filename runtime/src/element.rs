//! Group elements from what a step computes.

use crate::linear::{eliminate, multiple_of_identity, rows, undefined};
use crate::space::by_lane;
use crate::{Error, Mask, Scalar};
use nalgebra::{Quaternion, SMatrix, SVector};
use num_traits::One;

/// I + D.
pub fn from_increment<T: Scalar, const N: usize>(d: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let mut element = *d;
    for i in 0..N {
        element[(i, i)] += T::one();
    }
    element
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
    by_lane(a, |a| {
        let mut inverse = multiple_of_identity(T::Lane::one());
        match eliminate(rows(a), &mut inverse) {
            Some(_) => SMatrix::from_fn(|i, j| inverse[i][j]),
            None => undefined(),
        }
    })
}

/// The solution `x` where the step exists, whose angle θ has this sin²θ: below one, it does. Lanes in which it does not are NaN.
///
/// # Errors
/// Where it exists in no lane: [`Error::Unsolvable`] with 1/|sin θ|, the fraction of the momentum for which it would;
/// [`Error::NotFinite`].
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

/// The error of the first lane whose momentum is finite, as the others have none of their own.
#[cold]
fn beyond_right_angle<T: Scalar>(sine_squared: T) -> Error {
    match (0..T::LANES).map(|lane| sine_squared.lane(lane)).find(|square| square.is_finite()) {
        Some(square) => Error::Unsolvable { solvable_fraction: square.sqrt().recip().to_f64(), step_size: None },
        None => Error::NotFinite { name: "momentum" },
    }
}

#[cfg(test)]
mod tests {
    use super::{below_right_angle, inverse, quaternion_from_increment};
    use crate::Error;
    use nalgebra::{Matrix3, Matrix4, Quaternion, Vector1};

    #[test]
    fn steps_beyond_a_quarter_turn_say_by_how_much() {
        let check = |sine_squared: f64| below_right_angle(Vector1::new(1.0), sine_squared);
        assert_eq!(check(0.99), Ok(Vector1::new(1.0)));
        assert_eq!(check(4.0), Err(Error::Unsolvable { solvable_fraction: 0.5, step_size: None }));
        assert_eq!(check(f64::NAN), Err(Error::NotFinite { name: "momentum" }));
    }

    #[test]
    fn an_inverse_needs_its_pivots() {
        let permutation = Matrix4::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0);
        assert_eq!(permutation * inverse(&permutation), Matrix4::identity());
        assert!(inverse(&Matrix3::<f64>::zeros())[(0, 0)].is_nan());
    }

    #[test]
    fn a_quaternion_starts_at_one() {
        let increment = Quaternion::new(0.0, 1.0, 2.0, 3.0);
        assert_eq!(quaternion_from_increment(&increment), Quaternion::new(1.0, 1.0, 2.0, 3.0));
    }
}
