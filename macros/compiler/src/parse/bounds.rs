//! Limits on the size of a declaration, checked before anything recurses: for any tokens at all the compiler must come to an end.
//!
//! Parsers recurse into brackets, and behind operators in front of operands. The parsed expression is as deep as chains
//! of operators are long. All levels from the item to any of its tokens have to fit into the two megabytes of stack
//! that threads have. This must hold where neither syn nor this compiler is optimised too: there a bracket in a type
//! takes 35 kilobytes.

use proc_macro2::{Spacing, Span, TokenStream, TokenTree};

use crate::diagnostic::{Diagnostics, bail, error};

/// Levels of brackets and of operators in front of their operands, in the stack that [`LEVEL`] stands for.
const DEPTH: usize = 41;
/// The weight of a level, in half kilobytes of stack.
const LEVEL: usize = 72;
/// The weight of a token in a chain of operators or methods.
const LINK: usize = 1;
/// Tokens between two separators at one level.
const RUN: usize = 2000;
/// Characters of a number: syn reads it digit by digit with all digits before.
const DIGITS: usize = 500;
/// Tokens of the item.
const TOTAL: usize = 60_000;

/// Refuses items that are nested too deeply or too long to be read.
pub fn check(item: &TokenStream) -> Result<(), Diagnostics> {
    let mut pending: Vec<(TokenStream, usize)> = vec![(item.clone(), 0)];
    let mut total = 0;
    while let Some((stream, outside)) = pending.pop() {
        let mut run = Run::default();
        for token in stream {
            total += 1;
            if total > TOTAL {
                return Err(too("long", token.span(), format!("more than {TOTAL} tokens")));
            }
            if matches!(&token, TokenTree::Punct(mark) if matches!(mark.as_char(), ',' | ';' | '#')) {
                run.end(outside, &mut pending);
                continue;
            }
            run.add(&token, outside)?;
        }
        run.end(outside, &mut pending);
    }
    Ok(())
}

fn too(what: &str, span: Span, how: String) -> Diagnostics {
    let error = error!(span, "the declaration is too {what} to be read: {how}";
        help "give names to its parts with `let`, or sum over a range with `(0..n).map(|i| …).sum()`");
    error.into()
}

/// The tokens since the last separator.
#[derive(Default)]
struct Run {
    length: usize,
    /// Levels that last to the end of the run.
    lasting: usize,
    /// `<` without their `>`.
    angles: usize,
    /// Operators without an operand between them.
    prefixes: usize,
    last: Option<char>,
    /// The tokens in brackets, with the levels on the way to them.
    groups: Vec<(TokenStream, usize)>,
}

impl Run {
    fn add(&mut self, token: &TokenTree, outside: usize) -> Result<(), Diagnostics> {
        self.length += 1;
        if let TokenTree::Literal(literal) = token
            && literal.to_string().len() > DIGITS
            && literal.to_string().starts_with(|first: char| first.is_ascii_digit())
        {
            bail!(token, "this number is beyond the range of `f64`: it has more than {DIGITS} digits";
                help "round it, and write it with an exponent, as in `6.674e-11`");
        }
        if self.length > RUN {
            return Err(too("long", token.span(), format!("more than {RUN} tokens in one expression")));
        }
        self.open(token);
        let levels = self.lasting + self.angles + self.prefixes;
        if !matches!(token, TokenTree::Punct(_)) {
            self.prefixes = 0;
        }
        if let TokenTree::Group(group) = token {
            self.groups.push((group.stream(), levels + 1));
        }
        let inside = usize::from(matches!(token, TokenTree::Group(_)));
        if outside + (levels + inside) * LEVEL + self.length * LINK <= DEPTH * LEVEL {
            return Ok(());
        }
        let how = "levels deep, or fewer with long chains of operators on the way";
        Err(too("deep", token.span(), format!("brackets and operators nest {DEPTH} {how}")))
    }

    /// Counts the levels of the grammar that a token may start and that no bracket marks.
    fn open(&mut self, token: &TokenTree) {
        const WORDS: [&str; 22] = [
            "return", "break", "yield", "if", "else", "match", "while", "for", "loop", "unsafe", "async", "const",
            "move", "static", "let", "as", "fn", "impl", "dyn", "mut", "ref", "box",
        ];
        let after_operator = self.last.is_some_and(|last| last != '.');
        let TokenTree::Punct(punct) = token else {
            let is_word = matches!(token, TokenTree::Ident(word) if WORDS.iter().any(|known| word == known));
            self.lasting += usize::from(is_word);
            self.last = None;
            return;
        };
        match punct.as_char() {
            '<' => self.angles += 1,
            '>' if matches!(self.last, Some('-' | '=')) => {}
            '>' => self.angles = self.angles.saturating_sub(1),
            '|' | '=' | '@' => self.lasting += 1,
            '.' => self.lasting += usize::from(punct.spacing() == Spacing::Joint),
            _ => self.prefixes += usize::from(after_operator),
        }
        self.last = Some(punct.as_char());
    }

    /// Passes on the tokens in brackets, with the depth of the complete run, and starts anew.
    fn end(&mut self, outside: usize, pending: &mut Vec<(TokenStream, usize)>) {
        let run = std::mem::take(self);
        let chain = outside + run.length * LINK;
        pending.extend(run.groups.into_iter().map(|(stream, levels)| (stream, chain + levels * LEVEL)));
    }
}
