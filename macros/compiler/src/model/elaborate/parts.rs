//! Rows, columns and blocks: `row(0)`, `fixed_view::<2, 2>(0, 0)`, `xyz()`.

use clebsch_symbolic::{Expr, Group, IntoList, Shape};
use syn::{BinOp, Expr as Syntax, ExprMethodCall, GenericArgument};

use super::tables::Part;
use super::{Elaborator, Growth, Value};
use crate::diagnostic::{Diagnostic, refuse};
use crate::parse::{parenthesized, spell};

impl<'g> Elaborator<'_, '_, 'g> {
    pub(super) fn part(&mut self, part: Part, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let (name, all) = (&call.method, a.shape());
        let written: Vec<&GenericArgument> = call.turbofish.iter().flat_map(|turbofish| &turbofish.args).into_list();
        if written.len() != part.sizes {
            let sizes = ["", "::<2>", "::<2, 2>"][part.sizes];
            refuse!(self, name, "`{name}` needs {} sizes", part.sizes; help "write `{name}{sizes}(…)`");
        }
        let shape = (part.shape)(all, &self.sizes(&written)?);
        // `xy` and `xyz` are of vectors
        let needs_vector = part.starts == [false; 2];
        if shape.rows > all.rows || shape.columns > all.columns || (needs_vector && all.columns > 1) {
            refuse!(self, name, "`{}` is {all}: `{name}` is {shape}", spell(&call.receiver);
                note "a part lies inside of the matrix");
        }
        let of = format!("the starts of `{name}` in `{}`", spell(&call.receiver));
        let mut start = |syntax: Option<&Syntax>, last: usize| {
            syntax.map_or(Some(0), |syntax| self.position(syntax, last + 1, &of))
        };
        let row = start(call.args.first().filter(|_| part.starts[0]), all.rows - shape.rows);
        let column = start(call.args.last().filter(|_| part.starts[1]), all.columns - shape.columns);
        let (row, column) = row.zip(column)?;
        self.build(call, &[a], Growth::Sum, || a.block(row, column, shape))
    }

    /// A of an element (A x; 0 1) of SE(n), Aff(n) or Sim(n), an (n+1)×(n+1) matrix.
    pub(super) fn rotation(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let (group, n) = self.affine_group(call, a)?;
        let linear = self.grow(call, &[a], Growth::Sum, || a.block(0, 0, Shape::square(n)))?;
        match group {
            Group::SpecialEuclidean(n) if n > 1 => self.members.insert(linear, Group::SpecialOrthogonal(n)),
            Group::Affine(n) => self.members.insert(linear, Group::GeneralLinear(n)),
            _ => {}
        }
        Some(Value::Matrix(linear))
    }

    /// x of an element (A x; 0 1) of SE(n), Aff(n) or Sim(n).
    pub(super) fn translation(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let (_, n) = self.affine_group(call, a)?;
        self.build(call, &[a], Growth::Sum, || a.block(0, n, Shape::vector(n)))
    }

    /// The group of an element with a linear part, and the size of that part.
    fn affine_group(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<(Group, usize)> {
        let group = self.group_of(a);
        if let Some((group, n)) = group.and_then(|group| Some((group, group.linear_part()?))) {
            return Some((group, n));
        }
        let (name, text, shape) = (&call.method, spell(&call.receiver), a.shape());
        let message = match group.map(|group| group.name(self.graph())) {
            Some(group) => format!("`{text}` is in {group}: `{name}` is of SE<n>, Aff<n> and Sim<n>"),
            None => format!("`{text}` is {shape}, but `{name}` is of an element of SE<n>, Aff<n> or Sim<n>"),
        };
        let error = Diagnostic::new(name, message).maybe_help(first_of_difference(call));
        self.refuse(error.note("group elements are the arguments that are typed as one, their products and inverses"))
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
        _ => Some(format!("{}.{}()", parenthesized(syntax), call.method)),
    };
    let text = match (part(left), part(right)) {
        (Some(left), Some(right)) => format!("{left} {sign} {right}"),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => return None,
    };
    Some(format!("take the part of each element, `{text}`"))
}
