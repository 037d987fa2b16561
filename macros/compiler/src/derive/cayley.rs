//! The Cayley coordinates of a step, Z = (F − I)(F + I)⁻¹ = Σ z_i E_i, as symbols with their own law of motion.
//!
//! Lagrangians that are discretised by Cayley's map are functions of z, and z moves by polynomials. Along δF = ηF it
//! moves by δZ = ½ (I − Z) η (I + Z), along δF = Fη by δZ = ½ (I + Z) η (I − Z). So the derivatives of formulas in z
//! contain no inverse.

use clebsch_symbolic::{Block, Expr, Group, Property, Role, Shape};

use crate::model::System;

/// The symbol z of a factor.
pub(crate) fn symbol<'g>(model: &System<'g>, k: usize) -> Expr<'g> {
    let factor = &model.factors[k];
    let shape = Shape::vector(factor.group.dimension());
    model.graph.symbol(&format!("cay⁻¹({})", factor.name), shape, Role::Cayley(k), Property::General)
}

/// Whether (F − I)(F + I)⁻¹ is in the Lie algebra, as a matrix.
fn is_rational(model: &System<'_>, group: Group) -> bool {
    !group.is_translation() && group != Group::UnitQuaternions && group.has_cayley_chart(model.graph)
}

/// (F − I)(F + I)⁻¹ with F = I + D, D(2I + D)⁻¹, in coordinates.
pub(crate) fn of_increment<'g>(model: &System<'g>, k: usize, increment: Expr<'g>) -> Option<(Expr<'g>, Expr<'g>)> {
    let group = model.factors[k].group;
    if !is_rational(model, group) {
        return None;
    }
    let twice = 2 * group.identity(model.graph);
    Some((symbol(model, k), group.projected_coordinates(increment * (increment + twice).inverse())))
}

/// The same without the inverse in the plane and in space, (D − Dᵀ)/(4 + tr D).
pub(super) fn of_turn<'g>(model: &System<'g>, k: usize, increment: Expr<'g>) -> Option<(Expr<'g>, Expr<'g>)> {
    let Group::SpecialOrthogonal(2 | 3) = model.factors[k].group else { return of_increment(model, k, increment) };
    let turn = 2 * model.factors[k].group.projected_coordinates(increment);
    Some((symbol(model, k), turn / (increment.trace() + model.graph.integer(4))))
}

/// The replacements of the components of (F − I)(F + I)⁻¹, block by block, by those of Z.
pub(super) fn replacements<'g>(model: &System<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let mut replacements = Vec::new();
    for (k, factor) in model.factors.iter().enumerate().filter(|(_, factor)| is_rational(model, factor.group)) {
        let (f, z, identity) = (factor.symbol, symbol(model, k), factor.group.identity(model.graph));
        let whole = (f - identity) * (f + identity).inverse();
        for Block { algebra, row, column, offset } in model.graph.blocks(factor.group).iter().copied() {
            let part = whole.block(row, column, algebra.shape).components(algebra);
            let coordinates = z.block(offset, 0, Shape::vector(algebra.dimension));
            replacements.push((part, coordinates.wedge(algebra).components(algebra)));
        }
    }
    replacements
}

/// δz along δF = ηF, or along δF = Fη.
pub(super) fn motion<'g>(model: &System<'g>, k: usize, eta: Expr<'g>, from_left: bool) -> Option<(Expr<'g>, Expr<'g>)> {
    let group = model.factors[k].group;
    if !is_rational(model, group) {
        return None;
    }
    let (z, one) = (symbol(model, k), group.identity(model.graph));
    let (plus, minus) = (one + group.wedge(z), one - group.wedge(z));
    let wedge = group.wedge(eta);
    let moved = if from_left { minus * wedge * plus } else { plus * wedge * minus };
    // in the plane and in space −Z η Z is (z·η) Z, and Z η − η Z is (z × η)^
    if let Group::SpecialOrthogonal(n @ (2 | 3)) = group {
        let turned = if n == 3 { group.wedge(z) * eta } else { model.graph.zero(z.shape()) };
        let turned = if from_left { -turned } else { turned };
        return Some((z, (eta + turned + z.dot(eta) * z) / 2));
    }
    Some((z, group.projected_coordinates(moved.expand()) / 2))
}
