//! Constraints: the closure `constraint`. Its equations are affine in the velocity, or of the configuration alone.

use clebsch_symbolic::{Elements, Expr, IntoElements, IntoList, identity};
use proc_macro2::Ident;
use syn::{BinOp, Expr as Syntax, ExprArray, ExprBinary, ExprForLoop, ExprMethodCall, Stmt};

use super::closures::optional;
use super::elaborate::{Context, Elaborator};
use super::features::{self, Feature, Found};
use super::sites::unrolled;
use super::slots::{CONSTRAINT, Slot};
use super::typed::{ActedSystem, Velocity};
use super::value::Value;
use super::{Constraint, Equation, VelocityRows, Written};
use crate::diagnostic::{Diagnostics, Location, error, refuse};
use crate::parse::{Closure, Declaration, Kinetic, shortened, spell, spell_tokens, tail};

/// One equation of the list, as left side less right side.
pub(super) struct Sides<'g> {
    pub difference: Expr<'g>,
    pub written: Written,
}

/// The equations of one closure, and the velocities that they are of; none for equations of the configuration.
struct Equations<'g> {
    all: Vec<Sides<'g>>,
    velocities: Option<Vec<Expr<'g>>>,
}

impl<'g> ActedSystem<'_, '_, 'g> {
    /// The constraint of all closures: on the velocity if that is among the arguments, else on the configuration. `None` with
    /// an error, which was reported.
    pub fn constraint(&mut self, declaration: &Declaration) -> Option<Constraint<'g>> {
        let Declaration { constraints: closures, dials, kinetic, .. } = declaration;
        let graph = self.context.graph;
        let (mut places, mut rows, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let (mut of_places, mut of_velocities) = (Vec::new(), Vec::new());
        for closure in closures {
            let Equations { all, velocities } = self.equations(closure)?;
            match &velocities {
                Some(velocities) => {
                    let found = self::of_velocities(closure, &all, velocities, self.context.diagnostics)?;
                    rows.push(found.rows);
                    values.push(found.values);
                }
                None => {
                    all.iter().try_for_each(|sides| check_squares(self.context, sides))?;
                    places.extend(all.each(|sides| sides.difference));
                }
            }
            let is_of_velocities = velocities.is_some();
            let known = if is_of_velocities { &mut of_velocities } else { &mut of_places };
            let equation =
                |Sides { difference, written }| Equation { count: difference.shape().rows, written, is_of_velocities };
            known.extend(all.into_each(equation));
        }
        of_places.extend(of_velocities);
        if let (Kinetic::Cost(_), Some(chosen), true) = (kinetic, &dials.discretization, rows.is_empty()) {
            let discretization = (Feature::Discretization, Found::at(chosen.span));
            let error = features::refusal(discretization, (Feature::Cost, Found::somewhere()));
            self.context.diagnostics.push(error.note("a constraint on places has no velocity to discretise"));
        }
        let velocities = || VelocityRows { rows: graph.below(&rows), values: graph.below(&values) };
        Some(Constraint {
            places: (!places.is_empty()).then(|| graph.below(&places)),
            velocities: (!rows.is_empty()).then(velocities),
            equations: of_places,
            discretization: dials.discretization.as_ref().map(|chosen| chosen.value),
        })
    }

    /// The equations of one closure.
    fn equations(&mut self, closure: &Closure) -> Option<Equations<'g>> {
        let (graph, diagnostics) = (self.context.graph, self.context.diagnostics);
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
            let equations = list.elems.iter().map(|syntax| element(elaborator, syntax)).into_list();
            let all = equations.into_iter().collect::<Option<Vec<Vec<Sides<'g>>>>>()?;
            Some(all.into_iter().flatten().into_list())
        })?;
        if all.is_empty() {
            refuse!(diagnostics, list, "the constraint has no equation"; help "write a range with a number in it, as in `(0..2)`");
        }
        Some(Equations { all, velocities })
    }
}

