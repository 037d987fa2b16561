//! Equations, which stand only where a key asks for one: `a == b` at the end of a body.

use syn::{BinOp, Expr as Syntax, ExprBlock, Stmt};

use super::super::value::Value;
use super::Elaborator;
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::spell;

impl<'g> Elaborator<'_, '_, 'g> {
    /// Both sides of the equation that a body ends with.
    pub fn equation(&mut self, syntax: &Syntax) -> Option<(Value<'g>, Value<'g>)> {
        match syntax {
            Syntax::Paren(inner) => self.equation(&inner.expr),
            Syntax::Group(inner) => self.equation(&inner.expr),
            Syntax::Block(block) if block.label.is_none() => self.equation_of_block(block),
            Syntax::Binary(link) if matches!(link.op, BinOp::Eq(_)) => {
                let left = self.elaborate(&link.left);
                let right = self.elaborate(&link.right);
                left.zip(right)
            }
            other => {
                let text = super::shortened(&spell(other));
                let error = Diagnostic::new(Location::of(other), format!("`{text}` is no equation"));
                self.error(match other {
                    Syntax::Binary(link) if matches!(link.op, BinOp::And(_)) => {
                        error.help("write several equations as one, `(a, b) == (c, d)`")
                    }
                    _ => error.help("write `a == b`"),
                })
            }
        }
    }

    fn equation_of_block(&mut self, block: &ExprBlock) -> Option<(Value<'g>, Value<'g>)> {
        let Some((Stmt::Expr(last, None), before)) = block.block.stmts.split_last() else {
            let error = Diagnostic::new(Location::of(block), "the block ends without an equation");
            return self.error(error.help("end it with `a == b`"));
        };
        let mark = self.scope.mark();
        before.iter().for_each(|statement| self.statement(statement));
        let sides = self.equation(last);
        self.scope.release(mark);
        sides
    }
}
