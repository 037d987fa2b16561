//! Where configurations lie: by how much they are off their groups and spheres.

use crate::linear::{Orientation, rows};
use crate::space::{lane_of, larger};
use crate::{Mask, Scalar};
use nalgebra::{SMatrix, SVector};

/// The largest entry of |RᵀR − I|; +∞ for a reflection, whose determinant is negative.
pub fn orthogonality_defect<T: Scalar, const N: usize>(r: &SMatrix<T, N, N>) -> T {
    let mut defect = T::zero();
    for i in 0..N {
        for j in 0..N {
            let product = (0..N).fold(T::zero(), |sum, k| sum + r[(k, i)] * r[(k, j)]);
            let expected = if i == j { T::one() } else { T::zero() };
            defect = larger(defect, (product - expected).abs());
        }
    }
    T::select(orientated(r, Orientation::NEGATIVE), T::one() / T::zero(), defect)
}

/// 0 for a matrix with a positive determinant, +∞ for the others: those on another component, or singular.
pub fn orientation_defect<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>) -> T {
    T::select(orientated(a, Orientation::POSITIVE), T::zero(), T::one() / T::zero())
}

/// The lanes in which the determinant has the sign `orientation`.
fn orientated<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>, orientation: Orientation) -> T::Mask {
    let has_sign = |lane| Orientation::of(rows(&lane_of(a, lane))) == Some(orientation);
    T::Mask::from_bits((0..T::LANES).fold(0, |bits, lane| bits | u16::from(has_sign(lane)) << lane))
}

/// ||q|² − 1|.
pub fn length_defect<T: Scalar, const N: usize>(q: &SVector<T, N>) -> T {
    (q.iter().fold(T::zero(), |sum, &x| sum + x * x) - T::one()).abs()
}

/// The largest of the sizes of some numbers; 0 for none, NaN where one of them is.
pub fn largest<T: Scalar, const K: usize>(values: [T; K]) -> T {
    largest_of(values.into_iter().map(|x| x.abs()))
}

/// The largest of numbers that are not negative. Unlike [`larger`] it keeps NaN, which overflow makes of a difference.
fn largest_of<T: Scalar>(values: impl Iterator<Item = T>) -> T {
    values.fold(T::zero(), |max, x| {
        let is_ordered = x.at_most(max) | max.at_most(x);
        T::select(is_ordered, larger(max, x), T::zero() / T::zero())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Matrix3, Vector3};

    #[test]
    fn rotations_have_no_defect_and_reflections_an_infinite_one() {
        let rotation = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        assert_eq!(orthogonality_defect(&rotation), 0.0);
        assert_eq!(orthogonality_defect(&-rotation), f64::INFINITY);
        assert_eq!(orthogonality_defect(&(rotation * 2.0)), 3.0);
    }

    #[test]
    fn orientations() {
        assert_eq!(orientation_defect(&Matrix2::new(1.25_f64, 0.75, 0.75, 1.25)), 0.0);
        assert_eq!(orientation_defect(&Matrix2::new(0.0, 1.0, 1.0, 0.0)), f64::INFINITY);
        assert_eq!(orientation_defect(&Matrix2::<f64>::zeros()), f64::INFINITY);
    }

    #[test]
    fn the_largest_number_keeps_what_is_none() {
        assert_eq!(largest([1.0, -3.0, 2.0]), 3.0);
        assert_eq!(largest::<f64, 0>([]), 0.0);
        for values in [[f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::NAN]] {
            assert!(largest(values).is_nan());
        }
        assert_eq!(largest([1.0, f64::INFINITY, 2.0]), f64::INFINITY);
    }

    #[test]
    fn lengths_are_squared() {
        assert_eq!(length_defect(&Vector3::new(0.0, 3.0, 0.0)), 8.0);
    }
}
