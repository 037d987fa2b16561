//! The scalar of a system: all fields that are read, and all spaces that name one, have to agree.

use syn::{Generics, Ident, Type};

use super::ScalarType;
use super::shapes::last_name;
use crate::diagnostic::{Diagnostics, refuse, report};
use crate::parse::{Declaration, spell_type};

/// The name of the dial in messages.
const DIAL: &str = "`scalar`";

/// The scalar that all types agree on.
pub(super) struct Agreement<'d> {
    generics: &'d Generics,
    /// The scalar on which all agree, and the item that named it first.
    pub found: Option<(ScalarType, String)>,
    diagnostics: &'d Diagnostics,
}

impl<'d> Agreement<'d> {
    /// Begins with the dial `scalar`.
    pub fn new(declaration: &'d Declaration, diagnostics: &'d Diagnostics) -> Agreement<'d> {
        let generics = &declaration.generics;
        let named = |ident: &Ident| match named_scalar(&ident.to_string(), generics) {
            Some(scalar) => Some((scalar, DIAL.to_string())),
            None => refuse!(diagnostics, ident, "`{ident}` is no scalar";
                help "write `f64`, `f32` or a type parameter of the struct"),
        };
        Agreement { generics, found: declaration.dials.scalar.as_ref().and_then(named), diagnostics }
    }

    /// Compares one more scalar with those before.
    pub fn meet(&mut self, ty: &Type, whose: &str) {
        let text = spell_type(ty);
        if last_name(ty) == "Complex" {
            report!(self.diagnostics, ty, "the scalar of {whose} is `{text}`, and all scalars are real";
                help "write real numbers, twice as many: the real parts before the imaginary parts";
                note "`U<N>` moves vectors of 2N real components, and `SU<2>` moves a `Quaternion`");
            return;
        }
        let Some(scalar) = named_scalar(&last_name(ty), self.generics) else {
            report!(self.diagnostics, ty, "the scalar `{text}` of {whose} is neither `f64`, `f32` nor a type parameter";
                help "write `f64`"; note "a macro cannot see what an alias stands for");
            return;
        };
        match &self.found {
            None => self.found = Some((scalar, whose.to_string())),
            Some((other, first)) if *other != scalar => {
                let other = spell_scalar(other);
                let dial = if first == DIAL { ", or leave out `scalar`" } else { "" };
                report!(self.diagnostics, ty, "the scalar of {whose} is `{text}`, that of {first} is `{other}`";
                    help "write `{other}`{dial}"; note "a system has one scalar type");
            }
            Some(_) => {}
        }
    }
}

fn named_scalar(name: &str, generics: &Generics) -> Option<ScalarType> {
    match name {
        "f64" => Some(ScalarType::F64),
        "f32" => Some(ScalarType::F32),
        _ => generics
            .type_params()
            .find(|parameter| parameter.ident == name)
            .map(|parameter| ScalarType::Parameter(parameter.ident.clone())),
    }
}

pub(super) fn spell_scalar(scalar: &ScalarType) -> String {
    match scalar {
        ScalarType::F32 => "f32".into(),
        ScalarType::F64 => "f64".into(),
        ScalarType::Parameter(ident) => ident.to_string(),
    }
}
