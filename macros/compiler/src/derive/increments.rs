//! The group element of a step as I + D: what is near the identity is written without cancellation.

use clebsch_symbolic::{Expr, Group};

use super::{SystemFormulas, cayley};

impl<'g> SystemFormulas<'g> {
    /// The replacement of each group element by I + D (D for translations), and of its inverse by that of I + D.
    pub(super) fn increments(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let mut replacements = Vec::new();
        for (k, factor) in self.model.factors.iter().enumerate() {
            let element = from_increment(factor.group, self.symbols.increments[k]);
            let logarithm = (self.symbols.logarithms[k], factor.group.logarithm(element));
            replacements.extend(inverse_by(factor.group, factor.symbol, element));
            replacements.extend([logarithm, (factor.symbol, element)]);
        }
        let increments = self.symbols.increments.iter().enumerate();
        replacements.extend(increments.filter_map(|(k, d)| cayley::of_increment(&self.model, k, *d)));
        replacements
    }

    /// Expressions with I + D put in for F, products distributed.
    pub(super) fn at_increments(&self, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let elements = self.increments();
        parts.iter().map(|part| part.substitute(&elements).expand()).collect()
    }
}

/// The replacement of the letters F⁻¹ and F⁻ᵀ by the explicit inverse of an element.
pub(super) fn inverse_by<'g>(group: Group, symbol: Expr<'g>, element: Expr<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    if group.is_translation() || group.is_orthogonal() || group == Group::UnitQuaternions {
        return Vec::new();
    }
    let inverse = group.explicit_inverse(element);
    vec![(symbol.inverse(), inverse), (symbol.transpose().inverse(), inverse.transpose())]
}

pub(super) fn from_increment<'g>(group: Group, increment: Expr<'g>) -> Expr<'g> {
    if group.is_translation() { increment } else { group.identity(increment.graph()) + increment }
}

/// An expression with I + D put in for F. Products are distributed, so that what cancels does so; but not around an inverse, where that
/// only makes them many times longer: there F occurs as F − I and F + I.
pub(super) fn inserted<'g>(expression: Expr<'g>, elements: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
    let inserted = expression.substitute(elements);
    if inserted.has_inverse() { inserted } else { inserted.expand() }
}
