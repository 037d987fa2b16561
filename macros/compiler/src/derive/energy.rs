//! The kinetic energy ½ ξ·Σξ, the Hessian of the cost at the identity, with the checks that it exists and is regular.

use clebsch_symbolic::{Elements, Expr, IntoList, Shape, identity, integer};

use super::symbols::{at_zero, identities};
use super::symmetric::vanishing_for_symmetric;
use super::{DiscreteLagrangian, Symbols, SystemFormulas, degenerate, signature};
use crate::diagnostic::{Diagnostics, bail};
use crate::model::{Factor, Kinetic, Mechanics, Signature, System};

/// The Lagrangian ℓ(t, q, ξ) = ½ ξ·Σξ + A·ξ − V(t, q) that is the limit of ℓd(t, h, q, exp hξ)/h, less the potential.
pub struct Energy<'g> {
    /// ½ ξ·Σξ.
    pub kinetic: Expr<'g>,
    /// A·ξ, the part that is linear in the velocity.
    pub gyroscopic: Expr<'g>,
    /// ℓ(t, q, ξ) − ℓ(t, q, 0) where it is not the sum of the two: a Lagrangian that is not quadratic in the velocity.
    pub general: Option<Expr<'g>>,
}

/// The kinetic part of the continuous Lagrangian.
pub(super) fn kinetic<'g>(model: &Mechanics<'g>, system: &SystemFormulas<'g>) -> Result<Energy<'g>, Diagnostics> {
    let cost = match &model.kinetic {
        Kinetic::Cost(cost) => *cost,
        Kinetic::Lagrangian { energy, velocities, .. } => {
            let replaced: Vec<_> = velocities.iter().copied().zip(system.symbols.algebra.iter().copied()).into_list();
            return declared(model, system, energy.substitute(&replaced));
        }
    };
    let derivatives = along_exponential(system, cost);
    let second = (model.step_size * derivatives[1] / 2).expand();
    let gyroscopic = gyroscopic(model, derivatives[0])?;
    if !gyroscopic.is_zero() {
        let limit = if second.is_zero() { Some(second) } else { limit(second, model.step_size) };
        let of_limit = |limit| check_order(model, &system.symbols.algebra, limit, gyroscopic);
        limit.map_or(Ok(()), of_limit)?;
    }
    let kinetic = check_scaling(model, second)?;
    let general = if is_quadratic(model, &derivatives) { None } else { Some(general(system, cost)?) };
    Ok(Energy { kinetic, gyroscopic, general })
}

/// lim K(h, I + hξ)/h, less its value at rest.
fn general<'g>(system: &SystemFormulas<'g>, cost: Expr<'g>) -> Result<Expr<'g>, Diagnostics> {
    let (model, h) = (&system.model, system.model.step_size);
    let along = |(factor, xi): (&Factor<'g>, &Expr<'g>)| {
        (factor.symbol, factor.group.identity(model.graph) + h * factor.group.wedge(*xi))
    };
    let elements: Vec<_> = model.factors.iter().zip(&system.symbols.algebra).map(along).into_list();
    let action = cost.substitute(&elements) - cost.substitute(&identities(model));
    if let Some(limit) = limit(action.expand_all() / h, h) {
        return Ok(limit);
    }
    bail!(model.spans.kinetic.place, "cannot read the Lagrangian off this cost";
        help "write it in terms of `({} - I) / h`, or give a `lagrangian` instead of a cost", model.factors[0].name;
        note "the cost is not quadratic, and its limit K(h, I + h ξ)/h for h to 0 is hidden in a function of h");
}

