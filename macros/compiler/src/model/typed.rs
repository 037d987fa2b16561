//! The factors of the group and the leaves of the configuration: their symbols, and what they are in closures.

use clebsch_symbolic::{Expr, Graph, Group, Role};
use proc_macro2::Span;

use super::arguments::{Arguments, TypedArguments};
use super::groups::GroupNames;
use super::leaves::leaf_names;
use super::slots::SharedNames;
use super::spaces::{Product, SpaceType, span_of};
use super::value::Value;
use super::{Access, Configuration, Factor, Layout, LeafSpace, Side};
use crate::diagnostic::Diagnostics;
use crate::parse::{Argument, Pattern};

/// What the two arguments of the action stand for. A part with an error, which was reported, is `None`.
pub(super) struct Typed<'g> {
    pub element: Layout,
    pub factors: Option<Vec<Factor<'g>>>,
    pub configuration: Layout,
    pub configurations: Option<Vec<Configuration<'g>>>,
}

/// A system whose action has been read: what symmetries, forces and inputs are read for.
#[derive(Copy, Clone)]
pub(super) struct ActedSystem<'a, 'g> {
    pub arguments: &'a Arguments<'a, 'g>,
    pub names: GroupNames<'a>,
    pub element: &'a Layout,
    pub factors: &'a [Factor<'g>],
    pub configuration: &'a Layout,
    pub configurations: &'a [Configuration<'g>],
    /// Φ_F(q), leaf by leaf.
    pub action: &'a [Expr<'g>],
}

impl<'g> Typed<'g> {
    /// The symbols of all factors and leaves.
    pub fn new(
        graph: &'g Graph,
        arguments: TypedArguments,
        groups: Product<Group>,
        spaces: Product<SpaceType>,
        diagnostics: &Diagnostics,
    ) -> Typed<'g> {
        let factors = factors(graph, arguments.element, &groups, diagnostics);
        let configurations = leaves(graph, arguments.configuration, &spaces, Role::Configuration, diagnostics);
        Typed { element: groups.structure, factors, configuration: spaces.structure, configurations }
    }

    /// The arguments of all closures.
    pub fn arguments<'d>(
        &self,
        typed: TypedArguments<'d>,
        input: Option<&'d Argument>,
        (step_size, time): (Expr<'g>, Expr<'g>),
    ) -> Arguments<'d, 'g> {
        let (factors, configurations) = (self.factors.as_deref(), self.configurations.as_deref());
        let element = |all: &[Factor<'g>]| {
            let leaf = |factor: &Factor<'g>| Value::leaf(factor.symbol, factor.group == Group::UnitQuaternions);
            Value::nested(&self.element, &all.iter().map(leaf).collect::<Vec<_>>())
        };
        let of_group = |factor: &Factor<'g>| (!factor.group.is_translation()).then_some((factor.symbol, factor.group));
        let on_group = |leaf: &Configuration<'g>| match leaf.space {
            LeafSpace::Group(group) => Some((leaf.symbol, group)),
            LeafSpace::Vectors | LeafSpace::Unit => None,
        };
        let members = factors.into_iter().flatten().filter_map(of_group);
        let input = input.map(|argument| &argument.pattern);
        Arguments {
            names: SharedNames { element: typed.element, configuration: typed.configuration, input },
            element_value: factors.map(element),
            configuration_value: configurations.map(|all| value_of(&self.configuration, all)),
            members: members.chain(configurations.into_iter().flatten().filter_map(on_group)).collect(),
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

/// What a configuration or an input is in a closure.
pub(super) fn value_of<'g>(structure: &Layout, leaves: &[Configuration<'g>]) -> Value<'g> {
    let values: Vec<_> = leaves.iter().map(|leaf| Value::leaf(leaf.symbol, leaf.is_quaternion)).collect();
    Value::nested(structure, &values)
}

/// The factors of the group, the side of each still open.
fn factors<'g>(
    graph: &'g Graph,
    pattern: &Pattern,
    groups: &Product<Group>,
    diagnostics: &Diagnostics,
) -> Option<Vec<Factor<'g>>> {
    let names = leaf_names(pattern, &groups.structure, diagnostics)?.into_iter().zip(groups.structure.accessors());
    let factors = names.zip(&groups.leaves).enumerate().map(|(k, ((name, accessor), (group, ty)))| {
        Factor::new(graph, *group, name, Role::Element(k), accessor, span_of(ty))
    });
    Some(factors.collect())
}

/// The leaves of the configuration or of an input, by their role.
pub(super) fn leaves<'g>(
    graph: &'g Graph,
    pattern: &Pattern,
    spaces: &Product<SpaceType>,
    role: fn(usize) -> Role,
    diagnostics: &Diagnostics,
) -> Option<Vec<Configuration<'g>>> {
    let names = leaf_names(pattern, &spaces.structure, diagnostics)?.into_iter().zip(spaces.structure.accessors());
    let leaves = names.zip(&spaces.leaves).enumerate().map(|(i, ((name, accessor), (leaf, _)))| {
        let symbol = graph.symbol(&name, leaf.shape, role(i), leaf.property());
        let SpaceType { space, shape, is_quaternion, .. } = *leaf;
        Configuration { symbol, name, space, shape, is_quaternion, accessor }
    });
    Some(leaves.collect())
}
