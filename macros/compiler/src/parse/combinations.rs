//! Keys that do not go together.

use proc_macro2::Span;

use super::Order;
use super::keys::{KEYS, Keys};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};

/// Reports all combinations of keys that the table of features refuses.
pub(super) fn check(keys: &Keys, diagnostics: &mut Diagnostics) {
    let found = |feature| place(keys, feature).map(|place| named(keys, Found::at(place)));
    features::refusals(found).into_iter().for_each(|error| diagnostics.push(error));
}

/// Messages about an order name it.
fn named(keys: &Keys, found: Found) -> Found {
    match &keys.dials.order {
        Some(order) => found.named(order.value.number()),
        None => found,
    }
}

/// Where a key was given, or a value of one.
fn place(keys: &Keys, feature: Feature) -> Option<Span> {
    let dials = &keys.dials;
    let emitted = |asked: bool| keys.place_of("emit").filter(|_| asked);
    let order =
        |fits: fn(Order) -> bool| dials.order.as_ref().filter(|order| fits(order.value)).map(|order| order.span);
    match feature {
        Feature::Controls => keys.controls.as_ref().map(|closure| closure.key.span()),
        Feature::Dynamics => keys.dynamics.as_ref().map(|closure| closure.key.span()),
        // where inputs move the configuration it is their price
        Feature::Cost if keys.controls.is_some() || keys.dynamics.is_some() => None,
        Feature::Cost => keys.cost.as_ref().map(|closure| closure.key.span()),
        Feature::Composition => order(|order| order.stages().is_some()),
        Feature::Sixteenth => order(|order| order == Order::Sixteenth),
        Feature::Tangent => emitted(dials.emit.tangent),
        Feature::Boundary => emitted(dials.emit.boundary),
        Feature::Momentum => emitted(dials.emit.momentum),
        Feature::Discretization => dials.discretization.as_ref().map(|discretization| discretization.span),
        _ => keys.place_of(key(feature)?),
    }
}

/// The key that a feature is, if it is one.
fn key(feature: Feature) -> Option<&'static str> {
    let word = feature.words().strip_prefix('`')?.strip_suffix('`')?;
    KEYS.iter().map(|key| key.name).find(|name| *name == word)
}
