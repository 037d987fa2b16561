//! The part of a declaration with errors that can still be read: the types that its integrator would have.

use clebsch_symbolic::{Elements, Graph, Group, IntoList, Shape};
use quote::ToTokens;

use super::groups::GroupNames;
use super::spaces::{self, Product, SpaceType};
use super::{Layout, Length, ScalarType, arguments, declared, references};
use crate::diagnostic::Diagnostics;
use crate::parse::{Argument, Declaration, Pattern, Potential};

/// The types of an integrator, without its mathematics.
pub struct Outline {
    /// The number of sites of a power. The other fields describe one site.
    pub sites: Option<Length>,
    /// The group element.
    pub element: Nested,
    /// The configuration.
    pub configuration: Nested,
    /// The input of a stepper.
    pub input: Nested,
    /// The number of entries of the input of a plan, which has no references of forces behind it.
    pub chosen: usize,
    /// The reference of a step, and that of the end.
    pub references: [Nested; 2],
    /// The number of components of a momentum.
    pub dimension: usize,
    /// Whether a closure takes the time.
    pub takes_time: bool,
    /// The scalar, as far as it can be told.
    pub scalar: ScalarType,
}

/// A product: how its leaves nest, and the shape of each with whether it is a quaternion.
pub type Nested = (Layout, Vec<(Shape, bool)>);

/// A tuple of products.
fn together(parts: &[Nested]) -> Nested {
    let mut leaves = Vec::new();
    let mut layouts = Vec::new();
    for (layout, own) in parts {
        layouts.push(layout.shifted(leaves.len()));
        leaves.extend(own.iter().copied());
    }
    (Layout::Tuple(layouts), leaves)
}

/// The outline of a declaration whose action has readable types.
pub fn outline(graph: &Graph, declaration: &Declaration) -> Option<Outline> {
    let ignored = Diagnostics::new();
    let declared = declared::read_all(graph, &declaration.groups, &ignored);
    let names = GroupNames { generics: &declaration.generics, declared: &declared, diagnostics: &ignored };
    let types = arguments::of_action(declaration, arguments::ByNumber::Unrolled, &ignored)?;
    let groups = spaces::read_groups(types.group, names)?;
    let of_group = |(group, _): &(Group, _)| (group.element_shape(), *group == Group::UnitQuaternions);
    let nested =
        |spaces: Product<SpaceType>| (spaces.layout, spaces.leaves.each(|(leaf, _)| (leaf.shape, leaf.is_quaternion)));
    let is_time = |argument: &Argument| matches!(&argument.pattern, Pattern::Name(ident) if ident == "t");
    let opaque = declaration.potential.as_ref().and_then(Potential::opaque);
    let opaque_takes_time = opaque.is_some_and(|opaque| opaque.takes_time);
    let point = || (Layout::Tuple(Vec::new()), Vec::new());
    let spaces = spaces::read_spaces(types.space, names)?;
    let input = declaration.input().and_then(|argument| spaces::read_spaces(argument.ty.as_ref()?, names));
    let input = input.map_or_else(point, nested);
    let chosen = input.1.iter().map(|(shape, _)| shape.len()).sum();
    let of_forces = types.references.of_steps.iter().take(types.references.of_forces);
    let of_forces =
        of_forces.map(|argument| references::outlined(&[*argument], names).unwrap_or_else(point)).into_list();
    let input = if of_forces.is_empty() { input } else { together(&[vec![input], of_forces].concat()) };
    let [of_steps, of_end] = [&types.references.of_steps, &types.references.of_end];
    let references = [of_steps, of_end].map(|arguments| references::outlined(arguments, names).unwrap_or_else(point));
    Some(Outline {
        references,
        sites: types.sites.clone(),
        input,
        chosen,
        dimension: groups.leaves.iter().map(|(group, _)| group.dimension()).sum(),
        element: (groups.layout, groups.leaves.each(of_group)),
        configuration: if declaration.dials.emit.momentum { point() } else { nested(spaces) },
        takes_time: opaque_takes_time
            || declaration.step.is_some()
            || declaration.closures().flat_map(|closure| &closure.arguments).any(is_time),
        scalar: scalar(declaration),
    })
}

/// The first type parameter, or `f32` where the dial or a field says so, or `f64`.
fn scalar(declaration: &Declaration) -> ScalarType {
    if let Some(parameter) = declaration.generics.type_params().next() {
        return ScalarType::Parameter(parameter.ident.clone());
    }
    let named = declaration.dials.scalar.as_ref().is_some_and(|ident| ident == "f32");
    let held = declaration.fields.iter().any(|field| field.ty.to_token_stream().to_string().contains("f32"));
    if named || held { ScalarType::F32 } else { ScalarType::F64 }
}
