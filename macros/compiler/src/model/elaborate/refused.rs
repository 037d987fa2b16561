//! Rust that is no mathematics, refused by name.

use proc_macro2::Span;
use syn::Expr as Syntax;

use super::{Elaborator, Value};
use crate::diagnostic::{Location, error};
use crate::parse::spell;

impl<'g> Elaborator<'_, '_, 'g> {
    /// The error for an expression that no closure can hold.
    pub(super) fn refused(&mut self, syntax: &Syntax) -> Option<Value<'g>> {
        let (place, what, help) = describe(syntax);
        let error = error!(place, "{what} cannot stand in the {}", self.key);
        let error = if help.is_empty() { error } else { error.help(help) };
        self.refuse(error.note("a closure is one formula: it is differentiated, not run"))
    }
}

/// Where an expression is, by its keyword if it has one, what it is, and what to write instead.
fn describe(syntax: &Syntax) -> (Location, &'static str, String) {
    let at = |span: Span, what, help: &str| (span.into(), what, help.to_string());
    let whole = |what, help: &str| (Location::of(syntax), what, help.to_string());
    match syntax {
        Syntax::If(inner) => {
            at(inner.if_token.span, "`if`", "write one formula that holds everywhere, smooth where the cases meet")
        }
        Syntax::Match(inner) => at(inner.match_token.span, "`match`", "write one formula that holds everywhere"),
        Syntax::ForLoop(inner) => at(inner.for_token.span, "`for`", "write a sum, `(0..3).map(|i| …).sum()`"),
        Syntax::While(inner) => at(inner.while_token.span, "`while`", ""),
        Syntax::Loop(inner) => at(inner.loop_token.span, "`loop`", ""),
        Syntax::Cast(inner) => {
            let place = Location::between(inner.as_token.span, Location::of(&inner.ty).start());
            (place, "`as`", format!("write `{}`: numbers mix freely", spell(&inner.expr)))
        }
        Syntax::Return(inner) => at(inner.return_token.span, "`return`", "end the block with its value"),
        Syntax::Try(inner) => at(inner.question_token.span, "`?`", ""),
        Syntax::Break(_) => whole("`break`", ""),
        Syntax::Continue(_) => whole("`continue`", ""),
        Syntax::Closure(_) => whole("a closure", "closures stand only in `.map(|i| …)`"),
        Syntax::Assign(_) => whole("an assignment", "give the new value a name with `let`"),
        Syntax::Await(_) | Syntax::Async(_) => whole("`async`", ""),
        Syntax::Unsafe(_) => whole("`unsafe`", ""),
        Syntax::Struct(_) => whole("a struct", "write a vector, `vector![a, b, c]`"),
        Syntax::Reference(_) => whole("`&mut`", "remove it: every value is copied"),
        Syntax::Block(_) => whole("a labelled block", ""),
        Syntax::Let(_) => whole("a condition", ""),
        Syntax::Infer(_) => whole("`_`", ""),
        _ => whole("this expression", ""),
    }
}
