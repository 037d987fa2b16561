//! The closures as a whole: what each of them gives, and what it has to give.

use clebsch_symbolic::{Expr, Graph, Group, Shape};
use syn::{BinOp, Expr as Syntax, Stmt};

use super::arguments::Arguments;
use super::elaborate::{Context, Elaborator};
use super::leaves::{Expected, leaves, new_value_of};
use super::power::Term;
use super::sites;
use super::value::{Each, PerSite, Value};
use super::velocity::Velocity;
use super::{Configuration, Discretization, Factor, Kinetic, Layout, Spans, Written};
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::{self, Closure, Declaration, spell};

/// Φ_F(q), leaf by leaf.
pub(super) fn action<'g>(
    context: &mut Context<'_, 'g>,
    declaration: &Declaration,
    arguments: &Arguments<'_, 'g>,
    structure: &Layout,
    configurations: Option<&[Configuration<'g>]>,
) -> Option<Vec<Expr<'g>>> {
    let closure = &declaration.action;
    let scope = arguments.action_scope(&mut context.diagnostics);
    let value = Elaborator::new(context, "action", scope).elaborate(&closure.body)?;
    let value = of_site(context, &closure.body, value)?;
    let expected: Vec<Expected> = configurations?.iter().map(Expected::point).collect();
    let old = arguments.names.configuration.spell();
    leaves(context, &closure.body, "action", &value, structure, &expected, &new_value_of(&old))
}

/// What the action of a power gives for each site; any other value as it is.
fn of_site<'g>(context: &mut Context<'_, 'g>, body: &Syntax, value: Value<'g>) -> Option<Value<'g>> {
    let Some(power) = &context.power else { return Some(value) };
    let (zero, name) = (context.graph.integer(0), power.name.clone());
    match value {
        Value::Sequence(range, each) if range == (zero, power.count) => Some(*each),
        other => {
            let message = format!("the action gives {}, but it has to give a value for each site", other.describe());
            let error = Diagnostic::new(tail(body).0, message);
            context.diagnostics.push(error.help(format!("write `(0..{name}).map(|i| …)`")));
            None
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
            let discretization = declaration.dials.discretization.as_ref();
            let discretization =
                discretization.map_or_else(|| default_discretization(context.graph, factors), |chosen| chosen.value);
            lagrangian(context, closure, arguments, structure, factors)
                .map(|(energy, velocities, name)| Kinetic::Lagrangian { energy, velocities, name, discretization })
        }
        // what inputs move is read with them
        parse::Kinetic::Controls(_) | parse::Kinetic::Dynamics(_) => None,
    }
}

/// The Cayley map where it stays in every factor: projected, it grows beyond use. The exponential elsewhere.
pub(super) fn default_discretization(graph: &Graph, factors: Option<&[Factor<'_>]>) -> Discretization {
    let leaves = |factor: &&Factor<'_>| !factor.group.is_translation() && !factor.group.has_cayley_chart(graph);
    match factors.is_some_and(|factors| factors.iter().any(|factor| leaves(&factor))) {
        true => Discretization::Exponential,
        false => Discretization::Cayley,
    }
}

fn cost<'g>(
    context: &mut Context<'_, 'g>,
    closure: &Closure,
    arguments: &Arguments<'_, 'g>,
    factors: Option<&[Factor<'g>]>,
) -> Option<Kinetic<'g>> {
    let scope = arguments.cost_scope(closure, &mut context.diagnostics);
    let cost = scalar(context, closure, Elaborated { scope, needs: "a discrete Lagrangian is a scalar" })?;
    for factor in factors? {
        if !cost.depends_on(factor.symbol) {
            let message = format!("the cost does not depend on `{}`", factor.name);
            let error = Diagnostic::new(tail(&closure.body).0, message)
                .help(format!("add the kinetic energy of `{}`, as in `{}`", factor.name, example_cost(factor)))
                .note(format!(
                    "the momentum of `{}` is the derivative of the cost, and cannot be inverted where that is 0",
                    factor.name
                ));
            context.diagnostics.push(error);
        }
    }
    Some(Kinetic::Cost(cost))
}

