//! References: data of a plan that motions, forces, prices and bounds read step by step, and that the price of the end reads once.

use clebsch_symbolic::{Elements, Graph, IntoList, Role, indexed};
use syn::Type;

use super::arguments::TypedArguments;
use super::groups::GroupNames;
use super::shapes::spelled;
use super::space::Space;
use super::spaces::{SpaceType, read_spaces};
use super::typed::part;
use super::value::Value;
use super::{Access, Configuration, Layout, LeafSpace};
use crate::diagnostic::{Location, refuse};
use crate::parse::{Argument, Closure, Declaration, Pattern, joined, spell_type};

/// The typed arguments that introduce references, in order of their first use.
#[derive(Clone, Default)]
pub(super) struct Introduced<'d> {
    /// Those of motion, price and bounds, first those of forces.
    pub of_steps: Vec<&'d Argument>,
    /// Those of the price of the end and of the target. A name that a step refers to is of the same type there.
    pub of_end: Vec<&'d Argument>,
    /// The number of those that forces read.
    pub of_forces: usize,
}

impl<'d> Introduced<'d> {
    /// The arguments of motions, prices and bounds that are of no other meaning.
    pub fn new(declaration: &'d Declaration, names: &TypedArguments<'d>) -> Introduced<'d> {
        let is_new = |argument: &&Argument| !names.is_other(&argument.pattern);
        let mut introduced = Introduced::default();
        let motion = Some(declaration.kinetic.closure()).filter(|_| declaration.kinetic.is_steered());
        let choice = declaration.choice().into_iter().flat_map(|choice| [Some(&choice.price), choice.bounds.as_ref()]);
        let forces =
            || declaration.force.iter().chain(&declaration.force_on).filter(|_| declaration.choice().is_some());
        // the first type in a force is that of its input
        let behind_input = |closure: &'d Closure| {
            let typed = closure.arguments.iter().position(|argument| argument.ty.is_some());
            closure.arguments.iter().skip(typed.map_or(usize::MAX, |input| input + 1))
        };
        let others = motion.into_iter().chain(choice.flatten()).flat_map(|closure| &closure.arguments);
        for argument in forces().flat_map(behind_input).chain(others).filter(is_new) {
            if argument.ty.is_some() && find(&introduced.of_steps, &argument.pattern).is_none() {
                introduced.of_steps.push(argument);
            }
        }
        let read: Vec<&Pattern> =
            forces().flat_map(|closure| &closure.arguments).map(|argument| &argument.pattern).into_list();
        let is_of_forces = |argument: &&Argument| read.iter().any(|pattern| argument.pattern.holds(pattern));
        let (of_forces, others): (Vec<_>, Vec<_>) = introduced.of_steps.into_iter().partition(is_of_forces);
        introduced.of_forces = of_forces.len();
        introduced.of_steps = [of_forces, others].concat();
        for argument in declaration.of_end().flat_map(|closure| &closure.arguments).filter(is_new) {
            let known = || find(&introduced.of_steps, &argument.pattern).copied();
            let typed = if argument.ty.is_some() { Some(argument) } else { known() };
            introduced.of_end.extend(typed.filter(|typed| find(&introduced.of_end, &typed.pattern).is_none()));
        }
        introduced
    }
}

/// The argument with a pattern or with one that holds it.
pub(super) fn find<'a, 'd>(arguments: &'a [&'d Argument], pattern: &Pattern) -> Option<&'a &'d Argument> {
    arguments.iter().find(|argument| argument.pattern.holds(pattern))
}

/// The type of the vectors, matrices and quaternions of a product, as it is written.
fn plain(layout: &Layout, leaves: &[(SpaceType, &Type)]) -> String {
    match layout {
        Layout::Leaf(k) if leaves[*k].0.is_quaternion => "Quaternion".to_string(),
        Layout::Leaf(k) => spelled(leaves[*k].0.shape),
        Layout::Tuple(parts) => format!("({})", joined(parts.iter().map(|part| plain(part, leaves)))),
        Layout::Array(parts) => {
            let part = parts.first().map(|part| plain(part, leaves)).unwrap_or_default();
            format!("[{part}; {}]", parts.len())
        }
    }
}

