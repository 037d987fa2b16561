//! Methods, further ways to step the same system: `method NAME = (order = 6, discretization = exact)`.

use clebsch_symbolic::IntoElements;
use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::{ParseBuffer, ParseStream};
use syn::{Token, parenthesized};

use super::dials::{Dials, Emit};
use super::keys::{KEYS, Keys};
use super::spelling::listed;
use super::{Declaration, attribute};
use crate::diagnostic::{Diagnostic, Diagnostics, bail, nearest, report};

/// A further way to step the system.
#[derive(Clone)]
pub struct DeclaredMethod {
    /// The unit struct of the user that stands for it.
    pub name: Ident,
    /// Its dials; the others have their defaults, whatever the declaration says.
    pub dials: Dials,
}

/// Reads the tokens after the word `method`.
pub(super) fn read(word: &Ident, stream: ParseStream, keys: &mut Keys) -> Result<(), Diagnostic> {
    let Ok(name) = stream.call(Ident::parse_any) else {
        bail!(word, "a method has a name, that of a unit struct";
            help "write `struct Fine;` next to the system, and `method Fine = (order = 6)`");
    };
    if keys.methods.iter().any(|(other, _)| other.unraw() == name.unraw()) {
        bail!(&name, "the method `{name}` is declared twice";
            help "remove one of the two, or write another unit struct for it");
    }
    if stream.peek(Token![::]) {
        bail!(&name, "a method is named by one word";
            help "write `use` with the path of the unit struct, and its last word here: `method Fine = (order = 6)`");
    }
    let is_list = stream.parse::<Token![=]>().is_ok() && stream.peek(syn::token::Paren);
    if !is_list {
        bail!(&name, "the method `{name}` has no dials"; help "write `method {name} = (order = 6)`");
    }
    let content = parenthesis(stream)?;
    if content.is_empty() {
        report!(keys.diagnostics, &name, "the method `{name}` has no dials";
            help "write `method {name} = (order = 6)`; a method takes {}", listed(dials()));
    }
    let mut own = Keys::new(keys.diagnostics);
    attribute::read_items(&content, &mut own, read_dial);
    keys.methods.push((name, own));
    Ok(())
}

fn parenthesis<'s>(stream: ParseStream<'s>) -> syn::Result<ParseBuffer<'s>> {
    let content;
    parenthesized!(content in stream);
    Ok(content)
}

/// `dial = value` and the comma after it.
fn read_dial(stream: ParseStream, keys: &mut Keys) -> Result<(), Diagnostic> {
    let key = stream.call(Ident::parse_any)?;
    match KEYS.iter().find(|known| key == known.name) {
        Some(found) if found.of_method => attribute::read_value(&key, found, stream, keys),
        None if !attribute::is_named(&key) => {
            let similar = nearest(&key.to_string(), dials()).map(|dial| format!("write `{dial}`"));
            let help = similar.unwrap_or_else(|| format!("a method takes {}", listed(dials())));
            bail!(&key, "unknown dial `{key}`"; help "{help}")
        }
        _ => bail!(&key, "`{key}` is of the system, not of a method";
            help "write it outside of the method, which takes {}", listed(dials())),
    }
}

fn dials() -> impl Iterator<Item = &'static str> {
    KEYS.iter().filter(|key| key.of_method).map(|key| key.name)
}

/// The methods of a struct; the struct itself cannot be one.
pub(super) fn checked(system: &Ident, keys: Vec<(Ident, Keys)>, diagnostics: &Diagnostics) -> Vec<DeclaredMethod> {
    for (name, _) in keys.iter().filter(|(name, _)| name.unraw() == system.unraw()) {
        report!(diagnostics, name.span(), "the method `{system}` is the system itself";
            help "write another unit struct, as in `struct Fine;` and `method Fine = (…)`");
    }
    keys.into_each(|(name, keys)| DeclaredMethod { name, dials: keys.dials })
}

impl Declaration {
    /// The same system with the dials of a method.
    pub(crate) fn by(&self, method: &DeclaredMethod) -> Declaration {
        let system = &self.dials;
        let dials = Dials {
            isotropy: system.isotropy.clone(),
            signature: system.signature.clone(),
            // words that concern the system, and derivatives of its steps
            emit: Emit { generated: false, latex: false, ..system.emit },
            scalar: system.scalar.clone(),
            krate: system.krate.clone(),
            ..method.dials.clone()
        };
        let system = Declaration { endpoint: None, target: None, methods: Vec::new(), ..self.clone() };
        Declaration { dials, control: None, choice_of_system: self.control.clone(), ..system }
    }

    /// The same system without derivatives of its steps.
    pub(crate) fn without_variations(mut self) -> Declaration {
        self.dials.emit = Emit { tangent: false, boundary: false, ..self.dials.emit };
        self
    }
}
