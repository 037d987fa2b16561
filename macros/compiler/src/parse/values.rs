//! The values of keys, each read as its key asks.

use proc_macro2::Ident;
use proc_macro2::extra::DelimSpan;
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseBuffer, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Expr, ExprClosure, Lit, LitInt, Path, Token, bracketed, parenthesized};

use super::dials::{Emit, Order};
use super::keys::{
    CHARTS, CODES, DISCRETIZATIONS, EMITTED, ISOTROPIES, Keys, Kind, Located, ORDERS, SOLVERS, SUMMATIONS,
};
use super::{Closure, Potential, opaque};
use crate::diagnostic::{Diagnostic, Diagnostics, nearest};

/// A value that the key may have.
pub(super) fn example(kind: Kind) -> &'static str {
    match kind {
        Kind::Closure(example) => example,
        Kind::Potential => "|q| …",
        Kind::Symmetry => "|S: SO<3>, q, F| (S * q, S * F * S.transpose())",
        Kind::Order => "2",
        Kind::Discretization => "cayley",
        Kind::Chart => "exponential",
        Kind::Solver => "fixed_point",
        Kind::Tolerance => "1e-8",
        Kind::Iterations => "4",
        Kind::Summation => "compensated",
        Kind::Code => "matrices",
        Kind::Isotropy => "free",
        Kind::Emit => "[generated]",
        Kind::Scalar => "f64",
        Kind::Crate => "::clebsch",
        Kind::Later => "…",
    }
}

