//! The words in which generated code is written. They give way to the names of the user's item.
//!
//! `runtime` is the module of the runtime for generated code, and `T` the scalar. `Q`, `F` and `Mu` are the types of
//! configurations, group elements and momenta, and `C` that of the constants. Mostly these are their names in the
//! expansion too. Where the user has such a name, or the scalar is a type parameter, other tokens are put in for them
//! at the end. Until then names of the user are raw identifiers.

use std::collections::BTreeSet;

use proc_macro2::{Group, Ident, Span, TokenStream, TokenTree};
use quote::{format_ident, quote};
use syn::Lifetime;

use crate::model::ScalarType;

const WORDS: [&str; 7] = ["runtime", "T", "Q", "F", "Mu", "C", "Velocity"];

/// Names of generated types and of their lifetime. Names of the user's item and of the code that it reads are taken.
#[derive(Clone)]
pub(super) struct Names {
    taken: BTreeSet<String>,
    /// The tokens for words that do not stand for themselves.
    words: Option<[TokenStream; 7]>,
}

impl Names {
    /// The names next to some tokens of the user.
    pub(super) fn new(scalar: &ScalarType, has_configuration: bool, users: &[TokenStream]) -> Names {
        let mut names = Names { taken: BTreeSet::new(), words: None };
        users.iter().for_each(|tokens| collect(tokens.clone(), &mut names.taken));
        let ScalarType::Parameter(parameter) = scalar else {
            let is_taken = WORDS.iter().any(|word| names.taken.contains(*word));
            let words = is_taken.then(|| WORDS.map(|word| TokenTree::from(names.free(word)).into()));
            return Names { words, ..names };
        };
        names.taken.insert(parameter.to_string());
        let word = |word| match (word, names.free(word)) {
            ("T", _) => quote!(#parameter),
            ("F" | "Mu" | "C", name) => quote!(#name<#parameter>),
            // momenta that are stepped alone have no configuration
            ("Q", name) if has_configuration => quote!(#name<#parameter>),
            (_, name) => quote!(#name),
        };
        Names { words: Some(WORDS.map(word)), ..names }
    }

    /// The name, with underscores behind it as long as it is taken.
    pub(super) fn free(&self, name: &str) -> Ident {
        let mut name = name.to_string();
        while self.taken.contains(&name) {
            name.push('_');
        }
        format_ident!("{name}")
    }

    /// The lifetime of references to the user's struct.
    pub(super) fn lifetime(&self) -> Lifetime {
        Lifetime { apostrophe: Span::call_site(), ident: self.free("clebsch") }
    }

    /// The struct of an equation.
    pub(super) fn equation(&self, suffix: &str, number: usize) -> Ident {
        let suffix = match suffix {
            "_first" => "First",
            "_adjoint" => "Adjoint",
            "_whole" => "Whole",
            _ => "",
        };
        self.free(&format!("Equation{suffix}{}", number + 1))
    }

    /// Tokens of the user, in which no name is a word.
    pub(super) fn of_user(&self, tokens: TokenStream) -> TokenStream {
        let raw = |name: &str, span| Some(TokenTree::from(Ident::new_raw(name, span)).into());
        match self.words {
            Some(_) => put_in(tokens, &|name, span| WORDS.contains(&name).then(|| raw(name, span))?),
            None => tokens,
        }
    }

    /// Generated code, with its words replaced.
    pub(super) fn put_in(&self, tokens: TokenStream) -> TokenStream {
        let Some(words) = &self.words else { return tokens };
        put_in(tokens, &|name, span| match name.strip_prefix("r#") {
            Some(plain) if WORDS.contains(&plain) => Some(TokenTree::from(Ident::new(plain, span)).into()),
            _ => Some(words[WORDS.iter().position(|word| *word == name)?].clone()),
        })
    }
}

/// Some tokens, with some of their names replaced. Fields, methods, lifetimes and names in a path stay.
pub(super) fn put_in(tokens: TokenStream, other: &dyn Fn(&str, Span) -> Option<TokenStream>) -> TokenStream {
    let (mut all, mut before) = (TokenStream::new(), [' ', ' ']);
    for token in tokens {
        let is_member = before == [':', ':'] || ['.', '\''].contains(&before[1]);
        before = [before[1], if let TokenTree::Punct(punct) = &token { punct.as_char() } else { ' ' }];
        let changed = match &token {
            TokenTree::Ident(name) if !is_member => other(&name.to_string(), name.span()),
            TokenTree::Group(group) => {
                let mut changed = Group::new(group.delimiter(), put_in(group.stream(), other));
                changed.set_span(group.span());
                Some(TokenTree::from(changed).into())
            }
            _ => None,
        };
        all.extend(changed.unwrap_or_else(|| token.into()));
    }
    all
}

/// All identifiers of some tokens; those of lifetimes too, without their quote.
fn collect(tokens: TokenStream, taken: &mut BTreeSet<String>) {
    for token in tokens {
        match token {
            TokenTree::Ident(ident) => drop(taken.insert(ident.to_string())),
            TokenTree::Group(group) => collect(group.stream(), taken),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}
