//! Where configurations lie: by how much they are off their groups and spheres.

use crate::linear::rows;
use crate::orientation::Orientation;
use crate::space::{lane_of, larger};
use crate::summation::accumulate;
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

/// R, brought back by one step R(3I − RᵀR)/2 of Newton and Schulz to the rotation next to it where rounding has moved |Re|², e = (1, …, 1), off N by more
/// than 8Nε.
///
/// After each product of rotations: rounding would add up like √steps. All entries of RᵀR count in |Re|², which costs N² additions that nothing waits
/// for; the correction is made once in some hundred steps.
///
/// Source: Higham, *Functions of Matrices*, section 8.3.
#[inline(always)]
pub fn orthogonal<T: Scalar, const N: usize>(r: SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let is_off = is_off_rotations(&r);
    if !is_off.any() {
        return r;
    }
    // a copy: what is handed on by reference would be kept in memory at every step
    let moved = r;
    let change = to_rotations(&moved, &SMatrix::zeros());
    r.zip_map(&change, |entry, change| T::select(is_off, entry + change, entry))
}

/// The same for R + δ, where δ is what sums have left: the correction is added as the step was, and its rest is left in turn.
#[inline(always)]
pub fn orthogonal_with_rest<T: Scalar, const N: usize>(
    r: SMatrix<T, N, N>,
    rest: SMatrix<T, N, N>,
) -> (SMatrix<T, N, N>, SMatrix<T, N, N>) {
    let is_off = is_off_rotations(&r);
    if !is_off.any() {
        return (r, rest);
    }
    let (moved, left) = (r, rest);
    accumulate_where(is_off, r, rest, to_rotations(&moved, &left))
}

/// The lanes in which |Re|² is off N by more than 8Nε.
#[inline(always)]
fn is_off_rotations<T: Scalar, const N: usize>(r: &SMatrix<T, N, N>) -> T::Mask {
    let square = r.row_iter().fold(T::zero(), |sum, row| {
        let along = row.iter().fold(T::zero(), |along, &entry| along + entry);
        sum + along * along
    });
    let expected = T::from_ratio(N as i64, 1);
    (T::from_ratio(8, 1) * T::EPSILON * expected).below((square - expected).abs())
}

/// R(I − RᵀR − Rᵀδ − δᵀR)/2, what takes R + δ to the rotation next to it.
#[cold]
#[inline(never)]
fn to_rotations<T: Scalar, const N: usize>(r: &SMatrix<T, N, N>, rest: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    // of the size of the defect
    let missing = SMatrix::<T, N, N>::from_fn(|i, j| {
        let start = if i == j { T::one() } else { T::zero() };
        let of_sums = (0..N).fold(start, |sum, k| sum - r[(k, i)] * r[(k, j)]);
        let of_rests = (0..N).fold(T::zero(), |sum, k| sum + r[(k, i)] * rest[(k, j)] + rest[(k, i)] * r[(k, j)]);
        (of_sums - of_rests) * T::from_ratio(1, 2)
    });
    SMatrix::from_fn(|i, j| (0..N).fold(T::zero(), |sum, k| sum + r[(i, k)] * missing[(k, j)]))
}

/// `sum` + `change` with the rest, in the lanes of the mask.
fn accumulate_where<T: Scalar, const R: usize, const C: usize>(
    mask: T::Mask,
    sum: SMatrix<T, R, C>,
    rest: SMatrix<T, R, C>,
    change: SMatrix<T, R, C>,
) -> (SMatrix<T, R, C>, SMatrix<T, R, C>) {
    let (changed, left) = accumulate::<T, _>(&sum, &rest, &change);
    let select = |yes: T, no: T| T::select(mask, yes, no);
    (changed.zip_map(&sum, select), left.zip_map(&rest, select))
}

/// q, brought back to length one by q(3 − |q|²)/2 where rounding has moved |q|² off by more than 8ε. See [`orthogonal`].
#[inline(always)]
pub fn of_length_one<T: Scalar, const N: usize>(q: SVector<T, N>) -> SVector<T, N> {
    let half = T::from_ratio(1, 2);
    let missing = short_of_one(&q);
    let is_off = is_off_length_one(missing);
    if is_off.any() { q.map(|x| T::select(is_off, x + x * (half * missing), x)) } else { q }
}

