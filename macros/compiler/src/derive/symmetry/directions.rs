//! The directions in which a system may be moved: its own group's, those of commuting sides, and offered ones.

use clebsch_symbolic::{Chart, Elements, Expr, Group, IntoList, Shape, identity};

use super::{Direction, Family};
use crate::derive::SystemFormulas;
use crate::derive::symbols::moved;
use crate::model::{LeafSpace, Mechanics, Side};

/// Collects directions, family by family.
pub(super) struct Directions<'a, 'g> {
    model: &'a Mechanics<'g>,
    system: &'a SystemFormulas<'g>,
    pub(super) families: Vec<Family>,
    pub(super) all: Vec<Direction<'g>>,
}

impl<'a, 'g> Directions<'a, 'g> {
    pub(super) fn of(model: &'a Mechanics<'g>, system: &'a SystemFormulas<'g>) -> Directions<'a, 'g> {
        let mut directions = Directions { model, system, families: Vec::new(), all: Vec::new() };
        let several = |count: usize, name: &str| if count > 1 { format!(" of {name}") } else { String::new() };
        for (k, factor) in model.factors.iter().enumerate() {
            let of = several(model.factors.len(), &factor.name);
            directions.add(factor.group, of, factor.side, None, |own, index| Some(own.own(k, index)));
        }
        for (j, leaf) in model.configurations.iter().enumerate() {
            for side in [Side::Left, Side::Right] {
                let Some(k) = directions.commuting_factor(j, side) else { continue };
                let of = several(model.configurations.len(), &leaf.name);
                directions
                    .add(model.factors[k].group, of, side, None, |own, index| Some(own.commuting(j, k, side, index)));
            }
        }
        for (offer, offered) in model.symmetries.iter().enumerate() {
            let of = format!(" of {}", offered.name);
            directions.add(offered.group, of, offered.side, Some(offer), |own, index| own.offered(offer, index));
        }
        directions
    }

    /// A family of directions, one for each basis element of a group.
    fn add(
        &mut self,
        group: Group,
        of: String,
        side: Side,
        offered: Option<usize>,
        direction: impl Fn(&Self, usize) -> Option<Direction<'g>>,
    ) {
        self.families.push(Family { group, of, frame: side.frame(), offered });
        let made: Vec<_> = (0..group.dimension()).filter_map(|index| direction(self, index)).into_list();
        self.all.extend(made);
    }

    /// The family that was begun last.
    fn family(&self) -> usize {
        self.families.len() - 1
    }

