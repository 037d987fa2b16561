//! Shapes of matrices. Scalars are 1×1, vectors are n×1.

use std::fmt;

/// Rows and columns of a matrix.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Shape {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
}

impl Shape {
    /// The shape of `rows` × `columns` matrices.
    pub const fn new(rows: usize, columns: usize) -> Shape {
        Shape { rows, columns }
    }

    /// 1×1.
    pub const fn scalar() -> Shape {
        Shape::new(1, 1)
    }

    /// n×1.
    pub const fn vector(n: usize) -> Shape {
        Shape::new(n, 1)
    }

    /// n×n.
    pub const fn square(n: usize) -> Shape {
        Shape::new(n, n)
    }

    /// Whether this is 1×1.
    pub fn is_scalar(self) -> bool {
        self == Shape::scalar()
    }

    /// Whether there are as many rows as columns.
    pub fn is_square(self) -> bool {
        self.rows == self.columns
    }

    /// Whether this is a column vector, 1×1 included.
    pub fn is_column(self) -> bool {
        self.columns == 1
    }

    /// The shape of the transpose.
    pub fn transposed(self) -> Shape {
        Shape::new(self.columns, self.rows)
    }

    /// Number of entries.
    pub fn len(self) -> usize {
        self.rows * self.columns
    }

    /// Whether there are no entries.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// All positions, row by row.
    pub fn positions(self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.rows).flat_map(move |i| (0..self.columns).map(move |j| (i, j)))
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.rows, self.columns)
    }
}