fn example_cost(factor: &Factor) -> String {
    match factor.group {
        Group::Translation(_) => format!("self.mass * {}.norm_squared() / (2 * h)", factor.name),
        _ => format!("self.mass * ({} - I).norm_squared() / (4 * h)", factor.name),
    }
}

/// The Lagrangian with the symbols of its velocity and the user's name for it.
fn lagrangian<'g>(
    context: &mut Context<'_, 'g>,
    closure: &Closure,
    arguments: &Arguments<'_, 'g>,
    structure: &Layout,
    factors: Option<&[Factor<'g>]>,
) -> Option<(Expr<'g>, Vec<Expr<'g>>, String)> {
    let (taken, pattern) = arguments.velocity(closure, &mut context.diagnostics);
    let velocity = factors.zip(pattern).and_then(|(factors, pattern)| {
        let graph = context.graph;
        Velocity { graph, factors }.of(pattern, structure, &mut context.diagnostics)
    });
    let value = velocity.as_ref().map(|(value, _)| value.clone());
    let value = match context.power.is_some() {
        true => value.map(|own| Value::PerSite(PerSite { of: Each::Motion, own: Box::new(own) })),
        false => value,
    };
    let velocities = velocity.map(|(_, velocities)| velocities);
    let mut scope = arguments.lagrangian_scope(closure, &taken, value, &mut context.diagnostics);
    if let Some((velocities, factors)) = velocities.as_ref().zip(factors) {
        scope.set_velocities(velocities.iter().copied().zip(factors.iter().map(|factor| factor.group)).collect());
    }
    let energy = scalar(context, closure, Elaborated { scope, needs: "a Lagrangian is a scalar" })?;
    let (velocities, factors, pattern) = (velocities?, factors?, pattern?);
    let unmoved = |(velocity, _): &(&Expr<'g>, &Factor<'g>)| !energy.depends_on(**velocity);
    if let Some((velocity, factor)) = velocities.iter().zip(factors).find(unmoved) {
        let of = if factors.len() > 1 { format!(" of `{}`", factor.name) } else { String::new() };
        let message = format!("the lagrangian does not depend on the velocity `{velocity}`{of}");
        let example = format!("{velocity}.dot(&(self.inertia * {velocity})) / 2");
        context.diagnostics.push(
            Diagnostic::new(tail(&closure.body).0, message).help(format!("add the kinetic energy, as in `{example}`")),
        );
        return None;
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
            let scope = arguments.potential_scope(closure, &mut context.diagnostics);
            scalar(context, closure, Elaborated { scope, needs: "an energy is a scalar" })
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
) -> Vec<Term<'g>> {
    // by construction: an opaque potential has been refused
    let Some(parse::Potential::Closure(closure)) = &declaration.potential else { return Vec::new() };
    let scope = arguments.potential_scope(closure, &mut context.diagnostics);
    let Some(value) = Elaborator::new(context, "potential", scope).elaborate(&closure.body) else { return Vec::new() };
    match value {
        Value::Sum(terms) => terms,
        Value::Matrix(value) if value.shape().is_scalar() => vec![Term { ranges: Vec::new(), value }],
        other => {
            let message = format!("the potential is {}, but an energy is a scalar", other.describe());
            let error = Diagnostic::new(tail(&closure.body).0, message);
            context.diagnostics.push(error.help("add what sites have, as in `(0..N).map(|i| …).sum()`"));
            Vec::new()
        }
    }
}

/// What a scalar closure is elaborated with.
pub(super) struct Elaborated<'g> {
    pub scope: super::scope::Scope<'g>,
    pub needs: &'static str,
}

