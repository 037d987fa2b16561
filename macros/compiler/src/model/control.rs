//! The choice of inputs: the closures `controls` and `dynamics`, the price, the bounds and the price of the end.

use clebsch_symbolic::{Elements, Expr, IntoList};
use syn::Expr as Syntax;

use super::closures::{chosen_discretization, optional, scalar, written};
use super::comparisons::{Among, comparisons, conjuncts, equations_first, is_comparison};
use super::elaborate::{Elaborator, Kink};
use super::features::{self, Feature, Found};
use super::groups::without_cayley_map;
use super::scope::Scope;
use super::slots::{
    BOUNDS, BOUNDS_OF_FORCES, CONTROLS, DYNAMICS, EFFORT, END, END_OF_STATES, Matched, PRICE, RIGHT_HAND_SIDE, Slot,
};
use super::space::{Space, new_value_of};
use super::typed::{ActedSystem, Velocity, part};
use super::value::Value;
use super::{Bound, BoundKind, Condition, Discretization, EndPrice, InputChoice, Motion};
use crate::diagnostic::refuse;
use crate::parse::{self, Argument, Closure, Declaration, Located, RungeKutta, joined, tail};

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

    /// A closure that introduces the input.
    fn with_input(&mut self, closure: &Closure, slots: &'static [Slot]) -> Option<(Space<'g>, Value<'g>)> {
        let matched = self.arguments.matched(closure, slots);
        let Some(argument) = matched.argument(Slot::Input) else {
            if matched.has_error() {
                return None;
            }
            refuse!(self.context.diagnostics, closure.head, "the {} introduce no input", closure.key;
                help "write the input behind the configuration, with its type, as in `u: Vector2`");
        };
        let input = self.read_input(argument)?;
        let scope = self.arguments.scope(&matched, &[(Slot::Input, Some(input.value()))]);
        Some((input, self.context.value(closure, scope)?))
    }

    /// The price and the bounds; `None` if one has an error.
    pub fn choice(&mut self, control: &parse::Choice, input: &Space<'g>, is_steered: bool) -> Option<InputChoice<'g>> {
        let diagnostics = self.context.diagnostics;
        let [leaf] = input.leaves.as_slice() else {
            if input.leaves.is_empty() {
                refuse!(diagnostics, control.price.head, "no force takes the input that `effort` prices";
                    help "write `force = |omega, u: Vector3| …`, with the input behind the velocity");
            }
            refuse!(diagnostics, control.price.head, "the input has to be one vector";
                help "write `u: Vector3`, with all inputs in one vector");
        };
        if !leaf.shape.is_column() && !leaf.shape.is_scalar() {
            let (name, shape) = (&leaf.name, leaf.shape);
            refuse!(diagnostics, control.price.head, "the input has to be a vector, and `{name}` is {shape}";
                help "write `u: Vector3`");
        }
        let matched = self.arguments.matched(&control.price, if is_steered { PRICE } else { EFFORT });
        let priced = self.with_velocity(&matched, Some(input)).and_then(|(scope, velocities)| {
            self.context.kinks = Some(Vec::new());
            let price = scalar(self.context, &control.price, scope, "a price is a scalar");
            let kinks = self.context.kinks.take().unwrap_or_default();
            let (price, kinks) = self.without_kinks(price?, kinks, input, &velocities)?;
            Some((price, velocities, kinks))
        });
        let bounded = optional(control.bounds.as_ref(), |closure| self.bounds(closure, input, is_steered));
        let ((price, velocities, kinks), bounded) = (priced?, bounded?);
        let (mut bounds, of_bounds) = bounded.unwrap_or_default();
        // price and bounds speak of one velocity, each under its own name
        if !velocities.is_empty() {
            let names: Vec<_> = of_bounds.iter().copied().zip(velocities.iter().copied()).into_list();
            bounds.iter_mut().for_each(|bound| bound.value = bound.value.substitute(&names));
        }
        bounds.extend(kinks);
        let velocities = if velocities.is_empty() { of_bounds } else { velocities };
        Some(InputChoice { price, velocities, bounds, written: written(&control.price) })
    }

    /// A price p = p₀ + Σ w max(a, 0) as p₀, and as bounds a ≤ 0 that may be violated at the price w.
    fn without_kinks(
        &self,
        price: Expr<'g>,
        kinks: Vec<Kink<'g>>,
        input: &Space<'g>,
        velocities: &[Expr<'g>],
    ) -> Option<(Expr<'g>, Vec<Bound<'g>>)> {
        let (graph, diagnostics) = (self.context.graph, self.context.diagnostics);
        let symbols = kinks.each(|kink| kink.symbol);
        let leaves = self.space.leaves.iter().chain(&input.leaves).map(|leaf| leaf.symbol);
        let moving = leaves.chain(velocities.iter().copied()).chain(symbols.iter().copied()).into_list();
        let moves = |value: Expr<'g>| moving.iter().any(|symbol| value.depends_on(*symbol));
        let soft = |Kink { symbol, value, written }: Kink<'g>| {
            let weight = price.differential(&[(symbol, graph.integer(1))]);
            if symbols.iter().any(|other| value.depends_on(*other)) {
                refuse!(diagnostics, written.place, "`{}` has another `abs` or `max` in it", written.text;
                    help "write a sum of them");
            }
            if moves(weight) {
                refuse!(diagnostics, written.place, "the factor of `{}` depends on the place, the input or the velocity", written.text;
                    help "write a sum of such terms, each times fields and `h`, as in `h * self.price * {}`", written.text);
            }
            Some(Bound { value, kind: BoundKind::Soft(weight), text: written.text })
        };
        let bounds = kinks.into_iter().map(soft).collect::<Option<Vec<_>>>()?;
        let zeros = symbols.each(|symbol| (*symbol, graph.integer(0)));
        Some((price.substitute(&zeros), bounds))
    }

    /// The price of the end, with the velocity there, one for each factor, where it takes one; `None` if it has an
    /// error.
    pub fn endpoint(&mut self, closure: &Closure, is_steered: bool) -> Option<EndPrice<'g>> {
        let matched = self.arguments.matched(closure, if is_steered { END } else { END_OF_STATES });
        let (scope, velocities) = self.with_velocity(&matched, None)?;
        let value = scalar(self.context, closure, scope, "a price is a scalar")?;
        Some(EndPrice { value, velocities, written: written(closure) })
    }

    /// The scope of a price, and the symbols of the velocity, one for each factor; none if it takes no velocity.
    pub(super) fn with_velocity(
        &mut self,
        matched: &Matched<'_>,
        input: Option<&Space<'g>>,
    ) -> Option<(Scope<'g>, Vec<Expr<'g>>)> {
        let velocity =
            Velocity { graph: self.context.graph, factors: self.factors, diagnostics: self.context.diagnostics };
        let pattern = matched.argument(Slot::Velocity).map(|argument| &argument.pattern);
        let (value, velocities) = optional(pattern, |pattern| {
            // a part of the velocity is found in all of it
            let all = self.arguments.names.declared_velocity().filter(|all| all.holds(pattern)).unwrap_or(pattern);
            let (value, symbols) = velocity.of(all, self.element)?;
            Some((part(all, &value, pattern)?, symbols))
        })?
        .unzip();
        let velocities = velocities.unwrap_or_default();
        let introduced = [(Slot::Velocity, value), (Slot::Chosen, input.map(Space::value))];
        let mut scope = self.arguments.scope(matched, &introduced);
        if !velocities.is_empty() {
            scope.set_velocities(&velocities, self.factors);
        }
        Some((scope, velocities))
    }

    /// `[a == b, c <= d, …]` as a − b = 0 and c − d ≤ 0, equations first, with the velocity, one for each factor, where it is taken.
    fn bounds(
        &mut self,
        closure: &Closure,
        input: &Space<'g>,
        is_steered: bool,
    ) -> Option<(Vec<Bound<'g>>, Vec<Expr<'g>>)> {
        let diagnostics = self.context.diagnostics;
        let body = tail(&closure.body);
        let Syntax::Array(list) = body else {
            let name = self.arguments.names.input.map_or("u".into(), |pattern| pattern.spell());
            refuse!(diagnostics, body, "bounds are a list of inequalities and equations";
                help "write `bounds = |{}| [{}]`", joined(closure.arguments.iter().map(Argument::spell)),
                    if is_comparison(body) { conjuncts(body) } else { format!("-1 <= {name}.x, {name}.x <= 1") });
        };
        // arguments are matched once, so that a mistake in them is told once
        let matched = self.arguments.matched(closure, if is_steered { BOUNDS } else { BOUNDS_OF_FORCES });
        if matched.has_error() {
            return None;
        }
        let (scope, velocities) = self.with_velocity(&matched, Some(input))?;
        let mut elaborator = Elaborator::new(self.context, "bounds", scope);
        let leaves = self.space.leaves.iter().chain(&input.leaves).map(|leaf| leaf.symbol);
        let moving = leaves.chain(velocities.iter().copied()).into_list();
        let comparisons =
            elaborator.in_block(&closure.body, |elaborator| comparisons(elaborator, list, (Among::Bounds, &moving)))?;
        let bound = |Condition { left, right, is_equation, text, .. }: Condition<'g>| Bound {
            value: left - right,
            kind: if is_equation { BoundKind::Equation } else { BoundKind::Inequality },
            text,
        };
        Some((equations_first(comparisons).into_iter().map(bound).into_list(), velocities))
    }
}
