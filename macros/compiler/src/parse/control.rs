//! The keys of control: `controls`, `dynamics` or `effort`, with `bounds`, `endpoint` and `target`.

use clebsch_symbolic::IntoList;
use proc_macro2::{Ident, Literal};
use syn::ext::IdentExt;
use syn::{Expr, ExprLit, GenericArgument, Lit, PathArguments, Type, parse_quote, parse_quote_spanned};

use super::keys::Keys;
use super::{Argument, Closure, Kinetic, Pattern};
use crate::diagnostic::{Location, refuse, report};

/// The price of a choice of inputs, and its bounds.
#[derive(Clone)]
pub struct Choice {
    /// The price of a step: the `cost` of a system with `controls` or `dynamics`, the `effort` of one with forces.
    pub price: Closure,
    /// `[a <= b, …]`.
    pub bounds: Option<Closure>,
}

/// The key that moves the configuration, and the choice of its inputs. The keys of both are taken out of `keys`. Where
/// inputs, not momenta, move the configuration, its cost is the price.
pub(super) fn read(keys: &mut Keys) -> (Option<Kinetic>, Option<Choice>) {
    let bounds = keys.closures.remove("bounds");
    let Some(motion) = keys.closures.remove("controls").or_else(|| keys.closures.remove("dynamics")) else {
        let control = control_of_forces(keys, bounds);
        let lagrangian = keys.closures.remove("lagrangian").map(Kinetic::Lagrangian);
        return (keys.closures.remove("cost").map(Kinetic::Cost).or(lagrangian), control);
    };
    let price = keys.closures.remove("cost");
    if price.is_none() && !keys.was_given("cost") {
        // the dynamics introduce their configuration too
        let mut typed = motion.arguments.iter().filter(|argument| argument.ty.is_some());
        let input = typed.nth(usize::from(motion.key == "dynamics")).or(motion.arguments.last());
        let input = input.map_or("u".into(), |argument| argument.pattern.spell());
        report!(keys.diagnostics, &motion.key, "there are `{}`, but no cost to choose them by", motion.key;
            help "write `cost = |h, {input}| h * {input}.norm_squared() / 2`");
    }
    let kinetic = if motion.key == "controls" { Some(Kinetic::Controls(motion)) } else { moved(keys, motion) };
    (kinetic, price.map(|price| Choice { price, bounds }))
}

fn control_of_forces(keys: &mut Keys, bounds: Option<Closure>) -> Option<Choice> {
    let Some(price) = keys.closures.remove("effort") else {
        let bounds = bounds.filter(|_| !keys.was_given("effort"))?;
        refuse!(keys.diagnostics, &bounds.key, "`{}` without anything to choose", bounds.key;
            help "add `effort = |u| u.norm_squared() / 2` to a force with an input, or `controls`, or `dynamics`");
    };
    if !keys.was_given("force") && !keys.was_given("force_on") {
        report!(keys.diagnostics, &price.key, "there is an effort, but no force that takes an input";
            help "write `force = |omega, torque: Vector3| torque`";
            note "the effort is the price of the inputs of the force");
    }
    Some(Choice { price, bounds })
}

/// The end has a price, or conditions, where something is chosen that leads there.
pub(super) fn check_end(keys: &Keys, control: Option<&Choice>) {
    let chosen = control.is_some() || keys.dials.emit.boundary || keys.was_given("effort");
    if let Some(target) = keys.closures.get("target").filter(|_| !chosen) {
        report!(keys.diagnostics, &target.key, "`target` without anything to choose";
            help "add `effort`, `controls` or `dynamics` for inputs that lead there");
    }
    if let Some(endpoint) = keys.closures.get("endpoint").filter(|_| !chosen) {
        report!(keys.diagnostics, &endpoint.key, "`endpoint` without anything to choose";
            help "add `emit = [boundary]` for paths of least action to a free end, or `effort`, `controls` or `dynamics` for inputs");
    }
}

/// The translations that `dynamics` are made of: the action is x ↦ x + a, and the closure loses the type of x.
fn moved(keys: &mut Keys, mut dynamics: Closure) -> Option<Kinetic> {
    if keys.closures.remove("action").is_some() {
        // it has been refused with them
        return None;
    }
    let example = match keys.integration {
        Some(method) => format!("{method}(|x: Vector2, u: Vector1| vector![x.y, u.x])"),
        None => "|h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x]".to_string(),
    };
    let typed: Vec<usize> = (0..dynamics.arguments.len()).filter(|&i| dynamics.arguments[i].ty.is_some()).into_list();
    let &[state, _, ..] = typed.as_slice() else {
        refuse!(keys.diagnostics, dynamics.head, "the dynamics have to introduce a configuration and an input, each with its type";
            help "write `dynamics = {example}`");
    };
    let ty = dynamics.arguments[state].ty.take()?;
    dynamics.arguments[state].written = Some(ty.clone());
    let pattern = dynamics.arguments[state].pattern.clone();
    let (Some(mut size), Pattern::Name(name)) = (length(&ty), &pattern) else {
        refuse!(keys.diagnostics, &ty, "dynamics move one vector";
            help "write `dynamics = {example}`, with all of the configuration in one vector");
    };
    // an error of the size is shown where the size was written
    size.set_span(Location::from(&ty).start);
    let span = name.span();
    // a name for the translation that the closure does not use
    let names: Vec<&Ident> = dynamics.arguments.iter().flat_map(|argument| argument.pattern.names()).into_list();
    let mut shift = String::from("shift");
    while names.iter().any(|name| name.unraw() == shift) {
        shift.push('_');
    }
    let shift = Ident::new(&shift, span);
    let group: Type = parse_quote_spanned!(span=> Translation<#size>);
    let arguments = vec![
        Argument { pattern: Pattern::Name(shift.clone()), ty: Some(group), written: None },
        Argument { pattern: pattern.clone(), ty: Some(ty), written: None },
    ];
    let key = Ident::new("action", dynamics.key.span());
    let action = Closure { key, arguments, head: dynamics.head, body: parse_quote!(#name + #shift) };
    keys.closures.insert("action", action);
    Some(Kinetic::Dynamics(dynamics, keys.integration))
}

/// n of `VectorN`, `SVector<n>` and `SVector<f64, n>`.
fn length(ty: &Type) -> Option<Literal> {
    let Type::Path(path) = ty else { return None };
    let segment = path.path.segments.last()?;
    let name = segment.ident.to_string();
    if let Some(digits) = name.strip_prefix("Vector") {
        return digits.parse().ok().map(Literal::usize_unsuffixed);
    }
    let PathArguments::AngleBracketed(arguments) = &segment.arguments else { return None };
    let size = arguments.args.iter().find_map(|argument| match argument {
        GenericArgument::Const(Expr::Lit(ExprLit { lit: Lit::Int(size), .. })) => size.base10_parse().ok(),
        _ => None,
    });
    size.filter(|_| name == "SVector").map(Literal::usize_unsuffixed)
}
