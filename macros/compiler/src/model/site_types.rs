//! The types of the action of a power: those of one site.

use proc_macro2::Ident;
use syn::{Generics, Type};

use super::arguments::TypedArguments;
use super::sizes::const_generic;
use crate::diagnostic::{Diagnostic, error};

/// The arguments of the action of a site with the const generic N, where the action is one of a power: what stands inside `[…; N]` of both
/// types. The arguments themselves where neither type has a const generic for its length.
///
/// # Errors
/// Where only one of them has, or another one.
pub(super) fn of_site<'d>(
    types: TypedArguments<'d>,
    generics: &'d Generics,
) -> Result<(TypedArguments<'d>, Option<&'d Ident>), Diagnostic> {
    match (array(types.group, generics), array(types.space, generics)) {
        (None, None) => Ok((types, None)),
        (Some((length, group)), Some((other, space))) if length == other => {
            Ok((TypedArguments { group, space, ..types }, Some(length)))
        }
        (Some((length, inner)), _) => Err(unequal(types.space, inner, length)),
        (None, Some((length, inner))) => Err(unequal(types.group, inner, length)),
    }
}

fn unequal(ty: &Type, inner: &Type, length: &Ident) -> Diagnostic {
    let (text, inner) = (crate::parse::spell_type(ty), crate::parse::spell_type(inner));
    error!(ty, "`{text}` is no power with {length} sites";
        help "write `[…; {length}]` for both, the group and the space that it moves";
        note "the other argument has {length} times `{inner}`, and each site is moved by its own element")
}

/// N and `T` of `[T; N]` with a const generic N.
pub(super) fn array<'t, 'd>(ty: &'t Type, generics: &'d Generics) -> Option<(&'d Ident, &'t Type)> {
    match ty {
        Type::Group(group) => array(&group.elem, generics),
        Type::Paren(paren) => array(&paren.elem, generics),
        Type::Array(array) => Some((const_generic(&crate::parse::spell(&array.len), generics)?, &*array.elem)),
        _ => None,
    }
}
