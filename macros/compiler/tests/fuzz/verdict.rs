//! The possible outcomes of any text at all: an integrator that is Rust, or errors that help. The second time it is the
//! same, and there is no panic.
//!
//! The tests and the fuzz targets of `tests/fuzz` include this file.

use std::panic::catch_unwind;

use clebsch_compiler::diagnostic::Diagnostics;
use clebsch_compiler::{Graph, compile, expand};
use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The answer of the compiler about the first declaration in a text: nothing, or errors that help.
///
/// # Errors
/// A panic, other tokens the second time, code that is no Rust, or an error without message, help or place.
pub fn verdict(text: &str) -> Result<Option<Diagnostics>, String> {
    let Ok(tokens) = text.parse::<TokenStream>() else { return Ok(None) };
    if tokens.is_empty() {
        return Ok(None);
    }
    let item = declaration(tokens);
    let expansion = expand(item.clone()).to_string();
    if expansion.contains("has found a bug in clebsch") {
        return Err(format!("a panic:\n{text}"));
    }
    if syn::parse_str::<syn::File>(&expansion).is_err() {
        return Err(format!("no Rust:\n{expansion}\n{text}"));
    }
    if !expansion.starts_with(":: core :: compile_error !") {
        return match expand(item).to_string() == expansion {
            true => Ok(None),
            false => Err(format!("other tokens the second time:\n{text}")),
        };
    }
    let Ok(Some(errors)) = catch_unwind(|| compile(&Graph::new(), item.clone()).err()) else {
        return refused_in_emission(&expansion, text);
    };
    if !expansion.starts_with(&errors.to_compile_errors().to_string()) {
        return Err(format!("other errors the second time:\n{text}"));
    }
    helps(&errors, text)?;
    // rustc gives a macro complete items: only others may end without a place
    let is_whole = || errors.to_string().contains("to be read") || syn::parse2::<syn::DeriveInput>(item).is_ok();
    match placed(&errors, text) {
        Err(failure) if is_whole() => Err(failure),
        _ => Ok(Some(errors)),
    }
}

/// The text of the code is the last that a budget is spent on.
fn refused_in_emission(expansion: &str, text: &str) -> Result<Option<Diagnostics>, String> {
    match expansion.contains("is too large to expand: ") {
        true => Ok(None),
        false => Err(format!("errors that come from nowhere:\n{text}")),
    }
}

/// The item of a file that derives `Clebsch`, as the macro gets it; all tokens of a text without such an item.
pub fn declaration(tokens: TokenStream) -> TokenStream {
    let mut items: Vec<Vec<TokenTree>> = vec![Vec::new()];
    for token in tokens.clone() {
        let ends = match &token {
            TokenTree::Punct(mark) => mark.as_char() == ';',
            TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
            _ => false,
        };
        // by construction: there is an item from the beginning
        items.last_mut().expect("an item").push(token);
        if ends {
            items.push(Vec::new());
        }
    }
    let derives = |token: &TokenTree| matches!(token, TokenTree::Group(group) if begins(group.stream(), "derive"));
    let declared = |token: &TokenTree| matches!(token, TokenTree::Group(group) if begins(group.stream(), "clebsch"));
    let Some(item) = items.into_iter().find(|item| item.iter().any(|token| derives(token) || declared(token))) else {
        return tokens;
    };
    let is_derive = |at: usize| item.get(at).is_some_and(derives);
    let kept = |at: &usize| !is_derive(*at) && !is_derive(at + 1);
    (0..item.len()).filter(kept).map(|at| item[at].clone()).collect()
}

fn begins(stream: TokenStream, word: &str) -> bool {
    matches!(stream.into_iter().next(), Some(TokenTree::Ident(first)) if first == word)
}

/// Every error has a message, and a help or a note.
fn helps(errors: &Diagnostics, text: &str) -> Result<(), String> {
    let broken = |what: &str| Err(format!("{what}:\n{errors}\n{text}"));
    let found = errors.clone().into_vec();
    if found.is_empty() {
        return broken("refused without an error");
    }
    for error in &found {
        let said = error.to_string();
        let first = said.lines().next().unwrap_or_default();
        if first.trim().is_empty() || first.ends_with('.') || first.starts_with(char::is_uppercase) {
            return broken("an error without a first line, or with a sentence there");
        }
        if !said.contains("\nhelp: ") && !said.contains("\nnote: ") {
            return broken("an error without a help or a note");
        }
    }
    Ok(())
}

/// Every error has a place in the text.
fn placed(errors: &Diagnostics, text: &str) -> Result<(), String> {
    // `compile_error! { … }` carries the first and the last token of the place
    for token in errors.to_compile_errors() {
        let (from, to) = (token.span().start(), token.span().end());
        if from.line == 0 || from >= to || text.lines().nth(to.line - 1).is_none_or(|line| line.len() < to.column) {
            return Err(format!("an error without a place, `{token}` at {from:?} to {to:?}:\n{errors}\n{text}"));
        }
    }
    Ok(())
}
