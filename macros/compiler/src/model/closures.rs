//! The closures as a whole: what each of them gives, and what it has to give.

use clebsch_symbolic::{Expr, Graph, Shape};
use syn::{BinOp, Expr as Syntax, Stmt};

use super::arguments::Arguments;
use super::chart::without_cayley_map;
use super::elaborate::{Context, Elaborator};
use super::leaves::{leaves, new_value_of};
use super::power::Term;
use super::scope::Scope;
use super::sites;
use super::slots::{COST, LAGRANGIAN, POTENTIAL, Slot};
use super::value::{Each, Value};
use super::velocity::Velocity;
use super::{Configuration, Discretization, Factor, Kinetic, Layout, Spans, Written};
use crate::diagnostic::{Location, error, refuse, report};
use crate::parse::{self, Closure, Declaration, spell};

/// What an optional closure gives, if it is there; `None` where it has an error, which was reported.
pub(super) fn optional<C, T>(closure: Option<C>, read: impl FnOnce(C) -> Option<T>) -> Option<Option<T>> {
    closure.map_or(Some(None), |closure| read(closure).map(Some))
}

/// Φ_F(q), leaf by leaf.
pub(super) fn action<'g>(
    context: &mut Context<'_, 'g>,
    declaration: &Declaration,
    arguments: &Arguments<'_, 'g>,
    structure: &Layout,
    configurations: Option<&[Configuration<'g>]>,
) -> Option<Vec<Expr<'g>>> {
    let Closure { key, body, .. } = &declaration.action;
    let scope = arguments.action_scope(&context.diagnostics);
    let value = context.value(&declaration.action, scope)?;
    let value = of_site(context, body, value)?;
    let is = new_value_of(arguments.names.configuration);
    leaves((key, body), &value, structure, configurations?, &is, &context.diagnostics)
}

/// What the action of a power gives for each site; any other value as it is.
fn of_site<'g>(context: &Context<'_, 'g>, body: &Syntax, value: Value<'g>) -> Option<Value<'g>> {
    let Some(power) = &context.power else { return Some(value) };
    match value {
        Value::Sequence(range, each) if range == (context.graph.integer(0), power.count) => Some(*each),
        other => {
            let is = other.describe();
            refuse!(context.diagnostics, tail(body).0, "the action gives {is}, but it has to give a value for each site";
                help "write `(0..{}).map(|i| …)`", power.name)
        }
    }
}

/// The cost, or the Lagrangian with its velocity.
pub(super) fn kinetic<'g>(
    context: &mut Context<'_, 'g>,
    declaration: &Declaration,
    arguments: &Arguments<'_, 'g>,
    structure: &Layout,
    factors: Option<&[Factor<'g>]>,
) -> Option<Kinetic<'g>> {
    match &declaration.kinetic {
        parse::Kinetic::Cost(closure) => cost(context, closure, arguments, factors),
        parse::Kinetic::Lagrangian(closure) => {
            let chosen = declaration.dials.discretization.as_ref();
            let discretization =
                chosen.map_or_else(|| default_discretization(context.graph, factors), |chosen| chosen.value);
            let (energy, velocities, name) = lagrangian(context, closure, arguments, structure, factors)?;
            Some(Kinetic::Lagrangian { energy, velocities, name, discretization })
        }
        // what inputs move is read with them
        parse::Kinetic::Controls(_) | parse::Kinetic::Dynamics(_) => None,
    }
}

/// The Cayley map where it stays in every factor: projected, it grows beyond use. The exponential elsewhere.
pub(super) fn default_discretization(graph: &Graph, factors: Option<&[Factor<'_>]>) -> Discretization {
    if factors.is_some_and(|factors| without_cayley_map(graph, factors).is_some()) {
        Discretization::Exponential
    } else {
        Discretization::Cayley
    }
}

fn cost<'g>(
    context: &mut Context<'_, 'g>,
    closure: &Closure,
    arguments: &Arguments<'_, 'g>,
    factors: Option<&[Factor<'g>]>,
) -> Option<Kinetic<'g>> {
    let matched = arguments.matched(closure, COST, &context.diagnostics);
    let scope = arguments.scope(&matched, &[], &context.diagnostics);
    let cost = scalar(context, closure, scope, "a discrete Lagrangian is a scalar")?;
    for Factor { name, group, .. } in factors?.iter().filter(|factor| !cost.depends_on(factor.symbol)) {
        let example = if group.is_translation() {
            format!("self.mass * {name}.norm_squared() / (2 * h)")
        } else {
            format!("self.mass * ({name} - I).norm_squared() / (4 * h)")
        };
        report!(context.diagnostics, tail(&closure.body).0, "the cost does not depend on `{name}`";
            help "add the kinetic energy of `{name}`, as in `{example}`";
            note "the momentum of `{name}` is the derivative of the cost, and cannot be inverted where that is 0");
    }
    Some(Kinetic::Cost(cost))
}

