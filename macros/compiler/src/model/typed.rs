//! The factors of the group, the leaves of the configuration and velocities: their symbols, and their values in
//! closures.

use clebsch_symbolic::{Block, Elements, Expr, Graph, Group, IntoList, Property, Role, Shape};
use syn::Type;

use super::arguments::TypedArguments;
use super::elaborate::Context;
use super::groups::GroupNames;
use super::references::References;
use super::scope::Scope;
use super::slots::{Matched, Slot};
use super::space::{Space, leaf_names};
use super::spaces::{Product, SpaceType};
use super::value::{Each, Value};
use super::{Access, Factor, Layout, Side};
use crate::diagnostic::{Diagnostics, Location};
use crate::parse::{Closure, Pattern};

/// The meaning of the two arguments of the action. A part with an error, which was reported, is `None`.
pub(super) struct Typed<'g> {
    pub element: Layout,
    pub factors: Option<Vec<Factor<'g>>>,
    pub space: Option<Space<'g>>,
}

/// A system whose action has been read, for reading symmetries, forces and inputs.
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
    pub fn new(
        graph: &'g Graph,
        typed: &TypedArguments,
        groups: Product<Group>,
        spaces: Product<SpaceType>,
    ) -> Typed<'g> {
        let factors = leaf_names(typed.element, &groups.layout, typed.diagnostics).map(|names| {
            let names = names.into_iter().zip(groups.layout.accessors());
            let factors = names.zip(&groups.leaves).enumerate().map(|(k, ((name, accessor), leaf))| Factor {
                accessor,
                ..Factor::new(graph, *leaf, name, Role::Element(k))
            });
            factors.into_list()
        });
        let space = Space::new(graph, typed.configuration, spaces, Role::Configuration, typed.diagnostics);
        Typed { element: groups.layout, factors, space }
    }

    pub fn arguments<'d>(
        &self,
        graph: &'g Graph,
        names: TypedArguments<'d>,
        references: [Option<References<'d, 'g>>; 2],
    ) -> Arguments<'d, 'g> {
        let element = |all: &Vec<Factor<'g>>| {
            let leaf = |factor: &Factor<'g>| Value::leaf(factor.symbol, factor.group == Group::UnitQuaternions);
            Value::nested(&self.element, &all.each(leaf))
        };
        let is_power = names.sites.is_some() && self.space.is_some();
        let mut members = Vec::new();
        for factor in self.factors.iter().flatten().filter(|factor| !factor.group.is_translation()) {
            members.push((factor.symbol, factor.group));
        }
        members.extend(self.space.iter().flat_map(Space::members));
        Arguments {
            names,
            element_value: self.factors.as_ref().map(|all| element(all).of_each(Each::Motion, is_power)),
            configuration_value: self.space.as_ref().map(|space| space.value().of_each(Each::Configuration, is_power)),
            members,
            step_size: graph.symbol("h", Shape::scalar(), Role::StepSize, Property::General),
            time: graph.symbol("t", Shape::scalar(), Role::Time, Property::General),
            references,
        }
    }
}

/// The arguments of closures by their names: their values.
pub(super) struct Arguments<'d, 'g> {
    pub names: TypedArguments<'d>,
    pub element_value: Option<Value<'g>>,
    pub configuration_value: Option<Value<'g>>,
    /// The symbols that lie on a group.
    pub members: Vec<(Expr<'g>, Group)>,
    pub step_size: Expr<'g>,
    pub time: Expr<'g>,
    /// Those of a step and of the end. `None` where one has an error, which was reported.
    pub references: [Option<References<'d, 'g>>; 2],
}

impl<'d, 'g> Arguments<'d, 'g> {
    /// The names in the action itself.
    pub fn action_scope(&self) -> Scope<'g> {
        let mut scope = Scope::new(&self.members);
        scope.add_argument(self.names.element, self.element_value.clone(), self.names.diagnostics);
        scope.add_argument(self.names.configuration, self.configuration_value.clone(), self.names.diagnostics);
        let (f, q) = (self.names.element.spell(), self.names.configuration.spell());
        let help = format!("the action depends on `{f}` and `{q}` alone");
        scope.missing = ["h", "t"].map(|name| (name.to_string(), help.clone())).into();
        scope
    }

