//! The values of the closures, and the types that they must have.

use clebsch_symbolic::{Elements, Expr, Graph, Group, IntoList, Shape, both, identity};
use syn::{BinOp, Expr as Syntax, ExprBinary};

use super::elaborate::{Context, Elaborator};
use super::groups::without_cayley_map;
use super::power::Term;
use super::scope::Scope;
use super::sites;
use super::slots::{COST, LAGRANGIAN, MONITOR, POTENTIAL, Slot};
use super::space::new_value_of;
use super::typed::{Arguments, Typed, Velocity};
use super::value::{Each, Value};
use super::{Discretization, Factor, Kinetic, Leaf, Monitor, Parameter, Written};
use crate::diagnostic::{Location, error, refuse, report};
use crate::parse::{self, Closure, Declaration, Opaque, Pattern, parenthesized, spell, tail};

/// The value of an optional closure, if it is there; `None` if it has an error, which was reported.
pub(super) fn optional<C, T>(closure: Option<C>, read: impl FnOnce(C) -> Option<T>) -> Option<Option<T>> {
    closure.map_or(Some(None), |closure| read(closure).map(Some))
}

/// The data for reading closures over the arguments of the action.
pub(super) struct Closures<'a, 'c, 'g> {
    pub context: &'a mut Context<'c, 'g>,
    pub declaration: &'a Declaration,
    pub arguments: &'a Arguments<'a, 'g>,
    pub typed: &'a Typed<'g>,
}