/// References with their values.
pub(super) struct References<'d, 'g> {
    /// Each argument with its space.
    arguments: Vec<(&'d Pattern, Space<'g>)>,
}

impl<'d, 'g> References<'d, 'g> {
    /// Reads their types; `None` where one has an error, which was reported. A leaf has the role of its argument and its own number.
    pub fn read(
        graph: &'g Graph,
        arguments: &[&'d Argument],
        role: impl Fn(usize, usize) -> Role,
        names: GroupNames,
    ) -> Option<References<'d, 'g>> {
        let mut read: Vec<(&'d Pattern, Space<'g>)> = Vec::new();
        for (number, argument) in arguments.iter().enumerate() {
            let ty = argument.ty.as_ref()?;
            let product = read_spaces(ty, names)?;
            let is_other = |(leaf, _): &&(SpaceType, _)| leaf.space != LeafSpace::Vectors;
            if let Some((_, ty)) = product.leaves.iter().find(is_other) {
                let (name, meant) = (argument.pattern.spell(), plain(&product.layout, &product.leaves));
                refuse!(names.diagnostics, Location::from(*ty), "`{}` is no type of a reference, which is made of vectors, matrices and quaternions", spell_type(ty);
                    help "write `{name}: {meant}`";
                    note "references are data that nothing moves, so that no space is asked of them");
            }
            let first: usize = read.iter().map(|(_, space)| space.leaves.len()).sum();
            let role = |leaf| role(number, first + leaf);
            read.push((&argument.pattern, Space::new(graph, &argument.pattern, product, role, names.diagnostics)?));
        }
        Some(References { arguments: read })
    }

    /// The value of an argument.
    pub fn value(&self, pattern: &Pattern) -> Option<Value<'g>> {
        self.arguments.iter().find_map(|(known, space)| part(known, &space.value(), pattern))
    }

    /// All of them as one: the one reference, or a tuple.
    pub fn joined(self) -> Space<'g> {
        together(self.arguments.into_iter().map(|(_, space)| space))
    }

    /// How the first ones, so many, are reached in all of them.
    pub fn first(&self, count: usize) -> Vec<Access> {
        indexed(count, |k| if self.arguments.len() == 1 { Access::default() } else { Access::field(k) })
    }

    /// The input of a stepper: that of the forces, with the references that they read behind it, so many.
    pub fn behind(&self, input: Space<'g>, of_forces: usize) -> Space<'g> {
        together([input].into_iter().chain(self.arguments.iter().take(of_forces).map(|(_, space)| space.clone())))
    }
}

/// Spaces as one: the only one, or a tuple.
fn together<'g>(spaces: impl Iterator<Item = Space<'g>>) -> Space<'g> {
    let mut leaves: Vec<Configuration<'g>> = Vec::new();
    let mut layouts = Vec::new();
    for space in spaces {
        layouts.push(space.layout.shifted(leaves.len()));
        leaves.extend(space.leaves);
    }
    let layout = if layouts.len() == 1 { layouts.remove(0) } else { Layout::Tuple(layouts) };
    let accessors = layout.accessors();
    let leaves = leaves.into_iter().zip(accessors);
    Space { leaves: leaves.map(|(leaf, accessor)| Configuration { accessor, ..leaf }).into_list(), layout }
}

/// The types of the references of a declaration with errors, as far as they can be read.
pub(super) fn outlined(arguments: &[&Argument], names: GroupNames) -> Option<super::outline::Nested> {
    let graph = Graph::new();
    let role = |_, leaf| Role::Reference(leaf);
    let Space { layout, leaves } = References::read(&graph, arguments, role, names)?.joined();
    Some((layout, leaves.each(|leaf| (leaf.shape, leaf.is_quaternion))))
}
