//! Keys that do not go together.

use proc_macro2::Span;

use super::keys::{KEYS, Keys};
use super::{Closure, Order, Signature};
use crate::model::features::{self, Feature, Found};

/// Reports all combinations of keys that the table of features refuses.
pub(super) fn check(keys: &Keys) {
    let refuse = |of_steps: &Keys, of_system: fn(Feature) -> bool| {
        // messages about an order name it
        let order = of_steps.dials.order.as_ref().map(|order| order.value.to_string()).unwrap_or_default();
        let place = |feature| if of_system(feature) { None } else { place(keys, of_steps, feature) };
        keys.diagnostics.extend(features::refusals(|feature| Some(Found::at(place(feature)?).named(&order))));
        keys.diagnostics.is_empty()
    };
    // a mistake of the system is reported once
    if refuse(keys, |_| false) {
        for (_, of_method) in &keys.methods {
            refuse(of_method, is_declared_alone);
        }
    }
}

/// Whether a feature is of the steps with the declared dials alone.
fn is_declared_alone(feature: Feature) -> bool {
    matches!(
        feature,
        Feature::Effort
            | Feature::Bounds
            | Feature::Endpoint
            | Feature::Target
            | Feature::Tangent
            | Feature::Boundary
            | Feature::Inputs
    )
}

/// Where a key was given, or a value of one. Keys of a method are in `of_steps`.
fn place(keys: &Keys, of_steps: &Keys, feature: Feature) -> Option<Span> {
    let (dials, emit) = (&of_steps.dials, &keys.dials.emit);
    let readable = |name| keys.closures.get(name).map(|closure: &Closure| closure.key.span());
    let emitted = |asked: bool| keys.place_of("emit").filter(|_| asked);
    let order =
        |fits: fn(Order) -> bool| dials.order.as_ref().filter(|order| fits(order.value)).map(|order| order.span);
    match feature {
        Feature::Controls => readable("controls"),
        Feature::Dynamics => readable("dynamics"),
        // where inputs move the configuration it is their price
        Feature::Cost if readable("controls").or_else(|| readable("dynamics")).is_some() => None,
        Feature::Cost => readable("cost"),
        Feature::IndefiniteSignature => {
            let signature = keys.dials.signature.as_ref()?;
            (signature.value == Signature::Indefinite).then_some(signature.span)
        }
        Feature::FirstOrder => order(|order| order == Order::First),
        Feature::Composition => order(|order| order.stages().is_some()),
        Feature::Sixteenth => order(|order| order == Order::Sixteenth),
        Feature::Tangent => emitted(emit.tangent),
        Feature::Boundary => emitted(emit.boundary),
        Feature::Momentum => emitted(emit.momentum),
        Feature::Connection => emitted(emit.connection),
        Feature::Midpoint => emitted(emit.midpoint),
        // it discretises the velocity of a constraint too
        Feature::Discretization if keys.lists.contains_key("constraint") => None,
        Feature::Discretization => dials.discretization.as_ref().map(|discretization| discretization.span),
        Feature::Method => keys.place_of("method"),
        _ => {
            let key = KEYS.iter().find(|key| feature.is_key(key.name))?;
            if key.of_method { of_steps.place_of(key.name) } else { keys.place_of(key.name) }
        }
    }
}
