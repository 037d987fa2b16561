//! What the kernels of an edge, of prices and of bounds compute: derivatives at F = I + D.

use clebsch_symbolic::{Expr, Shape};

use super::increments::{inserted, inverse_by};
use super::{EdgeDerivatives, MatrixForm, MechanicsFormulas, SystemFormulas};
use crate::model::{Configuration, LeafSpace};

/// What the kernels of an edge compute.
pub struct EdgeMatrices<'g> {
    /// ℓd, F⁻ℓd, F⁺ℓd.
    pub momenta: Vec<MatrixForm<'g>>,
    /// ∂F⁻ℓd/∂η, ∂F⁻ℓd/∂η′, ∂F⁺ℓd/∂η′, and ∂F⁺ℓd/∂η where it is not −(∂F⁻ℓd/∂η′)ᵀ.
    pub derivatives: Vec<MatrixForm<'g>>,
    /// F⁺ℓd; Ad, ∂F⁻ℓd and ∂F⁺ℓd for motions that leave F as it is; ∂F⁻ℓd/∂η′, ∂F⁺ℓd/∂η′.
    pub carried: Vec<MatrixForm<'g>>,
    /// The derivatives of F⁻ℓd and of F⁺ℓd with respect to the quantities that are fixed during a step.
    pub slopes: Option<[MatrixForm<'g>; 2]>,
}

/// Puts I + D in for F, and the formulas of their groups for the inverses of configurations.
pub(super) struct Inserted<'g> {
    elements: Vec<(Expr<'g>, Expr<'g>)>,
}

impl<'g> Inserted<'g> {
    pub(super) fn of(formulas: &SystemFormulas<'g>) -> Inserted<'g> {
        let leaves = formulas.model.configurations.iter().zip(&formulas.symbols.images);
        let inverses = leaves.flat_map(|(leaf, image): (&Configuration<'g>, &Expr<'g>)| match leaf.space {
            LeafSpace::Group(group) => {
                [leaf.symbol, *image].into_iter().flat_map(|q| inverse_by(group, q, q)).collect()
            }
            _ => Vec::new(),
        });
        Inserted { elements: formulas.increments().into_iter().chain(inverses).collect() }
    }

    /// An expression, products distributed.
    pub(super) fn whole(&self, expression: Expr<'g>) -> MatrixForm<'g> {
        MatrixForm::Whole(inserted(expression, &self.elements))
    }

    /// A matrix from its columns, products distributed.
    pub(super) fn columns(&self, columns: &[Expr<'g>]) -> MatrixForm<'g> {
        MatrixForm::of_columns(columns.iter().map(|column| inserted(*column, &self.elements)))
    }

    /// A matrix of scalars.
    pub(super) fn entries(&self, shape: Shape, entry: impl Fn(usize, usize) -> Expr<'g>) -> MatrixForm<'g> {
        let entries = shape.positions().map(|(i, j)| entry(i, j).substitute(&self.elements));
        MatrixForm::Entries(shape, entries.collect())
    }
}

impl<'g> MechanicsFormulas<'g> {
    /// What the kernels of an edge compute: with whole matrices derivatives along one motion, of which loops make the columns.
    pub fn edge_matrices(&self, variation: &EdgeDerivatives<'g>, keeps_matrices: bool) -> EdgeMatrices<'g> {
        let at = Inserted::of(self);
        let basis = self.symbols.basis();
        let along_motions = |derivative: Expr<'g>| {
            if keeps_matrices {
                return at.whole(derivative);
            }
            let columns: Vec<_> = basis.iter().map(|element| derivative.substitute(element)).collect();
            at.columns(&columns)
        };
        let EdgeDerivatives { before_by_start, before_by_end, after_by_end, .. } = *variation;
        let carried = &variation.carried;
        let momenta = [variation.lagrangian, variation.before, variation.after].map(|value| at.whole(value));
        let derivatives = [before_by_start, before_by_end, after_by_end].map(along_motions);
        let [_, by_end, after_by_end] = derivatives.clone();
        let other = variation.after_by_start.map(along_motions);
        let along_with = [carried.adjoint, carried.before, carried.after].map(along_motions);
        let slopes = variation.slopes.as_ref();
        EdgeMatrices {
            carried: momenta[2..].iter().cloned().chain(along_with).chain([by_end, after_by_end]).collect(),
            momenta: momenta.to_vec(),
            derivatives: derivatives.into_iter().chain(other).collect(),
            slopes: slopes.map(|slopes| [&slopes.before, &slopes.after].map(|columns| at.columns(columns))),
        }
    }
}
