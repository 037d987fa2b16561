//! The kinetic energy ½ ξ·Σξ, the Hessian of the cost at the identity, with the checks that it exists and is regular.

use clebsch_symbolic::{Expr, Group, Shape, identity, integer};

use super::action::identities;
use super::{DiscreteLagrangian, Symbols};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Model;

/// ½ ξ·Σξ = lim K(h, exp hξ)/h.
pub(super) fn kinetic<'g>(model: &Model<'g>, symbols: &Symbols<'g>, cost: Expr<'g>) -> Result<Expr<'g>, Diagnostics> {
    let derivatives = along_exponential(model, symbols, cost);
    let energy = (model.step_size * derivatives[1] / 2).expand();
    check_rest(model, derivatives[0])?;
    check_scaling(model, energy)?;
    check_quadratic(model, &derivatives)?;
    check_rank(model, symbols, energy)?;
    Ok(energy)
}

/// The first to fourth derivatives of K(h, exp εξ) at ε = 0.
fn along_exponential<'g>(model: &Model<'g>, symbols: &Symbols<'g>, cost: Expr<'g>) -> Vec<Expr<'g>> {
    let factors = model.factors.iter().zip(&symbols.algebra);
    let directions: Vec<_> = factors
        .map(|(factor, xi)| {
            (factor.symbol, factor.group.translate_left(factor.symbol, xi.wedge(factor.group.algebra())))
        })
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

fn check_rest<'g>(model: &Model<'g>, slope: Expr<'g>) -> Result<(), Diagnostics> {
    if identity::vanishes(slope) {
        return Ok(());
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

fn check_scaling<'g>(model: &Model<'g>, energy: Expr<'g>) -> Result<(), Diagnostics> {
    let h = model.step_size;
    let scaled = energy.substitute(&[(h, 2 * h)]);
    if energy == scaled || identity::equal(&[energy], &[scaled]) {
        return Ok(());
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

fn check_quadratic<'g>(model: &Model<'g>, derivatives: &[Expr<'g>]) -> Result<(), Diagnostics> {
    let survives = |order: i64| {
        let derivative = derivatives[order as usize - 1];
        !identity::vanishes(derivative)
            && derivative.least_exponent(model.step_size).is_some_and(|least| least <= integer(1 - order))
    };
    if !(survives(3) || survives(4)) {
        return Ok(());
    }
    let error =
        Diagnostic::new(model.spans.kinetic.place, "the kinetic energy of this cost is not quadratic in the velocity")
            .help("use a quadratic form of `F - I`, divided by `2 * h`")
            .note("costs whose Lagrangian is not quadratic come with a later version of clebsch");
    Err(error.into())
}

fn check_rank<'g>(model: &Model<'g>, symbols: &Symbols<'g>, energy: Expr<'g>) -> Result<(), Diagnostics> {
    let inertia = inertia(symbols, energy);
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

/// What a degenerate kinetic energy leaves undetermined.
enum Lost {
    About(String),
    Basis(Vec<String>),
    Other,
}

fn lost_direction<'g>(model: &Model<'g>, inertia: Expr<'g>) -> Lost {
    let dimension = inertia.shape().rows;
    for leaf in model.configurations.iter().filter(|leaf| leaf.shape == Shape::vector(dimension)) {
        if identity::vanishes(inertia * leaf.symbol) {
            return Lost::About(leaf.name.clone());
        }
    }
    let is_lost = |j: &usize| identity::vanishes(inertia.block(0, *j, Shape::vector(dimension)));
    let directions: Vec<String> = (0..dimension).filter(is_lost).map(|j| basis_direction(model, j)).collect();
    if directions.is_empty() { Lost::Other } else { Lost::Basis(directions) }
}

/// The j-th basis element of all factors together, in words.
fn basis_direction(model: &Model<'_>, mut j: usize) -> String {
    for factor in &model.factors {
        let dimension = factor.group.dimension();
        if j < dimension {
            let of = if model.factors.len() > 1 { format!(" of `{}`", factor.name) } else { String::new() };
            return match factor.group {
                Group::SpecialOrthogonal(3) => format!("the rotation about `e{}`{of}", j + 1),
                Group::SpecialOrthogonal(n) => {
                    let pairs: Vec<_> = (1..=n).flat_map(|a| (a + 1..=n).map(move |b| (a, b))).collect();
                    format!("the rotation in the plane of `e{}` and `e{}`{of}", pairs[j].0, pairs[j].1)
                }
                Group::Translation(_) => format!("the translation along `e{}`{of}", j + 1),
            };
        }
        j -= dimension;
    }
    "a direction of the group".to_string()
}

/// Σ, the Hessian of ½ ξ·Σξ.
pub(super) fn inertia<'g>(symbols: &Symbols<'g>, energy: Expr<'g>) -> Expr<'g> {
    let graph = energy.graph();
    let dimension: usize = symbols.algebra.iter().map(|xi| xi.shape().rows).sum();
    let gradients: Vec<Expr<'g>> = symbols.algebra.iter().map(|xi| energy.gradient(*xi)).collect();
    let mut blocks = graph.zero(Shape::square(dimension));
    let mut row = 0;
    for gradient in &gradients {
        let mut column = 0;
        for xi in &symbols.algebra {
            blocks = blocks + gradient.jacobian(*xi).embed(Shape::square(dimension), row, column);
            column += xi.shape().rows;
        }
        row += gradient.shape().rows;
    }
    blocks
}

/// V(q): the declared potential and what the cost holds of one.
pub(super) fn potential<'g>(model: &Model<'g>, lagrangian: &DiscreteLagrangian<'g>) -> Result<Expr<'g>, Diagnostics> {
    let h = model.step_size;
    let energy = -(lagrangian.start / h + lagrangian.end / h);
    let scaled = energy.substitute(&[(h, 2 * h)]);
    match energy == scaled || identity::equal(&[energy], &[scaled]) {
        true => Ok(if energy.depends_on(h) { energy.substitute(&[(h, model.graph.integer(1))]) } else { energy }),
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
