//! Rust that is no mathematics, refused by name.

use syn::Expr as Syntax;

use super::super::value::Value;
use super::Elaborator;
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::spell;

impl<'g> Elaborator<'_, '_, 'g> {
    /// The error for an expression that no closure can hold.
    pub(super) fn refused(&mut self, syntax: &Syntax) -> Option<Value<'g>> {
        let (what, help) = describe(syntax);
        let error = Diagnostic::new(place(syntax), format!("{what} cannot stand in the {}", self.key));
        let error = error.maybe_help(help);
        self.error(error.note("a closure is one formula: it is differentiated, not run"))
    }
}

fn describe(syntax: &Syntax) -> (&'static str, Option<String>) {
    let help = |text: &str| Some(text.to_string());
    match syntax {
        Syntax::If(_) => ("`if`", help("write one formula that holds everywhere, smooth where the cases meet")),
        Syntax::Match(_) => ("`match`", help("write one formula that holds everywhere")),
        Syntax::ForLoop(_) => ("`for`", help("write a sum, `(0..3).map(|i| …).sum()`")),
        Syntax::While(_) => ("`while`", None),
        Syntax::Loop(_) => ("`loop`", None),
        Syntax::Cast(cast) => ("`as`", Some(format!("write `{}`: numbers mix freely", spell(&cast.expr)))),
        Syntax::Return(_) => ("`return`", help("end the block with its value")),
        Syntax::Break(_) => ("`break`", None),
        Syntax::Continue(_) => ("`continue`", None),
        Syntax::Closure(_) => ("a closure", help("closures stand only in `.map(|i| …)`")),
        Syntax::Assign(_) => ("an assignment", help("give the new value a name with `let`")),
        Syntax::Try(_) => ("`?`", None),
        Syntax::Await(_) | Syntax::Async(_) => ("`async`", None),
        Syntax::Unsafe(_) => ("`unsafe`", None),
        Syntax::Struct(_) => ("a struct", help("write a vector, `vector![a, b, c]`")),
        Syntax::Reference(_) => ("`&mut`", help("remove it: every value is copied")),
        Syntax::Block(_) => ("a labelled block", None),
        Syntax::Let(_) => ("a condition", None),
        Syntax::Infer(_) => ("`_`", None),
        _ => ("this expression", None),
    }
}

/// The keyword, where there is one.
fn place(syntax: &Syntax) -> Location {
    match syntax {
        Syntax::If(inner) => inner.if_token.span.into(),
        Syntax::Match(inner) => inner.match_token.span.into(),
        Syntax::ForLoop(inner) => inner.for_token.span.into(),
        Syntax::While(inner) => inner.while_token.span.into(),
        Syntax::Loop(inner) => inner.loop_token.span.into(),
        Syntax::Cast(inner) => Location::between(inner.as_token.span, Location::of(&inner.ty).start()),
        Syntax::Return(inner) => inner.return_token.span.into(),
        Syntax::Try(inner) => inner.question_token.span.into(),
        other => Location::of(other),
    }
}
