//! The values of keys, each read as its key asks.

use clebsch_symbolic::{Elements, IntoList};
use proc_macro2::Ident;
use proc_macro2::extra::DelimSpan;
use quote::ToTokens;
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseBuffer, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Expr, Lit, Path, Token, bracketed, parenthesized};

use super::dials::{EMITTED, Emit, RungeKutta, Word};
use super::keys::{Key, Keys, Kind, Located};
use super::spelling::tokens;
use super::{Closure, Potential, closure, opaque};
use crate::diagnostic::{Diagnostic, Diagnostics, Location, bail, error, nearest, refuse, report};

/// Reads the value of a key and puts it in its place.
pub(super) fn read(name: &Ident, key: &Key, stream: ParseStream, keys: &mut Keys) -> Result<(), Diagnostic> {
    let mut reader = Reader { name, example: key.example, stream, diagnostics: keys.diagnostics };
    match key.kind {
        Kind::Closure if opaque::comes_next(stream) => bail!(stream.span(), "the {name} cannot be opaque";
            help "write the {name} as a closure; `potential = opaque(Self::value, Self::gradient)` is for potentials";
            note "a step needs second derivatives of it, and two methods give a value and a gradient"),
        Kind::Closure => keys.closures.extend(reader.closure(stream)?.map(|closure| (key.name, closure))),
        Kind::Motion => {
            let (integration, closure) = reader.motion()?;
            keys.integration = integration;
            keys.closures.extend(closure.map(|closure| (key.name, closure)));
        }
        Kind::Potential if opaque::comes_next(stream) => {
            keys.potential = Some(Potential::Opaque(opaque::read(stream)?));
        }
        Kind::Potential => keys.potential = reader.closure(stream)?.map(Potential::Closure),
        Kind::Closures => keys.lists.extend([(key.name, reader.closures()?)]),
        Kind::Dial(read, ..) => read(&mut keys.dials, reader)?,
    }
    Ok(())
}

pub(super) struct Reader<'a, 's> {
    name: &'a Ident,
    example: &'static str,
    stream: ParseStream<'s>,
    diagnostics: &'a Diagnostics,
}

impl Reader<'_, '_> {
    /// Where a value is not of its key's kind, the error shows one that is.
    fn expected(&self, stream: ParseStream, what: &str) -> Diagnostic {
        // `"4"` and `4.0` mean 4
        let meant = stream.fork().parse::<Lit>().ok().and_then(|literal| match literal {
            Lit::Str(text) => Some(text.value()),
            Lit::Float(number) => number.base10_digits().strip_suffix(".0").map(str::to_string),
            _ => None,
        });
        let is_word = |text: &String| syn::parse_str::<Ident>(text).is_ok() || text.parse::<u32>().is_ok();
        let value = meant.filter(is_word).unwrap_or_else(|| self.example.to_string());
        error!(stream.span(), "the value of `{}` has to be {what}", self.name;
            help "write `{} = {value}`", self.name)
    }

    /// `|a, b| …`; `None` if it can be read over and has an error.
    fn closure(&mut self, stream: ParseStream) -> Result<Option<Closure>, Diagnostic> {
        if !is_closure(stream) {
            let error = self.expected(stream, "a closure");
            let is_method = self.name == "potential" && stream.peek(Token![Self]);
            let opaque =
                || "for methods of the struct write `potential = opaque(Self::value, Self::gradient)`".to_string();
            let size = || "leave it out for steps of one size: that is the argument of `stepper(h)`".to_string();
            let is_size = self.name == "step";
            return Err(error.maybe_help(is_method.then(opaque)).maybe_help(is_size.then(size)));
        }
        let closure = closure::parse(stream)?;
        Ok(Closure::read(self.name, closure, self.diagnostics))
    }

    /// A closure, or `rk4(closure)`.
    fn motion(&mut self) -> Result<(Option<RungeKutta>, Option<Closure>), Diagnostic> {
        if is_closure(self.stream) || !self.stream.peek2(syn::token::Paren) {
            return Ok((None, self.closure(self.stream)?));
        }
        let word = self.stream.call(Ident::parse_any)?;
        let content = parenthesis(self.stream)?;
        let method = RungeKutta::WORDS.iter().find(|(known, _)| word == known).map(|(_, method)| *method);
        if method.is_none() {
            report!(self.diagnostics, &word, "`{word}` is no method of integration"; help "write `rk4` or `midpoint`");
        }
        let closure = self.closure(&content)?;
        if !content.is_empty() {
            bail!(content.span(), "`{word}` takes one closure"; help "write `{} = {word}(|x: Vector2, u: Vector1| …)`", self.name);
        }
        Ok((method, closure.filter(|_| method.is_some())))
    }

