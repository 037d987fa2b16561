//! Closures as values of keys: arguments that are names or tuples of names, and a body.

use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::spanned::Spanned;
use syn::{Expr, ExprClosure, Pat, ReturnType, Type};

use super::spell_type;
use super::spelling::{spell, spell_pattern};
use crate::diagnostic::{Diagnostic, Diagnostics, Location};

/// A closure of the declaration.
#[derive(Clone)]
pub struct Closure {
    /// The key that it is the value of.
    pub key: Ident,
    /// Its arguments.
    pub arguments: Vec<Argument>,
    /// What is between the bars, bars included.
    pub head: Location,
    /// Its value.
    pub body: Expr,
}

/// An argument of a closure.
#[derive(Clone)]
pub struct Argument {
    /// The names that it introduces.
    pub pattern: Pattern,
    /// Its type, where it introduces a space.
    pub ty: Option<Type>,
}

/// Names, and tuples of them.
#[derive(Clone, Debug)]
pub enum Pattern {
    /// One name.
    Name(Ident),
    /// A tuple of patterns, and where it is.
    Tuple(Vec<Pattern>, Location),
}

impl Closure {
    /// Takes a closure apart; whatever is more than mathematics is an error.
    pub fn read(key: &Ident, closure: ExprClosure, diagnostics: &mut Diagnostics) -> Option<Closure> {
        let head = Location::between(closure.inputs_begin.span, closure.inputs_end.span);
        let plain = closure.attrs.is_empty()
            && closure.lifetimes.is_none()
            && closure.constness.is_none()
            && closure.asyncness.is_none()
            && closure.capture.is_none()
            && matches!(closure.output, ReturnType::Default);
        if !plain {
            let bare: Vec<String> = closure.inputs.iter().map(super::spelling::tokens).collect();
            let message = format!("the {key} is a plain closure, without `move`, `async` or a return type");
            diagnostics.push(Diagnostic::new(head, message).help(format!("write `|{}| …`", bare.join(", "))));
            return None;
        }
        let count = closure.inputs.len();
        let arguments: Vec<Argument> =
            closure.inputs.into_iter().filter_map(|input| Argument::read(input, diagnostics)).collect();
        let complete = arguments.len() == count;
        complete.then(|| Closure { key: key.clone(), arguments, head, body: *closure.body })
    }
}

impl Argument {
    fn read(input: Pat, diagnostics: &mut Diagnostics) -> Option<Argument> {
        match input {
            Pat::Type(typed) => {
                let pattern = Pattern::read(&typed.pat, diagnostics)?;
                Some(Argument { pattern, ty: Some(*typed.ty) })
            }
            other => Some(Argument { pattern: Pattern::read(&other, diagnostics)?, ty: None }),
        }
    }

    /// The text of the argument.
    pub fn spell(&self) -> String {
        match &self.ty {
            Some(ty) => format!("{}: {}", spell_pattern(&self.pattern), spell_type(ty)),
            None => spell_pattern(&self.pattern),
        }
    }
}

impl Pattern {
    /// Reads a pattern of names and tuples.
    pub(crate) fn read(pattern: &Pat, diagnostics: &mut Diagnostics) -> Option<Pattern> {
        match pattern {
            Pat::Ident(name) if name.by_ref.is_none() && name.mutability.is_none() && name.subpat.is_none() => {
                Some(Pattern::Name(name.ident.clone()))
            }
            Pat::Ident(name) => {
                let message = format!("`{}` is more than a name", super::spelling::tokens(pattern));
                diagnostics
                    .push(Diagnostic::new(Location::of(pattern), message).help(format!("write `{}`", name.ident)));
                None
            }
            Pat::Paren(inner) => Pattern::read(&inner.pat, diagnostics),
            Pat::Tuple(tuple) => {
                let parts: Vec<Pattern> =
                    tuple.elems.iter().filter_map(|part| Pattern::read(part, diagnostics)).collect();
                let complete = parts.len() == tuple.elems.len();
                complete.then(|| Pattern::Tuple(parts, Location::of(pattern)))
            }
            Pat::Reference(reference) => Pattern::read(&reference.pat, diagnostics),
            Pat::Wild(wild) => {
                let error = Diagnostic::new(wild.underscore_token.span, "an argument needs a name");
                diagnostics.push(error.note("the other closures call it by this name"));
                None
            }
            other => {
                let message = format!("`{}` is neither a name nor a tuple of names", super::spelling::tokens(other));
                diagnostics.push(Diagnostic::new(other.span(), message).help("write a name, or `(a, b)` for a pair"));
                None
            }
        }
    }

    /// All names in it, from left to right.
    pub fn names(&self) -> Vec<&Ident> {
        match self {
            Pattern::Name(ident) => vec![ident],
            Pattern::Tuple(parts, _) => parts.iter().flat_map(Pattern::names).collect(),
        }
    }

    /// Where it is.
    pub fn place(&self) -> Location {
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

    /// The text of the pattern.
    pub fn spell(&self) -> String {
        spell_pattern(self)
    }
}

impl Closure {
    /// The arguments with their bars, `|h, F|`.
    pub fn spell_head(&self) -> String {
        format!("|{}|", self.arguments.iter().map(Argument::spell).collect::<Vec<_>>().join(", "))
    }

    /// The whole closure.
    pub fn spell(&self) -> String {
        format!("{} {}", self.spell_head(), spell(&self.body))
    }
}
