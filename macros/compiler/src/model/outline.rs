//! What a declaration with errors still says: the types that its integrator would have.

use clebsch_symbolic::{Graph, Group, Shape};
use quote::ToTokens;

use super::groups::GroupNames;
use super::{Layout, ScalarType, arguments, declared, spaces};
use crate::diagnostic::Diagnostics;
use crate::parse::{Argument, Declaration, Pattern, Potential};

/// The types of an integrator, without its mathematics.
pub struct Outline {
    /// The const generic that is the number of sites of a power, of which the rest says what one is.
    pub sites: Option<syn::Ident>,
    /// How the factors nest.
    pub element: Layout,
    /// The groups of the factors.
    pub groups: Vec<Group>,
    /// How the leaves of the configuration nest.
    pub configuration: Layout,
    /// The shapes of the leaves of the configuration.
    pub shapes: Vec<Shape>,
    /// Which leaves of the configuration are quaternions.
    pub quaternions: Vec<bool>,
    /// How the leaves of the input nest.
    pub input: Layout,
    /// The shapes of the leaves of the input.
    pub inputs: Vec<Shape>,
    /// Whether a closure takes the time.
    pub takes_time: bool,
    /// The scalar, as far as it can be told.
    pub scalar: ScalarType,
}

/// The outline of a declaration whose action has readable types.
pub fn outline(graph: &Graph, declaration: &Declaration) -> Option<Outline> {
    let ignored = Diagnostics::new();
    let declared = declared::read_all(graph, &declaration.groups, &ignored);
    let names = GroupNames { generics: &declaration.generics, declared: &declared, diagnostics: &ignored };
    let types = arguments::of_action(declaration, &ignored)?;
    let groups = spaces::read_groups(types.group, names)?;
    let mut spaces = spaces::read_spaces(types.space, names)?;
    let input = declaration.input().and_then(|argument| argument.ty.as_ref());
    let input = input.and_then(|ty| spaces::read_spaces(ty, names));
    if declaration.dials.emit.momentum {
        (spaces.layout, spaces.leaves) = (Layout::Tuple(Vec::new()), Vec::new());
    }
    Some(Outline {
        sites: types.sites.cloned(),
        inputs: input.iter().flat_map(|input| input.leaves.iter().map(|(leaf, _)| leaf.shape)).collect(),
        input: input.map_or(Layout::Tuple(Vec::new()), |input| input.layout),
        element: groups.layout,
        groups: groups.leaves.iter().map(|(group, _)| *group).collect(),
        configuration: spaces.layout,
        shapes: spaces.leaves.iter().map(|(space, _)| space.shape).collect(),
        quaternions: spaces.leaves.iter().map(|(space, _)| space.is_quaternion).collect(),
        takes_time: takes_time(declaration),
        scalar: scalar(declaration),
    })
}

/// Whether a closure has an argument `t`, or an opaque potential takes the time.
fn takes_time(declaration: &Declaration) -> bool {
    let is_time = |argument: &Argument| matches!(&argument.pattern, Pattern::Name(ident) if ident == "t");
    let opaque = matches!(&declaration.potential, Some(Potential::Opaque(opaque)) if opaque.takes_time);
    opaque || declaration.closures().any(|closure| closure.arguments.iter().any(is_time))
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