    /// A closure, or `[closure, …]`.
    fn closures(&mut self) -> Result<Vec<Closure>, Diagnostic> {
        if !self.stream.peek(syn::token::Bracket) {
            return self.closure(self.stream).map(|closure| closure.into_iter().into_list());
        }
        let place = self.stream.span();
        let list = bracket(self.stream)?;
        if list.is_empty() {
            bail!(place, "the list of `{}` is empty", self.name; help "write `{} = {}`, or leave out the key", self.name, self.example);
        }
        let mut closures = Vec::new();
        while !list.is_empty() {
            closures.extend(self.closure(&list)?);
            if !list.is_empty() {
                list.parse::<Token![,]>()?;
            }
        }
        Ok(closures)
    }

    pub fn word<T: Word>(self, dial: &mut Option<Located<T>>) -> Result<(), Diagnostic> {
        let stream = self.stream;
        let word = stream.call(Ident::parse_any).map_err(|_| self.expected(stream, "a name"))?;
        *dial = self.choose(&word, T::WORDS).map(|value| Located { value, span: word.span() });
        Ok(())
    }

    /// `[a, b]`, a list of words for emitted items.
    pub fn words(self, dial: &mut Emit) -> Result<(), Diagnostic> {
        if !self.stream.peek(syn::token::Bracket) {
            let word = self.stream.fork().call(Ident::parse_any).map(|word| word.to_string());
            let meant = word.ok().and_then(|word| nearest(&word, EMITTED.iter().map(|(known, _)| *known)));
            let example = meant.map_or(self.example.to_string(), |word| format!("[{word}]"));
            bail!(self.stream.span(), "the value of `{}` has to be a list", self.name;
                help "write `{} = {example}`", self.name);
        }
        let list = bracket(self.stream)?;
        let words: Punctuated<Ident, Token![,]> = Punctuated::parse_terminated_with(&list, Ident::parse_any)?;
        for word in &words {
            if word == "generated" && !cfg!(feature = "generated") {
                report!(self.diagnostics, word, "`emit = [generated]` needs the feature `generated` of the crate `clebsch`";
                    help "add the feature: `clebsch = {{ …, features = [\"generated\"] }}`");
            } else if let Some(emitted) = self.choose(word, &EMITTED) {
                *(emitted.part)(dial) = true;
            }
        }
        Ok(())
    }

    /// A number that has a value for the dial; else the error for the token that was written.
    pub fn number<L: Parse + ToTokens, T>(
        self,
        dial: &mut Option<Located<T>>,
        value: impl Fn(&L) -> Option<T>,
        error: impl Fn(Location, String) -> Diagnostic,
    ) -> Result<(), Diagnostic> {
        let start = self.stream.fork();
        let literal: L = self.stream.parse().map_err(|_| self.expected(&start, "a number"))?;
        let place = Location::from(&literal);
        *dial = value(&literal).map(|value| Located { value, span: place.start });
        if dial.is_none() {
            self.diagnostics.push(error(place, tokens(&literal)));
        }
        Ok(())
    }

    /// The value that a name stands for, or an error that lists the names.
    fn choose<T: Copy>(&self, name: &Ident, table: &[(&str, T)]) -> Option<T> {
        let words = table.each(|(word, _)| *word);
        self.position(name, &words).map(|position| table[position].1)
    }

    fn position(&self, name: &Ident, words: &[&str]) -> Option<usize> {
        let found = words.iter().position(|word| name == word);
        if found.is_some() {
            return found;
        }
        let help = match nearest(&name.to_string(), words.iter().copied()) {
            Some(similar) => format!("write `{similar}`"),
            None => format!("it is {}", words.each(|word| format!("`{word}`")).join(" or ")),
        };
        refuse!(self.diagnostics, name, "unknown {} `{name}`", self.name; help "{help}")
    }

    pub fn ident(self, dial: &mut Option<Ident>) -> Result<(), Diagnostic> {
        *dial = Some(self.stream.call(Ident::parse_any).map_err(|_| self.expected(self.stream, "a type"))?);
        Ok(())
    }

    pub fn path(self, dial: &mut Option<Path>) -> Result<(), Diagnostic> {
        *dial = Some(self.stream.call(Path::parse_mod_style).map_err(|_| self.expected(self.stream, "a path"))?);
        Ok(())
    }
}

pub(super) fn is_closure(stream: ParseStream) -> bool {
    stream.peek(Token![|]) || stream.peek(Token![||]) || stream.peek(Token![move])
}

fn parenthesis<'s>(stream: ParseStream<'s>) -> syn::Result<ParseBuffer<'s>> {
    let content;
    parenthesized!(content in stream);
    Ok(content)
}

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
    Ok((arguments.into_iter().into_list(), parenthesis.span))
}
