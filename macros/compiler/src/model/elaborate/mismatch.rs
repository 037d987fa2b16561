//! Errors for operands whose shapes do not fit, with the text to type instead.

use clebsch_symbolic::Expr;
use syn::{BinOp, Expr as Syntax, ExprBinary};

use super::operators::parenthesized;
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::spell;

/// A sum of matrices of different shapes.
pub(super) fn unequal_shapes(link: &ExprBinary, left: Expr, right: Expr, minus: bool) -> Diagnostic {
    let (a, b) = (spell(&link.left), spell(&link.right));
    let verb = if minus { "subtracted" } else { "added" };
    let side = |expr: Expr| if expr.shape().is_scalar() { "a scalar".to_string() } else { expr.shape().to_string() };
    let message = format!("`{a}` is {} and `{b}` is {}: they cannot be {verb}", side(left), side(right));
    let error = Diagnostic::new(Location::of(link), message);
    let (matrix, scalar) = (left.shape(), right.shape());
    if right.shape().is_column() && left.shape().columns == right.shape().rows && !right.shape().is_scalar() {
        return error.help(format!("multiply the vector, as in `{}`", applied(&link.left, &b)));
    }
    if left.shape().is_column() && right.shape().columns == left.shape().rows && !left.shape().is_scalar() {
        return error.help(format!("multiply the vector, as in `{}`", applied(&link.right, &a)));
    }
    if left.shape() == right.shape().transposed() {
        return error.help(format!("transpose one of them, as in `{}.transpose()`", parenthesized(&link.right)));
    }
    match (matrix.is_square(), scalar.is_scalar()) {
        (true, true) if !matrix.is_scalar() => {
            error.help(format!("multiply the scalar by the identity, as in `{} * I`", parenthesized(&link.right)))
        }
        _ => error.note("only matrices of one shape are added, entry by entry"),
    }
}

/// A matrix applied to a vector, products from the right: `A * (B * v)`.
fn applied(matrix: &Syntax, vector: &str) -> String {
    match matrix {
        Syntax::Binary(product) if matches!(product.op, BinOp::Mul(_)) => {
            format!("{} * ({} * {vector})", spell(&product.left), spell(&product.right))
        }
        Syntax::Paren(inner) => applied(&inner.expr, vector),
        Syntax::Binary(_) => format!("({}) * {vector}", spell(matrix)),
        _ => format!("{} * {vector}", spell(matrix)),
    }
}

/// An element of SE(n), Aff(n) or Sim(n), a matrix with a row and a column more, times a point.
pub(super) fn point_moved(link: &ExprBinary, left: Expr, right: Expr) -> Diagnostic {
    let (f, x) = (parenthesized(&link.left), parenthesized(&link.right));
    let message = format!("`{f}` is {} and `{x}` is {}: they cannot be multiplied", left.shape(), right.shape());
    Diagnostic::new(Location::of(link), message)
        .help(format!("write `{f}.rotation() * {x} + {f}.translation()` to move the point"))
        .note("the matrix has a last row and column more than the point, (A b; 0 1)")
}

/// A product whose inner dimensions differ.
pub(super) fn no_product(link: &ExprBinary, left: Expr, right: Expr) -> Diagnostic {
    let (a, b) = (parenthesized(&link.left), parenthesized(&link.right));
    let message = format!(
        "`{}` is {} and `{}` is {}: they cannot be multiplied",
        spell(&link.left),
        left.shape(),
        spell(&link.right),
        right.shape()
    );
    let error = Diagnostic::new(Location::of(link), message);
    let (l, r) = (left.shape(), right.shape());
    match () {
        () if l == r && l.is_column() => {
            error.help(format!("write `{a}.dot(&{b})` for the scalar product, `{a}.cross(&{b})` for the cross product"))
        }
        () if l.is_column() && r.is_square() && r.rows == l.rows => {
            error.help(format!("write the matrix first: `{b} * {a}`"))
        }
        () if l.rows == r.rows => error.help(format!("transpose the first: `{a}.transpose() * {b}`")),
        () if l.columns == r.columns => error.help(format!("transpose the second: `{a} * {b}.transpose()`")),
        () => error,
    }
    .note("a product needs as many columns on the left as there are rows on the right")
}
