//! The directions in which a system may be moved: its own group's, those of commuting sides, and offered ones.

use clebsch_symbolic::{Chart, Expr, Group, Shape, identity};

use super::{Direction, Family};
use crate::derive::Symbols;
use crate::derive::action::generator_columns;
use crate::model::{LeafSpace, Mechanics, Side};

/// All directions, family by family.
pub(super) fn directions<'g>(
    model: &Mechanics<'g>,
    symbols: &Symbols<'g>,
    generator: &[Expr<'g>],
) -> (Vec<Family>, Vec<Direction<'g>>) {
    let (mut families, mut all) = (Vec::new(), Vec::new());
    let several = |count: usize, name: &str| if count > 1 { format!(" of `{name}`") } else { String::new() };
    for (k, factor) in model.factors.iter().enumerate() {
        let frame = if factor.side == Side::Left { "spatial" } else { "body" };
        let of = several(model.factors.len(), &factor.name);
        families.push(Family { group: factor.group, of, frame, offered: None });
        all.extend(own_directions(model, symbols, generator, k, families.len() - 1));
    }
    for (j, leaf) in model.configurations.iter().enumerate() {
        for from_left in [true, false] {
            let Some(k) = commuting_factor(model, symbols, generator, j, from_left) else { continue };
            let frame = if from_left { "spatial" } else { "body" };
            let of = several(model.configurations.len(), &leaf.name);
            families.push(Family { group: model.factors[k].group, of, frame, offered: None });
            all.extend(other_directions(model, symbols, j, k, from_left, families.len() - 1));
        }
    }
    for (index, offered) in model.symmetries.iter().enumerate() {
        let of = format!(" of `{}`", offered.name);
        let frame = if offered.side == Side::Left { "spatial" } else { "body" };
        families.push(Family { group: offered.group, of, frame, offered: Some(index) });
        all.extend(offered_directions(model, symbols, generator, index, families.len() - 1));
    }
    (families, all)
}

fn unit_vector<'g>(model: &Mechanics<'g>, group: Group, index: usize) -> Expr<'g> {
    model.graph.unit(Shape::vector(group.dimension()), index, 0)
}

/// The velocity that is `xi` in factor k and zero in the others.
pub(super) fn in_factor<'g>(symbols: &Symbols<'g>, k: usize, xi: Expr<'g>) -> Vec<Expr<'g>> {
    let zero = |symbol: &Expr<'g>| symbol.graph().zero(symbol.shape());
    symbols.algebra.iter().enumerate().map(|(other, symbol)| if other == k { xi } else { zero(symbol) }).collect()
}

/// ξ_Q(q) for a velocity of all factors.
pub(super) fn generated<'g>(symbols: &Symbols<'g>, generator: &[Expr<'g>], velocity: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let replaced: Vec<_> = symbols.algebra.iter().copied().zip(velocity.iter().copied()).collect();
    generator.iter().map(|motion| motion.substitute(&replaced)).collect()
}

fn no_motion<'g>(model: &Mechanics<'g>) -> Vec<Expr<'g>> {
    model.factors.iter().map(|factor| model.graph.zero(factor.group.element_shape())).collect()
}

/// q ↦ Φ_g q with F ↦ gFg⁻¹ (left) or g⁻¹Fg (right).
fn own_directions<'g>(
    model: &Mechanics<'g>,
    symbols: &Symbols<'g>,
    generator: &[Expr<'g>],
    k: usize,
    family: usize,
) -> Vec<Direction<'g>> {
    let factor = &model.factors[k];
    let exponential = symbols.charts[k] == Chart::Exponential;
    let direction = |index: usize| {
        let velocity = in_factor(symbols, k, unit_vector(model, factor.group, index));
        let element = factor.group.wedge(velocity[k]);
        let conjugation =
            factor.group.translate_right(factor.symbol, element) - factor.group.translate_left(factor.symbol, element);
        let mut factors = no_motion(model);
        factors[k] = if factor.side == Side::Left { conjugation } else { -conjugation };
        let momentum = symbols.momenta[k].entry(index, 0);
        // log gFg⁻¹ = g (log F) g⁻¹
        let turned = match exponential {
            true => factor.group.ad(velocity[k]) * symbols.logarithms[k],
            false => model.graph.zero(velocity[k].shape()),
        };
        let logarithms = Some(in_factor(symbols, k, if factor.side == Side::Left { turned } else { -turned }));
        Direction { logarithms, family, index, leaves: generated(symbols, generator, &velocity), factors, momentum }
    };
    (0..factor.group.dimension()).map(direction).collect()
}

/// The factor of the leaf's own group for which q ↦ gq (or qg) commutes with the action: then ξ = q⁻¹wq (or qwq⁻¹).
fn commuting_factor<'g>(
    model: &Mechanics<'g>,
    symbols: &Symbols<'g>,
    generator: &[Expr<'g>],
    j: usize,
    from_left: bool,
) -> Option<usize> {
    let leaf = &model.configurations[j];
    let LeafSpace::Group(group) = leaf.space else { return None };
    let wanted = if from_left { Side::Right } else { Side::Left };
    let fits = |k: &usize| {
        let factor = &model.factors[*k];
        if factor.group != group || factor.side != wanted || group.is_translation() {
            return false;
        }
        let xi = symbols.algebra[*k];
        let moved = multiplied(group, leaf.symbol, group.wedge(xi), from_left);
        let velocity = in_factor(symbols, *k, transported(group, leaf.symbol, xi, from_left));
        let generated = generated(symbols, generator, &velocity);
        let expected = |other: usize| if other == j { moved } else { model.graph.zero(generated[other].shape()) };
        let expected: Vec<_> = (0..generated.len()).map(expected).collect();
        identity::equal(&generated, &expected) && commutes(model, j, moved)
    };
    (0..model.factors.len()).find(fits)
}

