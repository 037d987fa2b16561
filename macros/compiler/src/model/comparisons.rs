//! Comparisons: the lists `[a == b, c <= d]` of the keys `bounds` and `target`.

use clebsch_symbolic::{Expr, IntoList};
use syn::{BinOp, Expr as Syntax, ExprArray, ExprBinary};

use super::Condition;
use super::elaborate::Elaborator;
use super::value::Value;
use crate::diagnostic::{Diagnostic, Location, error, refuse, report};
use crate::parse::{parenthesized, shortened, spell};

/// The list that comparisons stand in.
#[derive(Clone, Copy)]
pub(super) enum Among {
    /// `bounds`, for each step.
    Bounds,
    /// `target`, for the end.
    Conditions,
}

impl Among {
    /// The word for one comparison.
    fn one(self) -> &'static str {
        match self {
            Among::Bounds => "bound",
            Among::Conditions => "condition",
        }
    }

    /// Whether such a comparison has to depend on moving parts.
    fn needs_motion(self, is_equation: bool) -> bool {
        is_equation || matches!(self, Among::Conditions)
    }

    /// The lack of a comparison of constants.
    fn lack(self) -> &'static str {
        match self {
            Among::Bounds => "depends on neither place nor input of a step",
            Among::Conditions => "does not depend on where a plan ends",
        }
    }
}

/// The comparisons of a list as written, each of scalars; `None` if one has an error. They are functions of `moving`.
pub(super) fn comparisons<'g>(
    elaborator: &mut Elaborator<'_, '_, 'g>,
    list: &ExprArray,
    (among, moving): (Among, &[Expr<'g>]),
) -> Option<Vec<Condition<'g>>> {
    let read = list.elems.iter().map(|syntax| {
        let mut rows = comparison(elaborator, syntax, among)?;
        let is_unmoved = |row: &Condition<'g>| {
            let difference = row.left - row.right;
            among.needs_motion(row.is_equation) && !moving.iter().any(|symbol| difference.depends_on(*symbol))
        };
        let diagnostics = elaborator.context.diagnostics;
        if rows.iter().all(is_unmoved) {
            report!(diagnostics, syntax, "`{}` {}", spell(syntax), among.lack(); help "leave it out");
            rows.truncate(1);
            return Some(rows);
        }
        // one row of `u == vector![u.x, 0]` says nothing
        let says_something = |row: &Condition<'g>| !row.is_equation || row.left != row.right;
        let unmoved = |(_, row): &(usize, &Condition<'g>)| says_something(row) && is_unmoved(row);
        for (index, _) in rows.iter().enumerate().filter(unmoved) {
            report!(diagnostics, syntax, "row {} of `{}` {}", index + 1, spell(syntax), among.lack();
                help "compare the other components, one by one");
        }
        rows.retain(says_something);
        Some(rows)
    });
    let read = read.into_list().into_iter().collect::<Option<Vec<_>>>()?;
    Some(read.into_iter().flatten().into_list())
}

/// Comparisons with all equations before the inequalities.
pub(super) fn equations_first(written: Vec<Condition<'_>>) -> Vec<Condition<'_>> {
    let (mut all, inequalities): (Vec<_>, Vec<_>) = written.into_iter().partition(|comparison| comparison.is_equation);
    all.extend(inequalities);
    all
}

/// Whether an expression compares, or joins comparisons.
pub(super) fn is_comparison(body: &Syntax) -> bool {
    use BinOp::{And, Eq, Ge, Gt, Le, Lt};
    matches!(body, Syntax::Assign(_))
        || matches!(body, Syntax::Binary(ExprBinary { op: Eq(_) | Le(_) | Ge(_) | Lt(_) | Gt(_) | And(_), .. }))
}

/// The comparisons of scalars that an element of the list is.
fn comparison<'g>(
    elaborator: &mut Elaborator<'_, '_, 'g>,
    syntax: &Syntax,
    among: Among,
) -> Option<Vec<Condition<'g>>> {
    let diagnostics = elaborator.context.diagnostics;
    let (text, one) = (shortened(syntax), among.one());
    let link = match syntax {
        Syntax::Binary(link) => link,
        Syntax::Assign(link) => refuse!(diagnostics, &link.eq_token, "`{text}` is no {one}";
            help "write `{} == {}`", spell(&link.left), spell(&link.right)),
        other => refuse!(diagnostics, other, "`{text}` is no {one}"; help "write `a == b`, `a <= b` or `a >= b`"),
    };
    let (is_equation, left, right) = match link.op {
        BinOp::Eq(_) => (true, &link.left, &link.right),
        BinOp::Le(_) => (false, &link.left, &link.right),
        BinOp::Ge(_) => (false, &link.right, &link.left),
        BinOp::And(_) => refuse!(diagnostics, &link.op, "`{text}` is no {one}";
            help "separate {}s by commas: write `{}`", one, conjuncts(syntax)),
        _ => refuse!(diagnostics, syntax, "`{text}` is no {one}";
            help "write `a == b`, `a <= b` or `a >= b`"; note "inequalities hold with equality where they are active"),
    };
    if let Some(error) = without_absolute_value((left, right), &format!("{one}s")).filter(|_| !is_equation) {
        return diagnostics.refuse(error);
    }
    let (first, second) = (elaborator.elaborate(left), elaborator.elaborate(right));
    let (first, second) = first.zip(second)?;
    let matrices = first.matrix().zip(second.matrix());
    let is_scalar = |value: &Value<'g>| value.matrix().is_some_and(|matrix| matrix.shape().is_scalar());
    let (a, b) = match matrices {
        Some((a, b)) if is_equation && a.shape() == b.shape() && a.shape().columns == 1 => (a, b),
        _ if is_equation => return diagnostics.refuse(unequal(syntax, (&first, &second), among)),
        Some((a, b)) if is_scalar(&first) && is_scalar(&second) => (a, b),
        _ => {
            let (side, value) = if is_scalar(&first) { (right, &second) } else { (left, &first) };
            refuse!(diagnostics, syntax, "`{text}` compares {}, and an inequality compares scalars", value.describe();
                help "compare component by component, as in `{}.x <= 1`, or lengths, as in `{}.norm_squared() <= 1`", parenthesized(side), parenthesized(side))
        }
    };
    let (place, text) = (Location::from(syntax), spell(syntax));
    let condition =
        |i: usize| Condition { left: a.entry(i, 0), right: b.entry(i, 0), is_equation, place, text: text.clone() };
    Some((0..a.shape().rows).map(condition).into_list())
}

