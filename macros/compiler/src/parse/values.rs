//! The values of keys, each read as its key asks.

use proc_macro2::Ident;
use proc_macro2::extra::DelimSpan;
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseBuffer, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Expr, ExprClosure, Lit, LitInt, Path, Token, bracketed, parenthesized};

use super::dials::{Emit, Order, Word};
use super::keys::{Key, Keys, Kind, Located};
use super::{Closure, Potential, opaque};
use crate::diagnostic::{Diagnostic, Diagnostics, nearest};

/// Reads the value of a key and puts it in its place.
pub(super) fn read(
    name: &Ident,
    key: &Key,
    stream: ParseStream,
    keys: &mut Keys,
    diagnostics: &mut Diagnostics,
) -> Result<(), Diagnostic> {
    let mut reader = Reader { name, example: key.example, stream, diagnostics };
    match key.kind {
        Kind::Closure(_) if opaque::comes_next(stream) => return Err(only_potentials_are_opaque(name, stream)),
        Kind::Closure(place) => *place(keys) = reader.closure(stream)?,
        Kind::Potential if opaque::comes_next(stream) => {
            keys.potential = Some(Potential::Opaque(opaque::read(stream)?));
        }
        Kind::Potential => keys.potential = reader.closure(stream)?.map(Potential::Closure),
        Kind::Symmetry => keys.symmetries = reader.closures()?,
        Kind::Dial(read, _) => read(&mut keys.dials, reader)?,
        // by construction: keys that come later have no value read
        Kind::Later => {}
    }
    Ok(())
}

/// Reads the value of one key.
pub(super) struct Reader<'a, 's> {
    name: &'a Ident,
    example: &'static str,
    stream: ParseStream<'s>,
    diagnostics: &'a mut Diagnostics,
}

impl Reader<'_, '_> {
    /// Where a value is not of its key's kind, the error shows one that is.
    fn expected(&self, stream: ParseStream, what: &str) -> Diagnostic {
        Diagnostic::new(stream.span(), format!("the value of `{}` has to be {what}", self.name))
            .help(format!("write `{} = {}`", self.name, self.example))
    }

    /// `|a, b| …`; `None` if it can be read over and has an error.
    fn closure(&mut self, stream: ParseStream) -> Result<Option<Closure>, Diagnostic> {
        if !(stream.peek(Token![|]) || stream.peek(Token![||]) || stream.peek(Token![move])) {
            return Err(self.expected(stream, "a closure"));
        }
        let closure: ExprClosure = stream.parse()?;
        Ok(Closure::read(self.name, closure, self.diagnostics))
    }

    /// A closure, or `[closure, …]`.
    fn closures(&mut self) -> Result<Vec<Closure>, Diagnostic> {
        if !self.stream.peek(syn::token::Bracket) {
            return self.closure(self.stream).map(|closure| closure.into_iter().collect());
        }
        let list = bracket(self.stream)?;
        let mut closures = Vec::new();
        while !list.is_empty() {
            closures.extend(self.closure(&list)?);
            if !list.is_empty() {
                list.parse::<Token![,]>()?;
            }
        }
        Ok(closures)
    }

    /// A word of a dial.
    pub fn word<T: Word>(self, dial: &mut Option<Located<T>>) -> Result<(), Diagnostic> {
        let stream = self.stream;
        let word = stream.call(Ident::parse_any).map_err(|_| self.expected(stream, "a name"))?;
        let words: Vec<(&str, Option<T>)> = T::WORDS.iter().map(|&(word, value)| (word, Some(value))).collect();
        let value = choose(self.name, &word, &words, self.diagnostics);
        *dial = value.map(|value| Located { value, span: word.span() });
        Ok(())
    }

    /// `[a, b]`, of the words for what is emitted.
    pub fn words(self, table: &[(&str, Option<Emit>)], dial: &mut Emit) -> Result<(), Diagnostic> {
        if !self.stream.peek(syn::token::Bracket) {
            return Err(self.expected(self.stream, "a list"));
        }
        let list = bracket(self.stream)?;
        let words: Punctuated<Ident, Token![,]> = Punctuated::parse_terminated_with(&list, Ident::parse_any)?;
        let chosen = words.iter().filter_map(|word| choose(self.name, word, table, self.diagnostics));
        *dial = chosen.fold(Emit::default(), Emit::and);
        Ok(())
    }

