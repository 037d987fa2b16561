//! The two arguments of the action, whose names the other closures use, and their types.

use clebsch_symbolic::IntoList;
use syn::ext::IdentExt;
use syn::{Generics, Type};

use super::groups::{GroupNames, group};
use super::power::Length;
use super::references::Introduced;
use super::scope::check_reserved;
use super::shapes::{const_generic, last_name, number, plain, vectors};
use crate::diagnostic::{Diagnostic, Diagnostics, bail, error, refuse, report};
use crate::parse::{Argument, Closure, Declaration, Kinetic, Pattern, spell, spell_type};

/// How a product by a number, `[SE<3>; 4]`, is read.
#[derive(Copy, Clone, PartialEq, Eq)]
pub enum ByNumber {
    /// As a power, whose formulas are those of one site.
    Sites,
    /// As one group.
    Unrolled,
}

/// The two arguments of the action: the group element and the configuration, with their types. Those of a power are those of one site.
#[derive(Clone)]
pub(super) struct TypedArguments<'d> {
    pub element: &'d Pattern,
    pub group: &'d Type,
    pub configuration: &'d Pattern,
    pub space: &'d Type,
    /// The number of sites of a power.
    pub sites: Option<Length>,
    /// The input, as the closure that introduces it calls it.
    pub input: Option<&'d Pattern>,
    /// The velocity, as the Lagrangian calls it, or else a force.
    pub velocity: Option<&'d Pattern>,
    /// The references of motions, prices and bounds, with their types.
    pub references: Introduced<'d>,
    pub diagnostics: &'d Diagnostics,
}

/// The patterns and types of the two arguments of the action.
pub(super) fn of_action<'d>(
    declaration: &'d Declaration,
    by_number: ByNumber,
    diagnostics: &'d Diagnostics,
) -> Option<TypedArguments<'d>> {
    let action = &declaration.action;
    let [element, configuration] = action.arguments.as_slice() else {
        let count = action.arguments.len();
        let plural = if count == 1 { "" } else { "s" };
        refuse!(diagnostics, action.head, "the action has {count} argument{plural}, not two";
            help "write `|F: SO<3>, q: Unit<Vector3>| …`";
            note "the group element comes first, then the configuration that it moves");
    };
    let mut seen = Vec::new();
    for ident in element.pattern.names().into_iter().chain(configuration.pattern.names()) {
        check_reserved(ident, "an argument", diagnostics);
        let name = ident.unraw();
        if seen.contains(&name) {
            refuse!(diagnostics, ident, "`{name}` is the name of two arguments"; help "choose another name for one of them");
        }
        seen.push(name);
    }
    let typed = |argument: &'d Argument, example: &str, what: &str| {
        let name = argument.pattern.spell();
        if argument.ty.is_none() {
            report!(diagnostics, argument.pattern.place(), "`{name}` has no type in the action";
                help "write `{name}: {example}`"; note "its type declares {what}");
        }
        argument.ty.as_ref()
    };
    let group = typed(element, "SO<3>", "the group");
    let space = typed(configuration, "Unit<Vector3>", "the space of configurations");
    let (element, configuration) = (&element.pattern, &configuration.pattern);
    let input = declaration.input().map(|argument| &argument.pattern);
    let velocity = match &declaration.kinetic {
        Kinetic::Lagrangian(lagrangian) => lagrangian.arguments.last().map(|argument| &argument.pattern),
        _ => {
            let mut forces = declaration.force.iter().chain(&declaration.force_on);
            // references are behind the input, or have their types in the price or in the bounds
            let choice =
                declaration.choice().into_iter().flat_map(|choice| [Some(&choice.price), choice.bounds.as_ref()]);
            let typed =
                choice.flatten().flat_map(|closure| &closure.arguments).filter(|argument| argument.ty.is_some());
            let references: Vec<&Pattern> = typed.map(|argument| &argument.pattern).into_list();
            let is_other = |argument: &&Argument| !references.iter().any(|known| known.holds(&argument.pattern));
            let before = |force: &'d Closure| force.arguments.iter().take_while(|argument| argument.ty.is_none());
            forces.find_map(|force| before(force).filter(is_other).last()).map(|argument| &argument.pattern)
        }
    };
    let (group, space) = (group?, space?);
    let references = Introduced::default();
    let types =
        TypedArguments { element, group, configuration, space, sites: None, input, velocity, references, diagnostics };
    let types = TypedArguments { references: Introduced::new(declaration, &types), ..types };
    diagnostics.take(types.of_site(&declaration.generics, by_number))
}

