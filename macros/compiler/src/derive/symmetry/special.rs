//! Symmetries beyond constant directions: along vector parameters, along the configuration, and for special parameters.

use clebsch_symbolic::identity::Point;
use clebsch_symbolic::{
    Elements, Expr, Group, IntoElements, IntoList, Property, Rational, Role, Shape, identity, integer,
};

use super::{ConservedMomentum, Direction, Family, Finder, holds};
use crate::derive::naming;
use crate::model::Parameter;

impl<'g> Finder<'_, 'g> {
    /// Directions along vector parameters: in one family of rotations, or in all of them at once.
    pub(super) fn along_parameters(&self, found: &[Vec<Rational>]) -> Vec<ConservedMomentum<'g>> {
        let (model, graph) = (self.sources.model, self.sources.model.graph);
        let is_turn = |family: &usize| turns_in_space(self.families[*family].group);
        let turns: Vec<usize> = (0..self.families.len()).filter(is_turn).into_list();
        let mut choices: Vec<Vec<usize>> = turns.each(|&family| vec![family]);
        if turns.len() > 1 {
            choices.push(turns);
        }
        // a parameter that both a site and the terms read is listed once
        let mut read: Vec<&Parameter<'g>> = model.parameters.iter().into_list();
        for parameter in model.power.iter().flat_map(|power| &power.parameters) {
            if read.iter().all(|other| other.name != parameter.name) {
                read.push(parameter);
            }
        }
        let mut momenta = Vec::new();
        for parameter in read.into_iter().filter(|parameter| !parameter.per_site) {
            for leaf in parameter.leaves.iter().filter(|leaf| leaf.shape == Shape::vector(3)) {
                for choice in choices.iter().filter(|choice| !choice.iter().all(|family| self.is_whole(found, *family)))
                {
                    let weight = |direction: &Direction<'g>| {
                        let is_of_choice = choice.contains(&direction.family);
                        if is_of_choice { leaf.symbol.entry(direction.index, 0) } else { graph.integer(0) }
                    };
                    let weights: Vec<_> = self.directions.each(weight);
                    let still = self.places.iter().map(|_| graph.integer(0));
                    let all: Vec<_> = still.chain(weights.iter().copied()).into_list();
                    let change = self.matrix * graph.stack(Shape::vector(all.len()), all);
                    if !identity::vanishes(change) {
                        continue;
                    }
                    let terms = self.directions.iter().zip(weights);
                    let terms = terms.map(|(direction, weight)| weight * direction.momentum);
                    let Family { of, frame, .. } = &self.families[choice[0]];
                    let of = if choice.len() == 1 { of } else { " of all factors" };
                    let name = format!("about {}{of}, {frame}", parameter.name);
                    momenta.push(ConservedMomentum { name, value: graph.total(Shape::scalar(), terms) });
                }
            }
        }
        momenta
    }

    /// Whether all directions of a family are conserved.
    fn is_whole(&self, found: &[Vec<Rational>], family: usize) -> bool {
        (0..self.directions.len()).filter(|&i| self.directions[i].family == family).all(|i| holds(found, i))
    }

    /// Where motions that fix q are motions too: the momentum along a vector leaf q of a group of rotations that turn about it.
    pub(super) fn isotropy(&self) -> Vec<ConservedMomentum<'g>> {
        let mut momenta = Vec::new();
        let factors = self.sources.model.factors.iter().enumerate();
        for (k, factor) in factors.filter(|(_, factor)| turns_in_space(factor.group)) {
            for leaf in self.sources.model.configurations.iter().filter(|leaf| leaf.shape == Shape::vector(3)) {
                let motion = self.sources.motion_by(&self.sources.in_factor(k, leaf.symbol));
                if motion.into_iter().all(identity::vanishes) {
                    let value = self.sources.symbols.momenta[k].dot(leaf.symbol);
                    let name = format!("about {}, {}", leaf.name, factor.side.frame());
                    momenta.push(ConservedMomentum { name, value });
                }
            }
        }
        momenta
    }

    /// Axes about which a system with special parameters is symmetric too: matrices axisymmetric and vectors along the axis.
    pub(super) fn special(&self, found: &[Vec<Rational>]) -> Vec<String> {
        let mut sentences = Vec::new();
        for (position, direction) in self.directions.iter().enumerate() {
            let Family { group, of, frame, .. } = &self.families[direction.family];
            if turns_in_space(*group)
                && !holds(found, position)
                && let Some(conditions) = self.conditions(position, direction.index)
            {
                let words = naming::basis_element(self.sources.model, *group, direction.index);
                sentences.push(format!("{words}{of}, {frame}, where {conditions}"));
            }
        }
        sentences
    }

    /// The special parameters for which a direction is a symmetry; `None` if there are none of this kind.
    fn conditions(&self, position: usize, axis: usize) -> Option<String> {
        let place = self.places.len() + position;
        let column = self.matrix.block(0, place, Shape::new(self.matrix.shape().rows, 1));
        let leaves = self.sources.model.parameters.iter().flat_map(|parameter| &parameter.leaves);
        let leaves = leaves.filter(|leaf| [Shape::vector(3), Shape::square(3)].contains(&leaf.shape));
        let leaves: Vec<Expr<'g>> = leaves.map(|leaf| leaf.symbol).into_list();
        if leaves.is_empty() || leaves.len() > 4 {
            return None;
        }
        // each choice: for every vector whether it lies along the axis or is alike in all directions across it
        let matrices = (0..leaves.len()).filter(|&index| leaves[index].shape() == Shape::square(3));
        let fixed: usize = matrices.map(|index| 1 << index).sum();
        (0..1_usize << leaves.len()).filter(|choice| choice & fixed == 0).find_map(|choice| {
            let is_along = |index: usize| choice >> index & 1 == 0;
            let special = |(index, symbol): (usize, &Expr<'g>)| Special::new(*symbol, axis, index, is_along(index));
            let special: Vec<Special<'g>> = leaves.iter().enumerate().map(special).into_list();
            self.least(column, special)
        })
    }

    /// The conditions without those that are not needed; `None` where all of them do not suffice, or leave no regular inertia.
    fn least(&self, column: Expr<'g>, mut special: Vec<Special<'g>>) -> Option<String> {
        let set = |chosen: &[Special<'g>], point: &mut Point<'g>| {
            for special in chosen {
                let value = point.evaluate(special.value);
                point.set(special.symbol, value);
            }
        };
        let holds = |chosen: &[Special<'g>]| identity::vanishes_where(column, &|point| set(chosen, point));
        if !holds(&special) {
            return None;
        }
        let mut position = 0;
        while position < special.len() {
            let mut without = special.clone();
            without.remove(position);
            if holds(&without) { special = without } else { position += 1 }
        }
        let regular = identity::rank_where(self.sources.inertia, &|point| set(&special, point))
            == self.sources.inertia.shape().rows;
        let texts: Vec<String> = special.into_each(|special| special.text);
        (regular && !texts.is_empty()).then(|| texts.join(" and "))
    }
}

/// Whether the elements of a group are the rotations of space.
fn turns_in_space(group: Group) -> bool {
    matches!(group, Group::SpecialOrthogonal(3) | Group::UnitQuaternions)
}

/// A special value of a parameter.
#[derive(Clone)]
struct Special<'g> {
    symbol: Expr<'g>,
    value: Expr<'g>,
    text: String,
}

impl<'g> Special<'g> {
    /// A matrix or a vector that is alike in all directions across an axis, or a vector along it.
    fn new(symbol: Expr<'g>, axis: usize, index: usize, along: bool) -> Special<'g> {
        let graph = symbol.graph();
        let free = |number: usize| {
            let name = format!("special{index}_{number}");
            graph.symbol(&name, Shape::scalar(), Role::Unknown, Property::General)
        };
        let unit = graph.unit(Shape::vector(3), axis, 0);
        let (axial, name) = (format!("e{}", axis + 1), symbol.to_string());
        if symbol.shape() == Shape::square(3) {
            let value = free(0) * graph.identity(3) + free(1) * (unit * unit.transpose());
            return Special { symbol, value, text: format!("{name} is axisymmetric about {axial}") };
        }
        if along {
            return Special { symbol, value: free(0) * unit, text: format!("{name} is along {axial}") };
        }
        let ones = graph.literal(Shape::vector(3), vec![integer(1); 3]);
        let value = free(0) * ones + free(1) * unit;
        Special { symbol, value, text: format!("the components of {name} across {axial} are equal") }
    }
}
