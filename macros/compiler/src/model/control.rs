//! The choice of inputs: the closures `controls` and `dynamics`, the price, the bounds and the price of the end.

use clebsch_symbolic::Expr;
use syn::{BinOp, Expr as Syntax};

use super::closures::{chosen_discretization, optional, scalar, written};
use super::elaborate::Elaborator;
use super::features::{self, Feature, Found};
use super::groups::without_cayley_map;
use super::slots::{BOUNDS, CONTROLS, DYNAMICS, POTENTIAL, PRICE, RIGHT_HAND_SIDE, Slot};
use super::space::{Space, new_value_of};
use super::typed::ActedSystem;
use super::value::Value;
use super::{Bound, Discretization, InputChoice, Motion};
use crate::diagnostic::{Diagnostic, Diagnostics, error, refuse};
use crate::parse::{
    self, Argument, Closure, Declaration, Located, RungeKutta, joined, parenthesized, shortened, spell, tail,
};

impl<'g> ActedSystem<'_, '_, 'g> {
    /// The motion that inputs give, with the input; `None` with an error, which was reported.
    pub fn motion(&mut self, declaration: &Declaration) -> Option<(Motion<'g>, Space<'g>)> {
        match &declaration.kinetic {
            parse::Kinetic::Controls(closure) => {
                let (input, value) = self.with_input(closure, CONTROLS)?;
                let velocity = self.components(closure, &value)?;
                let discretization = chosen_discretization(self.context.graph, declaration, self.factors);
                self.check_discretization(declaration.dials.discretization.as_ref())?;
                Some((Motion::Controls { velocity, discretization }, input))
            }
            parse::Kinetic::Dynamics(closure, method) => {
                let slots = if method.is_some() { RIGHT_HAND_SIDE } else { DYNAMICS };
                let (input, value) = self.with_input(closure, slots)?;
                let names = &self.arguments.names;
                let is = match method {
                    Some(_) => format!("the rate of `{}`, which has its shape", names.configuration.spell()),
                    None => new_value_of(names.configuration),
                };
                let place = (&closure.key, &closure.body);
                let next = self.space.leaves_of(place, &value, &is, self.context.diagnostics)?;
                // by construction: dynamics move one vector
                let from = method.and_then(|method| Some((*next.first()?, method)));
                let next = from.map_or(next, |(rate, method)| vec![self.integrated(rate, method)]);
                Some((Motion::Dynamics { next, from }, input))
            }
            parse::Kinetic::Cost(_) | parse::Kinetic::Lagrangian(_) => None,
        }
    }