/// The parts of a declared Lagrangian ℓ(t, q, ξ): of second and of first order in ξ.
fn declared<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    lagrangian: Expr<'g>,
) -> Result<Energy<'g>, Diagnostics> {
    let (graph, algebra) = (model.graph, &system.symbols.algebra);
    let rest = at_zero(algebra.iter().copied());
    let directions: Vec<_> = algebra.each(|xi| (*xi, *xi));
    let first = lagrangian.differential(&directions);
    // d/dξ along ξ itself counts the order of each term: ξ·∂ℓ is 2 T + A·ξ
    let gyroscopic =
        graph.total(Shape::scalar(), algebra.iter().map(|xi| lagrangian.gradient(*xi).substitute(&rest).dot(*xi)));
    let gyroscopic = if identity::vanishes(gyroscopic) { graph.integer(0) } else { gyroscopic };
    let twice = first - gyroscopic;
    // 2T counts twice under ξ·∂/∂ξ if and only if it is quadratic
    let quadratic = identity::equal(&[twice.differential(&directions)], &[2 * twice]);
    let half = if quadratic { twice } else { twice_second_order(algebra, &rest, lagrangian) } / 2;
    let kinetic = half.expand();
    if quadratic {
        check_order(model, algebra, kinetic, gyroscopic)?;
    }
    let general = (!quadratic).then(|| lagrangian - lagrangian.substitute(&rest));
    Ok(Energy { kinetic, gyroscopic, general })
}

/// ξ·Hξ with the Hessian H at rest.
fn twice_second_order<'g>(algebra: &[Expr<'g>], rest: &[(Expr<'g>, Expr<'g>)], lagrangian: Expr<'g>) -> Expr<'g> {
    let mut sum = lagrangian.graph().integer(0);
    for xi in algebra {
        for eta in algebra {
            sum = sum + xi.dot(lagrangian.gradient(*xi).jacobian(*eta).substitute(rest) * *eta);
        }
    }
    sum
}

/// The first to fourth derivatives of K(h, exp εξ) at ε = 0.
fn along_exponential<'g>(system: &SystemFormulas<'g>, cost: Expr<'g>) -> [Expr<'g>; 4] {
    let along = |(factor, xi): (&Factor<'g>, &Expr<'g>)| {
        (factor.symbol, factor.group.translate_left(factor.symbol, factor.group.wedge(*xi)))
    };
    let directions: Vec<_> = system.model.factors.iter().zip(&system.symbols.algebra).map(along).into_list();
    let at_identity = identities(&system.model);
    let mut derivative = cost;
    std::array::from_fn(|_| {
        derivative = derivative.differential(&directions);
        derivative.substitute(&at_identity)
    })
}

/// A·ξ, the limit of the slope of the cost at the identity.
fn gyroscopic<'g>(model: &System<'g>, slope: Expr<'g>) -> Result<Expr<'g>, Diagnostics> {
    if identity::vanishes(slope) {
        return Ok(model.graph.integer(0));
    }
    if (model.reads_configuration(slope) || slope.depends_on(model.time))
        && let Some(limit) = limit(slope, model.step_size)
    {
        return Ok(limit);
    }
    let place = model.spans.kinetic.place;
    let message =
        format!("the cost has a slope at `{}` = I, so a body at rest would start to move", model.factors[0].name);
    if let [matrix, others @ ..] = vanishing_for_symmetric(model, slope).as_slice() {
        let (verb, names) = match others {
            [] => ("is", format!("`{matrix}`")),
            _ => ("are", others.iter().fold(format!("`{matrix}`"), |names, other| format!("{names} and `{other}`"))),
        };
        bail!(place, "{message} unless {names} {verb} symmetric";
            help "write `#[clebsch(symmetric)]` above the field, which `stepper()` then checks";
            note "its derivative along exp(ε ξ) at the identity is {}", slope.expand());
    }
    bail!(place, "{message}";
        help "use a cost with a minimum there, as in `(F - I).norm_squared() / (2 * h)`";
        note "its derivative along exp(ε ξ) at the identity is {}", slope.expand());
}

/// The limit for h → 0 of a sum of powers of h; `None` if it does not exist or cannot be read off.
fn limit<'g>(expr: Expr<'g>, h: Expr<'g>) -> Option<Expr<'g>> {
    let expanded = expr.expand();
    let least = expanded.least_exponent(h)?;
    let zero = h.graph().integer(0);
    let limit = (least >= integer(0)).then(|| expanded.substitute(&[(h, zero)]).expand())?;
    limit.is_defined().then_some(limit)
}

/// An energy that does not change with h, or the one that it is for short steps. A Lagrangian of the time is the mean of its
/// values at t and at t + h.
fn without_step<'g>(model: &System<'g>, energy: Expr<'g>) -> Option<Expr<'g>> {
    let h = model.step_size;
    if is_free_of_step(energy, h) {
        let is_written = energy.depends_on(h);
        return Some(if is_written { energy.substitute(&[(h, model.graph.integer(1))]) } else { energy });
    }
    if energy.depends_on(model.time) { limit(energy, h) } else { None }
}

