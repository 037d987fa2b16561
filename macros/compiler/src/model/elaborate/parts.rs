//! Rows, columns and blocks: `row(0)`, `fixed_view::<2, 2>(0, 0)`, `xyz()`.

use clebsch_symbolic::{Expr, Group, Shape};
use syn::{BinOp, Expr as Syntax, ExprMethodCall, GenericArgument, Generics};

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

    /// `rotation()` and `translation()` of an element of SE(n), Aff(n) or Sim(n), an (n+1)×(n+1) matrix (A x; 0 1).
    pub(super) fn of_affine(&mut self, special: Special, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let group = self.group_of(a);
        let Some(n) = group.and_then(Group::linear_part) else {
            let (name, text) = (&call.method, spell(&call.receiver));
            let message = match group {
                Some(group) => {
                    format!("`{text}` is in {}: `{name}` is of SE<n>, Aff<n> and Sim<n>", group.name(self.graph()))
                }
                None => format!("`{text}` is {}, but `{name}` is of an element of SE<n>, Aff<n> or Sim<n>", a.shape()),
            };
            let error = Diagnostic::new(call.method.span(), message).maybe_help(first_of_difference(call));
            return self.error(
                error.note("group elements are the arguments that are typed as one, their products and inverses"),
            );
        };
        let part = match special {
            Special::Rotation => self.build(call, &[a], Growth::Sum, || a.block(0, 0, Shape::square(n)))?,
            _ => self.build(call, &[a], Growth::Sum, || a.block(0, n, Shape::vector(n)))?,
        };
        match (special, group) {
            (Special::Rotation, Some(Group::SpecialEuclidean(n))) if n > 1 => {
                self.members.insert(part, Group::SpecialOrthogonal(n));
            }
            (Special::Rotation, Some(Group::Affine(n))) => {
                self.members.insert(part, Group::GeneralLinear(n));
            }
            _ => {}
        }
        Some(Value::Matrix(part))
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

/// The part of each element first: `F.rotation() - I` for `(F - I).rotation()`.
fn first_of_difference(call: &ExprMethodCall) -> Option<String> {
    let Syntax::Binary(link) = super::access::strip(&call.receiver) else { return None };
    let (sign, left, right) = match link.op {
        BinOp::Add(_) => ("+", &link.left, &link.right),
        BinOp::Sub(_) => ("-", &link.left, &link.right),
        _ => return None,
    };
    let part = |syntax: &Syntax| match (syntax, call.method == "rotation") {
        (Syntax::Path(path), true) if path.path.is_ident("I") => Some("I".to_string()),
        (Syntax::Path(path), false) if path.path.is_ident("I") => None,
        _ => Some(format!("{}.{}()", super::operators::parenthesized(syntax), call.method)),
    };
    let text = match (part(left), part(right)) {
        (Some(left), Some(right)) => format!("{left} {sign} {right}"),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => return None,
    };
    Some(format!("take the part of each element, `{text}`"))
}
