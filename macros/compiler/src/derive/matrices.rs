//! Matrices of derivatives at F = I + D: those of the kernels of an edge, of prices and of bounds.

use clebsch_symbolic::{Elements, Expr, IntoList, Shape};

use super::moves::{distributed, inserted, inverse_by};
use super::{EdgeDerivatives, Id, MechanicsFormulas, SystemFormulas};
use crate::model::LeafSpace;

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
        MatrixForm::Columns(columns.into_iter().map(|column| vec![column]).into_list())
    }

    /// One expression for each matrix, where they are such.
    pub fn wholes(matrices: &[MatrixForm<'g>]) -> Option<Vec<Expr<'g>>> {
        let whole = |matrix: &MatrixForm<'g>| if let MatrixForm::Whole(whole) = matrix { Some(*whole) } else { None };
        matrices.iter().map(whole).collect()
    }
}

/// Puts I + D in for F, and the formulas of their groups for the inverses of configurations.
pub(super) struct Inserted<'g> {
    elements: Vec<(Expr<'g>, Expr<'g>)>,
}

impl<'g> Inserted<'g> {
    pub(super) fn of(formulas: &SystemFormulas<'g>) -> Inserted<'g> {
        let mut elements = formulas.increments();
        for (leaf, image) in formulas.model.configurations.iter().zip(&formulas.symbols.images) {
            if let LeafSpace::Group(group) = leaf.space {
                [leaf.symbol, *image].into_iter().for_each(|q| elements.extend(inverse_by(group, q, q)));
            }
        }
        Inserted { elements }
    }

    /// An expression, products distributed.
    pub(super) fn whole(&self, expression: Expr<'g>) -> MatrixForm<'g> {
        MatrixForm::Whole(inserted(expression, &self.elements))
    }

    /// A matrix from its columns, products distributed as long as no column before is too long for that.
    pub(super) fn columns(&self, columns: &[Expr<'g>]) -> MatrixForm<'g> {
        let mut is_long = false;
        MatrixForm::of_columns(columns.iter().map(|column| {
            let plain = column.substitute(&self.elements);
            let distributed = if is_long { plain } else { distributed(plain) };
            is_long = is_long || distributed.is_long();
            distributed
        }))
    }

    /// A matrix of scalars.
    pub(super) fn entries(&self, shape: Shape, entry: impl Fn(usize, usize) -> Expr<'g>) -> MatrixForm<'g> {
        let entries = shape.positions().map(|(i, j)| entry(i, j).substitute(&self.elements));
        MatrixForm::Entries(shape, entries.into_list())
    }
}

impl<'g> MechanicsFormulas<'g> {
    /// The outputs of the kernels of an edge: in matrix code derivatives along one motion, and loops make the columns.
    pub fn edge_kernels(
        &self,
        index: usize,
        variation: &EdgeDerivatives<'g>,
        keeps_matrices: bool,
    ) -> Vec<(Id, Vec<MatrixForm<'g>>)> {
        let at = Inserted::of(self);
        let basis = self.symbols.basis();
        let along_motions = |derivative: &Expr<'g>| {
            if keeps_matrices {
                return at.whole(*derivative);
            }
            let columns: Vec<_> = basis.each(|element| derivative.substitute(element));
            at.columns(&columns)
        };
        let momenta = variation.momenta.map(|value| at.whole(value)).to_vec();
        let derivatives: Vec<_> = variation.derivatives.each(along_motions);
        let carried = variation.carried.each_ref().map(along_motions);
        let carried = [&momenta[2..], &carried, &derivatives[1..3]].concat();
        let mut kernels = vec![(Id::EdgeMomenta(index), momenta.clone())];
        kernels.push((Id::Edge(index), [momenta, derivatives].concat()));
        kernels.push((Id::Carried(index), carried));
        if let Some(slopes) = &variation.slopes {
            kernels.push((Id::EdgeSlopes(index), slopes.each_ref().map(|columns| at.columns(columns)).to_vec()));
        }
        kernels.extend(variation.constraint.iter().flat_map(|constraint| {
            let [start, end] = constraint.rows.map(|rows| rows.map(|rows| at.whole(rows)).to_vec());
            let at_start = constraint.at_start.each_ref().map(along_motions);
            let at_end = constraint.at_end.each_ref().map(along_motions);
            let mut kernels = vec![
                (Id::ConstraintAtStart(index), [start.as_slice(), &at_start].concat()),
                (Id::ConstraintAtEnd(index), [end.as_slice(), &at_end].concat()),
            ];
            if variation.slopes.is_some() {
                let slopes = constraint.slopes.each_ref();
                let of_both = slopes.map(|slopes| slopes.each_ref().map(|columns| at.columns(columns)).to_vec());
                kernels.extend([Id::SlopesAtStart(index), Id::SlopesAtEnd(index)].into_iter().zip(of_both));
            }
            kernels
        }));
        kernels
    }
}
