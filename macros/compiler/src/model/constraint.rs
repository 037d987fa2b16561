//! Constraints: the closure `constraint`, equations that are affine in the velocity.

use clebsch_symbolic::{Elements, Expr, IntoList, Shape, identity};
use syn::{BinOp, Expr as Syntax, ExprArray, ExprBinary};

use super::closures::written;
use super::elaborate::Elaborator;
use super::slots::{CONSTRAINT, Slot};
use super::typed::{ActedSystem, Velocity};
use super::value::Value;
use super::{Constraint, Dials};
use crate::diagnostic::{Diagnostic, Diagnostics, error, refuse};
use crate::parse::{Argument, Closure, joined, shortened, spell, tail};

/// One equation of the list, as left side less right side.
struct Equation<'g> {
    value: Expr<'g>,
    text: String,
}

impl<'g> ActedSystem<'_, '_, 'g> {
    /// The rows of a constraint; `None` with an error, which was reported.
    pub fn constraint(&mut self, closure: &Closure, dials: &Dials) -> Option<Constraint<'g>> {
        let (graph, diagnostics) = (self.context.graph, self.context.diagnostics);
        if self.context.power.is_some() {
            // it has been refused
            return None;
        }
        let matched = self.arguments.matched(closure, CONSTRAINT);
        if matched.has_error() {
            return None;
        }
        let Some(argument) = matched.argument(Slot::Velocity) else {
            let help = format!("take the velocity as the last argument: write `|{}| …`", with_velocity(closure));
            return diagnostics.refuse(Diagnostic::later(
                closure.head,
                "a constraint on the configuration alone".to_string(),
                Some(&help),
            ));
        };
        let velocity = Velocity { graph, factors: self.factors, diagnostics };
        let (value, velocities) = velocity.of(&argument.pattern, self.element)?;
        let mut scope = self.arguments.scope(&matched, &[(Slot::Velocity, Some(value))]);
        scope.set_velocities(&velocities, self.factors);
        let list = list(closure, diagnostics)?;
        let mut elaborator = Elaborator::new(self.context, "constraint", scope);
        let equations = elaborator.in_block(&closure.body, |elaborator| {
            let equations = list.elems.iter().map(|syntax| equation(elaborator, syntax));
            equations.into_list().into_iter().collect::<Option<Vec<Equation<'g>>>>()
        })?;
        let constraint = rows(closure, &equations, &velocities, diagnostics)?;
        check_rows(list, &equations, &constraint, diagnostics)?;
        let discretization = dials.discretization.as_ref().map(|chosen| chosen.value);
        Some(Constraint { discretization, ..constraint })
    }
}

/// The arguments of a closure, and a velocity behind them.
fn with_velocity(closure: &Closure) -> String {
    joined(closure.arguments.iter().map(Argument::spell).chain(["xi".to_string()]))
}

/// The list that the body ends with.
fn list<'s>(closure: &'s Closure, diagnostics: &Diagnostics) -> Option<&'s ExprArray> {
    let body = tail(&closure.body);
    match body {
        Syntax::Array(list) if list.elems.is_empty() => {
            refuse!(diagnostics, list, "the constraint has no equation";
                help "write one, as in `[{}.z == 0]`, or leave out the key", last_name(closure))
        }
        Syntax::Array(list) => Some(list),
        Syntax::Binary(link) if is_comparison(link) => {
            refuse!(diagnostics, body, "a constraint is a list of equations"; help "write `[{}]`", as_equation(link))
        }
        Syntax::Binary(link) if matches!(link.op, BinOp::And(_)) => {
            refuse!(diagnostics, body, "a constraint is a list of equations"; help "write `[{}]`", conjuncts(body))
        }
        _ => refuse!(diagnostics, body, "a constraint is a list of equations";
            help "end it with a list, as in `[{}.z == 0]`", last_name(closure)),
    }
}

fn last_name(closure: &Closure) -> String {
    let names = closure.arguments.last().map(|argument| argument.pattern.names());
    names.and_then(|names| names.first().map(ToString::to_string)).unwrap_or_else(|| "xi".into())
}

/// The equations of `a == b && c == d`, separated by commas.
fn conjuncts(body: &Syntax) -> String {
    match body {
        Syntax::Binary(link) if matches!(link.op, BinOp::And(_)) => {
            format!("{}, {}", conjuncts(&link.left), conjuncts(&link.right))
        }
        Syntax::Binary(link) if is_comparison(link) => as_equation(link),
        other => spell(other),
    }
}

fn is_comparison(link: &ExprBinary) -> bool {
    matches!(link.op, BinOp::Eq(_) | BinOp::Le(_) | BinOp::Lt(_) | BinOp::Ge(_) | BinOp::Gt(_) | BinOp::Ne(_))
}

fn as_equation(link: &ExprBinary) -> String {
    format!("{} == {}", spell(&link.left), spell(&link.right))
}

