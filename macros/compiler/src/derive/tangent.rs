//! How q⁺ and F − I move with the chart coordinates of rotations: by the tangent of Cayley's map, as group elements do.
//!
//! F = (I − x^)⁻¹(I + x^) has δF F⁻¹ = ξ^ with ξ = 2(δ + x × δ)/(1 + |x|²), and F⁻¹ δF = ξ^ with x × δ subtracted. So q⁺ = Φ_F(q)
//! moves by δq⁺ = ξ_Q(q⁺), and a Jacobian is products of q⁺ itself, without the derivatives of its entries by x.

use clebsch_symbolic::{Chart, Expr, Group, IntoList, indexed};

use super::ChartBlock;
use super::equation::Sources;
use super::letters::Letters;
use crate::model::Side;

/// Dρ(x)·δ of a residual with letters for q⁺ and F − I. `None` where no rotation in space moves them in Cayley's chart, or where other
/// letters occur.
pub(super) fn directional<'g>(
    sources: &Sources<'_, 'g>,
    letters: &Letters<'_, 'g>,
    residual: Expr<'g>,
) -> Option<Expr<'g>> {
    let residual = letters.by_increments(residual)?;
    let (model, symbols) = (sources.model, &sources.symbols);
    let rotations: Vec<(&ChartBlock<'g>, Expr<'g>)> =
        symbols.blocks.iter().filter_map(|block| Some((block, velocity(sources, block)?))).into_list();
    if rotations.is_empty() {
        return None;
    }
    let is_rotation = |factor: usize| rotations.iter().any(|(block, _)| block.factor == factor);
    let others = symbols.blocks.iter().filter(|block| !is_rotation(block.factor));
    let others: Vec<_> = others.map(|block| (block.coordinates, block.direction)).into_list();
    // the motion of q⁺ by all rotations, and by other factors
    let velocities = symbols.algebra.iter().enumerate().map(|(k, &xi)| {
        let own = rotations.iter().find(|(block, _)| block.factor == k);
        (xi, own.map_or(model.graph.zero(xi.shape()), |(_, velocity)| *velocity))
    });
    let arrived = model.configurations.iter().zip(&letters.displacements);
    let at_end: Vec<_> = arrived.map(|(leaf, (letter, _))| (leaf.symbol, leaf.symbol + *letter)).into_list();
    let replaced: Vec<_> = velocities.chain(at_end).into_list();
    let moved = letters.displacements.iter().zip(&sources.generator).map(|((letter, displacement), generator)| {
        (*letter, generator.substitute(&replaced) + displacement.differential(&others))
    });
    let turned = letters.increments.iter().map(|(letter, increment)| {
        let factor = symbols.increments.iter().position(|symbol| symbol == letter);
        let own = rotations.iter().find(|(block, _)| Some(block.factor) == factor);
        let slope = own.map(|(block, velocity)| {
            let factor = &model.factors[block.factor];
            let (group, element) = (factor.group, factor.group.identity(model.graph) + *letter);
            match factor.side {
                Side::Left => group.wedge(*velocity) * element,
                Side::Right => element * group.wedge(*velocity),
            }
        });
        (*letter, slope.unwrap_or_else(|| increment.differential(&others)))
    });
    let coordinates = symbols.blocks.iter().map(|block| (block.coordinates, block.direction));
    let directions: Vec<_> = coordinates.chain(moved).chain(turned).into_list();
    Some(letters.replaced(residual.differential(&directions)))
}

/// The velocity ξ with which the element of a rotation in space moves, in Cayley's chart. Its scale is inside of its entries: a sum of
/// motions then is one vector.
fn velocity<'g>(sources: &Sources<'_, 'g>, block: &ChartBlock<'g>) -> Option<Expr<'g>> {
    let factor = &sources.model.factors[block.factor];
    if factor.group != Group::SpecialOrthogonal(3) || sources.symbols.charts[block.factor] != Chart::Cayley {
        return None;
    }
    let (x, delta, graph) = (block.coordinates, block.direction, sources.model.graph);
    let turned = factor.group.wedge(x) * delta;
    let sum = if factor.side == Side::Left { delta + turned } else { delta - turned };
    let scale = graph.integer(1) / ((graph.integer(1) + x.norm_squared()) / 2);
    Some(graph.stack(sum.shape(), indexed(sum.shape().rows, |i| sum.entry(i, 0) * scale)))
}