impl<'g> Closures<'_, '_, 'g> {
    /// Φ_F(q), leaf by leaf.
    pub fn action(&mut self) -> Option<Vec<Expr<'g>>> {
        let Closure { key, body, .. } = &self.declaration.action;
        let value = self.context.value(&self.declaration.action, self.arguments.action_scope())?;
        let value = sites::at_each(self.context.power.as_ref(), (value, body), "the action gives");
        let value = self.context.diagnostics.take(value)?;
        let is = new_value_of(self.arguments.names.configuration);
        self.typed.space.as_ref()?.leaves_of((key, body), &value, &is, self.context.diagnostics)
    }

    /// The cost, or the Lagrangian with its velocity.
    pub fn kinetic(&mut self) -> Option<Kinetic<'g>> {
        match &self.declaration.kinetic {
            parse::Kinetic::Cost(closure) => self.cost(closure).map(Kinetic::Cost),
            parse::Kinetic::Lagrangian(closure) => self.lagrangian(closure),
            // closures of inputs that move the configuration are read with them
            parse::Kinetic::Controls(_) | parse::Kinetic::Dynamics(..) => None,
        }
    }

    fn cost(&mut self, closure: &Closure) -> Option<Expr<'g>> {
        let cost =
            scalar(self.context, closure, self.arguments.scope_of(closure, COST), "a discrete Lagrangian is a scalar")?;
        let factors = self.typed.factors.as_deref()?;
        for factor in factors.iter().filter(|factor| !cost.depends_on(factor.symbol)) {
            let Factor { name, group, .. } = factor;
            if self.depends_on_increment(closure, factor) {
                report!(self.context.diagnostics, tail(&closure.body), "`{name}` cancels in the cost";
                    help "write `({name} - I)` in place of `{name}`";
                    note "products like `{name}` times its inverse are the identity, whatever `{name}` is");
                continue;
            }
            let mass = parse::mass(&self.declaration.fields, None);
            let example = if group.is_translation() {
                format!("{mass} * {name}.norm_squared() / (2 * h)")
            } else {
                format!("{mass} * ({name} - I).norm_squared() / (4 * h)")
            };
            report!(self.context.diagnostics, tail(&closure.body), "the cost does not depend on `{name}`";
                help "add the kinetic energy of `{name}`, as in `{example}`";
                note "the momentum of `{name}` is the derivative of the cost, and cannot be inverted where that is 0");
        }
        Some(cost)
    }

    /// Whether the cost would depend on F if it were written in F − I.
    fn depends_on_increment(&mut self, closure: &Closure, factor: &Factor<'g>) -> bool {
        let element = factor.symbol;
        if factor.group.is_translation() || factor.group == Group::UnitQuaternions {
            return false;
        }
        let increment = Value::Matrix(element - factor.group.identity(self.context.graph));
        let diagnostics = self.context.diagnostics;
        diagnostics.quietly(|| {
            let mut scope = self.arguments.scope_of(closure, COST);
            for (_, value) in &mut scope.names {
                let is_element = matches!(value, Some(Value::Matrix(known)) if *known == element);
                *value = if is_element { Some(increment.clone()) } else { value.take() };
            }
            let value = self.context.value(closure, scope);
            value.and_then(|value| value.matrix()).is_some_and(|cost| cost.depends_on(element))
        })
    }

    fn lagrangian(&mut self, closure: &Closure) -> Option<Kinetic<'g>> {
        let (graph, factors) = (self.context.graph, self.typed.factors.as_deref());
        let diagnostics = self.context.diagnostics;
        let matched = self.arguments.matched(closure, LAGRANGIAN);
        let pattern = matched.argument(Slot::Velocity).map(|argument| &argument.pattern);
        let velocity = factors
            .zip(pattern)
            .and_then(|(factors, pattern)| Velocity { graph, factors, diagnostics }.of(pattern, &self.typed.element));
        let (value, velocities) = velocity.unzip();
        let value = value.map(|own| own.of_each(Each::Motion, self.context.power.is_some()));
        let mut scope = self.arguments.scope(&matched, &[(Slot::Velocity, value)]);
        if let Some((velocities, factors)) = velocities.as_ref().zip(factors) {
            scope.set_velocities(velocities, factors);
        }
        let energy = scalar(self.context, closure, scope, "a Lagrangian is a scalar")?;
        let (velocities, factors, pattern) = (velocities?, factors?, pattern?);
        self.check_name(pattern, factors)?;
        let unmoved = |(velocity, _): &(&Expr<'g>, &Factor<'g>)| !energy.depends_on(**velocity);
        if let Some((velocity, factor)) = velocities.iter().zip(factors).find(unmoved) {
            let of = if factors.len() > 1 { format!(" of `{}`", factor.name) } else { String::new() };
            let inertia = parse::mass(&self.declaration.fields, Some(velocity.shape().rows));
            refuse!(diagnostics, tail(&closure.body), "the lagrangian does not depend on the velocity `{velocity}`{of}";
                help "add the kinetic energy, as in `{velocity}.dot(&({inertia} * {velocity})) / 2`");
        }
        self.check_momentum(closure, pattern, energy, &velocities)?;
        let discretization = chosen_discretization(graph, self.declaration, factors);
        Some(Kinetic::Lagrangian { energy, velocities, name: pattern.spell(), discretization })
    }

    /// Refuses `R_dot` for the velocity of a rotation `R`: it is a vector of the algebra, and no derivative of a matrix.
    fn check_name(&self, pattern: &Pattern, factors: &[Factor<'g>]) -> Option<()> {
        let (name, configuration) = (pattern.spell(), self.arguments.names.configuration.spell());
        let is_derivative =
            [format!("{configuration}dot"), format!("{configuration}_dot"), format!("d{configuration}")];
        let [factor] = factors else { return Some(()) };
        if !is_derivative.contains(&name) || factor.group.is_translation() {
            return Some(());
        }
        let (group, n) = (factor.group.name(self.context.graph), factor.group.dimension());
        let error = error!(
            pattern.place(),
            "the velocity is a vector of the Lie algebra of `{group}` with {n} components, not the derivative of `{configuration}`"
        );
        let other = if factor.group == Group::SpecialOrthogonal(3) { "omega" } else { "xi" };
        self.context.diagnostics.refuse(error.help(format!("give it another name, as `{other}`")))
    }

    /// Refuses p²/(2m): a kinetic energy that falls with the mass is a function of the momentum.
    fn check_momentum(
        &mut self,
        closure: &Closure,
        pattern: &Pattern,
        lagrangian: Expr<'g>,
        velocities: &[Expr<'g>],
    ) -> Option<()> {
        let parameters = self.context.fields.parameters.iter();
        let masses: Vec<&Parameter<'g>> = parameters.filter(|field| parse::is_mass(&field.name)).into_list();
        let leaves = masses.iter().flat_map(|field| &field.leaves).map(|leaf| leaf.symbol);
        let heavier: Vec<_> = leaves.map(|symbol| (symbol, 2 * symbol)).into_list();
        let at_rest: Vec<_> = velocities.each(|velocity| (*velocity, self.context.graph.zero(velocity.shape())));
        let kinetic = lagrangian - lagrangian.substitute(&at_rest);
        let falls = !heavier.is_empty() && identity::equal(&[2 * kinetic.substitute(&heavier)], &[kinetic]);
        if let Some(field) = masses.first().filter(|_| falls) {
            let (mass, v) = (&field.name, pattern.spell());
            refuse!(self.context.diagnostics, tail(&closure.body), "the kinetic energy is divided by `self.{mass}`, as that of a momentum is";
                help "{}", of_mass(&format!("self.{mass}"), &field.leaves, &v, velocities);
                note "`{v}` is the velocity: the last argument of the lagrangian is ξ, in the basis of the group");
        }
        Some(())
    }

    /// V(t, q), or its terms in a power; an opaque one is known by the name of its method alone. With an error, which was reported, there
    /// is none.
    pub fn potential(&mut self) -> (Option<Expr<'g>>, Vec<Term<'g>>) {
        let closure = match &self.declaration.potential {
            Some(parse::Potential::Closure(closure)) => closure,
            Some(parse::Potential::Opaque(opaque)) => return (self.opaque(opaque), Vec::new()),
            None => return (None, Vec::new()),
        };
        let scope = self.arguments.scope_of(closure, POTENTIAL);
        if self.context.power.is_none() {
            return (scalar(self.context, closure, scope, "an energy is a scalar"), Vec::new());
        }
        let Some(value) = self.context.value(closure, scope) else { return (None, Vec::new()) };
        if value.terms().is_none() {
            let is = value.describe();
            report!(self.context.diagnostics, tail(&closure.body), "the potential is {is}, but an energy is a scalar";
                help "add the values of sites, as in `(0..N).map(|i| …).sum()`");
        }
        (None, value.terms().unwrap_or_default())
    }

    /// The monitor of `step`; `None` within an error, which was reported.
    pub fn monitor(&mut self) -> Option<Option<Monitor<'g>>> {
        let Some(closure) = &self.declaration.step else { return Some(None) };
        let scope = self.arguments.scope_of(closure, MONITOR);
        let value = scalar(self.context, closure, scope, "the time of a step is a scalar")?;
        Some(Some(Monitor { value, written: written(closure) }))
    }

    fn opaque(&self, opaque: &Opaque) -> Option<Expr<'g>> {
        let time = opaque.takes_time.then_some(self.arguments.time);
        let points = self.typed.space.as_ref()?.leaves.iter().map(|leaf| leaf.symbol);
        let arguments: Vec<Expr<'g>> = time.into_iter().chain(points).into_list();
        let method = opaque.value.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
        Some(self.context.graph.opaque(&method, 0, &arguments, Shape::scalar()))
    }
}

