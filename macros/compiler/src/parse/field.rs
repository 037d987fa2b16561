//! Fields of the struct, and the promises on them.

use proc_macro2::{Ident, Span};
use syn::ext::IdentExt;
use syn::punctuated::Punctuated;
use syn::{Index, Member, Token, Type};

use super::dials::Promise;
use crate::diagnostic::{Diagnostic, Diagnostics, Location, nearest};

/// A field of the user's struct.
#[derive(Clone)]
pub struct Field {
    /// Its name or number.
    pub member: Member,
    /// Its type as written.
    pub ty: Type,
    /// What is promised about its values, and where.
    pub promise: Option<(Promise, Span)>,
}

impl Field {
    /// The name without `r#`; `0` for the first field of a tuple struct.
    pub fn name(&self) -> String {
        match &self.member {
            Member::Named(ident) => ident.unraw().to_string(),
            Member::Unnamed(index) => index.index.to_string(),
        }
    }
}

/// The promises by name.
const PROMISES: [(&str, Promise); 3] =
    [("symmetric", Promise::Symmetric), ("diagonal", Promise::Diagonal), ("unit", Promise::Unit)];

/// Reads a field and its `#[clebsch(…)]`.
pub(super) fn read(position: usize, field: &syn::Field, diagnostics: &mut Diagnostics) -> Field {
    let member = match &field.ident {
        Some(ident) => Member::Named(ident.clone()),
        None => Member::Unnamed(Index { index: position as u32, span: Location::of(&field.ty).start() }),
    };
    let mut promise: Option<(Promise, Span)> = None;
    for attribute in field.attrs.iter().filter(|attribute| attribute.path().is_ident("clebsch")) {
        let names = attribute.parse_args_with(Punctuated::<Ident, Token![,]>::parse_terminated);
        let Ok(names) = names else {
            let error = Diagnostic::new(Location::of(attribute), "a promise on a field is a single word");
            diagnostics.push(error.help("write `#[clebsch(symmetric)]`"));
            continue;
        };
        for name in names {
            match (find(&name), promise) {
                (None, _) => diagnostics.push(unknown(&name)),
                (Some(_), Some(_)) => {
                    let error = Diagnostic::new(name.span(), format!("`{name}` is a second promise on this field"));
                    diagnostics.push(error.help("keep the stronger of the two"));
                }
                (found, None) => promise = found.map(|kind| (kind, name.span())),
            }
        }
    }
    Field { member, ty: field.ty.clone(), promise }
}

fn find(name: &Ident) -> Option<Promise> {
    PROMISES.iter().find(|(word, _)| name == word).map(|&(_, promise)| promise)
}

fn unknown(name: &Ident) -> Diagnostic {
    let word = name.to_string();
    let similar = nearest(&word, PROMISES.iter().map(|&(word, _)| word));
    Diagnostic::new(name.span(), format!("unknown promise `{word}` on a field"))
        .maybe_help(similar.map(|similar| format!("write `#[clebsch({similar})]`")))
        .note("the promises are `symmetric`, `diagonal` and `unit`; the keys of a system stand on the struct")
}
