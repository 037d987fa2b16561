//! Constraints: the closure `constraint`. Its equations are affine in the velocity, or of the configuration alone.

use clebsch_symbolic::{Elements, Expr, IntoElements, IntoList, identity};
use syn::{BinOp, Expr as Syntax, ExprArray, ExprBinary};

use super::closures::optional;
use super::elaborate::Elaborator;
use super::slots::{CONSTRAINT, Slot};
use super::typed::{ActedSystem, Velocity};
use super::value::Value;
use super::{Constraint, Dials, Equation, Restriction, Written};
use crate::diagnostic::{Diagnostics, Location, error, refuse};
use crate::parse::{Closure, shortened, spell, tail};

/// One equation of the list, as left side less right side.
struct Sides<'g> {
    difference: Expr<'g>,
    written: Written,
}

impl<'g> ActedSystem<'_, '_, 'g> {
    /// A constraint: on the velocity if that is among the arguments, else on the configuration. `None` with an error, which was reported.
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
        let velocity = Velocity { graph, factors: self.factors, diagnostics };
        let pattern = matched.argument(Slot::Velocity).map(|argument| &argument.pattern);
        let (value, velocities) = optional(pattern, |pattern| velocity.of(pattern, self.element))?.unzip();
        let mut scope = self.arguments.scope(&matched, &[(Slot::Velocity, value)]);
        if let Some(velocities) = &velocities {
            scope.set_velocities(velocities, self.factors);
        }
        let list = list(closure, diagnostics)?;
        let mut elaborator = Elaborator::new(self.context, "constraint", scope);
        let all = elaborator.in_block(&closure.body, |elaborator| {
            let equations = list.elems.iter().map(|syntax| equation(elaborator, syntax));
            equations.into_list().into_iter().collect::<Option<Vec<Sides<'g>>>>()
        })?;
        let kind = match velocities {
            Some(velocities) => of_velocities(closure, &all, &velocities, diagnostics)?,
            None => Restriction::Places(graph.below(&all.each(|sides| sides.difference))),
        };
        let discretization = dials.discretization.as_ref().map(|chosen| chosen.value);
        let equations =
            all.into_each(|Sides { difference, written }| Equation { count: difference.shape().rows, written });
        Some(Constraint { kind, equations, discretization })
    }
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
        Syntax::Assign(link) => refuse!(diagnostics, body, "a constraint is a list of equations";
            help "write `[{} == {}]`", spell(&link.left), spell(&link.right)),
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
fn equation<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, syntax: &Syntax) -> Option<Sides<'g>> {
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
        Syntax::Assign(link) => refuse!(diagnostics, &link.eq_token, "`{text}` is no equation";
            help "write `{} == {}`", spell(&link.left), spell(&link.right)),
        other => refuse!(diagnostics, other, "`{text}` is no equation"; help "write `{} == 0`", spell(other)),
    }
    let (left, right) = elaborator.equation(syntax)?;
    let shape = |value: &Value<'g>| value.matrix().map(Expr::shape);
    match (left.matrix(), right.matrix()) {
        (Some(left), Some(right)) if left.shape() == right.shape() && left.shape().columns == 1 => {
            let written = Written { place: Location::from(syntax), text };
            Some(Sides { difference: left - right, written })
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
fn of_velocities<'g>(
    closure: &Closure,
    equations: &[Sides<'g>],
    velocities: &[Expr<'g>],
    diagnostics: &Diagnostics,
) -> Option<Restriction<'g>> {
    let graph = velocities.first()?.graph();
    let at_rest: Vec<_> = velocities.each(|velocity| (*velocity, graph.zero(velocity.shape())));
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for Sides { difference, written } in equations {
        let slopes = velocities.each(|velocity| difference.jacobian(*velocity));
        let slopes = graph.beside(&slopes).substitute(&at_rest);
        let value_at_rest = difference.substitute(&at_rest);
        if !identity::equal(&[*difference], &[slopes * graph.below(velocities) + value_at_rest]) {
            let name = last_name(closure);
            refuse!(diagnostics, written.place, "`{}` is not affine in the velocity", written.text;
                help "write sums of components of `{name}`, each times a function of the configuration";
                note "by the principle of d'Alembert a constraint acts along its rows, and only equations that are affine in the velocity have rows");
        }
        rows.push(slopes.expand());
        values.push((-value_at_rest).expand());
    }
    Some(Restriction::Velocities { rows: graph.below(&rows), values: graph.below(&values) })
}
