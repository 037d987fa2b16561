//! What is chosen: the closures `controls` and `dynamics`, the price, the bounds and the price of the end.

use clebsch_symbolic::Expr;
use syn::{BinOp, Expr as Syntax};

use super::arguments::Arguments;
use super::chart::without_cayley_map;
use super::closures::{Elaborated, default_discretization, scalar, tail, written};
use super::elaborate::{Context, Elaborator, shortened};
use super::features::{self, Feature, Found};
use super::forces::{self, Input};
use super::leaves::{Expected, leaves, new_value_of};
use super::slots::{BOUNDS, CONTROLS, DYNAMICS, POTENTIAL, PRICE, Slot};
use super::value::Value;
use super::{Bound, Configuration, Discretization, Factor, InputChoice, Motion};
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::{self, Closure, Declaration, Located, spell};

/// The motion that inputs give, with the input; `None` with an error, which was reported.
pub(super) fn motion<'g>(
    context: &mut Context<'_, 'g>,
    system: &forces::ForcedSystem<'_, '_, 'g>,
    declaration: &Declaration,
) -> Option<(Motion<'g>, Input<'g>)> {
    match &declaration.kinetic {
        parse::Kinetic::Controls(closure) => {
            let (input, value) = elaborate(context, system, closure, CONTROLS)?;
            let velocity = forces::components(context, system, closure, &value)?;
            let chosen = declaration.dials.discretization.as_ref();
            let discretization =
                chosen.map_or_else(|| default_discretization(context.graph, Some(system.factors)), |dial| dial.value);
            check_discretization(context, chosen, discretization, system.factors)?;
            Some((Motion::Controls { velocity, discretization }, input))
        }
        parse::Kinetic::Dynamics(closure) => {
            let (input, value) = elaborate(context, system, closure, DYNAMICS)?;
            let expected: Vec<Expected> = system.configurations.iter().map(Expected::point).collect();
            let is = new_value_of(&system.arguments.names.configuration.spell());
            let next = leaves(context, &closure.body, "dynamics", &value, system.configuration, &expected, &is)?;
            Some((Motion::Dynamics(next), input))
        }
        parse::Kinetic::Cost(_) | parse::Kinetic::Lagrangian(_) => None,
    }
}

/// Controls move by the exponential, or by Cayley's map where it stays in the group; `None` where this was refused.
fn check_discretization(
    context: &mut Context<'_, '_>,
    chosen: Option<&Located<Discretization>>,
    discretization: Discretization,
    factors: &[Factor<'_>],
) -> Option<()> {
    let Some(chosen) = chosen else { return Some(()) };
    let chosen = Found::at(chosen.span);
    let refused = match discretization {
        Discretization::Exponential => return Some(()),
        Discretization::Cayley => {
            let group = without_cayley_map(context.graph, factors).map(|factor| factor.group.name(context.graph));
            let Some(name) = group else { return Some(()) };
            let beside = Found::somewhere().named(name);
            features::refusal((Feature::CayleyDiscretization, chosen), (Feature::NoCayleyMap, beside))
        }
        Discretization::Projection | Discretization::MoserVeselov | Discretization::Exact => {
            features::refusal((Feature::OtherDiscretization, chosen), (Feature::Controls, Found::somewhere()))
        }
    };
    context.diagnostics.push(refused);
    None
}

/// A closure whose last argument introduces the input.
fn elaborate<'g>(
    context: &mut Context<'_, 'g>,
    system: &forces::ForcedSystem<'_, '_, 'g>,
    closure: &Closure,
    slots: &[Slot],
) -> Option<(Input<'g>, Value<'g>)> {
    let taken = system.arguments.names.match_slots(closure, slots, &mut context.diagnostics);
    let Some(position) = taken.iter().position(|slot| *slot == Some(Slot::Input)) else {
        if !taken.contains(&None) {
            let error = Diagnostic::new(closure.head, format!("the {} introduce no input", closure.key));
            context.diagnostics.push(error.help("give its type to the last argument, as in `u: Vector2`"));
        }
        return None;
    };
    let input = forces::read_input(context, system, &closure.arguments[position])?;
    let value = forces::value_of(&input);
    let scope = system.arguments.scope(closure, slots, &taken, &[(Slot::Input, Some(value))], &mut context.diagnostics);
    let key = closure.key.to_string();
    let value = Elaborator::new(context, &key, scope).elaborate(&closure.body)?;
    Some((input, value))
}