/// The Lagrangian with the symbols of its velocity and the user's name for it.
fn lagrangian<'g>(
    context: &mut Context<'_, 'g>,
    closure: &Closure,
    arguments: &Arguments<'_, 'g>,
    structure: &Layout,
    factors: Option<&[Factor<'g>]>,
) -> Option<(Expr<'g>, Vec<Expr<'g>>, String)> {
    let graph = context.graph;
    let matched = arguments.matched(closure, LAGRANGIAN, &context.diagnostics);
    let pattern = matched.argument(Slot::Velocity).map(|argument| &argument.pattern);
    let velocity = factors
        .zip(pattern)
        .and_then(|(factors, pattern)| Velocity { graph, factors }.of(pattern, structure, &context.diagnostics));
    let (value, velocities) = velocity.unzip();
    let is_power = context.power.is_some();
    let value = value.map(|own| if is_power { Value::PerSite(Each::Motion, Box::new(own)) } else { own });
    let mut scope = arguments.scope(&matched, &[(Slot::Velocity, value)], &context.diagnostics);
    if let Some((velocities, factors)) = velocities.as_ref().zip(factors) {
        scope.set_velocities(velocities, factors);
    }
    let energy = scalar(context, closure, scope, "a Lagrangian is a scalar")?;
    let (velocities, factors, pattern) = (velocities?, factors?, pattern?);
    let unmoved = |(velocity, _): &(&Expr<'g>, &Factor<'g>)| !energy.depends_on(**velocity);
    if let Some((velocity, factor)) = velocities.iter().zip(factors).find(unmoved) {
        let of = if factors.len() > 1 { format!(" of `{}`", factor.name) } else { String::new() };
        let place = tail(&closure.body).0;
        refuse!(context.diagnostics, place, "the lagrangian does not depend on the velocity `{velocity}`{of}";
            help "add the kinetic energy, as in `{velocity}.dot(&(self.inertia * {velocity})) / 2`");
    }
    Some((energy, velocities, pattern.spell()))
}

/// V(t, q); an opaque one is known by the name of its method alone.
pub(super) fn potential<'g>(
    context: &mut Context<'_, 'g>,
    declaration: &Declaration,
    arguments: &Arguments<'_, 'g>,
    configurations: Option<&[Configuration<'g>]>,
) -> Option<Expr<'g>> {
    match declaration.potential.as_ref()? {
        parse::Potential::Closure(closure) => {
            let matched = arguments.matched(closure, POTENTIAL, &context.diagnostics);
            let scope = arguments.scope(&matched, &[], &context.diagnostics);
            scalar(context, closure, scope, "an energy is a scalar")
        }
        parse::Potential::Opaque(opaque) => {
            let time = opaque.takes_time.then_some(arguments.time);
            let points = configurations?.iter().map(|leaf| leaf.symbol);
            let arguments: Vec<Expr<'g>> = time.into_iter().chain(points).collect();
            let method = opaque.value.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
            Some(context.graph.opaque(&method, 0, &arguments, Shape::scalar()))
        }
    }
}

/// The terms of the potential of a power; one with an error has none.
pub(super) fn potential_of_power<'g>(
    context: &mut Context<'_, 'g>,
    declaration: &Declaration,
    arguments: &Arguments<'_, 'g>,
) -> Option<Vec<Term<'g>>> {
    // by construction: an opaque potential has been refused
    let closure = declaration.potential.as_ref()?.closure()?;
    let matched = arguments.matched(closure, POTENTIAL, &context.diagnostics);
    let scope = arguments.scope(&matched, &[], &context.diagnostics);
    let value = context.value(closure, scope)?;
    if value.terms().is_none() {
        let (place, is) = (tail(&closure.body).0, value.describe());
        report!(context.diagnostics, place, "the potential is {is}, but an energy is a scalar";
            help "add what sites have, as in `(0..N).map(|i| …).sum()`");
    }
    value.terms()
}