    /// The arguments of a closure, with the slot that each takes.
    pub fn matched(&self, closure: &'d Closure, slots: &'static [Slot]) -> Matched<'d> {
        Matched::new(self.names.clone(), closure, slots)
    }

    /// The names in a closure that introduces none.
    pub fn scope_of(&self, closure: &'d Closure, slots: &'static [Slot]) -> Scope<'g> {
        self.scope(&self.matched(closure, slots), &[])
    }

    /// The scope in which arguments have the values of their slots, with the reason for each name that is left out.
    pub fn scope(&self, matched: &Matched, introduced: &[(Slot, Option<Value<'g>>)]) -> Scope<'g> {
        let mut scope = Scope::new(&self.members);
        for (argument, slot) in matched.arguments() {
            let value = slot.and_then(|slot| match slot {
                Slot::Time => Some(Value::Matrix(self.time)),
                Slot::Step => Some(Value::Matrix(self.step_size)),
                Slot::Configuration => {
                    part(self.names.configuration, self.configuration_value.as_ref()?, &argument.pattern)
                }
                Slot::Element => part(self.names.element, self.element_value.as_ref()?, &argument.pattern),
                Slot::Reference => {
                    let [of_step, of_end] = &self.references;
                    let references = if matched.is_of_step() { of_step } else { of_end };
                    references.as_ref().and_then(|references| references.value(&argument.pattern))
                }
                new => introduced.iter().find(|(slot, _)| *slot == new).and_then(|(_, value)| value.clone()),
            });
            scope.add_argument(&argument.pattern, value, self.names.diagnostics);
        }
        scope.missing = matched.missing();
        scope
    }
}

/// The value of a pattern, or of a part of it.
pub(super) fn part<'g>(whole: &Pattern, value: &Value<'g>, wanted: &Pattern) -> Option<Value<'g>> {
    match (whole, value) {
        _ if whole.matches(wanted) => Some(value.clone()),
        (Pattern::Tuple(patterns, _), Value::Tuple(values)) => {
            patterns.iter().zip(values).find_map(|(pattern, value)| part(pattern, value, wanted))
        }
        _ => None,
    }
}

impl<'g> Factor<'g> {
    /// A factor with its symbol, the side still open.
    pub(super) fn new(graph: &'g Graph, (group, ty): (Group, &Type), name: String, role: Role) -> Factor<'g> {
        let symbol = graph.symbol(&name, group.element_shape(), role, group.element_property());
        let (accessor, span) = (Access::default(), Location::from(ty).start);
        Factor { group, symbol, name, side: Side::Left, moves: true, accessor, span }
    }
}

/// The data for velocities.
pub(super) struct Velocity<'a, 'g> {
    pub graph: &'g Graph,
    pub factors: &'a [Factor<'g>],
    pub diagnostics: &'a Diagnostics,
}

impl<'g> Velocity<'_, 'g> {
    /// The value of a pattern, and the symbols of the factors. One name stands for everything in its place. A tuple
    /// stands for the parts of a product or for the blocks of one factor: `(omega, v)` for SE(3).
    pub fn of(&self, pattern: &Pattern, layout: &Layout) -> Option<(Value<'g>, Vec<Expr<'g>>)> {
        match (pattern, layout) {
            (Pattern::Tuple(patterns, _), Layout::Tuple(parts)) if patterns.len() == parts.len() => {
                let parts = patterns.iter().zip(parts).map(|(pattern, part)| self.of(pattern, part));
                let (values, symbols): (Vec<_>, Vec<_>) = parts.collect::<Option<Vec<_>>>()?.into_iter().unzip();
                Some((Value::Tuple(values), symbols.concat()))
            }
            (Pattern::Tuple(patterns, _), Layout::Leaf(k))
                if patterns.len() > 1 && self.graph.blocks(self.factors[*k].group).len() == patterns.len() =>
            {
                let names: Vec<String> = pattern.names().each(ToString::to_string);
                let symbol = self.symbol(*k, &names.join("_"));
                let part = |block: &Block| symbol.block(block.offset, 0, Shape::vector(block.algebra.dimension));
                let blocks = self.graph.blocks(self.factors[*k].group);
                let parts = blocks.iter().map(|block| Value::Matrix(part(block)));
                Some((Value::Tuple(parts.into_list()), vec![symbol]))
            }
            _ => {
                let names = leaf_names(pattern, layout, self.diagnostics)?;
                let leaves = layout.numbers();
                let symbols: Vec<Expr<'g>> =
                    leaves.iter().zip(&names).map(|(k, name)| self.symbol(*k, name)).into_list();
                // the leaves of a part of a product are numbered as in the product
                let mut values = vec![Value::Tuple(Vec::new()); self.factors.len()];
                leaves.iter().zip(&symbols).for_each(|(k, symbol)| values[*k] = Value::Matrix(*symbol));
                Some((Value::nested(layout, &values), symbols))
            }
        }
    }

    pub fn symbol(&self, factor: usize, name: &str) -> Expr<'g> {
        let shape = Shape::vector(self.factors[factor].group.dimension());
        self.graph.symbol(name, shape, Role::Algebra(factor), Property::General)
    }
}
