//! The grammar of `#[clebsch(…)]`: items `key = value`, separated by commas, in any number of attributes.

use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::ParseStream;
use syn::{Attribute, DeriveInput, Meta, Token};

use super::keys::{KEYS, Key, Keys};
use super::{groups, methods, values};
use crate::diagnostic::{Diagnostic, Diagnostics, Location, nearest};

/// Reads all attributes of the struct as one.
pub(super) fn read(input: &DeriveInput, diagnostics: &mut Diagnostics) -> Keys {
    let mut keys = Keys::default();
    for attribute in input.attrs.iter().filter(|attribute| attribute.path().is_ident("clebsch")) {
        read_attribute(attribute, &mut keys, diagnostics);
    }
    keys
}

fn read_attribute(attribute: &Attribute, keys: &mut Keys, diagnostics: &mut Diagnostics) {
    let Meta::List(list) = &attribute.meta else {
        let error = Diagnostic::new(Location::of(attribute), "the declaration stands in parentheses");
        diagnostics.push(error.help("write `#[clebsch(action = …, cost = …, potential = …)]`"));
        return;
    };
    let items = |stream: ParseStream| {
        while !stream.is_empty() {
            if let Err(error) = read_item(stream, keys, diagnostics) {
                diagnostics.push(error);
                skip_to_next_item(stream);
            }
        }
        Ok(())
    };
    // by construction: the parser consumes everything, and its own errors are among the diagnostics
    let _ = list.parse_args_with(items);
}

/// `key = value` and the comma after it; after an error the rest of the item is still to be skipped.
fn read_item(stream: ParseStream, keys: &mut Keys, diagnostics: &mut Diagnostics) -> Result<(), Diagnostic> {
    let key = stream.call(Ident::parse_any)?;
    if key == "group" {
        // there may be several
        let _ = keys.give(&key);
        groups::read(&key, stream, keys, diagnostics)?;
        return end_of_item(&key, stream);
    }
    if key == "method" {
        let _ = keys.give(&key);
        methods::read(&key, stream, keys, diagnostics)?;
        return end_of_item(&key, stream);
    }
    let found = find(&key).ok_or_else(|| unknown_key(&key))?;
    give(&key, keys)?;
    if found.comes_later() {
        return Err(Diagnostic::later(key.span(), format!("the key `{key}`")));
    }
    equals(&key, found, stream)?;
    values::read(&key, found, stream, keys, diagnostics)?;
    end_of_item(&key, stream)
}

/// Notes that a key is given, which it may be once.
pub(super) fn give(key: &Ident, keys: &mut Keys) -> Result<(), Diagnostic> {
    if keys.give(key) {
        return Ok(());
    }
    Err(Diagnostic::new(key.span(), format!("`{key}` is given twice")).help("remove one of the two"))
}

/// The `=` before the value of a key.
pub(super) fn equals(key: &Ident, found: &Key, stream: ParseStream) -> Result<(), Diagnostic> {
    if stream.parse::<Token![=]>().is_ok() {
        return Ok(());
    }
    let error = Diagnostic::new(key.span(), format!("the key `{key}` has no value"));
    Err(error.help(format!("write `{key} = {}`", found.example)))
}

/// A comma, or the end of the declaration.
pub(super) fn end_of_item(key: &Ident, stream: ParseStream) -> Result<(), Diagnostic> {
    if stream.is_empty() || stream.parse::<Token![,]>().is_ok() {
        return Ok(());
    }
    let error = Diagnostic::new(stream.span(), format!("expected a comma after the value of `{key}`"));
    Err(error.help("separate the keys by commas"))
}

fn find(key: &Ident) -> Option<&'static Key> {
    KEYS.iter().find(|known| key == known.name)
}

fn unknown_key(key: &Ident) -> Diagnostic {
    let name = key.to_string();
    let similar = nearest(&name, KEYS.iter().map(|key| key.name));
    let known: Vec<String> =
        KEYS.iter().filter(|key| !key.comes_later()).map(|key| format!("`{}`", key.name)).collect();
    let error = Diagnostic::new(key.span(), format!("unknown key `{name}`"));
    match similar {
        Some(similar) => error.help(format!("write `{similar}`")),
        None => error.help(format!("the keys are {}", known.join(", "))),
    }
}

/// Goes on behind the next comma that is followed by `key =`.
pub(super) fn skip_to_next_item(stream: ParseStream) {
    while !stream.is_empty() {
        let starts_item = |stream: ParseStream| {
            let key = stream.call(Ident::parse_any);
            let is_named = key.as_ref().is_ok_and(|key| key == "group" || key == "method");
            let known = is_named || key.is_ok_and(|key| find(&key).is_some());
            let assigned = stream.peek(Token![=]) && !stream.peek(Token![==]);
            known && (assigned || is_named)
        };
        // a key whose comma was forgotten starts an item too
        if starts_item(&stream.fork()) {
            return;
        }
        let comma = stream.peek(Token![,]);
        // by construction: the stream is not empty, so there is a token to skip
        let _ = stream.parse::<proc_macro2::TokenTree>();
        if comma && stream.peek(syn::Ident::peek_any) && {
            let fork = stream.fork();
            fork.call(Ident::parse_any).is_ok() && fork.peek(Token![=]) && !fork.peek(Token![==])
        } {
            return;
        }
    }
}
