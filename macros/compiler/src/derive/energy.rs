//! The kinetic energy ½ ξ·Σξ, the Hessian of the cost at the identity, with the checks that it exists and is regular.

use clebsch_symbolic::{Expr, Shape, identity, integer};

use super::action::identities;
use super::{DiscreteLagrangian, Symbols, naming};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Factor, Kinetic, Mechanics};

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
pub(super) fn kinetic<'g>(
    model: &Mechanics<'g>,
    symbols: &Symbols<'g>,
    cost: Expr<'g>,
) -> Result<Energy<'g>, Diagnostics> {
    if let Kinetic::Lagrangian { energy, velocities, .. } = &model.kinetic {
        let replaced: Vec<_> = velocities.iter().copied().zip(symbols.algebra.iter().copied()).collect();
        return declared(model, symbols, energy.substitute(&replaced));
    }
    let derivatives = along_exponential(model, symbols, cost);
    let second = (model.step_size * derivatives[1] / 2).expand();
    let gyroscopic = gyroscopic(model, derivatives[0])?;
    let kinetic = check_scaling(model, second)?;
    let general = match is_quadratic(model, &derivatives) {
        true => None,
        false => Some(general(model, symbols, cost)?),
    };
    check_rank(model, symbols, kinetic)?;
    Ok(Energy { kinetic, gyroscopic, general })
}

/// lim K(h, I + hξ)/h, less its value at rest.
fn general<'g>(model: &Mechanics<'g>, symbols: &Symbols<'g>, cost: Expr<'g>) -> Result<Expr<'g>, Diagnostics> {
    let h = model.step_size;
    let along = |factor: &Factor<'g>, xi: Expr<'g>| {
        let identity = factor.group.identity(model.graph);
        (factor.symbol, identity + h * factor.group.wedge(xi))
    };
    let elements: Vec<_> = model.factors.iter().zip(&symbols.algebra).map(|(factor, xi)| along(factor, *xi)).collect();
    let action = cost.substitute(&elements) - cost.substitute(&identities(model));
    limit(action.expand_all() / h, h).ok_or_else(|| {
        let f = &model.factors[0].name;
        Diagnostic::new(model.spans.kinetic.place, "cannot read the Lagrangian off this cost")
            .help(format!("write it in terms of `({f} - I) / h`, or give a `lagrangian` instead of a cost"))
            .note("the cost is not quadratic, and its limit K(h, I + h ξ)/h for h to 0 is hidden in a function of h")
            .into()
    })
}

/// The parts of a declared Lagrangian ℓ(t, q, ξ): of second and of first order in ξ.
fn declared<'g>(model: &Mechanics<'g>, symbols: &Symbols<'g>, lagrangian: Expr<'g>) -> Result<Energy<'g>, Diagnostics> {
    let zero = model.graph.integer(0);
    let rest: Vec<_> = symbols.algebra.iter().map(|xi| (*xi, model.graph.zero(xi.shape()))).collect();
    let directions: Vec<_> = symbols.algebra.iter().map(|xi| (*xi, *xi)).collect();
    let first = lagrangian.differential(&directions);
    // d/dξ along ξ itself counts the order of each term: ξ·∂ℓ is 2 T + A·ξ
    let linear = symbols.algebra.iter().map(|xi| lagrangian.gradient(*xi).substitute(&rest).dot(*xi));
    let gyroscopic = linear.fold(zero, |sum, term| sum + term);
    let gyroscopic = if identity::vanishes(gyroscopic) { zero } else { gyroscopic };
    let twice = first - gyroscopic;
    // 2T counts twice under ξ·∂/∂ξ if and only if it is quadratic
    let quadratic = identity::equal(&[twice.differential(&directions)], &[2 * twice]);
    let kinetic = match quadratic {
        true => (twice / 2).expand(),
        false => second_order(symbols, lagrangian),
    };
    check_rank(model, symbols, kinetic)?;
    let general = (!quadratic).then(|| lagrangian - lagrangian.substitute(&rest));
    Ok(Energy { kinetic, gyroscopic, general })
}

/// ½ ξ·Hξ with the Hessian H at rest.
fn second_order<'g>(symbols: &Symbols<'g>, lagrangian: Expr<'g>) -> Expr<'g> {
    let rest: Vec<_> = symbols.algebra.iter().map(|xi| (*xi, xi.graph().zero(xi.shape()))).collect();
    let mut sum = lagrangian.graph().integer(0);
    for xi in &symbols.algebra {
        for eta in &symbols.algebra {
            let block = lagrangian.gradient(*xi).jacobian(*eta).substitute(&rest);
            sum = sum + xi.dot(block * *eta);
        }
    }
    (sum / 2).expand()
}

