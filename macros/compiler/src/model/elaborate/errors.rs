//! Errors with the text to type instead: operands whose shapes do not fit, and Rust that is no mathematics, by its name.

use clebsch_symbolic::{Expr, Role, Shape};
use proc_macro2::Span;
use syn::{BinOp, Expr as Syntax, ExprBinary};

use super::{Elaborator, Value};
use crate::diagnostic::{Diagnostic, Location, error};
use crate::parse::{parenthesized, spell};

/// The replacement of a loop.
const IN_SUMS: &str = "write a sum, `(0..3).map(|i| …).sum()`";

/// The verb for an operator, for messages.
pub(super) fn verb(operator: &BinOp) -> &'static str {
    match operator {
        BinOp::Add(_) => "added",
        BinOp::Sub(_) => "subtracted",
        BinOp::Mul(_) => "multiplied",
        BinOp::Div(_) => "divided",
        _ => "divided with remainder",
    }
}

/// `sum += x` and the like.
pub(super) fn is_assignment(syntax: &Syntax) -> bool {
    use BinOp::{AddAssign, DivAssign, MulAssign, RemAssign, SubAssign};
    matches!(
        syntax,
        Syntax::Binary(link)
            if matches!(link.op, AddAssign(_) | SubAssign(_) | MulAssign(_) | DivAssign(_) | RemAssign(_))
    )
}

/// The first line of the error for a sum.
pub(super) fn not_added(link: &ExprBinary, left: Expr, right: Expr) -> Diagnostic {
    let (a, b, verb) = (spell(&link.left), spell(&link.right), verb(&link.op));
    let (left, right) = (Value::Matrix(left).describe(), Value::Matrix(right).describe());
    error!(link, "`{a}` is {left} and `{b}` is {right}: they cannot be {verb}")
}

/// A sum of matrices of different shapes.
pub(super) fn unequal_shapes(link: &ExprBinary, left: Expr, right: Expr) -> Diagnostic {
    let (a, b) = (spell(&link.left), spell(&link.right));
    let (l, r) = (left.shape(), right.shape());
    let error = not_added(link, left, right);
    let is_vector = |shape: Shape| shape.is_column() && !shape.is_scalar();
    if is_vector(r) && l.columns == r.rows {
        error.help(format!("multiply the vector, as in `{}`", applied(&link.left, &b)))
    } else if is_vector(l) && r.columns == l.rows {
        error.help(format!("multiply the vector, as in `{}`", applied(&link.right, &a)))
    } else if l == r.transposed() {
        error.help(format!("transpose one of them, as in `{}.transpose()`", parenthesized(&link.right)))
    } else if r.is_scalar() && l.is_square() {
        error.help(format!("multiply the scalar by the identity, as in `{} * I`", parenthesized(&link.right)))
    } else {
        error.note("only matrices of one shape are added, entry by entry")
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
    error!(link, "`{f}` is {} and `{x}` is {}: they cannot be multiplied", left.shape(), right.shape();
        help "write `{f}.rotation() * {x} + {f}.translation()` to move the point";
        note "the matrix has a last row and column more than the point, (A b; 0 1)")
}

/// A product whose inner dimensions differ.
pub(super) fn no_product(link: &ExprBinary, left: Expr, right: Expr, meant: Option<String>) -> Diagnostic {
    let (a, b) = (parenthesized(&link.left), parenthesized(&link.right));
    let (left, right) = (left.shape(), right.shape());
    let (first, second) = (spell(&link.left), spell(&link.right));
    let error = error!(link, "`{first}` is {left} and `{second}` is {right}: they cannot be multiplied");
    let error = if let Some(meant) = meant {
        error.help(format!("is `{meant}` meant?"))
    } else if left == right && left.is_column() {
        error.help(format!("write `{a}.dot(&{b})` for the scalar product, `{a}.cross(&{b})` for the cross product"))
    } else if left.is_column() && right.is_square() && right.rows == left.rows {
        let quadratic = if matches!(&*link.left, Syntax::Path(_)) {
            format!("; a quadratic form is `{a}.dot(&({b} * {a}))`")
        } else {
            String::new()
        };
        error.help(format!("write the matrix first: `{b} * {a}`{quadratic}"))
    } else if left.rows == right.rows && (left.rows > 1 || left.columns != right.columns) {
        error.help(format!("transpose the first: `{a}.transpose() * {b}`"))
    } else if left.columns == right.columns {
        error.help(format!("transpose the second: `{a} * {b}.transpose()`"))
    } else {
        error
    };
    error.note("a product needs as many columns on the left as there are rows on the right")
}

impl<'g> Elaborator<'_, '_, 'g> {
    /// The advice for a constant where a vector or a matrix is needed.
    pub(super) fn of_constant(&self, operands: [(Expr<'g>, &Syntax); 2]) -> Option<String> {
        let is_constant = |(expr, _): &&(Expr<'g>, &Syntax)| matches!(expr.role(), Some(Role::Constant(_)));
        let (_, constant) = operands.iter().find(is_constant)?;
        Some(format!("constants are scalars: write a field in place of `{}`", spell(constant)))
    }

    /// The error for an expression that no closure can hold.
    pub(super) fn refused(&mut self, syntax: &Syntax) -> Option<Value<'g>> {
        let (place, what, help) = describe(syntax);
        let error = error!(place, "{what} cannot stand in the {}", self.key);
        let is_branch = matches!(syntax, Syntax::If(_) | Syntax::Match(_));
        let error = error.maybe_help(Some(help).filter(|help| !help.is_empty()));
        let error = error.maybe_help(self.opaque().filter(|_| is_branch));
        self.refuse(error.note("a closure is one formula: it is differentiated, not run"))
    }
}

/// Where an expression is (by its keyword if it has one), its kind, and its replacement.
fn describe(syntax: &Syntax) -> (Location, &'static str, String) {
    let at = |span: Span, what, help: &str| (span.into(), what, help.to_string());
    let whole = |what, help: &str| (Location::from(syntax), what, help.to_string());
    match syntax {
        Syntax::If(inner) => {
            at(inner.if_token.span, "`if`", "write one formula that holds everywhere, smooth where the cases meet")
        }
        Syntax::Match(inner) => at(inner.match_token.span, "`match`", "write one formula that holds everywhere"),
        Syntax::ForLoop(inner) => at(inner.for_token.span, "`for`", IN_SUMS),
        Syntax::While(inner) => at(inner.while_token.span, "`while`", IN_SUMS),
        Syntax::Loop(inner) => at(inner.loop_token.span, "`loop`", IN_SUMS),
        Syntax::Cast(inner) => {
            let place = Location { start: inner.as_token.span, end: Location::from(&inner.ty).start };
            (place, "`as`", format!("write `{}`: numbers mix freely", spell(&inner.expr)))
        }
        Syntax::Return(inner) => at(inner.return_token.span, "`return`", "end the block with its value"),
        Syntax::Try(inner) => at(inner.question_token.span, "`?`", ""),
        Syntax::Break(_) => whole("`break`", ""),
        Syntax::Continue(_) => whole("`continue`", ""),
        Syntax::Closure(_) => whole("a closure", "closures stand only in `.map(|i| …)`"),
        Syntax::Assign(_) => whole("an assignment", "give the new value a name with `let`"),
        _ if is_assignment(syntax) => whole("an assignment", "give the new value a name with `let`"),
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
