//! Limits on the size of a declaration, checked before anything recurses: for any tokens at all the compiler must come to an end.

use proc_macro2::{Spacing, Span, TokenStream, TokenTree};

use crate::diagnostic::{Diagnostic, Diagnostics};

/// Brackets inside brackets.
const DEPTH: usize = 64;
/// Tokens between two separators at one level, which bounds the length of chains of operators and methods.
const RUN: usize = 2000;
/// Tokens of one kind in such a run that open a new level of the grammar without a bracket.
const OPENERS: usize = 100;
/// Tokens of the whole item.
const TOTAL: usize = 60_000;

/// Refuses items that are nested too deeply or too long to be read.
pub fn check(item: &TokenStream) -> Result<(), Diagnostics> {
    let mut pending: Vec<(TokenStream, usize)> = vec![(item.clone(), 0)];
    let mut total = 0;
    while let Some((stream, depth)) = pending.pop() {
        let mut run = Run::default();
        for token in stream {
            total += 1;
            let span = token.span();
            if total > TOTAL {
                return Err(too("long", span, format!("more than {TOTAL} tokens")));
            }
            run.add(&token)?;
            if let TokenTree::Group(group) = token {
                if depth == DEPTH {
                    return Err(too("deep", span, format!("more than {DEPTH} brackets inside each other")));
                }
                pending.push((group.stream(), depth + 1));
            }
        }
    }
    Ok(())
}

fn too(what: &str, span: Span, how: String) -> Diagnostics {
    Diagnostic::new(span, format!("the declaration is too {what} to be read: {how}"))
        .help("give names to its parts with `let`, or sum over a range with `(0..n).map(|i| …).sum()`")
        .into()
}

/// The tokens since the last separator.
#[derive(Default)]
struct Run {
    length: usize,
    openers: usize,
    after_operator: bool,
}

impl Run {
    fn add(&mut self, token: &TokenTree) -> Result<(), Diagnostics> {
        let separator = matches!(token, TokenTree::Punct(punct) if matches!(punct.as_char(), ',' | ';' | '#'));
        if separator {
            *self = Run::default();
            return Ok(());
        }
        self.length += 1;
        self.openers += usize::from(self.opens(token));
        self.after_operator = matches!(token, TokenTree::Punct(punct) if punct.as_char() != '.');
        match (self.length > RUN, self.openers > OPENERS) {
            (true, _) => Err(too("long", token.span(), format!("more than {RUN} tokens in one expression"))),
            (_, true) => Err(too("deep", token.span(), format!("more than {OPENERS} operators that nest"))),
            _ => Ok(()),
        }
    }

    /// Whether a token may start a level of the grammar that its end does not mark.
    fn opens(&self, token: &TokenTree) -> bool {
        const WORDS: [&str; 22] = [
            "return", "break", "yield", "if", "else", "match", "while", "for", "loop", "unsafe", "async", "const",
            "move", "static", "let", "as", "fn", "impl", "dyn", "mut", "ref", "box",
        ];
        match token {
            TokenTree::Punct(punct) => match punct.as_char() {
                '|' | '<' | '=' | '@' => true,
                '.' => punct.spacing() == Spacing::Joint,
                _ => self.after_operator,
            },
            TokenTree::Ident(ident) => WORDS.iter().any(|word| ident == word),
            _ => false,
        }
    }
}
