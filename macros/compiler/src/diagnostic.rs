//! Errors that help: the mistake, the text to type instead, and the reason. They are collected, so that a stage reports
//! all of its errors.

use clebsch_symbolic::IntoList;
use std::cell::RefCell;
use std::fmt;

use proc_macro2::{Span, TokenStream, TokenTree};
use quote::{ToTokens, quote_spanned};

/// A stretch of the user's source, from the first to the last token.
#[derive(Copy, Clone, Debug)]
pub struct Location {
    pub(crate) start: Span,
    pub(crate) end: Span,
}

impl From<Span> for Location {
    fn from(span: Span) -> Location {
        Location { start: span, end: span }
    }
}

/// The place of everything that a syntax tree was made from.
impl<T: ToTokens + ?Sized> From<&T> for Location {
    fn from(tokens: &T) -> Location {
        Location::of(tokens.to_token_stream())
    }
}

impl Location {
    /// The first token.
    pub fn start(&self) -> Span {
        self.start
    }

    /// The last token.
    pub fn end(&self) -> Span {
        self.end
    }

    fn of(tokens: TokenStream) -> Location {
        let mut spans = tokens.into_iter().map(|token| match token {
            TokenTree::Group(group) => (group.span_open(), group.span_close()),
            other => (other.span(), other.span()),
        });
        let first = spans.next().unwrap_or_else(|| (Span::call_site(), Span::call_site()));
        Location { start: first.0, end: spans.last().unwrap_or(first).1 }
    }
}

/// Why something of the language is refused.
pub(crate) const LATER: &str = "it belongs to the language and comes with a later version of clebsch";

/// An error at a place: its message, then help and notes. Each is a text with the values that it formats.
macro_rules! error {
    ($place:expr, $message:literal $(, $given:expr)* $(; $line:ident $text:literal $(, $also:expr)*)*) => {
        $crate::diagnostic::Diagnostic::new($place, format_args!($message $(, $given)*))
            $(.$line(format_args!($text $(, $also)*)))*
    };
}

/// Returns an error.
macro_rules! bail {
    ($($error:tt)*) => { return Err($crate::diagnostic::error!($($error)*).into()) };
}

/// Reports an error to the collector, and returns no value.
macro_rules! refuse {
    ($collector:expr, $($error:tt)*) => { return $collector.refuse($crate::diagnostic::error!($($error)*)) };
}

/// Reports an error to the collector.
macro_rules! report {
    ($collector:expr, $($error:tt)*) => { $collector.push($crate::diagnostic::error!($($error)*)) };
}

pub(crate) use {bail, error, refuse, report};

/// One error: a first line, then lines of help and notes in the order in which they were added.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    place: Location,
    message: String,
    lines: Vec<String>,
}

impl Diagnostic {
    /// An error with its message: lower case, no full stop, the user's names in backticks.
    pub fn new(place: impl Into<Location>, message: impl fmt::Display) -> Diagnostic {
        Diagnostic { place: place.into(), message: message.to_string(), lines: Vec::new() }
    }

    /// Its first line.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The tokens that it is about.
    pub fn place(&self) -> Location {
        self.place
    }

    /// The first text to type instead.
    pub fn first_help(&self) -> Option<&str> {
        self.lines.iter().find_map(|line| line.strip_prefix("help: "))
    }

    /// The text to type instead.
    pub fn help(mut self, text: impl fmt::Display) -> Diagnostic {
        self.lines.push(format!("help: {text}"));
        self
    }

    /// The mathematical reason.
    pub fn note(mut self, text: impl fmt::Display) -> Diagnostic {
        self.lines.push(format!("note: {text}"));
        self
    }

    /// Help, if there is any.
    pub fn maybe_help(self, text: Option<impl fmt::Display>) -> Diagnostic {
        if let Some(text) = text { self.help(text) } else { self }
    }

    /// Says that something is part of the language, but not of this version, and gives its replacement.
    pub fn later(place: impl Into<Location>, what: impl fmt::Display, help: Option<&str>) -> Diagnostic {
        let error = Diagnostic::new(place, format!("{what} is not supported yet")).maybe_help(help);
        error.note(LATER)
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        if !self.lines.is_empty() {
            f.write_str("\n")?;
        }
        self.lines.iter().try_for_each(|line| write!(f, "\n{line}"))
    }
}

impl From<syn::Error> for Diagnostic {
    fn from(error: syn::Error) -> Diagnostic {
        let diagnostic = Diagnostic::new(error.span(), &error);
        if diagnostic.message.contains("\n\nhelp: ") {
            return diagnostic;
        }
        diagnostic.note("a declaration is `key = value, …`, and closures are written in Rust's syntax")
    }
}