/// Whether an expression does not change with h.
fn is_free_of_step<'g>(expr: Expr<'g>, h: Expr<'g>) -> bool {
    let scaled = expr.substitute(&[(h, 2 * h)]);
    expr == scaled || identity::equal(&[expr], &[scaled])
}

/// The limit of the second variation, h-free as that of an action has to be.
fn check_scaling<'g>(model: &System<'g>, energy: Expr<'g>) -> Result<Expr<'g>, Diagnostics> {
    let h = model.step_size;
    if is_free_of_step(energy, h) {
        return Ok(energy);
    }
    if let Some(limit) = limit(energy, h)
        && !identity::vanishes(limit)
    {
        return Ok(limit);
    }
    let scaled = energy.substitute(&[(h, 2 * h)]);
    let power = (-6..=6).find(|&k| identity::equal(&[scaled], &[energy * energy.graph().integer(2).powi(k)]));
    let of_step = match power.map_or(0, i32::abs) {
        1 => "h".to_string(),
        power => format!("h.powi({power})"),
    };
    let (help, limit) = match power {
        // the cost does not read the step
        Some(1) => ("take `h` as the first argument, and divide by it, as in `… / h`".to_string(), "vanishes"),
        Some(1..) => (format!("divide by `{of_step}`"), "vanishes"),
        Some(_) => (format!("multiply by `{of_step}`"), "grows without bound"),
        None => ("divide a quadratic form of `F - I` by `2 * h`".to_string(), ""),
    };
    let why = match power {
        Some(power) => format!("it is h^{} * …, so its Lagrangian {limit} as h goes to 0", power + 1),
        None => format!("its part of second order in xi is h * ({energy}), which still depends on h"),
    };
    let f = &model.factors[0].name;
    bail!(model.spans.kinetic.place, "the cost does not scale like an action";
        help "{help}"; note "with {f} = exp(h*xi) {why}");
}

/// Whether derivatives of third and fourth order of the cost vanish faster than those of an action that is not quadratic.
fn is_quadratic<'g>(model: &System<'g>, derivatives: &[Expr<'g>]) -> bool {
    let survives = |order: i64| {
        let derivative = derivatives[order as usize - 1];
        !identity::vanishes(derivative)
            && derivative.least_exponent(model.step_size).is_some_and(|least| least <= integer(1 - order))
    };
    !(survives(3) || survives(4))
}

/// Refuses velocities that ½ ξ·Σξ + A(t, q)·ξ contains linearly only: their momentum is A, which determines no
/// velocity.
fn check_order<'g>(
    model: &Mechanics<'g>,
    algebra: &[Expr<'g>],
    kinetic: Expr<'g>,
    gyroscopic: Expr<'g>,
) -> Result<(), Diagnostics> {
    let is_linear = |xi: &Expr<'g>| gyroscopic.depends_on(*xi) && identity::vanishes(kinetic.gradient(*xi));
    let linear: Vec<usize> = (0..algebra.len()).filter(|k| is_linear(&algebra[*k])).into_list();
    if linear.is_empty() {
        return Ok(());
    }
    let (what, of_each): (_, Vec<String>) = match &model.kinetic {
        Kinetic::Cost(_) => ("cost", linear.each(|k| format!("of `{}`", model.factors[*k].name))),
        Kinetic::Lagrangian { velocities, .. } => ("lagrangian", linear.each(|k| format!("`{}`", velocities[*k]))),
    };
    let velocity = match of_each.as_slice() {
        [one] => format!("the velocity {one}"),
        all => format!("the velocities {}", all.join(", ")),
    };
    bail!(model.spans.kinetic.place, "the {what} is linear in {velocity}, so no momentum determines a velocity";
        note "that momentum is a function of the configuration: T*Q is not the phase space, and the motion is of first order in time";
        note "systems of first order, as point vortices and guiding centres are, cannot be declared yet");
}

/// Whether Σ is regular for general values of its symbols.
pub(super) fn is_regular(inertia: Expr<'_>) -> bool {
    is_multiple_of_identity(inertia) || identity::rank(inertia) == inertia.shape().rows
}

