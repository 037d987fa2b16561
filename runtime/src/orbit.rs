//! Where configurations lie: by how much they are off their groups and spheres.

use crate::linear::rows;
use crate::orientation::Orientation;
use crate::space::larger;
use crate::sums::accumulate;
use crate::{Mask, Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// The largest defect of a rotation or of a unit vector that is corrected, relative to its size.
const LARGEST_DEFECT: f64 = 1.0 / 1024.0;

/// The largest entry of |RᵀR − I|; +∞ for a reflection, whose determinant is negative.
pub fn orthogonality_defect<T: Scalar, const N: usize>(r: &SMatrix<T, N, N>) -> T {
    T::select(orientated(r, Orientation::NEGATIVE), T::one() / T::zero(), orthonormality_defect(r))
}

/// The largest entry of |XᵀX − I|.
pub fn orthonormality_defect<T: Scalar, const R: usize, const C: usize>(x: &SMatrix<T, R, C>) -> T {
    let mut defect = T::zero();
    for i in 0..C {
        for j in 0..C {
            let product = (0..R).fold(T::zero(), |sum, k| sum + x[(k, i)] * x[(k, j)]);
            let expected = if i == j { T::one() } else { T::zero() };
            defect = larger(defect, (product - expected).abs());
        }
    }
    defect
}

/// 0 for a matrix with a positive determinant, +∞ for the others: those on another component, or singular.
pub fn orientation_defect<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>) -> T {
    T::select(orientated(a, Orientation::POSITIVE), T::zero(), T::one() / T::zero())
}

/// The lanes in which the determinant has the sign `orientation`.
fn orientated<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>, orientation: Orientation) -> T::Mask {
    let has_sign = |lane| Orientation::of(rows(&a.lane(lane))) == Some(orientation);
    T::Mask::from_bits((0..T::LANES).fold(0, |bits, lane| bits | u16::from(has_sign(lane)) << lane))
}

/// ||q|² − 1|.
pub fn length_defect<T: Scalar, const N: usize>(q: &SVector<T, N>) -> T {
    (q.iter().fold(T::zero(), |sum, &x| sum + x * x) - T::one()).abs()
}

/// The largest entry of |P − Pᵀ|, relative to the largest of P.
pub fn symmetry_defect<T: Scalar, const N: usize>(p: &SMatrix<T, N, N>) -> T {
    let defect = (p - p.transpose()).max_abs();
    T::select(defect.at_most(T::zero()), T::zero(), defect / p.max_abs())
}

/// P with the entries above its diagonal below it too: formulas of symmetric matrices read these.
#[inline(always)]
pub fn symmetric<T: Scalar, const N: usize>(p: SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    SMatrix::from_fn(|i, j| p[(i.min(j), i.max(j))])
}

/// The same for P + δ, where δ is the rounding error of sums.
#[inline(always)]
pub fn symmetric_with_rest<T: Scalar, const N: usize>(
    p: SMatrix<T, N, N>,
    rest: SMatrix<T, N, N>,
) -> (SMatrix<T, N, N>, SMatrix<T, N, N>) {
    (symmetric(p), symmetric(rest))
}

/// R, brought back to the next rotation where |Re|², e = (1, …, 1), is off N by more than 8Nε. It takes one step R(3I −
/// RᵀR)/2 of Newton and Schulz. Without it, rounding of products would add up like √steps. |Re|² costs N² additions
/// that nothing waits for; corrections are rare. Matrices of C orthonormal columns come back in the same way, with C for N.
///
/// Starts may be off by √ε: one step of Newton and Schulz leaves round-off. A larger defect takes three steps. Beyond
/// 1/1024 the result is NaN, as formulas have lost their digits.
///
/// Source: Higham, *Functions of Matrices*, section 8.3.
#[inline(always)]
pub fn orthogonal<T: Scalar, const R: usize, const C: usize>(r: SMatrix<T, R, C>) -> SMatrix<T, R, C> {
    let is_off = is_off_rotations(&r);
    if !is_off.any() {
        return r;
    }
    // a copy: passing it by reference would force it into memory in every step
    let moved = r;
    let change = to_rotations(&moved, &SMatrix::zeros());
    r.zip_map(&change, |entry, change| T::select(is_off, entry + change, entry))
}

/// The same for R + δ, where δ is the rounding error of sums. The correction is added as the step was, and its rounding
/// error is returned in turn.
#[inline(always)]
pub fn orthogonal_with_rest<T: Scalar, const R: usize, const C: usize>(
    r: SMatrix<T, R, C>,
    rest: SMatrix<T, R, C>,
) -> (SMatrix<T, R, C>, SMatrix<T, R, C>) {
    let is_off = is_off_rotations(&r);
    if !is_off.any() {
        return (r, rest);
    }
    let (moved, left) = (r, rest);
    accumulate_where(is_off, r, rest, to_rotations(&moved, &left))
}

/// The lanes in which |Re|² is off their number by more than 8ε of it.
#[inline(always)]
fn is_off_rotations<T: Scalar, const R: usize, const C: usize>(r: &SMatrix<T, R, C>) -> T::Mask {
    let square = r.row_iter().fold(T::zero(), |sum, row| {
        let along = row.iter().fold(T::zero(), |along, &entry| along + entry);
        sum + along * along
    });
    let expected = T::from_ratio(C as i64, 1);
    (T::from_ratio(8, 1) * T::EPSILON * expected).below((square - expected).abs())
}