/// The price and the bounds; `None` if one has an error.
pub(super) fn read<'g>(
    context: &mut Context<'_, 'g>,
    arguments: &Arguments<'_, 'g>,
    control: &parse::Choice,
    input: &Input<'g>,
) -> Option<InputChoice<'g>> {
    let [leaf] = input.1.as_slice() else {
        let error = Diagnostic::new(control.price.head, "what is chosen has to be one vector");
        context.diagnostics.push(error.help("write `u: Vector3`, with all inputs in one vector"));
        return None;
    };
    check_is_vector(context, control, leaf)?;
    let taken = arguments.names.match_slots(&control.price, PRICE, &mut context.diagnostics);
    let chosen = [(Slot::Chosen, Some(forces::value_of(input)))];
    let scope = arguments.scope(&control.price, PRICE, &taken, &chosen, &mut context.diagnostics);
    let price = scalar(context, &control.price, Elaborated { scope, needs: "a price is a scalar" });
    let bounds = control.bounds.as_ref().map(|closure| bounds(context, arguments, closure, input));
    Some(InputChoice {
        price: price?,
        bounds: bounds.map_or(Some(Vec::new()), |bounds| bounds)?,
        written: written(&control.price),
    })
}

/// The price of the end; `None` if it has an error.
pub(super) fn endpoint<'g>(
    context: &mut Context<'_, 'g>,
    arguments: &Arguments<'_, 'g>,
    closure: &Closure,
) -> Option<Expr<'g>> {
    let taken = arguments.names.match_slots(closure, POTENTIAL, &mut context.diagnostics);
    let scope = arguments.scope(closure, POTENTIAL, &taken, &[], &mut context.diagnostics);
    scalar(context, closure, Elaborated { scope, needs: "a price is a scalar" })
}

fn check_is_vector(context: &mut Context<'_, '_>, control: &parse::Choice, leaf: &Configuration<'_>) -> Option<()> {
    if leaf.shape.is_column() || leaf.shape.is_scalar() {
        return Some(());
    }
    let error = Diagnostic::new(
        control.price.head,
        format!("what is chosen has to be a vector, and `{}` is {}", leaf.name, leaf.shape),
    );
    context.diagnostics.push(error.help("write `u: Vector3`"));
    None
}

/// `[a <= b, …]` as a − b ≤ 0.
fn bounds<'g>(
    context: &mut Context<'_, 'g>,
    arguments: &Arguments<'_, 'g>,
    closure: &Closure,
    input: &Input<'g>,
) -> Option<Vec<Bound<'g>>> {
    let (place, list) = tail(&closure.body);
    let Syntax::Array(list) = list else {
        let error = Diagnostic::new(place, "bounds are a list of inequalities");
        let name = arguments.names.input.map_or("u".into(), |pattern| pattern.spell());
        context.diagnostics.push(error.help(format!("write `bounds = |{name}| [-1 <= {name}.x, {name}.x <= 1]`")));
        return None;
    };
    // arguments are matched once, so that a mistake in them is told once
    let taken = arguments.names.match_slots(closure, BOUNDS, &mut context.diagnostics);
    if taken.contains(&None) {
        return None;
    }
    let mut found = Vec::new();
    for inequality in &list.elems {
        let (lower, upper) = sides(context, inequality)?;
        let mut side = |side: &Syntax| {
            let chosen = [(Slot::Chosen, Some(forces::value_of(input)))];
            let scope = arguments.scope(closure, BOUNDS, &taken, &chosen, &mut context.diagnostics);
            let value = Elaborator::new(context, "bounds", scope).elaborate(side)?;
            match value.matrix().filter(|value| value.shape().is_scalar()) {
                Some(value) => Some(value),
                None => {
                    let message =
                        format!("`{}` is {}, and a bound compares scalars", shortened(&spell(side)), value.describe());
                    context
                        .diagnostics
                        .push(Diagnostic::new(Location::of(side), message).help("compare component by component"));
                    None
                }
            }
        };
        let value = side(lower)? - side(upper)?;
        found.push(Bound { value, text: spell(inequality) });
    }
    Some(found)
}

/// The smaller and the larger side of an inequality.
fn sides<'s>(context: &mut Context<'_, '_>, inequality: &'s Syntax) -> Option<(&'s Syntax, &'s Syntax)> {
    if let Syntax::Binary(comparison) = inequality {
        match comparison.op {
            BinOp::Le(_) => return Some((&comparison.left, &comparison.right)),
            BinOp::Ge(_) => return Some((&comparison.right, &comparison.left)),
            _ => {}
        }
    }
    let error = Diagnostic::new(Location::of(inequality), format!("`{}` is no bound", shortened(&spell(inequality))));
    context
        .diagnostics
        .push(error.help("write `a <= b` or `a >= b`").note("bounds hold with equality where they are active"));
    None
}
