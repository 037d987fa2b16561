//! Kernels of given expressions: each by itself, one below the other in one vector, or as matrices.

use clebsch_symbolic::{Expr, Shape};

use super::kernel::kernel;
use super::{Hoisting, Kernel, Lowering, Scalar, Scalars, matrices};
use crate::derive::{Formulas, Id, MatrixForm};

/// The kernel of a formula, one output for each of its expressions, nothing taken out.
pub(super) fn of_row(formulas: &Formulas<'_>, id: Id, scalars: &mut Scalars) -> Kernel {
    plain(scalars, formulas.value(id).unwrap_or_default())
}

/// Several expressions, one output each, nothing taken out.
pub(super) fn plain(scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Kernel {
    separate(scalars, expressions, Hoisting::Nothing)
}

/// Several expressions, one output each.
pub(super) fn separate(scalars: &mut Scalars, expressions: &[Expr<'_>], hoisting: Hoisting<'_>) -> Kernel {
    if scalars.keeps_matrices {
        return matrices::kernel(expressions);
    }
    let outputs = grids(scalars, expressions);
    kernel(scalars, &outputs, hoisting)
}

/// Vectors, one after the other in one output.
pub(super) fn stack(scalars: &mut Scalars, vectors: &[Expr<'_>], hoisting: Hoisting<'_>) -> Kernel {
    if scalars.keeps_matrices {
        return matrices::stack(vectors);
    }
    let entries = entries(scalars, vectors);
    kernel(scalars, &[(Shape::vector(entries.len()), entries)], hoisting)
}

/// Matrices, one output each: with whole matrices where all of them are such.
pub(super) fn of_matrices(scalars: &mut Scalars, forms: &[MatrixForm<'_>], hoisting: Hoisting<'_>) -> Kernel {
    if let Some(wholes) = MatrixForm::wholes(forms).filter(|_| scalars.keeps_matrices) {
        return matrices::kernel(&wholes);
    }
    let outputs: Vec<_> = forms.iter().map(|form| output(scalars, form)).collect();
    kernel(scalars, &outputs, hoisting)
}

fn output(scalars: &mut Scalars, matrix: &MatrixForm<'_>) -> (Shape, Vec<Scalar>) {
    match matrix {
        MatrixForm::Whole(expression) => (expression.shape(), entries(scalars, &[*expression])),
        MatrixForm::Entries(shape, parts) => (*shape, entries(scalars, parts)),
        MatrixForm::Columns(columns) => {
            let columns: Vec<Vec<Scalar>> = columns.iter().map(|parts| entries(scalars, parts)).collect();
            let shape = Shape::new(columns.first().map_or(0, Vec::len), columns.len());
            (shape, shape.positions().map(|(i, j)| columns[j][i]).collect())
        }
    }
}

/// The entries of expressions, one after the other.
pub(super) fn entries(scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Vec<Scalar> {
    grids(scalars, expressions).into_iter().flat_map(|(_, entries)| entries).collect()
}

/// The shape and the entries of each expression.
pub(super) fn grids(scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Vec<(Shape, Vec<Scalar>)> {
    let mut lowering = Lowering { scalars };
    expressions.iter().map(|&expr| (expr.shape(), lowering.grid(expr).entries.clone())).collect()
}