/// The correction from R + δ to the nearest rotation, NaN in lanes where there is none near.
#[cold]
#[inline(never)]
fn to_rotations<T: Scalar, const R: usize, const C: usize>(
    r: &SMatrix<T, R, C>,
    rest: &SMatrix<T, R, C>,
) -> SMatrix<T, R, C> {
    corrected(newton_schulz, r, rest)
}

/// The correction from X + δ by an iteration whose step gives the change and the defect. It is one step from near, three steps from
/// further away, and NaN in the lanes beyond [`LARGEST_DEFECT`].
#[inline(always)]
fn corrected<T: Scalar, const R: usize, const C: usize>(
    step: impl Fn(&SMatrix<T, R, C>, &SMatrix<T, R, C>) -> (SMatrix<T, R, C>, T),
    x: &SMatrix<T, R, C>,
    rest: &SMatrix<T, R, C>,
) -> SMatrix<T, R, C> {
    let (change, missing) = step(x, rest);
    let is_near = missing.at_most(T::from_ratio(C as i64, 1) * T::EPSILON.sqrt());
    if is_near.all() {
        return change;
    }
    let again = (0..2).fold(change, |change, _| change + step(&(x + change), rest).0);
    let is_known = missing.at_most(T::from_f64(LARGEST_DEFECT));
    change.zip_map(&again, |change, again| T::select(is_near, change, known(is_known, again)))
}

/// `value` in the lanes of the mask, NaN in the others.
#[inline]
fn known<T: Scalar>(mask: T::Mask, value: T) -> T {
    T::select(mask, value, T::zero() / T::zero())
}

/// R(I − RᵀR − Rᵀδ − δᵀR)/2, and the largest entry of its second factor.
fn newton_schulz<T: Scalar, const R: usize, const C: usize>(
    r: &SMatrix<T, R, C>,
    rest: &SMatrix<T, R, C>,
) -> (SMatrix<T, R, C>, T) {
    // of the size of the defect
    let missing = SMatrix::<T, C, C>::from_fn(|i, j| {
        let start = if i == j { T::one() } else { T::zero() };
        let of_sums = (0..R).fold(start, |sum, k| sum - r[(k, i)] * r[(k, j)]);
        let of_rests = (0..R).fold(T::zero(), |sum, k| sum + r[(k, i)] * rest[(k, j)] + rest[(k, i)] * r[(k, j)]);
        (of_sums - of_rests) * T::from_ratio(1, 2)
    });
    let change = SMatrix::from_fn(|i, j| (0..C).fold(T::zero(), |sum, k| sum + r[(i, k)] * missing[(k, j)]));
    (change, missing.max_abs())
}

/// `sum` + `change` with its rounding error, in the lanes of the mask.
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

/// q, brought back to length one by q(3 − |q|²)/2 where rounding has moved |q|² off by more than 8ε. NaN where it is no
/// unit vector. See [`orthogonal`].
#[inline(always)]
pub fn of_length_one<T: Scalar, const N: usize>(q: SVector<T, N>) -> SVector<T, N> {
    let missing = short_of_one(&q);
    let is_off = is_off_length_one(missing);
    if !is_off.any() {
        return q;
    }
    let longer = longer(missing);
    q.map(|x| T::select(is_off, x + x * longer, x))
}

/// The same without a branch, for a q that a rotation has moved. Behind it is whether |q|² is off one by less than 1/1024.
#[inline(always)]
pub fn near_length_one<T: Scalar, const N: usize>(q: SVector<T, N>) -> (SVector<T, N>, bool) {
    let missing = short_of_one(&q);
    let longer = T::select(is_off_length_one(missing), missing * T::from_ratio(1, 2), T::zero());
    (q.map(|x| x + x * longer), missing.abs().below(T::from_f64(LARGEST_DEFECT)).all())
}

/// λ with |q + λq| = 1, from 1 − |q|². NaN in lanes where |q|² is off one by more than [`LARGEST_DEFECT`].
#[inline(always)]
pub(crate) fn longer<T: Scalar>(missing: T) -> T {
    let is_near = missing.abs().at_most(T::from_ratio(4, 1) * T::EPSILON.sqrt());
    let longer = missing * T::from_ratio(1, 2);
    if is_near.all() { longer } else { T::select(is_near, longer, much_longer(missing)) }
}

#[cold]
#[inline(never)]
fn much_longer<T: Scalar>(missing: T) -> T {
    // of the value alone: |x| of a number with derivatives may count them
    let limit = T::from_f64(LARGEST_DEFECT);
    let is_known = missing.at_most(limit) & (-limit).at_most(missing);
    known(is_known, (T::one() - missing).sqrt().recip() - T::one())
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
    // by half of 1 − |q|² − 2 q·δ
    let along = q.zip_fold(&rest, T::zero(), |sum, x, left| sum + x * left);
    let scale = longer(missing) - along;
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

/// The largest of the sizes of some numbers; 0 for none, and NaN, which overflow makes of a difference, where one of them is.
pub fn largest<T: Scalar, const K: usize>(values: [T; K]) -> T {
    values.into_iter().map(|x| x.abs()).fold(T::zero(), |max, x| {
        let is_ordered = x.at_most(max) | max.at_most(x);
        T::select(is_ordered, larger(max, x), T::zero() / T::zero())
    })
}

mod projector;

pub use projector::{projector, projector_defect, projector_with_rest};

#[cfg(test)]
mod tests;