/// w q, or q w.
fn multiplied<'g>(group: Group, q: Expr<'g>, w: Expr<'g>, from_left: bool) -> Expr<'g> {
    if from_left { group.translate_right(q, w) } else { group.translate_left(q, w) }
}

/// The coordinates of q⁻¹wq, or of qwq⁻¹.
fn transported<'g>(group: Group, q: Expr<'g>, w: Expr<'g>, from_left: bool) -> Expr<'g> {
    let (element, inverse) = (group.wedge(w), group.inverse(q));
    let (before, after) = if from_left { (inverse, q) } else { (q, inverse) };
    group.projected_coordinates(group.compose(group.compose(before, element), after))
}

/// Whether a motion of leaf j is carried along by the action: DΦ_F(q)·δq = δq at Φ_F(q).
fn commutes<'g>(model: &Mechanics<'g>, j: usize, motion: Expr<'g>) -> bool {
    let leaf = model.configurations[j].symbol;
    let moved: Vec<_> = model.action.iter().map(|image| image.differential(&[(leaf, motion)])).collect();
    let images: Vec<_> =
        model.configurations.iter().zip(&model.action).map(|(leaf, image)| (leaf.symbol, *image)).collect();
    let expected = |i: usize| if i == j { motion.substitute(&images) } else { model.graph.zero(moved[i].shape()) };
    let expected: Vec<_> = (0..moved.len()).map(expected).collect();
    identity::equal(&moved, &expected)
}

fn other_directions<'g>(
    model: &Mechanics<'g>,
    symbols: &Symbols<'g>,
    j: usize,
    k: usize,
    from_left: bool,
    family: usize,
) -> Vec<Direction<'g>> {
    let (group, q) = (model.factors[k].group, model.configurations[j].symbol);
    let direction = |index: usize| {
        let w = unit_vector(model, group, index);
        let mut leaves: Vec<_> = model.configurations.iter().map(|leaf| model.graph.zero(leaf.shape)).collect();
        leaves[j] = multiplied(group, q, group.wedge(w), from_left);
        // ⟨N, q⁻¹wq⟩ = ⟨Ad*_{q⁻¹}N, w⟩
        let element = if from_left { group.inverse(q) } else { q };
        let momentum = group.coadjoint(element, symbols.momenta[k]).entry(index, 0);
        let logarithms = Some(in_factor(symbols, k, model.graph.zero(symbols.logarithms[k].shape())));
        Direction { family, index, leaves, factors: no_motion(model), logarithms, momentum }
    };
    (0..group.dimension()).map(direction).collect()
}

/// The directions of an offered symmetry whose motions of q are motions of the group: ξ_Q(q) = δq.
fn offered_directions<'g>(
    model: &Mechanics<'g>,
    symbols: &Symbols<'g>,
    generator: &[Expr<'g>],
    offer: usize,
    family: usize,
) -> Vec<Direction<'g>> {
    let offered = &model.symmetries[offer];
    let one = [(offered.symbol, offered.group.identity(model.graph))];
    let along = |image: &Expr<'g>, w: Expr<'g>| {
        image.differential(&[(offered.symbol, offered.group.wedge(w))]).substitute(&one)
    };
    let mut directions = Vec::new();
    for index in 0..offered.group.dimension() {
        let w = unit_vector(model, offered.group, index);
        let leaves: Vec<_> = offered.configurations.iter().map(|image| along(image, w)).collect();
        let factors: Vec<_> = offered.elements.iter().map(|image| along(image, w)).collect();
        if let Some(velocity) = velocity_of(model, symbols, generator, &leaves) {
            let pairs = symbols.momenta.iter().zip(&velocity);
            let momentum = pairs.fold(model.graph.integer(0), |sum, (mu, xi)| sum + mu.dot(*xi));
            directions.push(Direction { family, index, leaves, factors, logarithms: None, momentum });
        }
    }
    directions
}

/// ξ with ξ_Q(q) = δq, by least squares in the entries of q; `None` where the group cannot move q so.
fn velocity_of<'g>(
    model: &Mechanics<'g>,
    symbols: &Symbols<'g>,
    generator: &[Expr<'g>],
    motion: &[Expr<'g>],
) -> Option<Vec<Expr<'g>>> {
    let graph = model.graph;
    let columns = generator_columns(symbols, generator);
    let shape = Shape::new(columns[0].len(), columns.len());
    let matrix = graph.stack(shape, shape.positions().map(|(i, j)| columns[j][i]).collect());
    let entries = motion.iter().flat_map(|leaf| leaf.shape().positions().map(|(i, j)| leaf.entry(i, j)));
    let given = graph.stack(Shape::vector(shape.rows), entries.collect());
    let solved = match matrix.is_identity() {
        true => given,
        false => (matrix.transpose() * matrix).inverse() * (matrix.transpose() * given),
    };
    if !identity::equal(&[matrix * solved], &[given]) {
        return None;
    }
    let mut start = 0;
    let part = |xi: &Expr<'g>| {
        start += xi.shape().rows;
        solved.block(start - xi.shape().rows, 0, xi.shape())
    };
    Some(symbols.algebra.iter().map(part).collect())
}
