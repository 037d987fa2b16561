//! The scalar of a system: all fields that are read, and all spaces that name one, have to agree.

use syn::{Generics, Type};

use super::ScalarType;
use super::vectors::last_segment;
use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::parse::{Declaration, spell_type};

/// The scalar that all types agree on.
pub(super) struct Agreement<'d> {
    generics: &'d Generics,
    given: Option<ScalarType>,
    found: Option<(ScalarType, String)>,
}

impl<'d> Agreement<'d> {
    /// Begins with the dial `scalar`.
    pub fn new(declaration: &'d Declaration, diagnostics: &mut Diagnostics) -> Agreement<'d> {
        let generics = &declaration.generics;
        let given = declaration.dials.scalar.as_ref().and_then(|ident| {
            let scalar = named_scalar(&ident.to_string(), generics);
            if scalar.is_none() {
                let error = Diagnostic::new(ident.span(), format!("`{ident}` is no scalar"));
                diagnostics.push(error.help("write `f64`, `f32` or a type parameter of the struct"));
            }
            scalar
        });
        Agreement { generics, found: given.clone().map(|scalar| (scalar, "`scalar`".to_string())), given }
    }

    /// Compares one more scalar with those before.
    pub fn meet(&mut self, ty: &Type, whose: &str, diagnostics: &mut Diagnostics) {
        let text = spell_type(ty);
        let name = last_segment(ty).map(|segment| segment.ident.to_string()).unwrap_or_default();
        let Some(scalar) = named_scalar(&name, self.generics) else {
            diagnostics.push(
                Diagnostic::new(
                    Location::of(ty),
                    format!("the scalar `{text}` of {whose} is neither `f64`, `f32` nor a type parameter"),
                )
                .help("write `f64`")
                .note("a macro cannot see what an alias stands for"),
            );
            return;
        };
        match &self.found {
            None => self.found = Some((scalar, whose.to_string())),
            Some((other, first)) if *other != scalar => {
                let message =
                    format!("the scalar of {whose} is `{text}`, that of {first} is `{}`", spell_scalar(other));
                let error = Diagnostic::new(Location::of(ty), message);
                diagnostics
                    .push(error.help(format!("write `{}`", spell_scalar(other))).note("a system has one scalar type"));
            }
            Some(_) => {}
        }
    }

    /// What all agreed on; `f64` if nobody named a scalar.
    pub fn settle(self) -> ScalarType {
        self.found.map(|(scalar, _)| scalar).or(self.given).unwrap_or(ScalarType::F64)
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

/// The name of a scalar.
pub(super) fn spell_scalar(scalar: &ScalarType) -> String {
    match scalar {
        ScalarType::F32 => "f32".into(),
        ScalarType::F64 => "f64".into(),
        ScalarType::Parameter(ident) => ident.to_string(),
    }
}
