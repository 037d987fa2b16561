//! The grammar of `#[clebsch(…)]`: items `key = value`, separated by commas, in any number of attributes.

use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::ParseStream;
use syn::{DeriveInput, Meta, Token};

use super::keys::{KEYS, Key, Keys};
use super::spelling::listed;
use super::{expected, groups, methods, values};
use crate::diagnostic::{Diagnostic, Diagnostics, bail, nearest, report};

/// Reads all attributes of the struct as one.
pub(super) fn read<'d>(input: &DeriveInput, diagnostics: &'d Diagnostics) -> Keys<'d> {
    let mut keys = Keys::new(diagnostics);
    for attribute in input.attrs.iter().filter(|attribute| attribute.path().is_ident("clebsch")) {
        let Meta::List(list) = &attribute.meta else {
            report!(diagnostics, attribute, "the declaration stands in parentheses";
                help "write `#[clebsch(action = …, cost = …, potential = …)]`");
            continue;
        };
        // by construction: the parser consumes everything, and its own errors are among the diagnostics
        let _ = list.parse_args_with(|stream: ParseStream| {
            read_items(stream, &mut keys, read_item);
            Ok(())
        });
    }
    keys
}

/// Reads items to the end, each by a function that leaves an item with an error where that is.
pub(super) fn read_items(
    stream: ParseStream,
    keys: &mut Keys,
    read: fn(ParseStream, &mut Keys) -> Result<(), Diagnostic>,
) {
    while !stream.is_empty() {
        if let Err(error) = read(stream, keys) {
            keys.diagnostics.push(error);
            skip_to_next_item(stream);
        }
    }
}

/// `key = value` and the comma after it; after an error the remaining tokens of the item are still to be skipped.
fn read_item(stream: ParseStream, keys: &mut Keys) -> Result<(), Diagnostic> {
    let key = stream.call(Ident::parse_any)?;
    if is_named(&key) {
        // there may be several
        keys.give(&key);
        let read = if key == "group" { groups::read } else { methods::read };
        read(&key, stream, keys)?;
        return end_of_item(&key, stream);
    }
    if let Some(found) = find(&key) {
        return read_value(&key, found, stream, keys);
    }
    keys.has_unknown = true;
    let similar = nearest(&key.to_string(), KEYS.iter().map(|key| key.name)).and_then(found);
    let known = KEYS.iter().map(|key| key.name);
    let help = match (expected::advice(&key), similar) {
        (Some(advice), _) => advice.to_string(),
        (None, Some(similar)) => format!("write `{}`", similar.name),
        (None, None) => format!("the keys are {}", listed(known)),
    };
    bail!(&key, "unknown key `{key}`"; help "{help}")
}

/// The tokens after a key that takes one value, and the comma after it.
pub(super) fn read_value(key: &Ident, found: &Key, stream: ParseStream, keys: &mut Keys) -> Result<(), Diagnostic> {
    if !keys.give(key) {
        bail!(key, "`{key}` is given twice"; help "remove one of the two");
    }
    if stream.parse::<Token![=]>().is_err() {
        bail!(key, "the key `{key}` has no value"; help "write `{key} = {}`", found.example);
    }
    values::read(key, found, stream, keys)?;
    end_of_item(key, stream)
}

/// A comma, or the end of the declaration.
fn end_of_item(key: &Ident, stream: ParseStream) -> Result<(), Diagnostic> {
    if !stream.is_empty() && stream.parse::<Token![,]>().is_err() {
        bail!(stream.span(), "expected a comma after the value of `{key}`"; help "separate the keys by commas");
    }
    Ok(())
}

fn find(key: &Ident) -> Option<&'static Key> {
    found(&key.to_string())
}

fn found(name: &str) -> Option<&'static Key> {
    KEYS.iter().find(|known| known.name == name)
}

/// Whether a name follows a key that may occur several times.
pub(crate) fn is_named(key: &Ident) -> bool {
    key == "group" || key == "method"
}

/// Goes on behind the next comma that is followed by `key =`.
fn skip_to_next_item(stream: ParseStream) {
    let is_assigned = |stream: ParseStream| stream.peek(Token![=]) && !stream.peek(Token![==]);
    let starts_item = |stream: ParseStream| {
        let key = stream.call(Ident::parse_any);
        key.is_ok_and(|key| is_named(&key) || (find(&key).is_some() && is_assigned(stream)))
    };
    // a key whose comma was forgotten starts an item too
    while !stream.is_empty() && !starts_item(&stream.fork()) {
        let comma = stream.peek(Token![,]);
        // by construction: the stream is not empty, so there is a token to skip
        let _ = stream.parse::<proc_macro2::TokenTree>();
        let fork = stream.fork();
        if comma && fork.call(Ident::parse_any).is_ok() && is_assigned(&fork) {
            return;
        }
    }
}
