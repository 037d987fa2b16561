//! The factors of the group, the leaves of the configuration and velocities: their symbols, and what they are in closures.

use clebsch_symbolic::{Block, Expr, Graph, Group, Property, Role, Shape};
use proc_macro2::Span;

use super::arguments::{Arguments, TypedArguments};
use super::elaborate::Context;
use super::groups::GroupNames;
use super::slots::SharedNames;
use super::space::{Space, leaf_names};
use super::spaces::{Product, SpaceType, span_of};
use super::value::Value;
use super::{Access, Factor, Layout, LeafSpace, Side};
use crate::diagnostic::Diagnostics;
use crate::parse::{Argument, Pattern};

/// What the two arguments of the action stand for. A part with an error, which was reported, is `None`.
pub(super) struct Typed<'g> {
    pub element: Layout,
    pub factors: Option<Vec<Factor<'g>>>,
    pub space: Option<Space<'g>>,
}

/// A system whose action has been read: what symmetries, forces and inputs are read for.
pub(super) struct ActedSystem<'a, 'c, 'g> {
    pub context: &'a mut Context<'c, 'g>,
    pub arguments: &'a Arguments<'a, 'g>,
    pub names: GroupNames<'a>,
    pub element: &'a Layout,
    pub factors: &'a [Factor<'g>],
    pub space: &'a Space<'g>,
    /// Φ_F(q), leaf by leaf.
    pub action: &'a [Expr<'g>],
}

impl<'g> Typed<'g> {
    /// The symbols of all factors and leaves.
    pub fn new(
        graph: &'g Graph,
        typed: TypedArguments,
        groups: Product<Group>,
        spaces: Product<SpaceType>,
        diagnostics: &Diagnostics,
    ) -> Typed<'g> {
        let factors = leaf_names(typed.element, &groups.layout, diagnostics).map(|names| {
            let names = names.into_iter().zip(groups.layout.accessors());
            let factors = names.zip(&groups.leaves).enumerate().map(|(k, ((name, accessor), (group, ty)))| {
                Factor::new(graph, *group, name, Role::Element(k), accessor, span_of(ty))
            });
            factors.collect()
        });
        let space = Space::new(graph, typed.configuration, spaces, Role::Configuration, diagnostics);
        Typed { element: groups.layout, factors, space }
    }

    /// The arguments of all closures.
    pub fn arguments<'d>(
        &self,
        typed: TypedArguments<'d>,
        input: Option<&'d Argument>,
        (step_size, time): (Expr<'g>, Expr<'g>),
        diagnostics: &'d Diagnostics,
    ) -> Arguments<'d, 'g> {
        let element = |all: &Vec<Factor<'g>>| {
            let leaf = |factor: &Factor<'g>| Value::leaf(factor.symbol, factor.group == Group::UnitQuaternions);
            Value::nested(&self.element, &all.iter().map(leaf).collect::<Vec<_>>())
        };
        let mut members = Vec::new();
        for factor in self.factors.iter().flatten().filter(|factor| !factor.group.is_translation()) {
            members.push((factor.symbol, factor.group));
        }
        for leaf in self.space.iter().flat_map(|space| &space.leaves) {
            if let LeafSpace::Group(group) = leaf.space {
                members.push((leaf.symbol, group));
            }
        }
        let input = input.map(|argument| &argument.pattern);
        Arguments {
            names: SharedNames { element: typed.element, configuration: typed.configuration, input, diagnostics },
            element_value: self.factors.as_ref().map(element),
            configuration_value: self.space.as_ref().map(Space::value),
            members,
            step_size,
            time,
        }
    }
}

impl<'g> Factor<'g> {
    /// A factor with its symbol, the side still open.
    pub(super) fn new(
        graph: &'g Graph,
        group: Group,
        name: String,
        role: Role,
        accessor: Access,
        span: Span,
    ) -> Factor<'g> {
        let symbol = graph.symbol(&name, group.element_shape(), role, group.element_property());
        Factor { group, symbol, name, side: Side::Left, moves: true, accessor, span }
    }
}

/// What velocities are made for.
pub(super) struct Velocity<'a, 'g> {
    pub graph: &'g Graph,
    pub factors: &'a [Factor<'g>],
    pub diagnostics: &'a Diagnostics,
}

impl<'g> Velocity<'_, 'g> {
    /// The value of a pattern, and the symbols of the factors. One name stands for all that is in its place, a tuple for the parts of a
    /// product or for the blocks of one factor: `(omega, v)` for SE(3).
    pub fn of(&self, pattern: &Pattern, layout: &Layout) -> Option<(Value<'g>, Vec<Expr<'g>>)> {
        match (pattern, layout) {
            (Pattern::Tuple(patterns, _), Layout::Tuple(parts)) if patterns.len() == parts.len() => {
                let parts = patterns.iter().zip(parts).map(|(pattern, part)| self.of(pattern, part));
                let (values, symbols): (Vec<_>, Vec<_>) = parts.collect::<Option<Vec<_>>>()?.into_iter().unzip();
                Some((Value::Tuple(values), symbols.concat()))
            }
            (Pattern::Tuple(patterns, _), Layout::Leaf(k)) if self.has_blocks(*k, patterns.len()) => {
                let names: Vec<String> = pattern.names().iter().map(ToString::to_string).collect();
                let symbol = self.symbol(*k, &names.join("_"));
                let part = |block: &Block| symbol.block(block.offset, 0, Shape::vector(block.algebra.dimension));
                let blocks = self.graph.blocks(self.factors[*k].group);
                let parts = blocks.iter().map(|block| Value::Matrix(part(block)));
                Some((Value::Tuple(parts.collect()), vec![symbol]))
            }
            _ => {
                let names = leaf_names(pattern, layout, self.diagnostics)?;
                let leaves = layout.numbers();
                let symbols: Vec<Expr<'g>> = leaves.iter().zip(&names).map(|(k, name)| self.symbol(*k, name)).collect();
                // the leaves of a part of a product are numbered as in the whole
                let mut values = vec![Value::Tuple(Vec::new()); self.factors.len()];
                leaves.iter().zip(&symbols).for_each(|(k, symbol)| values[*k] = Value::Matrix(*symbol));
                Some((Value::nested(layout, &values), symbols))
            }
        }
    }

    /// The symbols of a velocity that the closure does not ask for.
    pub fn unnamed(&self) -> Vec<Expr<'g>> {
        (0..self.factors.len()).map(|k| self.symbol(k, "velocity")).collect()
    }

    /// Whether the algebra of a factor has several blocks, and as many as there are names.
    fn has_blocks(&self, factor: usize, names: usize) -> bool {
        names > 1 && self.graph.blocks(self.factors[factor].group).len() == names
    }

    fn symbol(&self, factor: usize, name: &str) -> Expr<'g> {
        let shape = Shape::vector(self.factors[factor].group.dimension());
        self.graph.symbol(name, shape, Role::Algebra(factor), Property::General)
    }
}