/// The error of two sides that cannot be compared.
fn unequal(syntax: &Syntax, (left, right): (&Value<'_>, &Value<'_>), among: Among) -> Diagnostic {
    let shape = |value: &Value<'_>| value.matrix().map(Expr::shape);
    let (a, b) = (left.describe(), right.describe());
    let sides = [left, right];
    let column = sides.into_iter().filter_map(shape).find(|shape| shape.is_column() && shape.rows > 1);
    let is_zero = sides.into_iter().any(|side| side.matrix().is_some_and(|side| side.is_zero()));
    match column.filter(|_| is_zero && a != b) {
        Some(shape) => error!(syntax, "the left side is {a} and the right side is {b}: they cannot be compared";
            help "write `Vector{}::zeros()` for 0", shape.rows),
        None if a == b => {
            let text = shortened(syntax);
            match among {
                Among::Conditions => error!(syntax, "`{text}` compares {a}, and a target compares scalars or vectors";
                    help "pass `Target::Configuration` or `Target::Place` for all of a place, or compare parts of it"),
                Among::Bounds => error!(syntax, "`{text}` compares {a}, and a bound compares scalars or vectors";
                    help "compare parts of both, as in `a[(0, 0)] == b[(0, 0)]` or `a * v == b * v` with a vector `v`"),
            }
        }
        None => error!(syntax, "the left side is {a} and the right side is {b}: they cannot be compared";
            help "write an equation of scalars, or of vectors with one shape"),
    }
}

/// The conditions of `a == b && c <= d`, separated by commas; of one value `a == 0`.
pub(super) fn conjuncts(body: &Syntax) -> String {
    match body {
        Syntax::Binary(ExprBinary { left, op: BinOp::And(_), right, .. }) => {
            format!("{}, {}", conjuncts(left), conjuncts(right))
        }
        Syntax::Binary(ExprBinary { op: BinOp::Eq(_) | BinOp::Le(_) | BinOp::Ge(_), .. }) => spell(body),
        Syntax::Binary(ExprBinary { left, op: BinOp::Lt(_), right, .. }) => {
            format!("{} <= {}", spell(left), spell(right))
        }
        Syntax::Binary(ExprBinary { left, op: BinOp::Gt(_), right, .. }) => {
            format!("{} >= {}", spell(left), spell(right))
        }
        Syntax::Assign(link) => format!("{} == {}", spell(&link.left), spell(&link.right)),
        other => format!("{} == 0", parenthesized(other)),
    }
}

/// The advice for `x.abs() <= a` among bounds or conditions.
fn without_absolute_value((lower, upper): (&Syntax, &Syntax), among: &str) -> Option<Diagnostic> {
    let Syntax::MethodCall(call) = lower else { return None };
    if call.method != "abs" {
        return None;
    }
    let (inside, limit) = (parenthesized(&call.receiver), parenthesized(upper));
    Some(error!(&call.method, "`abs` has no derivative at 0, so no {among} can use it";
        help "write two {among}, `-{limit} <= {inside}, {inside} <= {limit}`"))
}