/// The value of a closure that has to give a scalar.
pub(super) fn scalar<'g>(
    context: &mut Context<'_, 'g>,
    closure: &Closure,
    scope: Scope<'g>,
    needs: &str,
) -> Option<Expr<'g>> {
    let key = closure.key.to_string();
    let mut elaborator = Elaborator::new(context, &key, scope);
    let value = elaborator.elaborate(&closure.body)?;
    let (place, tail) = tail(&closure.body);
    if let Some(count) = elaborator.context.power.as_ref().map(|power| power.count)
        && let Some(terms) = value.terms()
    {
        match sites::of_one_site(&terms, count, context.graph) {
            Ok(sum) => return Some(sum),
            Err(reason) => {
                refuse!(context.diagnostics, place, "the {key} of a power is a sum over its sites, and {reason}";
                help "write `(0..{count}).map(|i| …).sum()` with what site `i` has alone";
                note "the equation of a step is solved site by site; what ties sites to each other belongs to the potential")
            }
        }
    }
    if let Some(expr) = value.matrix().filter(|expr| expr.shape().is_scalar()) {
        return Some(expr);
    }
    let reason = elaborator.quietly(|elaborator| because(elaborator, tail, &value));
    let error = error!(place, "the {key} is {}, but {needs}", value.describe()).maybe_help(to_scalar(tail, &value));
    context.diagnostics.refuse(reason.into_iter().fold(error, |error, reason| error.note(reason)))
}

/// How a scalar is made from a value.
fn to_scalar(tail: &Syntax, value: &Value) -> Option<String> {
    let text = match tail {
        Syntax::Binary(_) | Syntax::Unary(_) => format!("({})", spell(tail)),
        _ => spell(tail),
    };
    Some(match value {
        Value::Matrix(expr) if expr.shape() == Shape::vector(3) => format!("take a component, as in `{text}.z`"),
        Value::Matrix(expr) if expr.shape().is_column() => format!("take a component, as in `{text}[0]`"),
        Value::Matrix(expr) if expr.shape().is_square() => format!("take the trace, as in `{text}.trace()`"),
        Value::Matrix(_) => format!("take an entry, as in `{text}[(0, 0)]`"),
        Value::Quaternion(_) => format!("take its scalar part, as in `{text}.scalar()`"),
        Value::Array(_) => format!("add its entries, as in `{text}.sum()`"),
        _ => return None,
    })
}

/// Why a product has its shape. `let`s of a block are out of scope here, and then there is no reason.
fn because<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, tail: &Syntax, value: &Value<'g>) -> Option<String> {
    let Syntax::Binary(product) = tail else { return None };
    if !matches!(product.op, BinOp::Mul(_)) {
        return None;
    }
    let left = elaborator.elaborate(&product.left)?.matrix()?;
    let right = elaborator.elaborate(&product.right)?.matrix()?;
    let [left, right] = [left, right].map(|factor| Value::Matrix(factor).describe());
    let (a, b, text) = (spell(&product.left), spell(&product.right), spell(tail));
    Some(format!("`{text}` is {} because `{a}` is {left} and `{b}` is {right}", value.describe()))
}

/// The expression that gives a body its value, and where it is.
pub(super) fn tail(body: &Syntax) -> (Location, &Syntax) {
    match body {
        Syntax::Block(block) => match block.block.stmts.last() {
            Some(Stmt::Expr(value, None)) => tail(value),
            _ => (body.into(), body),
        },
        Syntax::Paren(inner) => tail(&inner.expr),
        Syntax::Group(inner) => tail(&inner.expr),
        _ => (body.into(), body),
    }
}

/// The bodies as they were written.
pub(super) fn spans(declaration: &Declaration) -> Spans {
    let order = declaration.dials.order.as_ref().map(|order| order.span);
    Spans { action: written(&declaration.action), kinetic: written(declaration.kinetic.closure()), order }
}

/// A closure's body as it was written.
pub(super) fn written(closure: &Closure) -> Written {
    Written { place: Location::of(&closure.body), text: spell(&closure.body), arguments: closure.spell_head() }
}
