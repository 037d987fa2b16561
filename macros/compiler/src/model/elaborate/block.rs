//! Blocks: `let`s, then a value.

use syn::{Block, Local, Stmt};

use super::super::scope::Binding;
use super::super::value::Value;
use super::Elaborator;
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::{Pattern, spell};

impl<'g> Elaborator<'_, '_, 'g> {
    /// The value of a block.
    pub(super) fn block(&mut self, block: &Block) -> Option<Value<'g>> {
        let mark = self.scope.mark();
        let value = self.statements(block);
        self.scope.release(mark);
        value
    }

    fn statements(&mut self, block: &Block) -> Option<Value<'g>> {
        let (last, before) = match block.stmts.split_last() {
            Some(parts) => parts,
            None => {
                return self.error(
                    Diagnostic::new(block.brace_token.span.join(), "this block is empty")
                        .help("end it with an expression"),
                );
            }
        };
        for statement in before {
            self.statement(statement);
        }
        match last {
            Stmt::Expr(value, None) => self.elaborate(value),
            Stmt::Macro(written) if written.semi_token.is_none() => self.macro_tokens(&written.mac),
            Stmt::Expr(value, Some(semicolon)) => {
                let error = Diagnostic::new(semicolon.span, "the block ends without a value");
                self.error(error.help(format!("remove the semicolon after `{}`", super::shortened(&spell(value)))))
            }
            other => {
                self.statement(other);
                self.error(
                    Diagnostic::new(Location::of(other), "the block ends without a value")
                        .help("end it with an expression"),
                )
            }
        }
    }

    pub(super) fn statement(&mut self, statement: &Stmt) {
        match statement {
            Stmt::Local(local) => self.local(local),
            other => {
                let error = Diagnostic::new(Location::of(other), "a block is `let`s and one value at its end");
                self.context.diagnostics.push(error.help("remove this statement, or give its value a name with `let`"));
            }
        }
    }

    fn local(&mut self, local: &Local) {
        let diagnostics = &mut self.context.diagnostics;
        let pattern = match &local.pat {
            syn::Pat::Type(typed) => {
                let error = Diagnostic::new(Location::of(&typed.ty), "a `let` has no type");
                diagnostics.push(error.help("remove it: the shape follows from the value"));
                Pattern::read(&typed.pat, diagnostics)
            }
            other => Pattern::read(other, diagnostics),
        };
        let value = match &local.init {
            Some(init) if init.diverge.is_none() => self.elaborate(&init.expr),
            _ => self.error(
                Diagnostic::new(Location::of(local), "a `let` has a value and no `else`")
                    .help("write `let name = value;`"),
            ),
        };
        if let Some(pattern) = pattern {
            self.bind(&pattern, value, "a `let`");
        }
    }

    /// Introduces the names of a pattern; those of a value with an error have an error too.
    pub(super) fn bind(&mut self, pattern: &Pattern, value: Option<Value<'g>>, what: &str) {
        let diagnostics = &mut self.context.diagnostics;
        match Binding::of(pattern, value, diagnostics) {
            Some(bindings) => bindings.into_iter().for_each(|binding| self.scope.add(binding, what, diagnostics)),
            None => {
                Binding::unknown(pattern).into_iter().for_each(|binding| self.scope.add(binding, what, diagnostics))
            }
        }
    }
}
