//! Group elements from what a step computes.

use crate::linear::{eliminate, multiple_of_identity, rows, undefined};
use crate::{Error, Scalar};
use nalgebra::{Quaternion, SMatrix, SVector};

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
    let mut inverse = multiple_of_identity(T::one());
    match eliminate(rows(a), &mut inverse) {
        Some(_) => SMatrix::from_fn(|i, j| inverse[i][j]),
        None => undefined(),
    }
}

/// Whether a step whose angle θ has this sin²θ exists: below one, it does.
///
/// # Errors
/// [`Error::Unsolvable`] with 1/|sin θ|, the fraction of the momentum for which it would; [`Error::NotFinite`].
#[inline]
pub fn check_sine_squared<T: Scalar>(sine_squared: T) -> Result<(), Error> {
    if sine_squared < T::one() {
        return Ok(());
    }
    if !sine_squared.is_finite() {
        return Err(Error::NotFinite { name: "momentum" });
    }
    Err(Error::Unsolvable { solvable_fraction: sine_squared.sqrt().recip().to_f64(), step_size: None })
}

#[cfg(test)]
mod tests {
    use super::{check_sine_squared, inverse, quaternion_from_increment};
    use crate::Error;
    use nalgebra::{Matrix3, Matrix4, Quaternion};

    #[test]
    fn steps_beyond_a_quarter_turn_say_by_how_much() {
        assert_eq!(check_sine_squared(0.99), Ok(()));
        assert_eq!(check_sine_squared(4.0), Err(Error::Unsolvable { solvable_fraction: 0.5, step_size: None }));
        assert_eq!(check_sine_squared(f64::NAN), Err(Error::NotFinite { name: "momentum" }));
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
