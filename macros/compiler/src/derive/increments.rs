//! The group element of a step as I + D: what is near the identity is written without cancellation.

use clebsch_symbolic::{Expr, Group};

use super::SystemFormulas;
use crate::model::Factor;

/// The replacement of each group element by I + D (D for translations), and of its inverse by that of I + D.
pub(crate) fn increments<'g>(formulas: &SystemFormulas<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let symbols = &formulas.symbols;
    let factors = formulas.model.factors.iter().zip(symbols.increments.iter().zip(&symbols.logarithms));
    let element = |(factor, (increment, y)): (&Factor<'g>, (&Expr<'g>, &Expr<'g>))| {
        let element = from_increment(factor.group, *increment);
        let mut replacements = inverse_by(factor.group, factor.symbol, element);
        replacements.push((*y, factor.group.logarithm(element)));
        replacements.push((factor.symbol, element));
        replacements
    };
    let coordinates = symbols.increments.iter().enumerate();
    let coordinates = coordinates.filter_map(|(k, d)| super::cayley_coordinates(&formulas.model, k, *d));
    factors.flat_map(element).chain(coordinates).collect()
}

/// The replacement of the letters F⁻¹ and F⁻ᵀ by the explicit inverse of an element.
pub(crate) fn inverse_by<'g>(group: Group, symbol: Expr<'g>, element: Expr<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    if group.is_translation() || group.is_orthogonal() || group == Group::UnitQuaternions {
        return Vec::new();
    }
    let inverse = group.explicit_inverse(element);
    vec![(symbol.inverse(), inverse), (symbol.transpose().inverse(), inverse.transpose())]
}

pub(crate) fn from_increment<'g>(group: Group, increment: Expr<'g>) -> Expr<'g> {
    if group.is_translation() { increment } else { group.identity(increment.graph()) + increment }
}

/// An expression with I + D put in for F. Products are distributed, so that what cancels does so; but not around an inverse, where that
/// only makes them many times longer: there F occurs as F − I and F + I.
pub(crate) fn inserted<'g>(expression: Expr<'g>, elements: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
    let inserted = expression.substitute(elements);
    if inserted.has_inverse() { inserted } else { inserted.expand() }
}