impl<'d> TypedArguments<'d> {
    /// The types inside `[…; N]` of both arguments, if these have a const generic N for their length, or a number that is read
    /// so.
    ///
    /// # Errors
    /// Where only one of them has, or another one.
    fn of_site(self, generics: &Generics, by_number: ByNumber) -> Result<TypedArguments<'d>, Diagnostic> {
        let sites = |ty: &'d Type| {
            let is_read = |length: &Length| by_number == ByNumber::Sites || matches!(length, Length::Generic(_));
            sites_of(ty, generics).filter(|(length, _)| is_read(length))
        };
        match (sites(self.group), sites(self.space)) {
            (None, None) => Ok(self),
            (Some((length, group)), Some((other, space))) if length == other => {
                Ok(TypedArguments { group, space, sites: Some(length), ..self })
            }
            (Some((length, inner)), _) => Err(unequal(self.space, inner, &length)),
            (None, Some((length, inner))) => Err(unequal(self.group, inner, &length)),
        }
    }
}

/// Refuses a space before the group that moves it.
pub(super) fn check_order(types: &TypedArguments, names: GroupNames) -> Result<(), Diagnostic> {
    let is_group = group(first_leaf(types.space), names).is_some();
    let (element, space) = (types.element.spell(), spell_type(types.group));
    // unit quaternions are elements of a group with another name
    let are_unit_quaternions = last_name(first_leaf(types.group)) == "Unit" && space.contains("Quaternion");
    if !is_group || are_unit_quaternions || !is_column(first_leaf(types.group), names.generics) {
        return Ok(());
    }
    let (configuration, of_group) = (types.configuration.spell(), spell_type(types.space));
    bail!(types.group, "`{space}` is a space, but the first argument of the action is a group element";
        help "write the group first: `|{configuration}: {of_group}, {element}: {space}|`")
}

/// Whether a type is a space of columns. A matrix may be meant for a group of matrices.
fn is_column(ty: &Type, generics: &Generics) -> bool {
    let column = vectors(ty, generics).and_then(Result::ok).is_some_and(|(shape, _)| shape.is_column());
    column || ["Unit", "Quaternion"].contains(&last_name(ty).as_str())
}

/// The first type inside tuples and arrays.
fn first_leaf(ty: &Type) -> &Type {
    match plain(ty) {
        Type::Tuple(tuple) => tuple.elems.first().map_or(ty, first_leaf),
        Type::Array(array) => first_leaf(&array.elem),
        leaf => leaf,
    }
}

fn unequal(ty: &Type, inner: &Type, length: &Length) -> Diagnostic {
    error!(ty, "`{}` is no power with {length} sites", spell_type(ty);
        help "write `[…; {length}]` for both, the group and the space that it moves";
        note "the other argument has {length} times `{}`, and each site is moved by its own element", spell_type(inner))
}

/// N and `T` of `[T; N]`, with a const generic N or a number.
pub(super) fn sites_of<'t>(ty: &'t Type, generics: &Generics) -> Option<(Length, &'t Type)> {
    let Type::Array(array) = plain(ty) else { return None };
    let length = match number(&array.len) {
        Some(number) => Length::Number(number.base10_parse().ok()?),
        None => Length::Generic(const_generic(&spell(&array.len), generics)?.clone()),
    };
    Some((length, &*array.elem))
}
