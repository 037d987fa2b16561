//! The target: the closure `target`, with the equations and inequalities that hold at the end of a plan.

use clebsch_symbolic::{Expr, IntoList};
use syn::{BinOp, Expr as Syntax, ExprBinary};

use super::closures::written;
use super::control::without_absolute_value;
use super::elaborate::Elaborator;
use super::slots::{END, END_OF_STATES};
use super::typed::ActedSystem;
use super::value::Value;
use super::{Condition, EndConditions};
use crate::diagnostic::{Diagnostic, Location, error, refuse, report};
use crate::parse::{Argument, Closure, joined, parenthesized, shortened, spell, tail};

impl<'g> ActedSystem<'_, '_, 'g> {
    /// The conditions of the end, equations first; `None` if one has an error.
    pub fn target(&mut self, closure: &Closure, is_steered: bool) -> Option<EndConditions<'g>> {
        let diagnostics = self.context.diagnostics;
        let matched = self.arguments.matched(closure, if is_steered { END } else { END_OF_STATES });
        let (scope, velocities) = self.with_velocity(&matched, None)?;
        let body = tail(&closure.body);
        let list = match body {
            Syntax::Array(list) if !list.elems.is_empty() => list,
            Syntax::Array(list) => refuse!(diagnostics, list, "the target has no condition";
                help "write one, as in `[{} == …]`, or leave out the key", self.arguments.names.configuration.spell()),
            body => refuse!(diagnostics, body, "a target is a list of conditions";
                help "write `target = |{}| [{}]`", joined(closure.arguments.iter().map(Argument::spell)), conjuncts(body)),
        };
        let mut elaborator = Elaborator::new(self.context, "target", scope);
        let conditions = elaborator.in_block(&closure.body, |elaborator| {
            let read = list.elems.iter().map(|syntax| conditions(elaborator, syntax)).into_list();
            Some(read.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().into_list())
        })?;
        let moving = self.space.leaves.iter().map(|leaf| leaf.symbol).chain(velocities.iter().copied()).into_list();
        for condition in &conditions {
            let difference = condition.left - condition.right;
            if !moving.iter().any(|symbol| difference.depends_on(*symbol)) {
                report!(diagnostics, condition.place, "`{}` does not depend on where a plan ends", condition.text;
                    help "leave it out");
            }
        }
        let motions: usize = self.factors.iter().map(|factor| factor.group.dimension()).sum();
        let room = if is_steered { motions } else { 2 * motions };
        if let Some(beyond) = conditions.get(room) {
            let count = conditions.len();
            report!(diagnostics, beyond.place, "the target has {count} conditions, and places have {room} dimensions";
                help "leave out conditions that follow from others, or write one for both sides of an interval, as in `(q.x - 1).powi(2) <= 0.01`");
        }
        let (mut all, inequalities): (Vec<_>, Vec<_>) =
            conditions.into_iter().partition(|condition| condition.is_equation);
        let equations = all.len();
        all.extend(inequalities);
        Some(EndConditions { conditions: all, equations, velocities, written: written(closure) })
    }
}

/// The conditions of scalars that an element of the list is.
fn conditions<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, syntax: &Syntax) -> Option<Vec<Condition<'g>>> {
    let diagnostics = elaborator.context.diagnostics;
    let text = shortened(syntax);
    let link = match syntax {
        Syntax::Binary(link) => link,
        Syntax::Assign(link) => refuse!(diagnostics, &link.eq_token, "`{text}` is no condition";
            help "write `{} == {}`", spell(&link.left), spell(&link.right)),
        other => refuse!(diagnostics, other, "`{text}` is no condition"; help "write `a == b`, `a <= b` or `a >= b`"),
    };
    let (is_equation, left, right) = match link.op {
        BinOp::Eq(_) => (true, &link.left, &link.right),
        BinOp::Le(_) => (false, &link.left, &link.right),
        BinOp::Ge(_) => (false, &link.right, &link.left),
        BinOp::And(_) => refuse!(diagnostics, &link.op, "`{text}` is no condition";
            help "separate conditions by commas: write `{}`", conjuncts(syntax)),
        _ => refuse!(diagnostics, syntax, "`{text}` is no condition";
            help "write `a == b`, `a <= b` or `a >= b`"; note "inequalities hold with equality where they are active"),
    };
    if let Some(error) = without_absolute_value((left, right), "conditions").filter(|_| !is_equation) {
        return diagnostics.refuse(error);
    }
    let (first, second) = (elaborator.elaborate(left), elaborator.elaborate(right));
    let (first, second) = first.zip(second)?;
    let sides = match (first.matrix(), second.matrix()) {
        (Some(a), Some(b)) if a.shape() == b.shape() && a.shape().columns == 1 => Some((a, b)),
        _ => None,
    };
    let sides = match sides {
        Some((a, b)) if is_equation || a.shape().is_scalar() => (a, b),
        Some(_) => {
            refuse!(diagnostics, syntax, "`{text}` compares {}, and an inequality compares scalars", first.describe();
            help "compare component by component, as in `{}.x <= 1`, or lengths, as in `{}.norm_squared() <= 1`", parenthesized(left), parenthesized(left))
        }
        None => return diagnostics.refuse(unequal(syntax, &first, &second)),
    };
    let place = Location::from(syntax);
    let (a, b) = sides;
    let condition =
        |i: usize| Condition { left: a.entry(i, 0), right: b.entry(i, 0), is_equation, place, text: text.clone() };
    Some((0..a.shape().rows).map(condition).into_list())
}

/// The error of two sides that cannot be compared.
fn unequal(syntax: &Syntax, left: &Value<'_>, right: &Value<'_>) -> Diagnostic {
    let shape = |value: &Value<'_>| value.matrix().map(Expr::shape);
    let (a, b) = (left.describe(), right.describe());
    let sides = [left, right];
    let column = sides.into_iter().filter_map(shape).find(|shape| shape.is_column() && shape.rows > 1);
    let is_zero = sides.into_iter().any(|side| side.matrix().is_some_and(|side| side.is_zero()));
    match column.filter(|_| is_zero && a != b) {
        Some(shape) => error!(syntax, "the left side is {a} and the right side is {b}: they cannot be compared";
            help "write `Vector{}::zeros()` for 0", shape.rows),
        None if a == b => {
            error!(syntax, "`{}` compares {a}, and a target compares scalars or vectors", shortened(syntax);
            help "pass `Target::Configuration` or `Target::Place` for all of a place, or compare parts of it")
        }
        None => error!(syntax, "the left side is {a} and the right side is {b}: they cannot be compared";
            help "write an equation of scalars, or of vectors with one shape"),
    }
}

/// The conditions of `a == b && c <= d`, separated by commas; of one value `a == 0`.
fn conjuncts(body: &Syntax) -> String {
    match body {
        Syntax::Binary(ExprBinary { left, op: BinOp::And(_), right, .. }) => {
            format!("{}, {}", conjuncts(left), conjuncts(right))
        }
        Syntax::Binary(ExprBinary { op: BinOp::Eq(_) | BinOp::Le(_) | BinOp::Ge(_), .. }) => spell(body),
        Syntax::Assign(link) => format!("{} == {}", spell(&link.left), spell(&link.right)),
        other => format!("{} == 0", parenthesized(other)),
    }
}
