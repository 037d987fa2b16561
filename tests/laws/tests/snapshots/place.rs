//! Where an error is, as rustc would underline it.

use std::fmt::Write;

use proc_macro2::{LineColumn, TokenStream, TokenTree};

/// From the first to behind the last character.
#[derive(Debug)]
pub struct Place {
    start: LineColumn,
    end: LineColumn,
}

impl Place {
    /// The place of tokens.
    pub fn of(tokens: TokenStream) -> Place {
        let spans: Vec<_> = tokens.into_iter().map(|token| token.span()).collect();
        Place { start: spans[0].start(), end: spans[spans.len() - 1].end() }
    }

    /// Whether it lies in another place and holds something.
    pub fn is_inside(&self, whole: &Place) -> bool {
        whole.start <= self.start && self.start < self.end && self.end <= whole.end
    }

    /// Its lines of the source, underlined.
    pub fn marked(&self, source: &str) -> String {
        let mut text = format!("{}:{}\n", self.start.line, self.start.column + 1);
        for (number, line) in
            source.lines().enumerate().skip(self.start.line - 1).take(self.end.line + 1 - self.start.line)
        {
            let indent = line.chars().take_while(|character| character.is_whitespace()).count();
            let first = if number + 1 == self.start.line { self.start.column } else { indent };
            let last = if number + 1 == self.end.line { self.end.column } else { line.chars().count() };
            // by construction: writing to a string does not fail
            let _ = writeln!(text, "| {line}\n| {:first$}{}", "", "^".repeat(last.saturating_sub(first)));
        }
        text
    }
}

/// The places of `compile_error!`s: rustc underlines from their first to their last token.
pub fn places(errors: TokenStream) -> Vec<Place> {
    let mut places = Vec::new();
    let mut pending = TokenStream::new();
    for token in errors {
        let is_last = matches!(token, TokenTree::Group(_));
        pending.extend([token]);
        if is_last {
            places.push(Place::of(std::mem::take(&mut pending)));
        }
    }
    places
}
