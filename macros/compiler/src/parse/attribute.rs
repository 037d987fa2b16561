//! The grammar of `#[clebsch(…)]`: items `key = value`, separated by commas, in any number of attributes.

use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Parser};
use syn::punctuated::Punctuated;
use syn::{Attribute, DeriveInput, ExprClosure, LitInt, Meta, Path, Token, bracketed};

use super::Closure;
use super::keys::{DISCRETIZATIONS, EMITTED, KEYS, Keys, Kind, Located, ORDERS};
use crate::diagnostic::{Diagnostic, Diagnostics, Place, nearest};

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
        let error = Diagnostic::new(Place::of(attribute), "the declaration stands in parentheses");
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
    let _ = items.parse2(list.tokens.clone());
}

/// `key = value` and the comma after it; after an error the rest of the item is still to be skipped.
fn read_item(stream: ParseStream, keys: &mut Keys, diagnostics: &mut Diagnostics) -> Result<(), Diagnostic> {
    let key = stream.call(Ident::parse_any)?;
    if key == "group" && !stream.peek(Token![=]) {
        let error = Diagnostic::later(key.span(), "a group of one's own, `group NAME = …`,");
        return Err(error.help("the groups of this version are `SO<n>` and `Translation<n>`"));
    }
    let kind = find(&key).ok_or_else(|| unknown_key(&key))?;
    if !keys.give(&key) {
        return Err(Diagnostic::new(key.span(), format!("`{key}` is given twice")).help("remove one of the two"));
    }
    if kind == Kind::Later {
        return Err(Diagnostic::later(key.span(), format!("the key `{key}`")));
    }
    if stream.parse::<Token![=]>().is_err() {
        let error = Diagnostic::new(key.span(), format!("the key `{key}` has no value"));
        return Err(error.help(format!("write `{key} = {}`", example(kind))));
    }
    read_value(&key, kind, stream, keys, diagnostics)?;
    if stream.is_empty() || stream.parse::<Token![,]>().is_ok() {
        return Ok(());
    }
    let error = Diagnostic::new(stream.span(), format!("expected a comma after the value of `{key}`"));
    Err(error.help("separate the keys by commas"))
}

fn find(key: &Ident) -> Option<Kind> {
    KEYS.iter().find(|(name, _)| key == name).map(|&(_, kind)| kind)
}

fn unknown_key(key: &Ident) -> Diagnostic {
    let name = key.to_string();
    let similar = nearest(&name, KEYS.iter().map(|&(name, _)| name));
    let known: Vec<String> =
        KEYS.iter().filter(|(_, kind)| *kind != Kind::Later).map(|(name, _)| format!("`{name}`")).collect();
    let error = Diagnostic::new(key.span(), format!("unknown key `{name}`"));
    match similar {
        Some(similar) => error.help(format!("write `{similar}`")),
        None => error.help(format!("the keys are {}", known.join(", "))),
    }
}

/// A value that the key may have.
fn example(kind: Kind) -> &'static str {
    match kind {
        Kind::Closure(example) => example,
        Kind::Order => "2",
        Kind::Discretization => "cayley",
        Kind::Emit => "[generated]",
        Kind::Scalar => "f64",
        Kind::Crate => "::clebsch",
        Kind::Later => "…",
    }
}

