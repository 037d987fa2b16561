//! What is chosen: the closures `controls` and `dynamics`, the price, the bounds and the price of the end.

use clebsch_symbolic::Expr;
use syn::{BinOp, Expr as Syntax};

use super::closures::{chosen_discretization, optional, scalar, tail, written};
use super::elaborate::{Context, Elaborator, shortened};
use super::features::{self, Feature, Found};
use super::forces::Input;
use super::groups::without_cayley_map;
use super::leaves::{leaves, new_value_of};
use super::slots::{BOUNDS, CONTROLS, DYNAMICS, POTENTIAL, PRICE, Slot};
use super::typed::ActedSystem;
use super::value::Value;
use super::{Bound, Discretization, InputChoice, Motion};
use crate::diagnostic::{Diagnostics, refuse};
use crate::parse::{self, Closure, Declaration, Located, spell};

impl<'g> ActedSystem<'_, 'g> {
    /// The motion that inputs give, with the input; `None` with an error, which was reported.
    pub fn motion(&self, context: &mut Context<'_, 'g>, declaration: &Declaration) -> Option<(Motion<'g>, Input<'g>)> {
        match &declaration.kinetic {
            parse::Kinetic::Controls(closure) => {
                let (input, value) = self.elaborate(context, closure, CONTROLS)?;
                let velocity = self.components(context, closure, &value)?;
                let discretization = chosen_discretization(context.graph, declaration, self.factors);
                self.check_discretization(context, declaration.dials.discretization.as_ref())?;
                Some((Motion::Controls { velocity, discretization }, input))
            }
            parse::Kinetic::Dynamics(closure) => {
                let (input, value) = self.elaborate(context, closure, DYNAMICS)?;
                let is = new_value_of(self.arguments.names.configuration);
                let place = (&closure.key, &closure.body);
                let next = leaves(place, &value, self.configuration, self.configurations, &is, &context.diagnostics)?;
                Some((Motion::Dynamics(next), input))
            }
            parse::Kinetic::Cost(_) | parse::Kinetic::Lagrangian(_) => None,
        }
    }

    /// Controls move by the exponential, or by Cayley's map where it stays in the group; `None` where this was refused.
    fn check_discretization(&self, context: &Context<'_, 'g>, chosen: Option<&Located<Discretization>>) -> Option<()> {
        let Some(chosen) = chosen else { return Some(()) };
        let refused = match chosen.value {
            Discretization::Exponential => return Some(()),
            Discretization::Cayley => {
                let Some(factor) = without_cayley_map(context.graph, self.factors) else { return Some(()) };
                let beside = Found::somewhere().named(factor.group.name(context.graph));
                features::refusal(
                    (Feature::CayleyDiscretization, Found::at(chosen.span)),
                    (Feature::NoCayleyMap, beside),
                )
            }
            Discretization::Projection | Discretization::MoserVeselov | Discretization::Exact => features::refusal(
                (Feature::OtherDiscretization, Found::at(chosen.span)),
                (Feature::Controls, Found::somewhere()),
            ),
        };
        context.diagnostics.refuse(refused)
    }

    /// A closure whose last argument introduces the input.
    fn elaborate(
        &self,
        context: &mut Context<'_, 'g>,
        closure: &Closure,
        slots: &'static [Slot],
    ) -> Option<(Input<'g>, Value<'g>)> {
        let matched = self.arguments.matched(closure, slots, &context.diagnostics);
        let Some(argument) = matched.argument(Slot::Input) else {
            if matched.has_error() {
                return None;
            }
            refuse!(context.diagnostics, closure.head, "the {} introduce no input", closure.key;
                help "give its type to the last argument, as in `u: Vector2`");
        };
        let input = self.read_input(context, argument)?;
        let introduced = [(Slot::Input, Some(input.value()))];
        let scope = self.arguments.scope(&matched, &introduced, &context.diagnostics);
        let value = context.value(closure, scope)?;
        Some((input, value))
    }

    /// The price and the bounds; `None` if one has an error.
    pub fn choice(
        &self,
        context: &mut Context<'_, 'g>,
        control: &parse::Choice,
        input: &Input<'g>,
    ) -> Option<InputChoice<'g>> {
        let [leaf] = input.leaves.as_slice() else {
            refuse!(context.diagnostics, control.price.head, "what is chosen has to be one vector";
                help "write `u: Vector3`, with all inputs in one vector");
        };
        if !leaf.shape.is_column() && !leaf.shape.is_scalar() {
            let (name, shape) = (&leaf.name, leaf.shape);
            refuse!(context.diagnostics, control.price.head, "what is chosen has to be a vector, and `{name}` is {shape}";
                help "write `u: Vector3`");
        }
        let matched = self.arguments.matched(&control.price, PRICE, &context.diagnostics);
        let scope = self.arguments.scope(&matched, &[(Slot::Chosen, Some(input.value()))], &context.diagnostics);
        let price = scalar(context, &control.price, scope, "a price is a scalar");
        let bounds = optional(control.bounds.as_ref(), |closure| self.bounds(context, closure, input));
        Some(InputChoice { price: price?, bounds: bounds?.unwrap_or_default(), written: written(&control.price) })
    }

    /// The price of the end; `None` if it has an error.
    pub fn endpoint(&self, context: &mut Context<'_, 'g>, closure: &Closure) -> Option<Expr<'g>> {
        let scope = self.arguments.scope_of(closure, POTENTIAL, &context.diagnostics);
        scalar(context, closure, scope, "a price is a scalar")
    }

    /// `[a <= b, …]` as a − b ≤ 0.
    fn bounds(&self, context: &mut Context<'_, 'g>, closure: &Closure, input: &Input<'g>) -> Option<Vec<Bound<'g>>> {
        let (place, list) = tail(&closure.body);
        let Syntax::Array(list) = list else {
            let name = self.arguments.names.input.map_or("u".into(), |pattern| pattern.spell());
            refuse!(context.diagnostics, place, "bounds are a list of inequalities";
                help "write `bounds = |{name}| [-1 <= {name}.x, {name}.x <= 1]`");
        };
        // arguments are matched once, so that a mistake in them is told once
        let matched = self.arguments.matched(closure, BOUNDS, &context.diagnostics);
        if matched.has_error() {
            return None;
        }
        let side = |context: &mut Context<'_, 'g>, side: &Syntax| {
            let scope = self.arguments.scope(&matched, &[(Slot::Chosen, Some(input.value()))], &context.diagnostics);
            let value = Elaborator::new(context, "bounds", scope).elaborate(side)?;
            let Some(scalar) = value.matrix().filter(|value| value.shape().is_scalar()) else {
                let (text, is) = (shortened(&spell(side)), value.describe());
                refuse!(context.diagnostics, side, "`{text}` is {is}, and a bound compares scalars";
                    help "compare component by component");
            };
            Some(scalar)
        };
        let bound = |inequality: &Syntax| {
            let (lower, upper) = sides(inequality, &context.diagnostics)?;
            let value = side(context, lower)? - side(context, upper)?;
            Some(Bound { value, text: spell(inequality) })
        };
        list.elems.iter().map(bound).collect()
    }
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
        _ => refuse!(diagnostics, inequality, "`{}` is no bound", shortened(&spell(inequality));
            help "write `a <= b` or `a >= b`"; note "bounds hold with equality where they are active"),
    }
}