/// The same for q + δ, see [`orthogonal_with_rest`].
#[inline(always)]
pub fn of_length_one_with_rest<T: Scalar, const N: usize>(
    q: SVector<T, N>,
    rest: SVector<T, N>,
) -> (SVector<T, N>, SVector<T, N>) {
    let missing = short_of_one(&q);
    let is_off = is_off_length_one(missing);
    if !is_off.any() {
        return (q, rest);
    }
    // half of 1 − |q|² − 2 q·δ
    let along = q.zip_fold(&rest, T::zero(), |sum, x, left| sum + x * left);
    let scale = missing * T::from_ratio(1, 2) - along;
    accumulate_where(is_off, q, rest, q.map(|x| x * scale))
}

/// 1 − |q|².
#[inline(always)]
fn short_of_one<T: Scalar, const N: usize>(q: &SVector<T, N>) -> T {
    q.iter().fold(T::one(), |sum, &x| sum - x * x)
}

/// The lanes in which |q|² is off one by more than 8ε.
#[inline(always)]
fn is_off_length_one<T: Scalar>(missing: T) -> T::Mask {
    (T::from_ratio(8, 1) * T::EPSILON).below(missing.abs())
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

    /// The polar factor of a matrix near a rotation by Newton's method for XᵀX = I, X ← (X + X⁻ᵀ)/2.
    ///
    /// Source: Higham, *Computing the polar decomposition, with applications*, SIAM J. Sci. Stat. Comput. 7, 1986. Not by singular values: Miri
    /// refuses a view of a view in those of nalgebra 0.35 (its issue 1588).
    fn nearest_rotation(a: Matrix3<f64>) -> Matrix3<f64> {
        (0..6).fold(a, |x, _| (x + x.try_inverse().expect("regular").transpose()) / 2.0)
    }

    /// To the square of the defect; what is off by rounding only keeps its bits, and NaN stay.
    #[test]
    fn what_has_left_its_space_comes_back() {
        let rotation = Matrix3::new(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
        assert_eq!(orthogonal(rotation), rotation);
        for defect in [1e-13, 1e-8, 1e-4] {
            let off = rotation + Matrix3::new(1.0, 0.5, -0.25, 0.75, 1.0, 0.5, -1.0, 0.25, 0.5) * defect;
            let error = (orthogonal(off) - nearest_rotation(off)).amax();
            assert!(error <= 4.0 * defect * defect + 4.0 * f64::EPSILON, "{defect:e}: {error:e}");
            let q = Vector3::new(0.6, 0.0, -0.8) * (1.0 + defect);
            let error = (of_length_one(q).norm() - 1.0).abs();
            assert!(error <= 4.0 * defect * defect + 2.0 * f64::EPSILON, "{defect:e}: {error:e}");
        }
        assert!(orthogonal(rotation.map(|_| f64::NAN)).iter().all(|entry| entry.is_nan()));
        assert_eq!(of_length_one(Vector3::<f64>::y()), Vector3::y());
    }

    /// R + δ and q + δ come back as exactly as R and q do, though δ is counted apart; what is on its space keeps its rest.
    #[test]
    fn rests_are_brought_back_too() {
        let rotation = Matrix3::new(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
        let direction = Matrix3::new(1.0, 0.5, -0.25, 0.75, 1.0, 0.5, -1.0, 0.25, 0.5);
        for defect in [1e-13, 1e-8, 1e-4] {
            // a rest of the size of the defect: what rounding leaves is too small to be seen
            let (r, rest) = (rotation + direction * defect, direction.transpose() * defect);
            let nearest = nearest_rotation(r + rest);
            let (r, rest) = orthogonal_with_rest(r, rest);
            let error = (r + rest - nearest).amax();
            assert!(error <= 16.0 * defect * defect + 4.0 * f64::EPSILON, "{defect:e}: {error:e}");
            assert!(rest.amax() <= f64::EPSILON / 2.0, "{rest}");

            let (q, rest) = (Vector3::new(0.6, 0.0, -0.8) * (1.0 + defect), Vector3::new(0.25, 0.5, -0.5) * defect);
            let (q, rest) = of_length_one_with_rest(q, rest);
            let error = ((q + rest).norm() - 1.0).abs();
            assert!(error <= 4.0 * defect * defect + 2.0 * f64::EPSILON, "{defect:e}: {error:e}");
            assert!(rest.amax() <= f64::EPSILON / 2.0, "{rest}");
        }
        let rest = direction * 1e-17;
        assert_eq!(orthogonal_with_rest(rotation, rest), (rotation, rest));
        let rest = Vector3::repeat(1e-17);
        assert_eq!(of_length_one_with_rest(Vector3::y(), rest), (Vector3::y(), rest));
    }

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