/// Σ is to be regular, so that a momentum determines a velocity.
pub(super) fn check_rank<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    inertia: Expr<'g>,
) -> Result<(), Diagnostics> {
    if is_regular(inertia) { check_sign(model, inertia) } else { Err(degenerate::error(model, system, inertia).into()) }
}

/// A kinetic energy without parameters has one signature, and `stepper()` would refuse it for every value of them.
fn check_sign<'g>(model: &Mechanics<'g>, inertia: Expr<'g>) -> Result<(), Diagnostics> {
    if model.signature == Signature::Indefinite || !inertia.symbols().is_empty() {
        return Ok(());
    }
    // spheres of many dimensions have a large one
    let inertia = if is_multiple_of_identity(inertia) { inertia.entry(0, 0) } else { inertia };
    let (is, help) = match signature::signature(inertia) {
        None | Some((_, 0)) => return Ok(()),
        Some((0, _)) => ("negative", "change its sign: the potential is subtracted, not the kinetic energy"),
        Some(_) => ("indefinite", "change the sign of the negative terms"),
    };
    bail!(model.spans.kinetic.place, "the kinetic energy is {is}";
        help "{help}"; help "or write `signature = indefinite`, where negative energies are meant");
}

/// Whether a matrix is written as a multiple of the identity that does not vanish.
pub(super) fn is_multiple_of_identity(matrix: Expr<'_>) -> bool {
    let (kappa, identity) = (matrix.entry(0, 0), matrix.graph().identity(matrix.shape().rows));
    matrix == kappa * identity && !identity::vanishes(kappa)
}

/// Σ, the Hessian of ½ ξ·Σξ.
pub(super) fn inertia<'g>(symbols: &Symbols<'g>, energy: Expr<'g>) -> Expr<'g> {
    let rows: Vec<_> = symbols.algebra.each(|xi| symbols.slopes(energy.gradient(*xi)));
    energy.graph().below(&rows)
}

/// κ, where Σξ = κξ.
pub(super) fn uniform<'g>(symbols: &Symbols<'g>, energy: Expr<'g>, inertia: Expr<'g>) -> Option<Expr<'g>> {
    let kappa = inertia.entry(0, 0).expand();
    let is_still = symbols.algebra.iter().all(|xi| !kappa.depends_on(*xi));
    let is_multiple = |xi: &Expr<'g>| identity::equal(&[energy.gradient(*xi)], &[kappa * *xi]);
    (is_still && symbols.algebra.iter().all(is_multiple)).then_some(kappa)
}

/// Whether a potential energy may push: the constants of a Lagrangian do not.
pub(super) fn pushes(model: &Mechanics<'_>, potential: Expr<'_>) -> bool {
    let is_declared = model.potential.is_some() || model.opaque.is_some();
    !potential.is_zero() && (is_declared || model.reads_configuration(potential))
}

/// V(t, q): the declared potential and the potential in the cost, whose value for F = I is given.
pub(super) fn potential<'g>(
    model: &Mechanics<'g>,
    lagrangian: &DiscreteLagrangian<'g>,
    at_rest: Expr<'g>,
) -> Result<Expr<'g>, Diagnostics> {
    let (h, graph) = (model.step_size, model.graph);
    let energy = |held: Expr<'g>| -((lagrangian.start + held) / h + lagrangian.end / h);
    // an energy that a body at rest has at every place, as m c², moves nothing; another value is left out
    let is_single = model.power.is_none() && !lagrangian.couples;
    let is_constant = is_single && !model.reads_configuration(at_rest) && at_rest.is_defined();
    if is_constant
        && !identity::vanishes(at_rest)
        && let Some(energy) = without_step(model, energy(at_rest))
    {
        return Ok(energy);
    }
    let energy = energy(if lagrangian.couples { at_rest } else { graph.integer(0) });
    if let Some(energy) = without_step(model, energy) {
        return Ok(energy);
    }
    let place = model.spans.kinetic.place;
    bail!(place, "the part of the cost that depends on the configuration does not scale like an action";
        help "multiply a potential energy by `h`, as in `- h * self.weight * q.z`";
        note "divided by h it is {}, which depends on h", -energy);
}
