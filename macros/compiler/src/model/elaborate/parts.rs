//! Rows, columns and blocks: `row(0)`, `fixed_view::<2, 2>(0, 0)`, `xyz()`.

use clebsch_symbolic::{Expr, Shape};
use syn::{Expr as Syntax, ExprMethodCall, GenericArgument, Generics};

use super::super::sizes::size_argument;
use super::super::value::Value;
use super::tables::Special;
use super::{Elaborator, Growth};
use crate::diagnostic::Diagnostic;
use crate::parse::spell;

impl<'g> Elaborator<'_, '_, 'g> {
    /// Rows, columns, blocks.
    pub(super) fn part(&mut self, special: Special, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let Shape { rows, columns } = a.shape();
        let name = call.method.to_string();
        let sizes = self.turbofish(special, call)?;
        let size = |position: usize| sizes.get(position).copied().unwrap_or(1);
        let shape = match special {
            Special::Row => Shape::new(1, columns),
            Special::Column => Shape::new(rows, 1),
            Special::FixedRows => Shape::new(size(0), columns),
            Special::FixedColumns => Shape::new(rows, size(0)),
            Special::FixedView => Shape::new(size(0), size(1)),
            Special::FirstTwo => Shape::vector(2),
            _ => Shape::vector(3),
        };
        if shape.rows > rows
            || shape.columns > columns
            || (columns > 1 && matches!(special, Special::FirstTwo | Special::FirstThree))
        {
            let message = format!("`{}` is {}: `{name}` is {shape}", spell(&call.receiver), a.shape());
            return self.error(Diagnostic::new(call.method.span(), message).note("a part lies inside of the whole"));
        }
        let of = format!("the starts of `{name}` in `{}`", spell(&call.receiver));
        let (row, column) = match special {
            Special::Row | Special::FixedRows => (self.start(&call.args[0], rows - shape.rows, &of)?, 0),
            Special::Column | Special::FixedColumns => (0, self.start(&call.args[0], columns - shape.columns, &of)?),
            Special::FixedView => {
                let row = self.start(&call.args[0], rows - shape.rows, &of);
                let column = self.start(&call.args[1], columns - shape.columns, &of);
                row.zip(column)?
            }
            _ => (0, 0),
        };
        self.build(call, &[a], Growth::Sum, || a.block(row, column, shape)).map(Value::Matrix)
    }

    fn start(&mut self, syntax: &Syntax, last: usize, of: &str) -> Option<usize> {
        self.position(syntax, last + 1, of)
    }

    /// The sizes in `fixed_view::<2, 2>`.
    fn turbofish(&mut self, special: Special, call: &ExprMethodCall) -> Option<Vec<usize>> {
        let expected = match special {
            Special::FixedRows | Special::FixedColumns => 1,
            Special::FixedView => 2,
            _ => 0,
        };
        let given: Vec<&GenericArgument> = call.turbofish.iter().flat_map(|turbofish| turbofish.args.iter()).collect();
        if given.len() != expected {
            let sizes = ["", "::<2>", "::<2, 2>"][expected];
            let error = Diagnostic::new(call.method.span(), format!("`{}` needs {expected} sizes", call.method));
            return self.error(error.help(format!("write `{}{sizes}(…)`", call.method)));
        }
        let mut sizes = Vec::new();
        for argument in given {
            match size_argument(argument, &Generics::default()) {
                Ok(size) => sizes.push(size),
                Err(error) => return self.error(error),
            }
        }
        Some(sizes)
    }
}