/// Reads the value of a key and puts it in its place.
pub(super) fn read(
    key: &Ident,
    kind: Kind,
    stream: ParseStream,
    keys: &mut Keys,
    diagnostics: &mut Diagnostics,
) -> Result<(), Diagnostic> {
    let expected = |what: &str| expected(key, kind, stream, what);
    match kind {
        Kind::Closure(_) => {
            if opaque::comes_next(stream) {
                return Err(only_potentials_are_opaque(key, stream));
            }
            let closure = read_closure(key, kind, stream, diagnostics)?;
            let place = match key.to_string().as_str() {
                "action" => &mut keys.action,
                "cost" => &mut keys.cost,
                "force" => &mut keys.force,
                "force_on" => &mut keys.force_on,
                "controls" => &mut keys.controls,
                "dynamics" => &mut keys.dynamics,
                "effort" => &mut keys.effort,
                "bounds" => &mut keys.bounds,
                "endpoint" => &mut keys.endpoint,
                _ => &mut keys.lagrangian,
            };
            *place = closure;
        }
        Kind::Potential if opaque::comes_next(stream) => {
            keys.potential = Some(Potential::Opaque(opaque::read(stream)?));
        }
        Kind::Potential => keys.potential = read_closure(key, kind, stream, diagnostics)?.map(Potential::Closure),
        Kind::Symmetry => keys.symmetries = read_closures(key, kind, stream, diagnostics)?,
        Kind::Order => {
            let literal: LitInt = stream.parse().map_err(|_| expected("a number"))?;
            keys.dials.order = read_order(&literal, diagnostics);
        }
        Kind::Discretization => {
            keys.dials.discretization = read_name(key, kind, stream, &DISCRETIZATIONS, diagnostics)?
        }
        Kind::Chart => keys.dials.chart = read_name(key, kind, stream, &CHARTS, diagnostics)?,
        Kind::Solver => keys.dials.solver = read_name(key, kind, stream, &SOLVERS, diagnostics)?,
        Kind::Tolerance => {
            let literal: Lit = stream.parse().map_err(|_| expected("a number"))?;
            keys.dials.tolerance = read_tolerance(&literal, diagnostics);
        }
        Kind::Iterations => {
            let literal: Lit = stream.parse().map_err(|_| expected("a number"))?;
            keys.dials.iterations = read_iterations(&literal, diagnostics);
        }
        Kind::Summation => keys.dials.summation = read_name(key, kind, stream, &SUMMATIONS, diagnostics)?,
        Kind::Code => keys.dials.code = read_name(key, kind, stream, &CODES, diagnostics)?,
        Kind::Isotropy => keys.dials.isotropy = read_name(key, kind, stream, &ISOTROPIES, diagnostics)?,
        Kind::Emit => {
            if !stream.peek(syn::token::Bracket) {
                return Err(expected("a list"));
            }
            let chosen = read_names(stream)?.into_iter().filter_map(|name| choose(key, &name, &EMITTED, diagnostics));
            keys.dials.emit = chosen.fold(Emit::default(), Emit::and);
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

/// Where a value is not of its key's kind, the error shows one that is.
fn expected(key: &Ident, kind: Kind, stream: ParseStream, what: &str) -> Diagnostic {
    Diagnostic::new(stream.span(), format!("the value of `{key}` has to be {what}"))
        .help(format!("write `{key} = {}`", example(kind)))
}

/// `|a, b| …`; `None` if it can be read over and has an error.
fn read_closure(
    key: &Ident,
    kind: Kind,
    stream: ParseStream,
    diagnostics: &mut Diagnostics,
) -> Result<Option<Closure>, Diagnostic> {
    if !(stream.peek(Token![|]) || stream.peek(Token![||]) || stream.peek(Token![move])) {
        return Err(expected(key, kind, stream, "a closure"));
    }
    let closure: ExprClosure = stream.parse()?;
    Ok(Closure::read(key, closure, diagnostics))
}

/// A closure, or `[closure, …]`.
fn read_closures(
    key: &Ident,
    kind: Kind,
    stream: ParseStream,
    diagnostics: &mut Diagnostics,
) -> Result<Vec<Closure>, Diagnostic> {
    if !stream.peek(syn::token::Bracket) {
        return read_closure(key, kind, stream, diagnostics).map(|closure| closure.into_iter().collect());
    }
    let list = bracket(stream)?;
    let mut closures = Vec::new();
    while !list.is_empty() {
        closures.extend(read_closure(key, kind, &list, diagnostics)?);
        if !list.is_empty() {
            list.parse::<Token![,]>()?;
        }
    }
    Ok(closures)
}

fn only_potentials_are_opaque(key: &Ident, stream: ParseStream) -> Diagnostic {
    Diagnostic::new(stream.span(), format!("the {key} cannot be opaque"))
        .help(format!(
            "write the {key} as a closure; `potential = opaque(Self::value, Self::gradient)` is for potentials"
        ))
        .note("a step needs second derivatives of it, and two methods give a value and a gradient")
}

fn read_order(literal: &LitInt, diagnostics: &mut Diagnostics) -> Option<Located<Order>> {
    let span = literal.span();
    let number = literal.base10_parse::<u32>().ok();
    let found = ORDERS.into_iter().find(|order| Some(order.number()) == number);
    if found.is_none() {
        let error = Diagnostic::new(span, format!("there is no step of order {literal}"));
        diagnostics.push(
            error.help("write `order = 2`; 4, 6, 8 or 16 for more digits, or 1 for the papers' step, drift then kick"),
        );
    }
    found.map(|value| Located { value, span })
}

/// A number between 0 and 1.
fn read_tolerance(literal: &Lit, diagnostics: &mut Diagnostics) -> Option<Located<f64>> {
    let number = match literal {
        Lit::Float(number) if number.suffix().is_empty() => number.base10_parse().ok(),
        _ => None,
    };
    let found = number.filter(|part: &f64| 0.0 < *part && *part < 1.0);
    if found.is_none() {
        let written = super::spelling::tokens(literal);
        let error = Diagnostic::new(literal.span(), format!("`{written}` is no tolerance"));
        diagnostics.push(
            error
                .help("write a number between 0 and 1, as in `tolerance = 1e-8`, or leave the key out for round-off")
                .note("it is the part of a step by which its momentum equation may be missed"),
        );
    }
    found.map(|value| Located { value, span: literal.span() })
}

/// A whole number above zero.
fn read_iterations(literal: &Lit, diagnostics: &mut Diagnostics) -> Option<Located<u32>> {
    let number = match literal {
        Lit::Int(number) if number.suffix().is_empty() => number.base10_parse().ok(),
        _ => None,
    };
    let found = number.filter(|count: &u32| *count > 0);
    if found.is_none() {
        let written = super::spelling::tokens(literal);
        let error = Diagnostic::new(literal.span(), format!("`{written}` is no number of iterations"));
        diagnostics.push(
            error
                .help("write a whole number above zero, as in `iterations = 4`, or leave the key out")
                .note("it is the most iterations that a step makes for each of its momentum equations; a step that needs more is an error"),
        );
    }
    found.map(|value| Located { value, span: literal.span() })
}

/// A name of a table.
fn read_name<T: Copy>(
    key: &Ident,
    kind: Kind,
    stream: ParseStream,
    table: &[(&str, Option<T>)],
    diagnostics: &mut Diagnostics,
) -> Result<Option<Located<T>>, Diagnostic> {
    let name = stream.call(Ident::parse_any).map_err(|_| expected(key, kind, stream, "a name"))?;
    let value = choose(key, &name, table, diagnostics);
    Ok(value.map(|value| Located { value, span: name.span() }))
}

/// `[a, b]`.
fn read_names(stream: ParseStream) -> syn::Result<Punctuated<Ident, Token![,]>> {
    Punctuated::parse_terminated_with(&bracket(stream)?, Ident::parse_any)
}

/// What is in brackets.
fn bracket<'s>(stream: ParseStream<'s>) -> syn::Result<ParseBuffer<'s>> {
    let content;
    bracketed!(content in stream);
    Ok(content)
}

/// `(a, b)`, and where its parentheses are.
pub(super) fn arguments(stream: ParseStream) -> syn::Result<(Vec<Expr>, DelimSpan)> {
    let content;
    let parenthesis = parenthesized!(content in stream);
    let arguments = Punctuated::<Expr, Token![,]>::parse_terminated_with(&content, Expr::parse)?;
    Ok((arguments.into_iter().collect(), parenthesis.span))
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
