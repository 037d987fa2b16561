//! Blocks: `let`s, then a value; or an equation `a == b`, which stands only where a key asks for one.

use clebsch_symbolic::IntoList;
use syn::{BinOp, Block, Expr as Syntax, Local, Stmt};

use super::super::scope::bindings;
use super::errors::is_assignment;
use super::{Elaborator, Value};
use crate::diagnostic::{error, refuse, report};
use crate::parse::{Pattern, shortened, spell_tokens};

/// The loop or the assignment that a statement is.
fn imperative(statement: &Stmt) -> Option<&Syntax> {
    let Stmt::Expr(syntax, _) = statement else { return None };
    let is_loop = matches!(syntax, Syntax::ForLoop(_) | Syntax::While(_) | Syntax::Loop(_) | Syntax::Assign(_));
    (is_loop || is_assignment(syntax)).then_some(syntax)
}

impl<'g> Elaborator<'_, '_, 'g> {
    /// Does something after which the names that it introduces are forgotten.
    pub(super) fn with_names<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let known = self.scope.names.len();
        let value = work(self);
        self.scope.names.truncate(known);
        value
    }

    pub(super) fn statements(&mut self, block: &Block) -> Option<Value<'g>> {
        let Some((last, before)) = block.stmts.split_last() else {
            refuse!(self, block.brace_token.span.join(), "this block is empty"; help "end it with an expression");
        };
        if let Some(imperative) = block.stmts.iter().find_map(imperative) {
            // the names that it changes have no meaning either
            return self.refused(imperative);
        }
        before.iter().for_each(|statement| self.statement(statement));
        match last {
            Stmt::Expr(value, None) => self.elaborate(value),
            Stmt::Macro(written) if written.semi_token.is_none() => self.macro_call(&written.mac),
            Stmt::Expr(Syntax::Return(inner), _) if inner.expr.is_some() => {
                let value = inner.expr.as_ref().map(|value| shortened(value)).unwrap_or_default();
                refuse!(self, inner.return_token.span, "`return` cannot stand in the {}", self.key;
                    help "end the block with its value: write `{value}`, without `return` and `;`")
            }
            Stmt::Expr(value, Some(semicolon)) => refuse!(self, semicolon.span, "the block ends without a value";
                help "remove the semicolon after `{}`", shortened(value)),
            other => {
                self.statement(other);
                refuse!(self, other, "the block ends without a value"; help "end it with an expression")
            }
        }
    }

    fn statement(&mut self, statement: &Stmt) {
        match statement {
            Stmt::Local(local) => self.local(local),
            other => report!(self.context.diagnostics, other, "a block is `let`s and one value at its end";
                help "remove this statement, or give its value a name with `let`"),
        }
    }

    fn local(&mut self, local: &Local) {
        let diagnostics = self.context.diagnostics;
        let mut pattern = &local.pat;
        if let syn::Pat::Type(typed) = pattern {
            report!(diagnostics, &typed.ty, "a `let` has no type"; help "remove it: the shape follows from the value");
            pattern = &typed.pat;
        }
        let value = match &local.init {
            Some(init) if init.diverge.is_none() => self.elaborate(&init.expr),
            _ => {
                diagnostics.refuse(error!(local, "a `let` has a value and no `else`"; help "write `let name = value;`"))
            }
        };
        self.bind_parts(pattern, value);
    }

    /// Introduces the names of a pattern: a name, a tuple, or `[a, b]` of an array.
    fn bind_parts(&mut self, pattern: &syn::Pat, value: Option<Value<'g>>) {
        let diagnostics = self.context.diagnostics;
        let syn::Pat::Slice(slice) = pattern else {
            if let Some(pattern) = Pattern::read(pattern, diagnostics) {
                self.bind(&pattern, value, "a `let`");
            }
            return;
        };
        let parts = match value {
            Some(Value::Array(parts)) if parts.len() == slice.elems.len() => parts.into_iter().map(Some).into_list(),
            other => {
                if let Some(value) = other {
                    report!(diagnostics, slice, "`{}` does not fit {}", spell_tokens(slice), value.describe();
                        help "write as many names as the array has parts, or one for all");
                }
                vec![None; slice.elems.len()]
            }
        };
        for (pattern, value) in slice.elems.iter().zip(parts) {
            self.bind_parts(pattern, value);
        }
    }

    /// Introduces the names of a pattern; those of a value with an error have an error too.
    pub(super) fn bind(&mut self, pattern: &Pattern, value: Option<Value<'g>>, what: &str) {
        let diagnostics = self.context.diagnostics;
        for (ident, value) in bindings(pattern, value, diagnostics) {
            self.scope.add(&ident, value, what, diagnostics);
        }
    }

    /// Does something with the names of the `let`s of a body that is a block.
    pub fn in_block<T>(&mut self, syntax: &Syntax, work: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        match syntax {
            Syntax::Paren(inner) => self.in_block(&inner.expr, work),
            Syntax::Group(inner) => self.in_block(&inner.expr, work),
            Syntax::Block(block) if block.label.is_none() => {
                let Some((Stmt::Expr(last, None), before)) = block.block.stmts.split_last() else { return work(self) };
                self.with_names(|this| {
                    before.iter().for_each(|statement| this.statement(statement));
                    this.in_block(last, work)
                })
            }
            _ => work(self),
        }
    }

    /// Both sides of the equation that a body ends with.
    pub fn equation(&mut self, syntax: &Syntax) -> Option<(Value<'g>, Value<'g>)> {
        match syntax {
            Syntax::Paren(inner) => self.equation(&inner.expr),
            Syntax::Group(inner) => self.equation(&inner.expr),
            Syntax::Block(block) if block.label.is_none() => {
                let Some((Stmt::Expr(last, None), before)) = block.block.stmts.split_last() else {
                    refuse!(self, block, "the block ends without an equation"; help "end it with `a == b`");
                };
                self.with_names(|this| {
                    before.iter().for_each(|statement| this.statement(statement));
                    this.equation(last)
                })
            }
            Syntax::Binary(link) if matches!(link.op, BinOp::Eq(_)) => {
                let left = self.elaborate(&link.left);
                let right = self.elaborate(&link.right);
                left.zip(right)
            }
            other => {
                let is_chain = matches!(other, Syntax::Binary(link) if matches!(link.op, BinOp::And(_)));
                let equation = if is_chain { "several equations as one, `(a, b) == (c, d)`" } else { "`a == b`" };
                refuse!(self, other, "`{}` is no equation", shortened(other); help "write {equation}")
            }
        }
    }
}
