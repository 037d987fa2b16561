//! The factors of the group and the leaves of the configuration: their symbols, and what they are in closures.

use clebsch_symbolic::{Expr, Graph, Group, Role};

use super::arguments::{Arguments, TypedArguments};
use super::leaves::leaf_names;
use super::slots::SharedNames;
use super::spaces::{Product, SpaceType, span_of};
use super::value::Value;
use super::{Configuration, Factor, Layout, LeafSpace, Side};
use crate::diagnostic::Diagnostics;
use crate::parse::Pattern;

/// What the two arguments of the action stand for. A part with an error, which was reported, is `None`.
pub(super) struct Typed<'g> {
    pub element: Layout,
    pub factors: Option<Vec<Factor<'g>>>,
    pub configuration: Layout,
    pub configurations: Option<Vec<Configuration<'g>>>,
}

impl<'g> Typed<'g> {
    /// The symbols of all factors and leaves.
    pub fn new(
        graph: &'g Graph,
        arguments: TypedArguments,
        groups: Product<Group>,
        spaces: Product<SpaceType>,
        diagnostics: &mut Diagnostics,
    ) -> Typed<'g> {
        let factors = factors(graph, arguments.element, &groups, diagnostics);
        let configurations = configurations(graph, arguments.configuration, &spaces, diagnostics);
        Typed { element: groups.structure, factors, configuration: spaces.structure, configurations }
    }

    /// The arguments of all closures.
    pub fn arguments<'d>(
        &self,
        typed: TypedArguments<'d>,
        input: Option<&'d Pattern>,
        (step_size, time): (Expr<'g>, Expr<'g>),
    ) -> Arguments<'d, 'g> {
        let factor = |factor: &Factor<'g>| Value::leaf(factor.symbol, factor.group == Group::UnitQuaternions);
        let point = |leaf: &Configuration<'g>| Value::leaf(leaf.symbol, leaf.is_quaternion);
        let nested = |structure: &Layout, leaves: Vec<Value<'g>>| Value::nested(structure, &leaves);
        Arguments {
            names: SharedNames { element: typed.element, configuration: typed.configuration, input },
            element_value: self.factors.as_deref().map(|all| nested(&self.element, all.iter().map(factor).collect())),
            configuration_value: (self.configurations.as_deref())
                .map(|all| nested(&self.configuration, all.iter().map(point).collect())),
            members: members(self.factors.as_deref(), self.configurations.as_deref()),
            step_size,
            time,
        }
    }
}

/// The symbols that lie on a group.
fn members<'g>(factors: Option<&[Factor<'g>]>, configurations: Option<&[Configuration<'g>]>) -> Vec<(Expr<'g>, Group)> {
    let of_leaf = |leaf: &Configuration<'g>| match leaf.space {
        LeafSpace::Group(group) => Some((leaf.symbol, group)),
        LeafSpace::Vectors | LeafSpace::Unit => None,
    };
    let factors = factors.into_iter().flatten().filter(|factor| !factor.group.is_translation());
    factors
        .map(|factor| (factor.symbol, factor.group))
        .chain(configurations.into_iter().flatten().filter_map(of_leaf))
        .collect()
}

/// The factors of the group, the side of each still open.
fn factors<'g>(
    graph: &'g Graph,
    pattern: &Pattern,
    groups: &Product<Group>,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Factor<'g>>> {
    let names = leaf_names(pattern, &groups.structure, diagnostics)?;
    let mut factors = Vec::new();
    for (&(group, ty), (name, accessor)) in
        groups.leaves.iter().zip(names.into_iter().zip(groups.structure.accessors()))
    {
        let role = Role::Element(factors.len());
        let symbol = graph.symbol(&name, group.element_shape(), role, group.element_property());
        let span = span_of(ty);
        factors.push(Factor { group, symbol, name, side: Side::Left, moves: true, accessor, span });
    }
    Some(factors)
}

fn configurations<'g>(
    graph: &'g Graph,
    pattern: &Pattern,
    spaces: &Product<SpaceType>,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Configuration<'g>>> {
    let names = leaf_names(pattern, &spaces.structure, diagnostics)?;
    let mut configurations = Vec::new();
    for ((leaf, _), (name, accessor)) in spaces.leaves.iter().zip(names.into_iter().zip(spaces.structure.accessors())) {
        let role = Role::Configuration(configurations.len());
        let symbol = graph.symbol(&name, leaf.shape, role, leaf.property());
        let SpaceType { space, shape, is_quaternion, .. } = *leaf;
        configurations.push(Configuration { symbol, name, space, shape, is_quaternion, accessor });
    }
    Some(configurations)
}
