//! Symmetric block tridiagonal matrices, with a block in each corner in a ring: LDLᵀ from the first block to the last.
//!
//! ```text
//! S_ii = D_i,    S_i,i−1 = C_i,    in a ring S_0,n−1 = C_0
//! L_i = C_i D̃⁻¹_i−1,    D̃_i = D_i − L_i C_iᵀ
//! ```
//! The corner fills the last row: G_i = E_i D̃_i⁻¹ with E_0 = C_0ᵀ and E_i = −E_i−1 L_iᵀ. The block before the last takes
//! E into its coupling.
//!
//! All is done block by block, so that one pass over the sites does it with the other work of a site.

use crate::{Mask, Scalar};
use nalgebra::{SMatrix, SVector};

/// The blocks of one site.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block<T, const R: usize> {
    /// D̃_i⁻¹
    inverse: SMatrix<T, R, R>,
    /// L_i
    lower: SMatrix<T, R, R>,
    /// G_i, in a ring.
    fill: SMatrix<T, R, R>,
    /// The right side; after a solve the solution.
    pub right: SVector<T, R>,
}

impl<T: Scalar, const R: usize> Block<T, R> {
    pub fn zero() -> Self {
        let zero = SMatrix::from_element(T::zero());
        Self { inverse: zero, lower: zero, fill: zero, right: SVector::from_element(T::zero()) }
    }

    /// D̃⁻¹
    #[inline(always)]
    pub fn inverse(&self) -> &SMatrix<T, R, R> {
        &self.inverse
    }

    #[inline(always)]
    pub fn set_inverse(&mut self, inverse: SMatrix<T, R, R>) {
        self.inverse = inverse;
    }
}

/// The place of a block among n.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub site: usize,
    pub sites: usize,
    pub is_ring: bool,
}

impl Place {
    #[inline(always)]
    fn is_first(self) -> bool {
        self.site == 0
    }

    #[inline(always)]
    fn is_last(self) -> bool {
        self.site + 1 == self.sites
    }

    /// Whether the block of the last row and of this column is filled.
    #[inline(always)]
    fn is_filled(self) -> bool {
        self.is_ring && self.site + 2 < self.sites
    }
}

/// An elimination that has come to some block.
pub(crate) struct Elimination<T, const R: usize> {
    /// D̃⁻¹ of the block before.
    before: SMatrix<T, R, R>,
    /// E
    corner: SMatrix<T, R, R>,
    /// Σ G_i E_iᵀ
    of_last: SMatrix<T, R, R>,
    /// The pivots that are 0.
    pub zeros: usize,
    /// The site of the first of them.
    pub first: usize,
}

impl<T: Scalar, const R: usize> Elimination<T, R> {
    pub fn new() -> Self {
        let zero = SMatrix::from_element(T::zero());
        Self { before: zero, corner: zero, of_last: zero, zeros: 0, first: 0 }
    }

    /// Takes the next block, D and C. A pivot of at most the part `least` of its entry in S counts as 0, and its row is left out.
    #[inline(always)]
    pub fn add(
        &mut self,
        block: &mut Block<T, R>,
        (mut diagonal, mut coupling): (SMatrix<T, R, R>, SMatrix<T, R, R>),
        at: Place,
        least: T,
    ) {
        let entries = diagonal.diagonal();
        if at.is_first() {
            self.corner = coupling.transpose();
        } else {
            if at.is_ring && at.is_last() {
                coupling += self.corner;
                diagonal -= self.of_last;
            }
            block.lower = coupling * self.before;
            diagonal -= block.lower * coupling.transpose();
            if at.is_ring && !at.is_last() {
                self.corner = -(self.corner * block.lower.transpose());
            }
        }
        let zeros = invert(&mut diagonal, &entries, least);
        if zeros > 0 && self.zeros == 0 {
            self.first = at.site;
        }
        self.zeros += zeros;
        if at.is_filled() {
            block.fill = self.corner * diagonal;
            self.of_last += block.fill * self.corner.transpose();
        }
        block.inverse = diagonal;
        self.before = diagonal;
    }
}

/// The solution of L y = right that has come to some block.
pub(crate) struct Forward<T, const R: usize> {
    before: SVector<T, R>,
    of_last: SVector<T, R>,
}

