//! Fields of the struct, and the promises on them.

use proc_macro2::{Ident, Span};
use syn::ext::IdentExt;
use syn::punctuated::Punctuated;
use syn::{Index, Member, Token, Type};

use super::dials::{Promise, Word, meanings};
use super::spell_type;
use crate::diagnostic::{Diagnostic, Diagnostics, Location, error, nearest, report};

/// A field of the user's struct.
#[derive(Clone)]
pub struct Field {
    /// Its name or number.
    pub member: Member,
    pub(crate) ty: Type,
    /// The promise about its values, and its place.
    pub promise: Option<(Promise, Span)>,
}

impl Field {
    /// The name without `r#`; `0` for the first field of a tuple struct.
    pub fn name(&self) -> String {
        member_name(&self.member)
    }
}

/// The name of a field without `r#`, or its number.
pub(crate) fn member_name(member: &Member) -> String {
    match member {
        Member::Named(ident) => ident.unraw().to_string(),
        Member::Unnamed(index) => index.index.to_string(),
    }
}

/// Names of inertias contain one of these words.
const INERTIAS: [&str; 2] = ["inertia", "moment"];

/// The mass that messages show: `self.name` of the first field that is called one, `self.mass` where there is none. With a size, the inertia,
/// a square matrix of that size.
pub(crate) fn mass(fields: &[Field], size: Option<usize>) -> String {
    let usual = if size.is_some() { "self.inertia" } else { "self.mass" };
    declared_mass(fields, size).unwrap_or_else(|| usual.to_string())
}

/// The same; `None` where no field is called one.
pub(crate) fn declared_mass(fields: &[Field], size: Option<usize>) -> Option<String> {
    let fits = |ty: &Type| {
        let text = spell_type(ty);
        let name = text.rsplit("::").next().unwrap_or_default();
        match size {
            None => name.chars().all(char::is_alphanumeric),
            Some(n) => name.starts_with(&format!("Matrix{n}")) || text.ends_with(&format!(", {n}, {n}>")),
        }
    };
    let is_mass = |field: &&Field| {
        let name = field.name().to_lowercase();
        // the mass matrix of a cost, ½tr(J)I − J, is no inertia
        if name.contains("inv") {
            // an inverse mass
            return false;
        }
        let is_mass = size.is_none() && (name.contains("mass") || name == "m");
        let is_inertia = size.is_some() && name == "j";
        fits(&field.ty) && (is_mass || is_inertia || INERTIAS.iter().any(|word| name.contains(word)))
    };
    fields.iter().find(is_mass).map(|field| format!("self.{}", field.name()))
}

/// Whether a field is called a mass or an inertia, and not an inverse or a ratio of such.
pub(crate) fn is_mass(name: &str) -> bool {
    let name = name.to_lowercase();
    let is_other = ["inv", "ratio"].iter().any(|word| name.contains(word));
    !is_other && (name == "m" || ["mass", "inertia", "moments"].iter().any(|word| name.contains(word)))
}

/// Reads a field and its `#[clebsch(…)]`.
pub(super) fn read(position: usize, field: &syn::Field, diagnostics: &Diagnostics) -> Field {
    let member = match &field.ident {
        Some(ident) => Member::Named(ident.clone()),
        None => Member::Unnamed(Index { index: position as u32, span: Location::from(&field.ty).start }),
    };
    let mut promise: Option<(Promise, Span)> = None;
    for attribute in field.attrs.iter().filter(|attribute| attribute.path().is_ident("clebsch")) {
        let names = attribute.parse_args_with(Punctuated::<Ident, Token![,]>::parse_terminated);
        let Ok(names) = names else {
            report!(diagnostics, attribute, "a promise on a field is a single word"; help "write `#[clebsch(symmetric)]`");
            continue;
        };
        for name in names {
            match Promise::WORDS.iter().find(|(word, _)| name == word) {
                None => diagnostics.push(unknown(&name)),
                Some(_) if promise.is_some() => {
                    report!(diagnostics, &name, "`{name}` is a second promise on this field";
                    help "keep the stronger of the two")
                }
                Some((_, found)) => promise = Some((*found, name.span())),
            }
        }
    }
    Field { member, ty: field.ty.clone(), promise }
}

/// The promises on fields in Markdown.
pub(crate) fn promises_as_markdown() -> String {
    let head = "| attribute | promises |\n|---|---|\n";
    let rows = meanings::<Promise>().into_iter();
    let row = |(word, meaning)| format!("| `#[clebsch({word})]` | {} |\n", str::replace(meaning, "|", "\\|"));
    rows.map(row).fold(head.to_string(), |table, row| table + &row)
}

fn unknown(name: &Ident) -> Diagnostic {
    let similar = nearest(&name.to_string(), Promise::WORDS.iter().map(|&(word, _)| word));
    error!(name, "unknown promise `{name}` on a field")
        .maybe_help(similar.map(|similar| format!("write `#[clebsch({similar})]`")))
        .note("the promises are `symmetric`, `diagonal` and `unit`; the keys of a system stand on the struct")
}