    fn basis_element(&self, group: Group, index: usize) -> Expr<'g> {
        self.model.graph.unit(Shape::vector(group.dimension()), index, 0)
    }

    fn no_motion(&self) -> Vec<Expr<'g>> {
        self.model.factors.each(|factor| self.model.graph.zero(factor.group.element_shape()))
    }

    /// q ↦ Φ_g q with F ↦ gFg⁻¹ (left) or g⁻¹Fg (right).
    fn own(&self, k: usize, index: usize) -> Direction<'g> {
        let (system, factor) = (self.system, &self.model.factors[k]);
        let signed = |change: Expr<'g>| if factor.side == Side::Left { change } else { -change };
        let velocity = system.in_factor(k, self.basis_element(factor.group, index));
        let mut factors = self.no_motion();
        factors[k] = signed(system.conjugation(k, velocity[k]));
        let momentum = system.symbols.momenta[k].entry(index, 0);
        // log gFg⁻¹ = g (log F) g⁻¹
        let turned = if system.symbols.charts[k] == Chart::Exponential {
            factor.group.ad(velocity[k]) * system.symbols.logarithms[k]
        } else {
            self.model.graph.zero(velocity[k].shape())
        };
        let logarithms = Some(system.in_factor(k, signed(turned)));
        let leaves = system.motion_by(&velocity);
        Direction { family: self.family(), index, leaves, factors, logarithms, momentum }
    }

    /// The factor of the leaf's own group for which q ↦ gq (or qg) commutes with the action: then ξ = q⁻¹wq (or qwq⁻¹).
    fn commuting_factor(&self, j: usize, side: Side) -> Option<usize> {
        let (model, leaf) = (self.model, &self.model.configurations[j]);
        let LeafSpace::Group(group) = leaf.space else { return None };
        let fits = |k: &usize| {
            let factor = &model.factors[*k];
            if factor.group != group || factor.side == side || group.is_translation() {
                return false;
            }
            let xi = self.system.symbols.algebra[*k];
            let motion = multiplied(group, leaf.symbol, group.wedge(xi), side);
            let (q, inverse) = (leaf.symbol, group.inverse(leaf.symbol));
            let (before, after) = if side == Side::Left { (inverse, q) } else { (q, inverse) };
            let moved = group.compose(group.compose(before, group.wedge(xi)), after);
            let velocity = self.system.in_factor(*k, group.projected_coordinates(moved));
            let generated = self.system.motion_by(&velocity);
            identity::equal(&generated, &alone(&generated, j, motion)) && self.commutes(j, motion)
        };
        (0..model.factors.len()).find(fits)
    }

    /// Whether a motion of leaf j is carried along by the action: DΦ_F(q)·δq = δq at Φ_F(q).
    fn commutes(&self, j: usize, motion: Expr<'g>) -> bool {
        let leaf = self.model.configurations[j].symbol;
        let images: Vec<_> = self.model.action.each(|image| image.differential(&[(leaf, motion)]));
        identity::equal(&images, &alone(&images, j, motion.substitute(&moved(self.model))))
    }

    /// q ↦ gq, or qg, of a leaf alone.
    fn commuting(&self, j: usize, k: usize, side: Side, index: usize) -> Direction<'g> {
        let (group, q) = (self.model.factors[k].group, self.model.configurations[j].symbol);
        let w = self.basis_element(group, index);
        let leaves = alone(&self.model.action, j, multiplied(group, q, group.wedge(w), side));
        // ⟨N, q⁻¹wq⟩ = ⟨Ad*_{q⁻¹}N, w⟩
        let element = if side == Side::Left { group.inverse(q) } else { q };
        let momentum = group.coadjoint(element, self.system.symbols.momenta[k]).entry(index, 0);
        let still = self.model.graph.zero(self.system.symbols.logarithms[k].shape());
        let logarithms = Some(self.system.in_factor(k, still));
        Direction { family: self.family(), index, leaves, factors: self.no_motion(), logarithms, momentum }
    }

    /// A direction of an offered symmetry, where its motion of q is a motion of the group: ξ_Q(q) = δq.
    fn offered(&self, offer: usize, index: usize) -> Option<Direction<'g>> {
        let offered = &self.model.symmetries[offer];
        let one = [(offered.symbol, offered.group.identity(self.model.graph))];
        let along = [(offered.symbol, offered.group.wedge(self.basis_element(offered.group, index)))];
        let motions =
            |images: &[Expr<'g>]| -> Vec<Expr<'g>> { images.each(|image| image.differential(&along).substitute(&one)) };
        let (leaves, factors) = (motions(&offered.configurations), motions(&offered.elements));
        let velocity = self.velocity_of(&leaves)?;
        let pairs = self.system.symbols.momenta.iter().zip(&velocity);
        let momentum = self.model.graph.total(Shape::scalar(), pairs.map(|(mu, xi)| mu.dot(*xi)));
        Some(Direction { family: self.family(), index, leaves, factors, logarithms: None, momentum })
    }

    /// ξ with ξ_Q(q) = δq, by least squares in the entries of q; `None` where the group cannot move q so.
    fn velocity_of(&self, motion: &[Expr<'g>]) -> Option<Vec<Expr<'g>>> {
        let (graph, matrix) = (self.model.graph, self.system.matrix_of_generator());
        let entries = motion.iter().flat_map(|leaf| leaf.entries());
        let given = graph.stack(Shape::vector(matrix.shape().rows), entries.into_list());
        let solved = if matrix.is_identity() {
            given
        } else {
            (matrix.transpose() * matrix).inverse() * (matrix.transpose() * given)
        };
        if !identity::equal(&[matrix * solved], &[given]) {
            return None;
        }
        let mut start = 0;
        let part = |xi: &Expr<'g>| {
            start += xi.shape().rows;
            solved.block(start - xi.shape().rows, 0, xi.shape())
        };
        Some(self.system.symbols.algebra.each(part))
    }
}

/// The motion of part j alone, of parts with these shapes.
fn alone<'g>(parts: &[Expr<'g>], j: usize, motion: Expr<'g>) -> Vec<Expr<'g>> {
    let mut motions: Vec<_> = parts.each(|part| part.graph().zero(part.shape()));
    motions[j] = motion;
    motions
}

/// w q, or q w.
fn multiplied<'g>(group: Group, q: Expr<'g>, w: Expr<'g>, side: Side) -> Expr<'g> {
    if side == Side::Left { group.translate_right(q, w) } else { group.translate_left(q, w) }
}

impl<'g> SystemFormulas<'g> {
    /// The velocity that is `xi` in factor k and zero in the others.
    pub(in crate::derive) fn in_factor(&self, k: usize, xi: Expr<'g>) -> Vec<Expr<'g>> {
        alone(&self.symbols.algebra, k, xi)
    }

    /// ξF − Fξ, the motion of F by gFg⁻¹.
    pub(super) fn conjugation(&self, k: usize, xi: Expr<'g>) -> Expr<'g> {
        let (group, f) = (self.model.factors[k].group, self.model.factors[k].symbol);
        let element = group.wedge(xi);
        group.translate_right(f, element) - group.translate_left(f, element)
    }
}
