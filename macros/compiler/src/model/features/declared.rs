//! The features that a declaration names.

use super::{Feature, Found};
use crate::model::Order;
use crate::parse::{CodeForm, Declaration, Potential};

/// Where a declaration names a feature: a key, a value of one, or a word of `emit`. `None` too for features that later stages find.
pub(crate) fn declared(declaration: &Declaration, feature: Feature) -> Option<Found> {
    let dials = &declaration.dials;
    let emitted = |asked: bool| asked.then(|| Found::at(declaration.ident.span()));
    let order = |fits: fn(Order) -> bool| {
        let order = dials.order.as_ref().filter(|order| fits(order.value))?;
        Some(Found::at(order.span).named(order.value.number()))
    };
    match feature {
        Feature::OpaquePotential => {
            let opaque = declaration.potential.as_ref().and_then(Potential::opaque);
            opaque.map(|opaque| Found::at(opaque.place))
        }
        Feature::FirstOrder => order(|order| order == Order::First),
        Feature::Sixteenth => order(|order| order == Order::Sixteenth),
        Feature::Method => declaration.methods.first().map(|method| Found::at(method.name.span())),
        Feature::Tangent => emitted(dials.emit.tangent),
        Feature::Boundary => emitted(dials.emit.boundary),
        Feature::Momentum => emitted(dials.emit.momentum),
        Feature::Connection => emitted(dials.emit.connection),
        Feature::Midpoint => emitted(dials.emit.midpoint),
        Feature::Matrices => {
            let code = dials.code.as_ref().filter(|code| code.value == CodeForm::Matrices);
            code.map(|code| Found::at(code.span))
        }
        key => {
            let closure = declaration.closures().find(|closure| key.is_key(&closure.key.to_string()));
            let dial = || dials.given().find(|(name, _)| key.is_key(name)).map(|(_, value)| value.span);
            closure.map(|closure| closure.key.span()).or_else(dial).map(Found::at)
        }
    }
}
