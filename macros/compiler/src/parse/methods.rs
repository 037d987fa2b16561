//! Methods, further ways to step the same system: `method NAME = (order = 6, discretization = exact)`.

use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::{ParseBuffer, ParseStream};
use syn::{Token, parenthesized};

use super::dials::Dials;
use super::keys::{KEYS, Key, Keys};
use super::{Declaration, attribute, values};
use crate::diagnostic::{Diagnostic, Diagnostics, nearest};

/// A further way to step the system.
#[derive(Clone)]
pub struct DeclaredMethod {
    /// The unit struct of the user that stands for it.
    pub name: Ident,
    /// Its dials; the others have their defaults, whatever the declaration says.
    pub dials: Dials,
}

/// A method with its keys, and where each was given.
pub(super) struct MethodKeys {
    pub name: Ident,
    pub keys: Keys,
}

/// Reads what follows on the word `method`.
pub(super) fn read(
    word: &Ident,
    stream: ParseStream,
    keys: &mut Keys,
    diagnostics: &mut Diagnostics,
) -> Result<(), Diagnostic> {
    let name = stream.call(Ident::parse_any).map_err(|_| {
        let error = Diagnostic::new(word.span(), "a method has a name, that of a unit struct");
        error.help("write `struct Fine;` beside the system, and `method Fine = (order = 6)`")
    })?;
    if keys.methods.iter().any(|method| method.name.unraw() == name.unraw()) {
        let error = Diagnostic::new(name.span(), format!("the method `{name}` is declared twice"));
        return Err(error.help("remove one of the two, or write another unit struct for it"));
    }
    let is_list = stream.parse::<Token![=]>().is_ok() && stream.peek(syn::token::Paren);
    if !is_list {
        let error = Diagnostic::new(name.span(), format!("the method `{name}` has no dials"));
        return Err(error.help(format!("write `method {name} = (order = 6)`")));
    }
    let content = parenthesis(stream)?;
    let is_empty = content.is_empty();
    let mut own = Keys::default();
    while !content.is_empty() {
        if let Err(error) = read_dial(&content, &mut own, diagnostics) {
            diagnostics.push(error);
            attribute::skip_to_next_item(&content);
        }
    }
    if is_empty {
        let error = Diagnostic::new(name.span(), format!("the method `{name}` has no dials"));
        diagnostics.push(error.help(format!("write `method {name} = (order = 6)`; a method takes {}", dials())));
    }
    keys.methods.push(MethodKeys { name, keys: own });
    Ok(())
}

/// What is in parentheses.
fn parenthesis<'s>(stream: ParseStream<'s>) -> syn::Result<ParseBuffer<'s>> {
    let content;
    parenthesized!(content in stream);
    Ok(content)
}

/// `dial = value` and the comma after it.
fn read_dial(stream: ParseStream, keys: &mut Keys, diagnostics: &mut Diagnostics) -> Result<(), Diagnostic> {
    let key = stream.call(Ident::parse_any)?;
    let found = KEYS.iter().find(|known| key == known.name && known.of_method).ok_or_else(|| {
        let is_key = key == "group" || key == "method" || KEYS.iter().any(|known| key == known.name);
        if is_key { no_dial(&key) } else { unknown_dial(&key) }
    })?;
    attribute::give(&key, keys)?;
    attribute::equals(&key, found, stream)?;
    values::read(&key, found, stream, keys, diagnostics)?;
    attribute::end_of_item(&key, stream)
}

fn no_dial(key: &Ident) -> Diagnostic {
    let error = Diagnostic::new(key.span(), format!("`{key}` is of the system, not of a method"));
    error.help(format!("write it beside the method, which takes {}", dials()))
}

fn unknown_dial(key: &Ident) -> Diagnostic {
    let error = Diagnostic::new(key.span(), format!("unknown dial `{key}`"));
    let known = KEYS.iter().filter(|key| key.of_method).map(|key| key.name);
    match nearest(&key.to_string(), known) {
        Some(similar) => error.help(format!("write `{similar}`")),
        None => error.help(format!("a method takes {}", dials())),
    }
}

/// The dials that a method takes.
fn dials() -> String {
    let names: Vec<String> =
        KEYS.iter().filter(|key: &&Key| key.of_method).map(|key| format!("`{}`", key.name)).collect();
    names.join(", ")
}

/// The methods of a struct, none of which may be the struct itself.
pub(super) fn checked(system: &Ident, keys: Vec<MethodKeys>, diagnostics: &mut Diagnostics) -> Vec<DeclaredMethod> {
    for method in keys.iter().filter(|method| method.name.unraw() == system.unraw()) {
        let error = Diagnostic::new(method.name.span(), format!("the method `{system}` is the system itself"));
        diagnostics.push(error.help("write a unit struct beside it, as in `struct Fine;` and `method Fine = (…)`"));
    }
    keys.into_iter().map(|method| DeclaredMethod { name: method.name, dials: method.keys.dials }).collect()
}

impl Declaration {
    /// The same system with the dials of a method. What is not of steps alone is emitted for the declared dials.
    pub(crate) fn by(&self, method: &DeclaredMethod) -> Declaration {
        let system = &self.dials;
        let dials = Dials {
            isotropy: system.isotropy.clone(),
            emit: system.emit.of_method(),
            scalar: system.scalar.clone(),
            krate: system.krate.clone(),
            ..method.dials.clone()
        };
        Declaration { dials, control: None, endpoint: None, methods: Vec::new(), ..self.clone() }
    }
}
