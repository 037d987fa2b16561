//! Potentials that no expression holds: `opaque(Self::value, Self::gradient)`, two methods of the struct.

use proc_macro2::{Ident, Span};
use syn::parse::ParseStream;
use syn::{Expr, ExprPath, Path};

use super::spelling::{spell, tokens};
use super::values;
use crate::diagnostic::{Diagnostic, Location, bail, error};

/// A potential whose value and gradient are methods of the struct.
#[derive(Clone)]
pub struct Opaque {
    /// `Self::value`.
    pub value: Path,
    /// `Self::gradient`.
    pub gradient: Path,
    /// Whether both take the time as their first argument: `opaque(t, Self::value, Self::gradient)`.
    pub takes_time: bool,
    pub(crate) place: Location,
}

impl Opaque {
    pub(crate) fn spell(&self) -> String {
        let time = if self.takes_time { "t, " } else { "" };
        format!("opaque({time}{}, {})", tokens(&self.value), tokens(&self.gradient))
    }
}

/// Whether the next value is an opaque one.
pub(super) fn comes_next(stream: ParseStream) -> bool {
    stream.fork().parse::<Ident>().is_ok_and(|word| word == "opaque")
}

/// `opaque(Self::value, Self::gradient)`, for which the caller has looked.
pub(super) fn read(stream: ParseStream) -> Result<Opaque, Diagnostic> {
    let word: Ident = stream.parse()?;
    if !stream.peek(syn::token::Paren) {
        return Err(two_methods(word.span()));
    }
    let (arguments, span) = values::arguments(stream)?;
    let is_time = |expr: &Expr| matches!(expr, Expr::Path(path) if path.path.is_ident("t"));
    let takes_time = arguments.first().is_some_and(is_time);
    let [value, gradient] = &arguments[usize::from(takes_time)..] else { return Err(two_methods(span.join())) };
    let (value, gradient) = (method(value)?, method(gradient)?);
    Ok(Opaque { value, gradient, takes_time, place: Location { start: word.span(), end: span.close() } })
}

/// `Self::value`.
fn method(expr: &Expr) -> Result<Path, Diagnostic> {
    let last = match expr {
        Expr::Path(ExprPath { qself: None, path, .. })
            if path.segments.len() == 2 && path.segments[0].ident == "Self" =>
        {
            return Ok(path.clone());
        }
        Expr::Path(path) => path.path.segments.last().map(|segment| segment.ident.to_string()),
        Expr::Field(field) => Some(tokens(&field.member)),
        Expr::MethodCall(call) => Some(call.method.to_string()),
        _ => None,
    };
    bail!(expr, "`{}` is no method of the struct", spell(expr);
        help "write `Self::{}`", last.unwrap_or_else(|| "value".into()))
}

fn two_methods(place: Span) -> Diagnostic {
    error!(place, "an opaque potential is made of two methods, its value and its gradient";
        help "write `opaque(Self::value, Self::gradient)`, or `opaque(t, Self::value, Self::gradient)` where both take the time first")
}