impl<T: Scalar, const R: usize> Forward<T, R> {
    pub fn new() -> Self {
        let zero = SVector::from_element(T::zero());
        Self { before: zero, of_last: zero }
    }

    /// Takes the next right side.
    #[inline(always)]
    pub fn add(&mut self, block: &mut Block<T, R>, mut right: SVector<T, R>, at: Place) {
        if !at.is_first() {
            right -= block.lower * self.before;
        }
        if at.is_ring && at.is_last() {
            right -= self.of_last;
        }
        if at.is_filled() {
            self.of_last += block.fill * right;
        }
        block.right = right;
        self.before = right;
    }
}

/// The solution of D Lᵀ x = y that has come back to some block.
pub(crate) struct Backward<T, const R: usize> {
    /// L_i+1ᵀ x_i+1
    known: SVector<T, R>,
    /// x_n−1
    last: SVector<T, R>,
}

impl<T: Scalar, const R: usize> Backward<T, R> {
    pub fn new() -> Self {
        let zero = SVector::from_element(T::zero());
        Self { known: zero, last: zero }
    }

    /// Takes the block before, and returns its solution.
    #[inline(always)]
    pub fn add(&mut self, block: &mut Block<T, R>, at: Place) -> SVector<T, R> {
        let mut solved = block.inverse * block.right - self.known;
        if at.is_filled() {
            solved -= block.fill.transpose() * self.last;
        }
        if at.is_last() {
            self.last = solved;
        }
        block.right = solved;
        self.known = block.lower.transpose() * solved;
        solved
    }
}

/// The inverse of a symmetric positive matrix by sweeps, without exchanges. Returns the number of pivots that count as 0:
/// their rows and columns are 0 in the inverse.
///
/// A positive matrix needs no exchanges: no entry of an elimination exceeds the largest of the matrix, in any order of
/// the pivots. The error of a solution is that of Cholesky's method, which no scale of the rows changes.
///
/// Sources: Goodnight, *A tutorial on the SWEEP operator*, The American Statistician 33 (1979). Higham, *Accuracy and
/// Stability of Numerical Algorithms* (2002), §10.1 and §14.4.
pub(super) fn invert<T: Scalar, const R: usize>(a: &mut SMatrix<T, R, R>, entries: &SVector<T, R>, least: T) -> usize {
    let mut zeros = 0;
    for k in 0..R {
        zeros += usize::from(!sweep(a, k, least * entries[k]));
    }
    *a = -*a;
    zeros
}

/// The same with the largest pivot first, each as a part of its entry. In lanes its least lane counts.
///
/// Rows that almost depend on each other come last, and rounding at their small pivots does not hide rows that do.
pub(super) fn invert_by_size<T: Scalar, const R: usize>(
    a: &mut SMatrix<T, R, R>,
    entries: &SVector<T, R>,
    least: T,
) -> usize {
    let (mut zeros, mut is_swept) = (0, [false; R]);
    for _ in 0..R {
        let (mut best, mut size) = (R, f64::NEG_INFINITY);
        for k in 0..R {
            if is_swept[k] {
                continue;
            }
            let part = a[(k, k)] / entries[k];
            let part = (0..T::LANES).map(|lane| part.lane(lane).to_f64()).fold(f64::INFINITY, f64::min);
            if best == R || part > size {
                (best, size) = (k, part);
            }
        }
        for k in 0..R {
            if k == best {
                is_swept[k] = true;
                zeros += usize::from(!sweep(a, k, least * entries[k]));
            }
        }
    }
    *a = -*a;
    zeros
}

/// Takes the pivot k, which counts as 0 if it is at most so large. Tells whether it does not.
#[inline(always)]
fn sweep<T: Scalar, const R: usize>(a: &mut SMatrix<T, R, R>, k: usize, most: T) -> bool {
    let pivot = a[(k, k)];
    // written so that NaN is no pivot
    let is_pivot = most.below(pivot);
    let inverse = T::select(is_pivot, pivot.recip(), T::zero());
    for i in 0..R {
        for j in 0..R {
            if i != k && j != k {
                let product = a[(i, k)] * a[(k, j)] * inverse;
                a[(i, j)] -= product;
            }
        }
    }
    for i in 0..R {
        if i != k {
            a[(i, k)] *= inverse;
            a[(k, i)] *= inverse;
        }
    }
    a[(k, k)] = -inverse;
    is_pivot.all()
}

#[cfg(test)]
mod tests;