    /// x after a step by an explicit Runge–Kutta method, x′ = `rate`.
    fn integrated(&self, rate: Expr<'g>, method: RungeKutta) -> Expr<'g> {
        let (x, t, h) = (self.space.leaves[0].symbol, self.arguments.time, self.arguments.step_size);
        let later = |part: Expr<'g>, slope: Expr<'g>| rate.substitute(&[(x, x + part * slope), (t, t + part)]);
        match method {
            RungeKutta::Midpoint => x + h * later(h / 2, rate),
            RungeKutta::Classical => {
                let second = later(h / 2, rate);
                let third = later(h / 2, second);
                x + h / 6 * (rate + 2 * second + 2 * third + later(h, third))
            }
        }
    }

    /// Controls move by the exponential, or by Cayley's map where it stays in the group; `None` where this was refused.
    fn check_discretization(&self, chosen: Option<&Located<Discretization>>) -> Option<()> {
        let Some(chosen) = chosen else { return Some(()) };
        let (refused, beside) = match chosen.value {
            Discretization::Exponential => return Some(()),
            Discretization::Cayley => {
                let Some(factor) = without_cayley_map(self.context.graph, self.factors) else { return Some(()) };
                let beside = Found::somewhere().named(factor.group.name(self.context.graph));
                (Feature::CayleyDiscretization, (Feature::NoCayleyMap, beside))
            }
            Discretization::Projection | Discretization::MoserVeselov | Discretization::Exact => {
                (Feature::OtherDiscretization, (Feature::Controls, Found::somewhere()))
            }
        };
        self.context.diagnostics.refuse(features::refusal((refused, Found::at(chosen.span)), beside))
    }

    /// A closure whose last argument introduces the input.
    fn with_input(&mut self, closure: &Closure, slots: &'static [Slot]) -> Option<(Space<'g>, Value<'g>)> {
        let matched = self.arguments.matched(closure, slots);
        let Some(argument) = matched.argument(Slot::Input) else {
            if matched.has_error() {
                return None;
            }
            refuse!(self.context.diagnostics, closure.head, "the {} introduce no input", closure.key;
                help "give its type to the last argument, as in `u: Vector2`");
        };
        let input = self.read_input(argument)?;
        let scope = self.arguments.scope(&matched, &[(Slot::Input, Some(input.value()))]);
        Some((input, self.context.value(closure, scope)?))
    }

    /// The price and the bounds; `None` if one has an error.
    pub fn choice(&mut self, control: &parse::Choice, input: &Space<'g>) -> Option<InputChoice<'g>> {
        let diagnostics = self.context.diagnostics;
        let [leaf] = input.leaves.as_slice() else {
            refuse!(diagnostics, control.price.head, "the input has to be one vector";
                help "write `u: Vector3`, with all inputs in one vector");
        };
        if !leaf.shape.is_column() && !leaf.shape.is_scalar() {
            let (name, shape) = (&leaf.name, leaf.shape);
            refuse!(diagnostics, control.price.head, "the input has to be a vector, and `{name}` is {shape}";
                help "write `u: Vector3`");
        }
        let matched = self.arguments.matched(&control.price, PRICE);
        let scope = self.arguments.scope(&matched, &[(Slot::Chosen, Some(input.value()))]);
        let price = scalar(self.context, &control.price, scope, "a price is a scalar");
        let bounds = optional(control.bounds.as_ref(), |closure| self.bounds(closure, input));
        Some(InputChoice { price: price?, bounds: bounds?.unwrap_or_default(), written: written(&control.price) })
    }

    /// The price of the end; `None` if it has an error.
    pub fn endpoint(&mut self, closure: &Closure) -> Option<Expr<'g>> {
        scalar(self.context, closure, self.arguments.scope_of(closure, POTENTIAL), "a price is a scalar")
    }

    /// `[a <= b, …]` as a − b ≤ 0.
    fn bounds(&mut self, closure: &Closure, input: &Space<'g>) -> Option<Vec<Bound<'g>>> {
        let diagnostics = self.context.diagnostics;
        let body = tail(&closure.body);
        let Syntax::Array(list) = body else {
            let name = self.arguments.names.input.map_or("u".into(), |pattern| pattern.spell());
            refuse!(diagnostics, body, "bounds are a list of inequalities";
                help "write `bounds = |{}| [{}]`", joined(closure.arguments.iter().map(Argument::spell)), conjuncts(body).unwrap_or(format!("-1 <= {name}.x, {name}.x <= 1")));
        };
        // arguments are matched once, so that a mistake in them is told once
        let matched = self.arguments.matched(closure, BOUNDS);
        if matched.has_error() {
            return None;
        }
        let mut side = |side: &Syntax| {
            let scope = self.arguments.scope(&matched, &[(Slot::Chosen, Some(input.value()))]);
            let value = Elaborator::new(self.context, "bounds", scope).elaborate(side)?;
            let Some(scalar) = value.matrix().filter(|value| value.shape().is_scalar()) else {
                let (text, is) = (shortened(side), value.describe());
                refuse!(diagnostics, side, "`{text}` is {is}, and a bound compares scalars";
                    help "compare component by component, as in `{}.x <= 1`", parenthesized(side));
            };
            Some(scalar)
        };
        let bound = |inequality: &Syntax| {
            let (lower, upper) = sides(inequality, diagnostics)?;
            if let Some(error) = without_absolute_value((lower, upper)) {
                return diagnostics.refuse(error);
            }
            Some(Bound { value: side(lower)? - side(upper)?, text: spell(inequality) })
        };
        list.elems.iter().map(bound).collect()
    }
}

/// The inequalities of `a <= b && c <= d`, separated by commas.
fn conjuncts(body: &Syntax) -> Option<String> {
    let Syntax::Binary(link) = body else { return None };
    let part = |side: &Syntax| conjuncts(side).unwrap_or_else(|| spell(side));
    match link.op {
        BinOp::And(_) => Some(format!("{}, {}", part(&link.left), part(&link.right))),
        BinOp::Le(_) | BinOp::Ge(_) => Some(spell(body)),
        _ => None,
    }
}

/// The advice for `x.abs() <= a`.
fn without_absolute_value((lower, upper): (&Syntax, &Syntax)) -> Option<Diagnostic> {
    let Syntax::MethodCall(call) = lower else { return None };
    if call.method != "abs" {
        return None;
    }
    let (inside, limit) = (parenthesized(&call.receiver), parenthesized(upper));
    Some(error!(&call.method, "`abs` has no derivative at 0, so no bounds can use it";
        help "write two bounds, `-{limit} <= {inside}, {inside} <= {limit}`"))
}

/// The smaller and the larger side of an inequality.
fn sides<'s>(inequality: &'s Syntax, diagnostics: &Diagnostics) -> Option<(&'s Syntax, &'s Syntax)> {
    match inequality {
        Syntax::Binary(comparison) if matches!(comparison.op, BinOp::Le(_)) => {
            Some((&comparison.left, &comparison.right))
        }
        Syntax::Binary(comparison) if matches!(comparison.op, BinOp::Ge(_)) => {
            Some((&comparison.right, &comparison.left))
        }
        _ => refuse!(diagnostics, inequality, "`{}` is no bound", shortened(inequality);
            help "write `a <= b` or `a >= b`"; note "bounds hold with equality where they are active"),
    }
}