/// The value of a closure that has to give a scalar.
pub(super) fn scalar<'g>(context: &mut Context<'_, 'g>, closure: &Closure, given: Elaborated<'g>) -> Option<Expr<'g>> {
    let key = closure.key.to_string();
    let mut elaborator = Elaborator::new(context, &key, given.scope);
    let value = elaborator.elaborate(&closure.body)?;
    if let Some(count) = elaborator.context.power.as_ref().map(|power| power.count) {
        let terms = match &value {
            Value::Sum(terms) => Some(terms.clone()),
            other => other
                .matrix()
                .filter(|value| value.shape().is_scalar())
                .map(|value| vec![Term { ranges: Vec::new(), value }]),
        };
        if let Some(terms) = terms {
            return match sites::of_one_site(&terms, count, context.graph) {
                Ok(sum) => Some(sum),
                Err(reason) => {
                    let message = format!("the {key} of a power is a sum over its sites, and {reason}");
                    let error = Diagnostic::new(tail(&closure.body).0, message)
                        .help(format!("write `(0..{count}).map(|i| …).sum()` with what site `i` has alone"));
                    context.diagnostics.push(error.note(
                        "the equation of a step is solved site by site; what ties sites to each other belongs to the potential",
                    ));
                    None
                }
            };
        }
    }
    if let Some(expr) = value.matrix().filter(|expr| expr.shape().is_scalar()) {
        return Some(expr);
    }
    let (place, tail) = tail(&closure.body);
    let error = Diagnostic::new(place, format!("the {key} is {}, but {}", value.describe(), given.needs));
    let help = to_scalar(tail, &value);
    let reason = elaborator.quietly(|elaborator| because(elaborator, tail, &value));
    let error = error.maybe_help(help);
    context.diagnostics.push(match reason {
        Some(reason) => error.note(reason),
        None => error,
    });
    None
}

/// How a scalar is made from a value.
fn to_scalar(tail: &Syntax, value: &Value) -> Option<String> {
    let text = match tail {
        Syntax::Binary(_) | Syntax::Unary(_) => format!("({})", spell(tail)),
        _ => spell(tail),
    };
    match value {
        Value::Matrix(expr) if expr.shape() == Shape::vector(3) => Some(format!("take a component, as in `{text}.z`")),
        Value::Matrix(expr) if expr.shape().is_column() => Some(format!("take a component, as in `{text}[0]`")),
        Value::Matrix(expr) if expr.shape().is_square() => Some(format!("take the trace, as in `{text}.trace()`")),
        Value::Matrix(_) => Some(format!("take an entry, as in `{text}[(0, 0)]`")),
        Value::Quaternion(_) => Some(format!("take its scalar part, as in `{text}.scalar()`")),
        Value::Array(_) => Some(format!("add its entries, as in `{text}.sum()`")),
        _ => None,
    }
}

/// Why a product has its shape. `let`s of a block are out of scope here, and then there is no reason.
fn because<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, tail: &Syntax, value: &Value<'g>) -> Option<String> {
    let Syntax::Binary(product) = tail else { return None };
    if !matches!(product.op, BinOp::Mul(_)) {
        return None;
    }
    let left = elaborator.elaborate(&product.left)?;
    let right = elaborator.elaborate(&product.right)?;
    left.shape()?;
    right.shape()?;
    let (a, b) = (spell(&product.left), spell(&product.right));
    Some(format!(
        "`{}` is {} because `{a}` is {} and `{b}` is {}",
        spell(tail),
        value.describe(),
        left.describe(),
        right.describe()
    ))
}

/// The expression that gives a body its value, and where it is.
pub(super) fn tail(body: &Syntax) -> (Location, &Syntax) {
    match body {
        Syntax::Block(block) => match block.block.stmts.last() {
            Some(Stmt::Expr(value, None)) => tail(value),
            _ => (Location::of(body), body),
        },
        Syntax::Paren(inner) => tail(&inner.expr),
        Syntax::Group(inner) => tail(&inner.expr),
        _ => (Location::of(body), body),
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