/// The first to fourth derivatives of K(h, exp εξ) at ε = 0.
fn along_exponential<'g>(model: &Mechanics<'g>, symbols: &Symbols<'g>, cost: Expr<'g>) -> Vec<Expr<'g>> {
    let factors = model.factors.iter().zip(&symbols.algebra);
    let directions: Vec<_> = factors
        .map(|(factor, xi)| (factor.symbol, factor.group.translate_left(factor.symbol, factor.group.wedge(*xi))))
        .collect();
    let at_identity = identities(model);
    let mut derivative = cost;
    let mut derivatives = Vec::new();
    for _ in 0..4 {
        derivative = derivative.differential(&directions);
        derivatives.push(derivative.substitute(&at_identity));
    }
    derivatives
}

/// A·ξ, the limit of the slope of the cost at the identity.
fn gyroscopic<'g>(model: &Mechanics<'g>, slope: Expr<'g>) -> Result<Expr<'g>, Diagnostics> {
    if identity::vanishes(slope) {
        return Ok(model.graph.integer(0));
    }
    let moves = model.configurations.iter().any(|leaf| slope.depends_on(leaf.symbol)) || slope.depends_on(model.time);
    if moves && let Some(limit) = limit(slope, model.step_size) {
        return Ok(limit);
    }
    let f = &model.factors[0].name;
    let error = Diagnostic::new(
        model.spans.kinetic.place,
        format!("the cost has a slope at `{f}` = I, so a body at rest would start to move"),
    )
    .help("use a cost with a minimum there, as in `(F - I).norm_squared() / (2 * h)`")
    .note(format!("its derivative along exp(ε ξ) at the identity is {}", slope.expand()));
    Err(error.into())
}

/// The limit for h → 0 of a sum of powers of h; `None` if it does not exist or cannot be read off.
fn limit<'g>(expr: Expr<'g>, h: Expr<'g>) -> Option<Expr<'g>> {
    let expanded = expr.expand();
    let least = expanded.least_exponent(h)?;
    let zero = h.graph().integer(0);
    let limit = (least >= integer(0)).then(|| expanded.substitute(&[(h, zero)]).expand())?;
    limit.is_defined().then_some(limit)
}

/// The limit of the second variation, h-free as that of an action has to be.
fn check_scaling<'g>(model: &Mechanics<'g>, energy: Expr<'g>) -> Result<Expr<'g>, Diagnostics> {
    let h = model.step_size;
    let scaled = energy.substitute(&[(h, 2 * h)]);
    if energy == scaled || identity::equal(&[energy], &[scaled]) {
        return Ok(energy);
    }
    if let Some(limit) = limit(energy, h)
        && !identity::vanishes(limit)
    {
        return Ok(limit);
    }
    let power = (-6..=6).find(|&k| identity::equal(&[scaled], &[energy.times_power_of_two(k)]));
    let error = Diagnostic::new(model.spans.kinetic.place, "the cost does not scale like an action");
    let f = &model.factors[0].name;
    let error = match power {
        Some(power) if power > 0 => error
            .help(format!(
                "divide by `{}`, as in `… / (2 * h)`",
                if power == 1 { "h".into() } else { format!("h.powi({power})") }
            ))
            .note(format!("with {f} = exp(h*xi) it is h^{} * …, so its Lagrangian vanishes as h goes to 0", power + 1)),
        Some(power) => error
            .help(format!("multiply by `{}`", if power == -1 { "h".into() } else { format!("h.powi({})", -power) }))
            .note(format!(
                "with {f} = exp(h*xi) it is h^{} * …, so its Lagrangian grows without bound as h goes to 0",
                power + 1
            )),
        None => error.help("divide a quadratic form of `F - I` by `2 * h`").note(format!(
            "with {f} = exp(h*xi) its part of second order in xi is h * ({energy}), which still depends on h"
        )),
    };
    Err(error.into())
}

/// Whether derivatives of third and fourth order of the cost vanish faster than those of an action that is not quadratic.
fn is_quadratic<'g>(model: &Mechanics<'g>, derivatives: &[Expr<'g>]) -> bool {
    let survives = |order: i64| {
        let derivative = derivatives[order as usize - 1];
        !identity::vanishes(derivative)
            && derivative.least_exponent(model.step_size).is_some_and(|least| least <= integer(1 - order))
    };
    !(survives(3) || survives(4))
}

