//! How square matrices enter a kinetic energy: quadratic forms take their symmetric parts alone.

use clebsch_symbolic::{Elements, Expr, IntoList, Property, identity};

use crate::model::System;

/// The matrices that enter the kinetic energy by their symmetric part alone.
pub struct SymmetricParts<'g> {
    /// Those whose antisymmetric part does nothing.
    pub taken: Vec<Expr<'g>>,
    /// Those whose antisymmetric part changes the cost, and so has to vanish.
    pub required: Vec<Expr<'g>>,
}

impl<'g> SymmetricParts<'g> {
    /// Those of a cost or a Lagrangian with this kinetic energy ½ ξ·Σξ.
    pub(super) fn of(model: &System<'g>, declared: Expr<'g>, kinetic: Expr<'g>) -> SymmetricParts<'g> {
        let takes_symmetric = |expression: Expr<'g>, matrix: Expr<'g>| {
            identity::equal(&[expression], &[expression.substitute(&[(matrix, symmetric_part(matrix))])])
        };
        let of_kinetic = general(model).into_iter().filter(|matrix| kinetic.depends_on(*matrix));
        let symmetric = of_kinetic.filter(|matrix| takes_symmetric(kinetic, *matrix)).into_list();
        let (taken, required) = symmetric.into_iter().partition(|matrix| takes_symmetric(declared, *matrix));
        SymmetricParts { taken, required }
    }

    /// In words; nothing where there are none.
    pub(super) fn sentences(&self) -> String {
        let names = |matrices: &[Expr<'g>]| matrices.each(|matrix| matrix.to_string());
        let taken = match names(&self.taken).as_slice() {
            [] => String::new(),
            [one] => format!(" Only the symmetric part of {one} enters."),
            several => format!(" Only the symmetric parts of {} enter.", several.join(", ")),
        };
        let required = names(&self.required).into_iter().map(|name| {
            format!(
                " {name} has to be symmetric: its antisymmetric part would change the cost, but not the kinetic energy."
            )
        });
        required.fold(taken, |text, sentence| text + &sentence)
    }
}

/// (A + Aᵀ)/2
fn symmetric_part(matrix: Expr<'_>) -> Expr<'_> {
    (matrix + matrix.transpose()) / 2
}

/// The square matrices among the parameters that carry no promise.
fn general<'g>(model: &System<'g>) -> Vec<Expr<'g>> {
    let leaves = model.parameters.iter().flat_map(|parameter| &parameter.leaves);
    let is_general = |matrix: &Expr<'g>| {
        let shape = matrix.shape();
        shape.is_square() && shape.rows > 1 && matrix.property() == Property::General
    };
    leaves.map(|leaf| leaf.symbol).filter(is_general).into_list()
}

/// The matrices whose symmetric parts, in their place, make an expression vanish that does not vanish otherwise.
pub(super) fn vanishing_for_symmetric<'g>(model: &System<'g>, expression: Expr<'g>) -> Vec<Expr<'g>> {
    let read = general(model).into_iter().filter(|matrix| expression.depends_on(*matrix)).into_list();
    let parts = read.each(|matrix| (*matrix, symmetric_part(*matrix)));
    if identity::vanishes(expression.substitute(&parts)) { read } else { Vec::new() }
}