fn read_value(
    key: &Ident,
    kind: Kind,
    stream: ParseStream,
    keys: &mut Keys,
    diagnostics: &mut Diagnostics,
) -> Result<(), Diagnostic> {
    // where a value is not of its key's kind, the error shows one that is
    let expected = |what: &str| {
        Diagnostic::new(stream.span(), format!("the value of `{key}` has to be {what}"))
            .help(format!("write `{key} = {}`", example(kind)))
    };
    match kind {
        Kind::Closure(_) => {
            let opaque = stream.fork().parse::<Ident>().is_ok_and(|word| word == "opaque");
            if opaque {
                return Err(Diagnostic::later(stream.span(), format!("an opaque {key}, by methods of the struct,")));
            }
            if !(stream.peek(Token![|]) || stream.peek(Token![||]) || stream.peek(Token![move])) {
                return Err(expected("a closure"));
            }
            let closure: ExprClosure = stream.parse()?;
            if let Some(closure) = Closure::read(key, closure, diagnostics) {
                keys.put(closure);
            }
        }
        Kind::Order => {
            let literal: LitInt = stream.parse().map_err(|_| expected("a number"))?;
            keys.dials.order = read_order(&literal, diagnostics);
        }
        Kind::Discretization => {
            let name = stream.call(Ident::parse_any).map_err(|_| expected("a name"))?;
            let value = choose(key, &name, &DISCRETIZATIONS, diagnostics);
            keys.dials.discretization = value.map(|value| Located { value, span: name.span() });
        }
        Kind::Emit => {
            if !stream.peek(syn::token::Bracket) {
                return Err(expected("a list"));
            }
            let chosen = read_names(stream)?.into_iter().filter_map(|name| choose(key, &name, &EMITTED, diagnostics));
            keys.dials.emit = chosen.last().unwrap_or_default();
        }
        Kind::Scalar => {
            keys.dials.scalar = Some(stream.call(Ident::parse_any).map_err(|_| expected("a type"))?);
        }
        Kind::Crate => {
            keys.dials.krate = Some(stream.call(Path::parse_mod_style).map_err(|_| expected("a path"))?);
        }
        // by construction: keys that come later have no value read
        Kind::Later => {}
    }
    Ok(())
}

fn read_order(literal: &LitInt, diagnostics: &mut Diagnostics) -> Option<Located<super::dials::Order>> {
    let span = literal.span();
    let number = literal.base10_parse::<i64>().ok();
    match ORDERS.iter().find(|&&(order, _)| Some(order) == number) {
        Some(&(_, Some(value))) => return Some(Located { value, span }),
        Some(_) => diagnostics.push(Diagnostic::later(span, format!("`order = {literal}`")).help("write `order = 2`")),
        None => diagnostics.push(
            Diagnostic::new(span, format!("there is no step of order {literal}"))
                .help("write `order = 2`, or `order = 1` for the papers' step, drift then kick"),
        ),
    }
    None
}

/// `[a, b]`.
fn read_names(stream: ParseStream) -> syn::Result<Punctuated<Ident, Token![,]>> {
    let names;
    bracketed!(names in stream);
    Punctuated::parse_terminated_with(&names, Ident::parse_any)
}

/// The value that a name stands for, or an error that lists the names.
fn choose<T: Copy>(key: &Ident, name: &Ident, table: &[(&str, Option<T>)], diagnostics: &mut Diagnostics) -> Option<T> {
    match table.iter().find(|(word, _)| name == word) {
        Some((_, Some(value))) => return Some(*value),
        Some((_, None)) => diagnostics.push(Diagnostic::later(name.span(), format!("`{name}` as `{key}`"))),
        None => {
            let present: Vec<&str> = table.iter().filter(|(_, value)| value.is_some()).map(|&(word, _)| word).collect();
            let list: Vec<String> = present.iter().map(|word| format!("`{word}`")).collect();
            let written = name.to_string();
            let help = match nearest(&written, present.iter().copied()) {
                Some(similar) => format!("write `{similar}`"),
                None => format!("it is {}", list.join(" or ")),
            };
            diagnostics.push(Diagnostic::new(name.span(), format!("unknown {key} `{name}`")).help(help));
        }
    }
    None
}

/// Goes on behind the next comma that is followed by `key =`.
fn skip_to_next_item(stream: ParseStream) {
    while !stream.is_empty() {
        let starts_item = |stream: ParseStream| {
            let key = stream.call(Ident::parse_any);
            let known = key.as_ref().is_ok_and(|key| key == "group" || find(key).is_some());
            let assigned = stream.peek(Token![=]) && !stream.peek(Token![==]);
            known && (assigned || key.is_ok_and(|key| key == "group"))
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