fn check_rank<'g>(model: &Mechanics<'g>, symbols: &Symbols<'g>, energy: Expr<'g>) -> Result<(), Diagnostics> {
    let inertia = inertia(symbols, energy);
    if is_multiple_of_identity(inertia) {
        return Ok(());
    }
    let (rank, dimension) = (identity::rank(inertia), inertia.shape().rows);
    if rank == dimension {
        return Ok(());
    }
    let name = &model.factors[0].name;
    let lost = if rank == 0 { Lost::Other } else { lost_direction(model, inertia) };
    let error = match lost {
        Lost::About(axis) => Diagnostic::new(model.spans.kinetic.place, format!("the cost does not fix the rotation about `{axis}`"))
            .note(format!("its Hessian at {name} = I has rank {rank} of {dimension}: the cost is unchanged by rotations about {axis}"))
            .help(format!("use the chord of the group: `self.mass * ({name} - I).norm_squared() / (4 * h)`, which has the same motion")),
        Lost::Basis(directions) => Diagnostic::new(
            model.spans.kinetic.place,
            format!("the cost does not depend on {}", directions.join(" and ")),
        )
        .help(format!("add the chord of the group, as in `… + self.inertia * ({name} - I).norm_squared() / (4 * h)`"))
        .note(format!(
            "its Hessian at the identity has rank {rank} of {dimension}, so the momentum cannot be inverted for {name}"
        )),
        Lost::Other => Diagnostic::new(model.spans.kinetic.place, "the cost does not fix the group element")
            .note(format!("its Hessian at the identity has rank {rank} of {dimension}, so the momentum cannot be inverted for {name}"))
            .help(format!("add a term such as `({name} - I).norm_squared() / (2 * h)`")),
    };
    Err(error.into())
}

/// Whether a matrix is written as a multiple of the identity that does not vanish.
pub(super) fn is_multiple_of_identity(matrix: Expr<'_>) -> bool {
    let (kappa, identity) = (matrix.entry(0, 0), matrix.graph().identity(matrix.shape().rows));
    matrix == kappa * identity && !identity::vanishes(kappa)
}

/// What a degenerate kinetic energy leaves undetermined.
enum Lost {
    About(String),
    Basis(Vec<String>),
    Other,
}

fn lost_direction<'g>(model: &Mechanics<'g>, inertia: Expr<'g>) -> Lost {
    let dimension = inertia.shape().rows;
    for leaf in model.configurations.iter().filter(|leaf| leaf.shape == Shape::vector(dimension)) {
        if identity::vanishes(inertia * leaf.symbol) {
            return Lost::About(leaf.name.clone());
        }
    }
    let is_lost = |j: &usize| identity::vanishes(inertia.block(0, *j, Shape::vector(dimension)));
    let directions: Vec<String> = (0..dimension).filter(is_lost).map(|j| naming::basis_direction(model, j)).collect();
    if directions.is_empty() { Lost::Other } else { Lost::Basis(directions) }
}

/// Σ, the Hessian of ½ ξ·Σξ.
pub(super) fn inertia<'g>(symbols: &Symbols<'g>, energy: Expr<'g>) -> Expr<'g> {
    let dimension: usize = symbols.algebra.iter().map(|xi| xi.shape().rows).sum();
    let shape = Shape::square(dimension);
    let mut row = 0;
    symbols.algebra.iter().fold(energy.graph().zero(shape), |sum, xi| {
        let placed = symbols.slopes(energy.gradient(*xi)).embed(shape, row, 0);
        row += xi.shape().rows;
        sum + placed
    })
}

/// κ, where Σξ = κξ.
pub(super) fn uniform<'g>(symbols: &Symbols<'g>, energy: Expr<'g>, inertia: Expr<'g>) -> Option<Expr<'g>> {
    let kappa = inertia.entry(0, 0).expand();
    let is_still = symbols.algebra.iter().all(|xi| !kappa.depends_on(*xi));
    let is_multiple = |xi: &Expr<'g>| identity::equal(&[energy.gradient(*xi)], &[kappa * *xi]);
    (is_still && symbols.algebra.iter().all(is_multiple)).then_some(kappa)
}

/// V(t, q): the declared potential and what the cost holds of one.
pub(super) fn potential<'g>(
    model: &Mechanics<'g>,
    lagrangian: &DiscreteLagrangian<'g>,
) -> Result<Expr<'g>, Diagnostics> {
    let h = model.step_size;
    let held = match lagrangian.couples {
        true => lagrangian.kinetic.substitute(&identities(model)),
        false => model.graph.integer(0),
    };
    let energy = -((lagrangian.start + held) / h + lagrangian.end / h);
    let scaled = energy.substitute(&[(h, 2 * h)]);
    match energy == scaled || identity::equal(&[energy], &[scaled]) {
        true => Ok(if energy.depends_on(h) { energy.substitute(&[(h, model.graph.integer(1))]) } else { energy }),
        // a Lagrangian of the time is the mean of its values at t and at t + h
        false
            if energy.depends_on(model.time)
                && let Some(limit) = limit(energy, h) =>
        {
            Ok(limit)
        }
        false => {
            let error = Diagnostic::new(
                model.spans.kinetic.place,
                "the part of the cost that depends on the configuration does not scale like an action",
            )
            .help("multiply a potential energy by `h`, as in `- h * self.weight * q.z`")
            .note(format!("divided by h it is {}, which depends on h", -energy));
            Err(error.into())
        }
    }
}
