//! Orthogonal projectors, Pᵀ = P and P² = P.

use super::{accumulate_where, corrected, largest, symmetric, symmetry_defect};
use crate::{Mask, Scalar, Space};
use nalgebra::SMatrix;

/// The largest entry of |P − Pᵀ| relative to the largest of P, and of |P² − P|, or |tr P − k|.
pub fn projector_defect<T: Scalar, const N: usize>(p: &SMatrix<T, N, N>, rank: usize) -> T {
    let trace = (0..N).fold(T::zero(), |sum, k| sum + p[(k, k)]);
    let of_rank = (trace - T::from_ratio(rank as i64, 1)).abs();
    largest([symmetry_defect(p), of_rank, missing(p, &SMatrix::zeros()).max_abs()])
}

/// P, symmetric by its entries above the diagonal. It is brought back to the next projector where |Pe|², e = (1, …, 1), is off e·Pe by more
/// than 8Nε. That takes one step 3P² − 2P³ of McWeeny. See [`orthogonal`](super::orthogonal).
///
/// Source: McWeeny, *Some recent advances in density matrix theory*, Rev. Mod. Phys. 32, 1960.
#[inline(always)]
pub fn projector<T: Scalar, const N: usize>(p: SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let p = symmetric(p);
    let is_off = is_off_projectors(&p);
    if !is_off.any() {
        return p;
    }
    let change = to_projectors(&p, &SMatrix::zeros());
    p.zip_map(&change, |entry, change| T::select(is_off, entry + change, entry))
}

/// The same for P + δ, where δ is the rounding error of sums, see [`orthogonal_with_rest`](super::orthogonal_with_rest).
#[inline(always)]
pub fn projector_with_rest<T: Scalar, const N: usize>(
    p: SMatrix<T, N, N>,
    rest: SMatrix<T, N, N>,
) -> (SMatrix<T, N, N>, SMatrix<T, N, N>) {
    let (p, rest) = (symmetric(p), symmetric(rest));
    let is_off = is_off_projectors(&p);
    if !is_off.any() {
        return (p, rest);
    }
    let change = to_projectors(&p, &rest);
    accumulate_where(is_off, p, rest, change)
}

/// The lanes in which |Pe|² is off e·Pe by more than 8Nε.
#[inline(always)]
fn is_off_projectors<T: Scalar, const N: usize>(p: &SMatrix<T, N, N>) -> T::Mask {
    let difference = p.row_iter().fold(T::zero(), |sum, row| {
        let along = row.iter().fold(T::zero(), |along, &entry| along + entry);
        sum + (along * along - along)
    });
    (T::from_ratio(8, 1) * T::EPSILON * T::from_ratio(N as i64, 1)).below(difference.abs())
}

/// The correction from P + δ to the nearest projector, NaN in lanes where there is none near.
#[cold]
#[inline(never)]
fn to_projectors<T: Scalar, const N: usize>(p: &SMatrix<T, N, N>, rest: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    corrected(purified, p, rest)
}

/// 3S² − 2S³ − S = (S − S²)(2S − I) of S = P + δ, symmetric, and the largest entry of its first factor.
fn purified<T: Scalar, const N: usize>(p: &SMatrix<T, N, N>, rest: &SMatrix<T, N, N>) -> (SMatrix<T, N, N>, T) {
    let missing = missing(p, rest);
    let change = SMatrix::<T, N, N>::from_fn(|i, j| {
        let start = -missing[(i, j)];
        (0..N).fold(start, |sum, k| sum + missing[(i, k)] * (p[(k, j)] + p[(k, j)]))
    });
    (symmetric(change), missing.max_abs())
}

/// S − S² of S = P + δ, of the size of the defect.
fn missing<T: Scalar, const N: usize>(p: &SMatrix<T, N, N>, rest: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    SMatrix::from_fn(|i, j| {
        let of_sums = (0..N).fold(p[(i, j)], |sum, k| sum - p[(i, k)] * p[(k, j)]);
        (0..N).fold(of_sums + rest[(i, j)], |sum, k| sum - p[(i, k)] * rest[(k, j)] - rest[(i, k)] * p[(k, j)])
    })
}