/// `a == b` as a − b, a scalar or a vector.
fn equation<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, syntax: &Syntax) -> Option<Equation<'g>> {
    let diagnostics = elaborator.context.diagnostics;
    let text = shortened(syntax);
    match syntax {
        Syntax::Binary(link) if matches!(link.op, BinOp::Eq(_)) => {}
        Syntax::Binary(link) if is_comparison(link) => {
            refuse!(diagnostics, &link.op, "`{text}` is no equation";
                help "write `{}`", as_equation(link);
                note "a constraint holds at every time; a contact that opens and closes is another problem")
        }
        Syntax::Binary(link) if matches!(link.op, BinOp::And(_)) => {
            refuse!(diagnostics, &link.op, "`{text}` is no equation"; help "separate equations by commas: write `{}`", conjuncts(syntax))
        }
        other => refuse!(diagnostics, other, "`{text}` is no equation"; help "write `{} == 0`", spell(other)),
    }
    let (left, right) = elaborator.equation(syntax)?;
    let shape = |value: &Value<'g>| value.matrix().map(Expr::shape);
    match (left.matrix(), right.matrix()) {
        (Some(left), Some(right)) if left.shape() == right.shape() && left.shape().columns == 1 => {
            Some(Equation { value: left - right, text })
        }
        _ => {
            let (a, b) = (left.describe(), right.describe());
            let zeros = [&left, &right].into_iter().filter_map(shape).find(|shape| shape.is_column() && shape.rows > 1);
            let is_zero = [&left, &right].into_iter().any(|side| side.matrix().is_some_and(|side| side.is_zero()));
            let error = error!(syntax, "the left side is {a} and the right side is {b}: they cannot be equal");
            let help = match zeros.filter(|_| is_zero && a != b) {
                Some(shape) => format!("write `Vector{}::zeros()` for 0", shape.rows),
                None => "write an equation of scalars, or of vectors with one shape".into(),
            };
            diagnostics.refuse(error.help(help))
        }
    }
}

/// The rows a and the values b with a ξ = b.
fn rows<'g>(
    closure: &Closure,
    equations: &[Equation<'g>],
    velocities: &[Expr<'g>],
    diagnostics: &Diagnostics,
) -> Option<Constraint<'g>> {
    let graph = velocities.first()?.graph();
    let at_rest: Vec<_> = velocities.each(|velocity| (*velocity, graph.zero(velocity.shape())));
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for Equation { value, text } in equations {
        let slopes = velocities.each(|velocity| value.jacobian(*velocity));
        let slopes = graph.beside(&slopes).substitute(&at_rest);
        let value_at_rest = value.substitute(&at_rest);
        if !identity::equal(&[*value], &[slopes * graph.below(velocities) + value_at_rest]) {
            let name = last_name(closure);
            refuse!(diagnostics, tail(&closure.body), "`{text}` is not affine in the velocity";
                help "write sums of components of `{name}`, each times a function of the configuration";
                note "by the principle of d'Alembert a constraint acts along its rows, and only equations that are affine in the velocity have rows");
        }
        rows.push(slopes.expand());
        values.push((-value_at_rest).expand());
    }
    let texts = equations.iter().map(|equation| equation.text.clone()).into_list();
    let (rows, values) = (graph.below(&rows), graph.below(&values));
    Some(Constraint { rows, values, discretization: None, texts, written: written(closure) })
}

/// Every equation fixes a velocity, and there are no more of them than velocities.
fn check_rows<'g>(
    list: &ExprArray,
    equations: &[Equation<'g>],
    constraint: &Constraint<'g>,
    diagnostics: &Diagnostics,
) -> Option<()> {
    let Shape { rows, columns } = constraint.rows.shape();
    let mut first = 0;
    let mut known = 0;
    for (Equation { value, text }, syntax) in equations.iter().zip(&list.elems) {
        let count = value.shape().rows;
        let last = first + count;
        let is_zero = |i: usize| identity::vanishes(constraint.rows.block(i, 0, Shape::new(1, columns)));
        if let Some(i) = (first..last).find(|i| is_zero(*i)) {
            let which = if count > 1 { format!("component {} of ", i - first) } else { String::new() };
            refuse!(diagnostics, syntax, "{which}`{text}` does not depend on the velocity";
                help "leave it out, or write the velocity that it fixes";
                note "an equation for the configuration alone is no equation for its velocity")
        }
        if rows > columns {
            first = last;
            continue;
        }
        let rank = identity::rank(constraint.rows.block(0, 0, Shape::new(last, columns)));
        if rank < known + count {
            refuse!(diagnostics, syntax, "`{text}` follows from the other equations, or contradicts them";
                help "leave it out";
                note "the rows of the constraint have rank {rank}, and there are {last} of them: their forces are not determined")
        }
        (first, known) = (last, rank);
    }
    if rows > columns {
        refuse!(diagnostics, list, "there are {rows} equations for a velocity of {columns} components";
            help "leave out those that follow from others")
    }
    Some(())
}
