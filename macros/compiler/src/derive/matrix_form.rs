//! Matrices of derivatives, which are made when a kernel asks for them.

use clebsch_symbolic::{Expr, Shape};

/// A matrix as it is derived.
#[derive(Clone)]
pub enum MatrixForm<'g> {
    /// One expression.
    Whole(Expr<'g>),
    /// Its columns, each of vectors that stand one below the other.
    Columns(Vec<Vec<Expr<'g>>>),
    /// Its entries, row by row.
    Entries(Shape, Vec<Expr<'g>>),
}

impl<'g> MatrixForm<'g> {
    /// A matrix whose columns are one vector each.
    pub fn of_columns(columns: impl IntoIterator<Item = Expr<'g>>) -> MatrixForm<'g> {
        MatrixForm::Columns(columns.into_iter().map(|column| vec![column]).collect())
    }

    /// One expression for each matrix, where they are such.
    pub fn wholes(matrices: &[MatrixForm<'g>]) -> Option<Vec<Expr<'g>>> {
        let whole = |matrix: &MatrixForm<'g>| if let MatrixForm::Whole(whole) = matrix { Some(*whole) } else { None };
        matrices.iter().map(whole).collect()
    }
}
