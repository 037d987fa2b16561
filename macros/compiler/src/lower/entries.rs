//! Grids of scalars: expressions are lowered to them, and kernels are built from them.

use clebsch_symbolic::{IntoList, Shape};

/// The identity of a scalar in its arena.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Scalar(pub(super) u32);

/// A matrix of scalars, row by row.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Grid {
    /// Rows and columns.
    pub shape: Shape,
    /// The entries, row by row.
    pub entries: Vec<Scalar>,
}

impl Grid {
    pub(super) fn from_fn(shape: Shape, entry: impl FnMut((usize, usize)) -> Scalar) -> Grid {
        Grid { shape, entries: shape.positions().map(entry).into_list() }
    }

    /// A matrix of one entry.
    pub fn scalar(entry: Scalar) -> Grid {
        Grid::vector(vec![entry])
    }

    /// A column.
    pub fn vector(entries: Vec<Scalar>) -> Grid {
        Grid { shape: Shape::vector(entries.len()), entries }
    }

    /// The entry in row i and column j.
    pub fn at(&self, i: usize, j: usize) -> Scalar {
        self.entries[i * self.shape.columns + j]
    }
}
