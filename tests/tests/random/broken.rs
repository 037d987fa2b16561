//! Valid problems with one mistake: each is refused, with a message, at a place, and with a help or a note.

use std::panic::catch_unwind;

use clebsch_compiler::diagnostic::Diagnostics;
use clebsch_compiler::{Graph, compile};
use clebsch_tests::oracle::random::Random;
use proc_macro2::{TokenStream, TokenTree};

use crate::groups::pick;
use crate::problem::{Declared, Kind, Kinetic};

/// The text of a declaration with a mistake, and what the mistake is.
pub struct Mistake {
    pub name: &'static str,
    pub text: String,
}

/// All mistakes that this problem offers.
pub fn mistakes(problem: &Declared) -> Vec<Mistake> {
    let text = problem.text();
    let mut found = Vec::new();
    let mut replaced = |name: &'static str, old: &str, new: &str| {
        if text.contains(old) {
            found.push(Mistake { name, text: text.replacen(old, new, 1) });
        }
    };
    replaced("an unknown key", "action =", "acton =");
    replaced("an unknown field", "self.field_0", "self.field_9");
    replaced("an unknown argument", "potential = |", "potential = |xi, ");
    replaced("the step in a potential", "potential = |", "potential = |h, ");
    replaced("a name that is none", "action = |F: ", "action = |f: ");
    replaced("an unknown group", ": SO<", ": OS<");
    replaced("a group without its size", ": SU<2>,", ": SU,");
    replaced("a method that is none", ".trace()", ".tarce()");
    replaced("a method without a derivative", "potential = |q| ", "potential = |q| 1.5.floor() * ");
    replaced("a cost that forgot the step", " / (2 * h))", " / 2)");
    replaced("an order that is none", "order = 1", "order = 3");
    replaced("an unknown dial", "isotropy = free", "isotropy = loose");
    replaced("an unknown discretisation", "discretization = cayley", "discretization = caley");
    replaced("the metric of no matrix", "discretization = projection", "discretization = moser-veselov");
    replaced("two actions", "action =", "action = |F: SO<3>, q: SO<3>| q * F,\n    action =");
    replaced("a forgotten comma", ",\n    potential", "\n    potential");
    replaced("a closure that is none", "action = |", "action = ");
    replaced("a field of text", ": f64,", ": &'static str,");
    if problem.fields.len() > 1 {
        replaced("a field of another scalar", ": f64,", ": f32,");
    }
    if problem.leaves[0].start.entries().len() > 1 {
        replaced("a vector in place of a scalar", "potential = |q| ", "potential = |q| q * ");
    }
    if problem.factors.len() == 1 && problem.factors[0].group.kind == Kind::Matrix {
        let n = problem.factors[0].group.group.size();
        // F q F is an action where everything commutes, and for the identity alone on 1×1
        let commutes = problem.factors[0].group.group.basis.len() == 1;
        if problem.factors[0].group.name.starts_with(['S', 'G']) && !commutes {
            replaced("no action", "| (q * F)", "| (F * q * F)");
            replaced("no action", "| (F * q)", "| (q + F * q)");
        }
        replaced("another size", &format!("q: SVector<{n}>"), &format!("q: SVector<{}>", n + 1));
        replaced("a row for a vector", &format!("q: SVector<{n}>"), &format!("q: SMatrix<1, {n}>"));
    }
    if let Kinetic::Cost(_) = problem.kinetic {
        replaced("a cost without step", "cost = |h, F| ", "cost = |F| ");
        replaced("a cost and a Lagrangian", "cost = |", "lagrangian = |v| v.norm_squared(),\n    cost = |");
    }
    found
}

/// The text without one of its tokens, with one twice, or with two of them exchanged.
pub fn mutilated(text: &str, random: &mut Random) -> String {
    let tokens: TokenStream = text.parse().expect("tokens");
    let mut words = Vec::new();
    flatten(tokens, &mut words);
    let (i, j) = (pick(random, words.len()), pick(random, words.len()));
    match pick(random, 3) {
        0 => drop(words.remove(i)),
        1 => words.insert(i, words[j].clone()),
        _ => words.swap(i, j),
    }
    words.join(" ")
}

fn flatten(tokens: TokenStream, words: &mut Vec<String>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    proc_macro2::Delimiter::Parenthesis => ("(", ")"),
                    proc_macro2::Delimiter::Brace => ("{", "}"),
                    proc_macro2::Delimiter::Bracket => ("[", "]"),
                    proc_macro2::Delimiter::None => ("", ""),
                };
                words.push(open.into());
                flatten(group.stream(), words);
                words.push(close.into());
            }
            other => words.push(other.to_string()),
        }
    }
}

/// What the compiler says of a text: nothing, or errors that help.
///
/// # Errors
/// A panic, or an error without message, help or place.
pub fn verdict(text: &str) -> Result<Option<Diagnostics>, String> {
    let Ok(tokens) = text.parse::<TokenStream>() else { return Ok(None) };
    let Ok(errors) = catch_unwind(|| compile(&Graph::new(), tokens).err()) else {
        return Err(format!("a panic:\n{text}"));
    };
    let Some(errors) = errors else { return Ok(None) };
    helps(&errors, text)?;
    Ok(Some(errors))
}

/// Every error has a message, a help or a note, and a place in the text.
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
    // `compile_error! { … }` carries the first and the last token of the place
    for token in errors.to_compile_errors() {
        let (from, to) = (token.span().start(), token.span().end());
        if from.line == 0 || from >= to || text.lines().nth(to.line - 1).is_none_or(|line| line.len() < to.column) {
            return broken(&format!("an error without a place, `{token}` at {from:?} to {to:?}"));
        }
    }
    Ok(())
}