/// The dial; else the Cayley map where it stays in every factor, as it grows beyond use where it is projected, and the exponential elsewhere.
pub(super) fn chosen_discretization(graph: &Graph, declaration: &Declaration, factors: &[Factor]) -> Discretization {
    match &declaration.dials.discretization {
        Some(chosen) => chosen.value,
        None if without_cayley_map(graph, factors).is_some() => Discretization::Exponential,
        None => Discretization::Cayley,
    }
}

/// The advice for the kinetic energy of a velocity, where a mass or an inertia fits it.
fn of_mass(mass: &str, leaves: &[Leaf], name: &str, velocities: &[Expr]) -> String {
    let ([leaf], [velocity]) = (leaves, velocities) else {
        return "write it as a function of the velocity: multiply by the mass".to_string();
    };
    let n = velocity.shape().rows;
    let form = match (leaf.shape.rows, leaf.shape.columns) {
        (1, 1) if n == 1 => format!("{mass} * {name}.powi(2) / 2"),
        (1, 1) => format!("{mass} * {name}.norm_squared() / 2"),
        (rows, 1) if rows == n => format!("{name}.dot(&{mass}.component_mul(&{name})) / 2"),
        (rows, columns) if rows == n && columns == n => format!("{name}.dot(&({mass} * {name})) / 2"),
        _ => return "write it as a function of the velocity: multiply by the mass".to_string(),
    };
    format!("write it as a function of the velocity, as in `{form}`")
}