/// No square in the potential is that of an equation: such a term is zero with its force wherever the equation holds.
pub(super) fn check_squares<'g>(context: &Context<'_, 'g>, Sides { difference, written }: &Sides<'g>) -> Option<()> {
    let repeats = |square: &Expr<'g>| {
        square.shape() == difference.shape()
            && (identity::equal(&[*square], &[*difference]) || identity::equal(&[*square], &[-*difference]))
    };
    let Some((Written { place, text }, _)) = context.squares.iter().find(|(_, square)| repeats(square)) else {
        return Some(());
    };
    refuse!(context.diagnostics, *place, "`{text}` repeats the constraint `{}`", written.text;
        help "leave it out of the potential, or leave out the constraint";
        note "where the equation holds, this term and its force are zero")
}

/// The list that the body ends with.
pub(super) fn list<'s>(closure: &'s Closure, diagnostics: &Diagnostics) -> Option<&'s ExprArray> {
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
        Syntax::MethodCall(call) if call.method == "map" => {
            refuse!(diagnostics, body, "a constraint is a list of equations"; help "write `[{}]`", spell(body))
        }
        Syntax::Macro(list) if list.mac.path.is_ident("vec") => {
            refuse!(diagnostics, body, "a constraint is a list of equations"; help "write `[{}]`", spell_tokens(&list.mac.tokens))
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

/// An element of the list: `a == b`, or `(0..3).map(|i| a == b)` with equations for each number.
fn element<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, syntax: &Syntax) -> Option<Vec<Sides<'g>>> {
    let Some(sequence) = sequence(syntax) else { return equation(elaborator, syntax).map(|only| vec![only]) };
    check_range(elaborator, sequence)?;
    let mut all = elaborator.each_of_map(sequence, of_each)?;
    let text = shortened(syntax);
    all.iter_mut().for_each(|sides| sides.written.text.clone_from(&text));
    Some(all)
}

/// The equations for one index: `a == b`, a list of equations, or those of numbers, `(0..2).map(|k| a == b)`.
pub(super) fn of_each<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, body: &Syntax) -> Option<Vec<Sides<'g>>> {
    elaborator.in_block(body, |elaborator| match (tail(body), sequence(tail(body))) {
        (Syntax::Array(list), _) if list.elems.is_empty() => {
            refuse!(elaborator.context.diagnostics, list, "the constraint has no equation"; help "write one, as in `[a == b]`")
        }
        (Syntax::Array(list), _) => {
            let all = list.elems.iter().map(|syntax| of_each(elaborator, syntax)).into_list();
            Some(all.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().into_list())
        }
        (Syntax::Binary(link), _) if matches!(link.op, BinOp::And(_)) => {
            refuse!(elaborator.context.diagnostics, &link.op, "`{}` is no equation", shortened(body);
                help "separate equations by commas, in a list: write `[{}]`", conjuncts(tail(body)))
        }
        (_, Some(inner)) => {
            check_range(elaborator, inner)?;
            if let Value::Range(..) = elaborator.elaborate(&inner.receiver)? {
                refuse!(elaborator.context.diagnostics, inner, "ranges inside each other make joints of all pairs";
                    help "{}", unrolled("constraint", &elaborator.context.power.as_ref()?.length);
                    note "a joint is of one site, or of two neighbours")
            }
            elaborator.each_of_map(inner, of_each)
        }
        (equation, None) => self::equation(elaborator, equation).map(|only| vec![only]),
    })
}

/// A sequence of equations goes over a range or an array as it is.
pub(super) fn check_range(elaborator: &Elaborator<'_, '_, '_>, sequence: &ExprMethodCall) -> Option<()> {
    let Syntax::MethodCall(call) = inside(&sequence.receiver) else { return Some(()) };
    let (range, diagnostics) = (a_range(elaborator), elaborator.context.diagnostics);
    refuse!(diagnostics, &call.method, "`{}` has no meaning in the constraint", call.method;
        help "go over indices, as in `{range}.map(|i| a == b)`";
        note "each number of a range gives an equation, and their order does not matter")
}

