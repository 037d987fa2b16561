//! Mistakes with their places in the text of the user.

use clebsch_compiler::diagnostic::{Diagnostic, Diagnostics};
use proc_macro2::Span;
use pyo3::prelude::*;

/// A mistake: its text, and its first and last letter.
#[derive(Clone, Debug, IntoPyObject)]
pub struct Mistake {
    /// The message, its help and its notes.
    pub message: String,
    /// Line and column of the first letter.
    pub start: (usize, usize),
    /// Line and column behind the last letter.
    pub end: (usize, usize),
}

impl Mistake {
    /// A mistake at a place.
    pub fn new(message: impl ToString, first: Span, last: Span) -> Self {
        let (start, end) = (first.start(), last.end());
        Self { message: message.to_string(), start: (start.line, start.column), end: (end.line, end.column) }
    }

    /// A panic of the compiler.
    pub fn bug() -> Self {
        let message = "the compiler of clebsch panicked\n\nhelp: please report this declaration";
        Self::new(message, Span::call_site(), Span::call_site())
    }
}

impl From<Diagnostic> for Mistake {
    fn from(diagnostic: Diagnostic) -> Self {
        let place = diagnostic.place();
        Self::new(diagnostic, place.start(), place.end())
    }
}

impl From<syn::Error> for Mistake {
    fn from(error: syn::Error) -> Self {
        Self::new(&error, error.span(), error.span())
    }
}

/// The mistakes that a stage found.
pub fn all(diagnostics: Diagnostics) -> Vec<Mistake> {
    diagnostics.into_iter().map(Mistake::from).collect()
}