/// The value of a closure that has to give a scalar.
pub(super) fn scalar<'g>(
    context: &mut Context<'_, 'g>,
    closure: &Closure,
    scope: Scope<'g>,
    is: &str,
) -> Option<Expr<'g>> {
    let key = closure.key.to_string();
    let mut elaborator = Elaborator::new(context, &key, scope);
    let value = elaborator.elaborate(&closure.body)?;
    let tail = tail(&closure.body);
    if let Some((count, length)) = elaborator.context.power.as_ref().map(|power| (power.count, power.length.clone()))
        && let Some(terms) = value.terms()
    {
        match sites::of_one_site(&terms, count, context.graph) {
            Ok(sum) => return Some(sum),
            Err(reason) => {
                refuse!(context.diagnostics, tail, "the {key} of a power is a sum over its sites, and {reason}";
                help "write `(0..{count}).map(|i| …).sum()` with a value of site `i` alone";
                help "{}", sites::unrolled(&key, &length);
                note "the equation of a step is solved site by site; terms that tie sites to each other belong to the potential")
            }
        }
    }
    if let Some(expr) = value.matrix().filter(|expr| expr.shape().is_scalar()) {
        return Some(expr);
    }
    let diagnostics = elaborator.context.diagnostics;
    let reason = diagnostics.quietly(|| because(&mut elaborator, tail, &value));
    let help = of_velocity(closure, &value, &elaborator).or_else(|| to_scalar(&key, tail, &value));
    let error = error!(tail, "the {key} is {}, but {is}", value.describe()).maybe_help(help);
    diagnostics.refuse(reason.into_iter().fold(error, |error, reason| error.note(reason)))
}

/// The kinetic energy, where a Lagrangian gives a vector with the shape of its velocity, a momentum.
fn of_velocity<'g>(closure: &Closure, value: &Value<'g>, elaborator: &Elaborator<'_, '_, 'g>) -> Option<String> {
    let velocity = closure.arguments.last().filter(|_| closure.key == "lagrangian")?.pattern.spell();
    let shape = elaborator.named(&velocity)?.shape();
    let momentum = value.matrix().filter(|momentum| momentum.shape() == shape && shape.is_column())?;
    let energy = elaborator.named(&velocity)?.dot(momentum);
    if identity::vanishes(energy) {
        return Some(format!(
            "a Lagrangian is the kinetic energy: write `{velocity}.dot(&(inertia * {velocity})) / 2`, with the inertia of the body"
        ));
    }
    Some(format!("write `{velocity}.dot(&({}))`", spell(tail(&closure.body))))
}

/// How a scalar is made from a value.
fn to_scalar(key: &str, tail: &Syntax, value: &Value) -> Option<String> {
    let is_operation = matches!(tail, Syntax::Binary(_) | Syntax::Unary(_));
    let text = if is_operation { parenthesized(tail) } else { spell(tail) };
    Some(match value {
        Value::Matrix(expr) if expr.shape().is_column() && key != "potential" => {
            format!("take the square of its length, as in `{text}.norm_squared()`")
        }
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
    let Syntax::Binary(ExprBinary { left: a, op: BinOp::Mul(_), right: b, .. }) = tail else { return None };
    let left = elaborator.elaborate(a)?.matrix()?;
    let right = elaborator.elaborate(b)?.matrix()?;
    let [left, right] = both([left, right], |factor| Value::Matrix(factor).describe());
    let (a, b, text) = (spell(a), spell(b), spell(tail));
    Some(format!("`{text}` is {} because `{a}` is {left} and `{b}` is {right}", value.describe()))
}

pub(super) fn written(closure: &Closure) -> Written {
    Written { place: Location::from(&closure.body), text: spell(&closure.body) }
}