/// A range to write in a message.
fn a_range(elaborator: &Elaborator<'_, '_, '_>) -> String {
    elaborator.context.power.as_ref().map_or_else(|| "(0..3)".to_string(), |power| format!("(1..{})", power.length))
}

/// The expression without parentheses.
fn inside(syntax: &Syntax) -> &Syntax {
    match syntax {
        Syntax::Paren(inner) => inside(&inner.expr),
        Syntax::Group(inner) => inside(&inner.expr),
        other => other,
    }
}

/// A call `….map(…)`.
pub(super) fn sequence(syntax: &Syntax) -> Option<&ExprMethodCall> {
    match inside(syntax) {
        Syntax::MethodCall(call) if call.method == "map" => Some(call),
        _ => None,
    }
}

/// `a == b` as a − b, a scalar or a vector.
pub(super) fn equation<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, syntax: &Syntax) -> Option<Sides<'g>> {
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
        Syntax::MethodCall(call) if ["collect", "into_iter", "to_vec"].iter().any(|name| call.method == name) => {
            refuse!(diagnostics, &call.method, "`{text}` is no equation"; help "write `{}`", spell(&call.receiver))
        }
        Syntax::MethodCall(call) if call.method == "flat_map" => {
            let map = ExprMethodCall { method: Ident::new("map", call.method.span()), ..call.clone() };
            refuse!(diagnostics, &call.method, "`{text}` is no equation"; help "write `{}`", spell(&Syntax::MethodCall(map)))
        }
        Syntax::ForLoop(ExprForLoop { pat, expr, body, for_token, .. }) => {
            let body = match &body.stmts[..] {
                [Stmt::Expr(equation, None)] => spell(equation),
                _ => spell_tokens(body),
            };
            refuse!(diagnostics, for_token, "a loop is no equation";
                help "write `({}).map(|{}| {body})`", spell(inside(expr)), spell_tokens(pat))
        }
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
            let length = elaborator.context.power.as_ref().map(|sites| sites.length.clone());
            if let Some(length) = length {
                let of_all =
                    [&left, &right].into_iter().find(|side| matches!(side, Value::Sum(_) | Value::PerSite(..)));
                match of_all {
                    Some(Value::Sum(_)) => refuse!(diagnostics, syntax, "the equation has a sum over all sites";
                        help "{}", unrolled("constraint", &length);
                        note "a joint is of one site, or of two neighbours"),
                    Some(_) => refuse!(diagnostics, syntax, "the equation is of all sites at once";
                        help "write one of a site for each, as in `(0..{length}).map(|i| {} == …)`", first_site(syntax)),
                    None => {}
                }
            }
            let error = error!(syntax, "the left side is {a} and the right side is {b}: they cannot be equal");
            let help = match zeros.filter(|_| is_zero && a != b) {
                Some(shape) => format!("write `Vector{}::zeros()` for 0", shape.rows),
                None => "write an equation of scalars, or of vectors with one shape".into(),
            };
            diagnostics.refuse(error.help(help))
        }
    }
}

/// The left side of an equation, or the right one, of the site i.
fn first_site(equation: &Syntax) -> String {
    match equation {
        Syntax::Binary(link) if matches!(*link.left, Syntax::Path(_)) => format!("{}[i]", spell(&link.left)),
        _ => "q[i]".to_string(),
    }
}

/// The rows a and the values b with a ξ = b.
fn of_velocities<'g>(
    closure: &Closure,
    equations: &[Sides<'g>],
    velocities: &[Expr<'g>],
    diagnostics: &Diagnostics,
) -> Option<VelocityRows<'g>> {
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
    Some(VelocityRows { rows: graph.below(&rows), values: graph.below(&values) })
}
