//! Block tridiagonal matrices, with a block in each corner in a ring: block elimination from the first row to the last.
//!
//! ```text
//! A_i x_i−1 + D_i x_i + B_i x_i+1 = b_i,    D̃_i = D_i − A_i U_i−1,    U_i = D̃_i⁻¹ B_i
//! ```
//! In a ring the last unknown is coupled to all others: V_i is its column, E_i its row.

use crate::Scalar;
use crate::linear::{divided, product};
use alloc::vec::Vec;
use nalgebra::{SMatrix, SVector};

type Square<T, const M: usize> = SMatrix<T, M, M>;

/// The blocks of a row.
#[derive(Clone, Copy, Debug)]
struct Row<T, const M: usize> {
    /// A
    before: Square<T, M>,
    /// D; behind an elimination D̃⁻¹.
    own: Square<T, M>,
    /// B; behind an elimination U.
    after: Square<T, M>,
}

/// The blocks of a row of a ring, where they are not of neighbours: the column of the last unknown and its row.
#[derive(Clone, Copy, Debug)]
struct Corner<T, const M: usize> {
    column: Square<T, M>,
    row: Square<T, M>,
}

/// A block tridiagonal matrix.
#[derive(Clone, Debug)]
pub(super) struct Tridiagonal<T, const M: usize> {
    rows: Vec<Row<T, M>>,
    /// None where it is no ring, or one of at most two rows.
    corners: Vec<Corner<T, M>>,
}

impl<T: Scalar, const M: usize> Tridiagonal<T, M> {
    pub fn new(rows: usize, is_ring: bool) -> Self {
        let zero = Square::from_element(T::zero());
        let corners = if is_ring { rows.saturating_sub(2) } else { 0 };
        Self {
            rows: alloc::vec![Row { before: zero, own: zero, after: zero }; rows],
            corners: alloc::vec![Corner { column: zero, row: zero }; corners],
        }
    }

    /// All blocks to 0.
    pub fn clear(&mut self) {
        let zero = Square::from_element(T::zero());
        self.rows.fill(Row { before: zero, own: zero, after: zero });
        self.corners.fill(Corner { column: zero, row: zero });
    }

    /// Adds to the block of a row and a column, which are neighbours or the same.
    pub fn add(&mut self, row: usize, column: usize, block: &Square<T, M>) {
        let last = self.rows.len().wrapping_sub(1);
        let place = match (self.rows.get_mut(row), self.corners.first_mut()) {
            (Some(blocks), _) if column == row => &mut blocks.own,
            (Some(blocks), _) if column == row + 1 => &mut blocks.after,
            (Some(blocks), _) if column + 1 == row => &mut blocks.before,
            (_, Some(corner)) if (row, column) == (last, 0) => &mut corner.row,
            (_, Some(corner)) if (row, column) == (0, last) => &mut corner.column,
            _ => return,
        };
        *place += block;
    }

    /// A row that says x = 0.
    pub fn hold(&mut self, row: usize) {
        let zero = Square::from_element(T::zero());
        let last = self.rows.len().wrapping_sub(1);
        if let Some(blocks) = self.rows.get_mut(row) {
            *blocks = Row { before: zero, own: Square::identity(), after: zero };
        }
        if let Some(corner) = self.corners.first_mut() {
            if row == 0 {
                corner.column = zero;
            }
            if row == last {
                corner.row = zero;
            }
        }
    }

    /// Eliminates. `None` where a pivot is singular or not finite.
    pub fn eliminate(&mut self) -> Option<()> {
        let zero = Square::from_element(T::zero());
        let (count, corners) = (self.rows.len(), self.corners.len());
        // U of the row before; of a ring V behind it and E in front of it, and Σ E_i V_i
        let (mut after, mut column, mut row, mut of_last) = (zero, zero, zero, zero);
        for (i, blocks) in self.rows.iter_mut().enumerate() {
            let corner = self.corners.get_mut(i);
            if let (true, Some(corner)) = (i == 0, &corner) {
                (column, row) = (corner.column, corner.row);
            } else if corners > 0 {
                column = -product(&blocks.before, &column);
            }
            if corners > 0 && corner.is_none() {
                // the fill meets the neighbours of the last unknown
                if i + 1 == count {
                    blocks.before += row;
                    blocks.own -= of_last;
                } else {
                    blocks.after += column;
                }
            }
            blocks.own -= product(&blocks.before, &after);
            blocks.own = divided(&blocks.own, &Square::identity())?;
            blocks.after = product(&blocks.own, &blocks.after);
            after = blocks.after;
            if let Some(corner) = corner {
                *corner = Corner { column: product(&blocks.own, &column), row };
                column = corner.column;
                of_last += product(&row, &column);
                row = -product(&row, &after);
            }
        }
        Some(())
    }

    /// Solves in place of the right sides, behind an elimination.
    pub fn solve(&self, right: &mut [SVector<T, M>]) {
        let count = right.len();
        let mut before = SVector::from_element(T::zero());
        let mut of_last = SVector::from_element(T::zero());
        for (i, (right, blocks)) in right.iter_mut().zip(&self.rows).enumerate() {
            if i + 1 == count {
                *right -= of_last;
            }
            *right = product(&blocks.own, &(*right - product(&blocks.before, &before)));
            before = *right;
            if let Some(corner) = self.corners.get(i) {
                of_last += product(&corner.row, &before);
            }
        }
        let last = before;
        let mut after = SVector::from_element(T::zero());
        for (i, (right, blocks)) in right.iter_mut().zip(&self.rows).enumerate().rev() {
            *right -= product(&blocks.after, &after);
            if let Some(corner) = self.corners.get(i) {
                *right -= product(&corner.column, &last);
            }
            after = *right;
        }
    }
}

#[cfg(test)]
mod tests;