    /// One of some orders.
    pub fn order(self, orders: &[Order], dial: &mut Option<Located<Order>>) -> Result<(), Diagnostic> {
        let stream = self.stream;
        let literal: LitInt = stream.parse().map_err(|_| self.expected(stream, "a number"))?;
        let span = literal.span();
        let number = literal.base10_parse::<u32>().ok();
        let found = orders.iter().find(|order| Some(order.number()) == number);
        if found.is_none() {
            let error = Diagnostic::new(span, format!("there is no step of order {literal}"));
            self.diagnostics.push(
                error.help(
                    "write `order = 2`; 4, 6, 8 or 16 for more digits, or 1 for the papers' step, drift then kick",
                ),
            );
        }
        *dial = found.map(|&value| Located { value, span });
        Ok(())
    }

    /// A number between 0 and 1.
    pub fn part(self, dial: &mut Option<Located<f64>>) -> Result<(), Diagnostic> {
        let stream = self.stream;
        let literal: Lit = stream.parse().map_err(|_| self.expected(stream, "a number"))?;
        let number = match &literal {
            Lit::Float(number) if number.suffix().is_empty() => number.base10_parse().ok(),
            _ => None,
        };
        let found = number.filter(|part: &f64| 0.0 < *part && *part < 1.0);
        if found.is_none() {
            let written = super::spelling::tokens(&literal);
            let error = Diagnostic::new(literal.span(), format!("`{written}` is no tolerance"));
            self.diagnostics.push(
                error
                    .help(
                        "write a number between 0 and 1, as in `tolerance = 1e-8`, or leave the key out for round-off",
                    )
                    .note("it is the part of a step by which its momentum equation may be missed"),
            );
        }
        *dial = found.map(|value| Located { value, span: literal.span() });
        Ok(())
    }

    /// A whole number above zero.
    pub fn count(self, dial: &mut Option<Located<u32>>) -> Result<(), Diagnostic> {
        let stream = self.stream;
        let literal: Lit = stream.parse().map_err(|_| self.expected(stream, "a number"))?;
        let number = match &literal {
            Lit::Int(number) if number.suffix().is_empty() => number.base10_parse().ok(),
            _ => None,
        };
        let found = number.filter(|count: &u32| *count > 0);
        if found.is_none() {
            let written = super::spelling::tokens(&literal);
            let error = Diagnostic::new(literal.span(), format!("`{written}` is no number of iterations"));
            self.diagnostics.push(
                error
                    .help("write a whole number above zero, as in `iterations = 4`, or leave the key out")
                    .note("it is the most iterations that a step makes for each of its momentum equations; a step that needs more is an error"),
            );
        }
        *dial = found.map(|value| Located { value, span: literal.span() });
        Ok(())
    }

    /// A type by its name.
    pub fn ident(self, dial: &mut Option<Ident>) -> Result<(), Diagnostic> {
        let stream = self.stream;
        *dial = Some(stream.call(Ident::parse_any).map_err(|_| self.expected(stream, "a type"))?);
        Ok(())
    }

    /// A path.
    pub fn path(self, dial: &mut Option<Path>) -> Result<(), Diagnostic> {
        let stream = self.stream;
        *dial = Some(stream.call(Path::parse_mod_style).map_err(|_| self.expected(stream, "a path"))?);
        Ok(())
    }
}

fn only_potentials_are_opaque(key: &Ident, stream: ParseStream) -> Diagnostic {
    Diagnostic::new(stream.span(), format!("the {key} cannot be opaque"))
        .help(format!(
            "write the {key} as a closure; `potential = opaque(Self::value, Self::gradient)` is for potentials"
        ))
        .note("a step needs second derivatives of it, and two methods give a value and a gradient")
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
