//! Powers: a group Gᴺ that acts site by site on Qᴺ, with a const generic N.
//!
//! The site is a system of its own, which the other stages derive as they derive any other. What ties sites to each other is the potential: a sum of
//! terms, each the same formula at every index that its sums run through. A formula names the sites that it reads by *places*, `q[i]`,
//! `q[(i + 1) % N]`, and is differentiated once.

pub(super) mod bounds;
#[cfg(test)]
mod tests;

use clebsch_symbolic::Expr;
use proc_macro2::Ident;
use syn::{Generics, Type};

use super::arguments::TypedArguments;
use super::sizes::const_generic;
use super::{Item, Parameter};
use crate::diagnostic::{Diagnostic, error};
pub use bounds::Linear;

/// What makes a power of the model of a site.
#[derive(Clone)]
pub struct Power<'g> {
    /// The user's struct; that of the model is the site.
    pub item: Item,
    /// The const generic N.
    pub length: Ident,
    /// The symbol N.
    pub sites: Expr<'g>,
    /// The sites that terms read.
    pub places: Vec<SiteIndex<'g>>,
    /// The potential, a sum of terms.
    pub terms: Vec<Term<'g>>,
    /// The fields that terms read; those of the model are what the site reads.
    pub parameters: Vec<Parameter<'g>>,
    /// The user's fields that the site has copies of, in the order of the model's parameters.
    pub copied: Vec<syn::Member>,
    /// Whether all sites have the same kinetic energy.
    pub is_uniform: bool,
}

/// One site that terms read.
#[derive(Clone, PartialEq, Eq)]
pub struct SiteIndex<'g> {
    /// Its index, a linear expression in the indices of sums and in N.
    pub index: Expr<'g>,
    /// Whether the index is taken modulo N.
    pub wraps: bool,
}

/// A term of a sum over sites, and the sums around it.
#[derive(Clone, Debug)]
pub struct Term<'g> {
    /// What the index of each sum runs through, the outermost first: from the first expression up to and without the second.
    pub ranges: Vec<(Expr<'g>, Expr<'g>)>,
    /// The formula.
    pub value: Expr<'g>,
}

impl Term<'_> {
    /// What its indices run through, `i in 0..N, j in i + 1..N`; nothing where there is no sum.
    pub fn indices(&self) -> String {
        let of_depth =
            |(depth, (from, to)): (usize, &(Expr<'_>, Expr<'_>))| format!("{} in {from}..{to}", index_name(depth));
        self.ranges.iter().enumerate().map(of_depth).collect::<Vec<_>>().join(", ")
    }
}

/// What the index of a sum inside `depth` others is called.
pub(super) fn index_name(depth: usize) -> String {
    match depth {
        0..=3 => ["i", "j", "k", "l"][depth].to_string(),
        _ => format!("i{depth}"),
    }
}

impl<'g> SiteIndex<'g> {
    /// As a closure writes it, `(i + 1) % N`.
    pub fn text(&self) -> String {
        if !self.wraps {
            return self.index.to_string();
        }
        match self.index.as_symbol() {
            Some(_) => format!("{} % N", self.index),
            None => format!("({}) % N", self.index),
        }
    }
}

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