/// The errors of a stage, in the order in which they were found.
#[derive(Clone, Default, Debug)]
pub struct Diagnostics {
    found: RefCell<Vec<Diagnostic>>,
}

impl Diagnostics {
    /// No errors yet.
    pub fn new() -> Diagnostics {
        Diagnostics::default()
    }

    pub(crate) fn push(&self, diagnostic: impl Into<Diagnostic>) {
        self.found.borrow_mut().push(diagnostic.into());
    }

    /// Adds an error, which leaves no value.
    pub fn refuse<T>(&self, diagnostic: impl Into<Diagnostic>) -> Option<T> {
        self.push(diagnostic);
        None
    }

    /// The value, or none and its errors among these.
    pub fn take<T>(&self, result: Result<T, impl Into<Diagnostics>>) -> Option<T> {
        result.map_err(|errors| self.extend(errors.into())).ok()
    }

    pub(crate) fn extend(&self, errors: impl IntoIterator<Item = Diagnostic>) {
        errors.into_iter().for_each(|error| self.push(error));
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.found.borrow().len()
    }

    /// Does something whose errors are forgotten.
    pub fn quietly<T>(&self, attempt: impl FnOnce() -> T) -> T {
        let reported = self.len();
        let result = attempt();
        self.found.borrow_mut().truncate(reported);
        result
    }

    /// Takes the errors that came after this many.
    pub(crate) fn since(&self, reported: usize) -> Vec<Diagnostic> {
        let mut found = self.found.borrow_mut();
        let from = reported.min(found.len());
        found.split_off(from)
    }

    /// The errors.
    pub fn into_vec(self) -> Vec<Diagnostic> {
        self.found.into_inner()
    }

    /// The value, unless there were errors.
    pub fn propagate<T>(self, value: T) -> Result<T, Diagnostics> {
        if self.is_empty() { Ok(value) } else { Err(self) }
    }

    /// One `compile_error!` for each error, at its place.
    pub fn to_compile_errors(&self) -> TokenStream {
        let error = |error: &Diagnostic| {
            let (Location { start, end }, text) = (error.place, error.to_string());
            let arguments = quote_spanned!(end=> { #text });
            quote_spanned!(start=> ::core::compile_error! #arguments)
        };
        self.found.borrow().iter().map(error).collect()
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Diagnostics {
        Diagnostics { found: vec![diagnostic].into() }
    }
}

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.into_vec().into_iter()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, diagnostic) in self.found.borrow().iter().enumerate() {
            let separator = if position == 0 { "" } else { "\n\n" };
            let text = diagnostic.to_string().replace("\n\n", "\n").replace('\n', "\n       ");
            write!(f, "{separator}error: {text}")?;
        }
        Ok(())
    }
}

/// The candidate that a misspelt name most likely means.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let mut best = None;
    for candidate in candidates {
        best = nearer(name, candidate, best);
    }
    best.map(|(_, candidate)| candidate)
}

/// A candidate with its distance where a name may mean it rather than the best one before, else that one.
fn nearer<'a>(name: &str, candidate: &'a str, best: Option<(usize, &'a str)>) -> Option<(usize, &'a str)> {
    let allowed = (name.chars().count() / 3).max(1);
    let distance = edit_distance(&name.to_lowercase(), &candidate.to_lowercase());
    let is_meant = distance <= allowed && distance < candidate.chars().count();
    let is_nearer = best.is_none_or(|(least, _)| distance < least);
    if is_meant && is_nearer { Some((distance, candidate)) } else { best }
}

/// The name that another one means: its synonym, or one that is spelled nearly like it.
pub fn meant<'a>(name: &str, synonyms: &[(&str, &'a str)], all: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let synonym = synonyms.iter().find(|(other, _)| *other == name).map(|&(_, meant)| meant);
    synonym.or_else(|| nearest(name, all))
}

/// The number of insertions, deletions, replacements and swaps of neighbours that turn one word into the other.
fn edit_distance(left: &str, right: &str) -> usize {
    let (left, right): (Vec<char>, Vec<char>) = (left.chars().take(64).into_list(), right.chars().take(64).into_list());
    let mut rows = vec![(0..=right.len()).into_list()];
    for i in 1..=left.len() {
        let mut row = vec![i];
        for j in 1..=right.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(left[i - 1] != right[j - 1]);
            let mut best = replaced.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && left[i - 1] == right[j - 2] && left[i - 2] == right[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            row.push(best);
        }
        rows.push(row);
    }
    rows[left.len()][right.len()]
}
