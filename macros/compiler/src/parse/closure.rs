//! Closures as values of keys: arguments that are names or tuples of names, and a body.

use clebsch_symbolic::IntoList;
use proc_macro2::{Ident, TokenTree};
use quote::ToTokens;
use syn::ext::IdentExt;
use syn::parse::ParseStream;
use syn::spanned::Spanned;
use syn::{Expr, ExprClosure, Pat, ReturnType, Token, Type};

use super::spell_type;
use super::spelling::{joined, spell, tokens};
use crate::diagnostic::{Diagnostic, Diagnostics, Location, error, refuse};

/// A closure of the declaration.
#[derive(Clone)]
pub struct Closure {
    /// The key that it is the value of.
    pub key: Ident,
    pub(crate) arguments: Vec<Argument>,
    /// The tokens between the bars, bars included.
    pub head: Location,
    pub(crate) body: Expr,
}

/// An argument of a closure.
#[derive(Clone)]
pub struct Argument {
    /// The names that it introduces.
    pub pattern: Pattern,
    /// Its type, where it introduces a space.
    pub ty: Option<Type>,
    /// Its type as it was written, where another closure introduces the space.
    pub written: Option<Type>,
}

/// Names, and tuples of them.
#[derive(Clone, Debug)]
pub enum Pattern {
    /// One name.
    Name(Ident),
    /// A tuple of patterns, and where it is.
    Tuple(Vec<Pattern>, Location),
}

/// Reads the syntax of a closure. Where its mistake is one of mathematicians, the error says how Rust writes it.
pub(super) fn parse(stream: ParseStream) -> Result<ExprClosure, Diagnostic> {
    let start = stream.fork();
    stream.parse().map_err(|error| {
        if let Some(word) = keyword(&start) {
            return error!(&word, "`{word}` is a word of Rust and cannot be a name"; help "choose another name");
        }
        if error.to_string().contains("cannot be chained") {
            return error!(error.span(), "comparisons cannot be chained";
                help "write two of them, as in `[a <= x, x <= b]` or `[a == b, b == c]`");
        }
        Diagnostic::from(error)
    })
}

/// The first argument whose name is a word of Rust.
fn keyword(stream: ParseStream) -> Option<Ident> {
    let mut is_name = stream.parse::<Token![|]>().is_ok();
    while !stream.is_empty() && !stream.peek(Token![|]) {
        let token = stream.parse::<TokenTree>().ok()?;
        match token {
            TokenTree::Ident(word) if is_name && syn::parse2::<Ident>(word.to_token_stream()).is_err() => {
                let is_part = ["_", "mut", "ref", "self"].iter().any(|part| word == part);
                return Some(word).filter(|_| !is_part);
            }
            TokenTree::Punct(mark) => is_name = mark.as_char() == ',',
            _ => is_name = false,
        }
    }
    None
}

impl Closure {
    /// Takes a closure apart; whatever is more than mathematics is an error.
    pub fn read(key: &Ident, closure: ExprClosure, diagnostics: &Diagnostics) -> Option<Closure> {
        let head = Location { start: closure.inputs_begin.span, end: closure.inputs_end.span };
        let plain = closure.attrs.is_empty()
            && closure.lifetimes.is_none()
            && closure.constness.is_none()
            && closure.asyncness.is_none()
            && closure.capture.is_none()
            && matches!(closure.output, ReturnType::Default);
        if !plain {
            refuse!(diagnostics, head, "the {key} is a plain closure, without `move`, `async` or a return type";
                help "write `|{}| …`", joined(closure.inputs.iter().map(tokens)));
        }
        let mut arguments = Vec::new();
        for input in &closure.inputs {
            let (pattern, ty) = match input {
                Pat::Type(typed) => (&*typed.pat, Some(*typed.ty.clone())),
                other => (other, None),
            };
            arguments.extend(Pattern::read(pattern, diagnostics).map(|pattern| Argument {
                pattern,
                ty,
                written: None,
            }));
        }
        let is_readable = arguments.len() == closure.inputs.len();
        is_readable.then(|| Closure { key: key.clone(), arguments, head, body: *closure.body })
    }

    pub(crate) fn spell(&self) -> String {
        format!("|{}| {}", joined(self.arguments.iter().map(Argument::spell)), spell(&self.body))
    }
}

impl Argument {
    pub(crate) fn spell(&self) -> String {
        let ty =
            self.ty.as_ref().or(self.written.as_ref()).map(|ty| format!(": {}", spell_type(ty))).unwrap_or_default();
        self.pattern.spell() + &ty
    }
}

impl Pattern {
    /// Reads a pattern of names and tuples.
    pub(crate) fn read(pattern: &Pat, diagnostics: &Diagnostics) -> Option<Pattern> {
        match pattern {
            Pat::Ident(name) if name.by_ref.is_none() && name.mutability.is_none() && name.subpat.is_none() => {
                Some(Pattern::Name(name.ident.clone()))
            }
            Pat::Ident(name) => refuse!(diagnostics, pattern, "`{}` is more than a name", tokens(pattern);
                help "write `{}`", name.ident),
            Pat::Paren(inner) => Pattern::read(&inner.pat, diagnostics),
            Pat::Tuple(tuple) => {
                let parts: Vec<_> = tuple.elems.iter().map(|part| Pattern::read(part, diagnostics)).into_list();
                Some(Pattern::Tuple(parts.into_iter().collect::<Option<_>>()?, Location::from(pattern)))
            }
            Pat::Reference(reference) => Pattern::read(&reference.pat, diagnostics),
            Pat::Wild(wild) => refuse!(diagnostics, wild.underscore_token.span, "an argument needs a name";
                note "the other closures call it by this name"),
            other => refuse!(diagnostics, other.span(), "`{}` is neither a name nor a tuple of names", tokens(other);
                help "write a name, or `(a, b)` for a pair"),
        }
    }

    /// All names in it, from left to right.
    pub fn names(&self) -> Vec<&Ident> {
        match self {
            Pattern::Name(ident) => vec![ident],
            Pattern::Tuple(parts, _) => parts.iter().flat_map(Pattern::names).into_list(),
        }
    }

    pub(crate) fn place(&self) -> Location {
        match self {
            Pattern::Name(ident) => ident.span().into(),
            Pattern::Tuple(_, place) => *place,
        }
    }

    /// Whether two patterns have the same names in the same places.
    pub fn matches(&self, other: &Pattern) -> bool {
        match (self, other) {
            (Pattern::Name(left), Pattern::Name(right)) => left.unraw() == right.unraw(),
            (Pattern::Tuple(left, _), Pattern::Tuple(right, _)) => {
                left.len() == right.len() && left.iter().zip(right).all(|(left, right)| left.matches(right))
            }
            _ => false,
        }
    }

    /// Whether another pattern is this one, or a part of this tuple.
    pub fn holds(&self, other: &Pattern) -> bool {
        self.matches(other) || matches!(self, Pattern::Tuple(parts, _) if parts.iter().any(|part| part.holds(other)))
    }

    pub(crate) fn spell(&self) -> String {
        match self {
            Pattern::Name(ident) => ident.to_string(),
            Pattern::Tuple(parts, _) => format!("({})", joined(parts.iter().map(Pattern::spell))),
        }
    }
}
