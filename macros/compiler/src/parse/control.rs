//! What is steered: `controls`, `dynamics` or `effort`, with `bounds` and `endpoint`.

use proc_macro2::{Ident, Span};
use quote::format_ident;
use syn::ext::IdentExt;
use syn::{Type, parse_quote, parse_quote_spanned};

use super::keys::Keys;
use super::{Argument, Closure, Kinetic, Pattern};
use crate::diagnostic::{Diagnostic, Diagnostics, Location};

/// What a choice of inputs costs, and what it is bound by.
#[derive(Clone)]
pub struct Choice {
    /// The price of a step: the `cost` of a system with `controls` or `dynamics`, the `effort` of one with forces.
    pub price: Closure,
    /// `[a <= b, …]`.
    pub bounds: Option<Closure>,
}

/// What has been read of a declaration's motion.
pub(super) struct Motion {
    pub action: Option<Closure>,
    pub kinetic: Option<Kinetic>,
    pub control: Option<Choice>,
}

/// Takes the keys that say what is steered, and with them action and cost where inputs, not momenta, move the configuration.
pub(super) fn read(keys: &mut Keys, diagnostics: &mut Diagnostics) -> Option<Motion> {
    let bounds = keys.bounds.take();
    let Some(motion) = keys.controls.take().or_else(|| keys.dynamics.take()) else {
        let control = control_of_forces(keys, bounds, diagnostics);
        return control.map(|control| Motion { action: keys.action.take(), kinetic: None, control: Some(control) });
    };
    let price = keys.cost.take();
    if price.is_none() && !keys.was_given("cost") {
        diagnostics.push(missing_price(&motion));
    }
    let (action, kinetic) = match motion.key == "controls" {
        true => (keys.action.take(), Some(Kinetic::Controls(motion))),
        false => moved(keys, motion, diagnostics)
            .map_or((None, None), |(action, dynamics)| (Some(action), Some(Kinetic::Dynamics(dynamics)))),
    };
    let control = price.map(|price| Choice { price, bounds });
    Some(Motion { action, kinetic, control })
}

fn control_of_forces(keys: &mut Keys, bounds: Option<Closure>, diagnostics: &mut Diagnostics) -> Option<Choice> {
    let Some(price) = keys.effort.take() else {
        if let Some(closure) = bounds.filter(|_| !keys.was_given("effort")) {
            let error = Diagnostic::new(closure.key.span(), format!("`{}` without anything to choose", closure.key));
            diagnostics.push(error.help(
                "add `effort = |u| u.norm_squared() / 2` to a force with an input, or `controls`, or `dynamics`",
            ));
        }
        return None;
    };
    if !keys.was_given("force") && !keys.was_given("force_on") {
        let error = Diagnostic::new(price.key.span(), "there is an effort, but no force that takes an input");
        diagnostics.push(
            error
                .help("write `force = |omega, torque: Vector3| torque`")
                .note("the effort is the price of the inputs of the force"),
        );
    }
    Some(Choice { price, bounds })
}

/// The end has a price where something is chosen that leads there.
pub(super) fn check_endpoint(keys: &Keys, control: Option<&Choice>, diagnostics: &mut Diagnostics) {
    let chosen = control.is_some() || keys.dials.emit.boundary || keys.was_given("effort");
    if let Some(endpoint) = keys.endpoint.as_ref().filter(|_| !chosen) {
        let error = Diagnostic::new(endpoint.key.span(), "`endpoint` without anything to choose");
        diagnostics.push(error.help(
            "add `emit = [boundary]` for paths of least action to a free end, or `effort`, `controls` or `dynamics` for inputs",
        ));
    }
}

fn missing_price(motion: &Closure) -> Diagnostic {
    let input = motion.arguments.last().map_or("u".into(), |argument| argument.pattern.spell());
    Diagnostic::new(motion.key.span(), format!("there are `{}`, but no cost to choose them by", motion.key))
        .help(format!("write `cost = |h, {input}| h * {input}.norm_squared() / 2`"))
}

/// The translations that `dynamics` are made of: the action x ↦ x + a, and the closure without the type of x.
fn moved(keys: &mut Keys, mut dynamics: Closure, diagnostics: &mut Diagnostics) -> Option<(Closure, Closure)> {
    // an action beside it has been refused
    keys.action.take().is_none().then_some(())?;
    let example = "|h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x]";
    let typed: Vec<usize> = (0..dynamics.arguments.len()).filter(|&i| dynamics.arguments[i].ty.is_some()).collect();
    let &[state, _] = typed.as_slice() else {
        let error = Diagnostic::new(
            dynamics.head,
            "the dynamics have to introduce a configuration and an input, each with its type",
        );
        diagnostics.push(error.help(format!("write `dynamics = {example}`")));
        return None;
    };
    let ty = dynamics.arguments[state].ty.take()?;
    let pattern = dynamics.arguments[state].pattern.clone();
    let (Some(mut size), Pattern::Name(name)) = (length(&ty), &pattern) else {
        let error = Diagnostic::new(Location::of(&ty), "dynamics move one vector");
        diagnostics
            .push(error.help(format!("write `dynamics = {example}`, with all of the configuration in one vector")));
        return None;
    };
    // what is wrong with the size is so where it was written
    size.set_span(Location::of(&ty).start());
    let span = name.span();
    let shift = shift_beside(&dynamics, span);
    let group: Type = parse_quote_spanned!(span=> Translation<#size>);
    let arguments = vec![
        Argument { pattern: Pattern::Name(shift.clone()), ty: Some(group) },
        Argument { pattern: pattern.clone(), ty: Some(ty) },
    ];
    let action = Closure {
        key: Ident::new("action", dynamics.key.span()),
        arguments,
        head: dynamics.head,
        body: parse_quote!(#name + #shift),
    };
    Some((action, dynamics))
}

/// A name for the translation that the closure does not use.
fn shift_beside(dynamics: &Closure, span: Span) -> Ident {
    let names: Vec<String> = dynamics
        .arguments
        .iter()
        .flat_map(|argument| argument.pattern.names())
        .map(|name| name.unraw().to_string())
        .collect();
    let mut shift = String::from("shift");
    while names.contains(&shift) {
        shift.push('_');
    }
    Ident::new(&format_ident!("{shift}").to_string(), span)
}

/// n of `VectorN`, `SVector<n>` and `SVector<f64, n>`.
fn length(ty: &Type) -> Option<proc_macro2::Literal> {
    let Type::Path(path) = ty else { return None };
    let segment = path.path.segments.last()?;
    let name = segment.ident.to_string();
    if let Some(digits) = name.strip_prefix("Vector") {
        return digits.parse().ok().map(proc_macro2::Literal::usize_unsuffixed);
    }
    let syn::PathArguments::AngleBracketed(arguments) = &segment.arguments else { return None };
    let size = arguments.args.iter().find_map(|argument| match argument {
        syn::GenericArgument::Const(syn::Expr::Lit(literal)) => match &literal.lit {
            syn::Lit::Int(size) => size.base10_parse().ok(),
            _ => None,
        },
        _ => None,
    });
    size.filter(|_| name == "SVector").map(proc_macro2::Literal::usize_unsuffixed)
}
