//! The kernels of a step: kick, solve, move, update.

use clebsch_symbolic::{Chart, Expr, Group, Shape};

use super::kernel::kernel;
use super::{Hoisted, Hoisting, Kernel, Scalar, Scalars, grids, inertia_inverse, is_diagonal, plain};
use crate::derive::{Equation, Formulas, Solution, Substep};
use crate::model::Side;

/// The kernels of one substep.
pub struct StepKernels {
    /// J(q, ∂U₀), from q.
    pub start: Option<Kernel>,
    /// J(q, ∂U₁), from q⁺; `None` if there is none.
    pub end: Option<Kernel>,
    /// Whether the end kick of a step is the start kick of the next.
    pub end_is_start: bool,
    /// ∂U₀ for each leaf, for the symmetric representation.
    pub start_gradient: Option<Kernel>,
    /// ∂U₁ for each leaf.
    pub end_gradient: Option<Kernel>,
    /// The momentum equations.
    pub solves: Vec<Solve>,
    /// The increment F − I of each factor, from the chart coordinates.
    pub increment: Kernel,
    /// q⁺, from q and the increments.
    pub advance: Kernel,
    /// M⁺, from M and the increments; `None` if M does not change.
    pub update: Option<Kernel>,
}

/// The kernels of a momentum equation.
pub struct Solve {
    /// The number of unknowns.
    pub dimension: usize,
    /// The components of all momenta that it holds, by index.
    pub components: Vec<usize>,
    /// How it is solved.
    pub solution: Solution,
    /// What is computed once per solve, one output each.
    pub prepare: Kernel,
    /// The starting point, or the solution where there is a formula for it.
    pub predict: Kernel,
    /// |a|² of the closed form, which has to be below one.
    pub sine_squared: Option<Kernel>,
    /// ρ(x) and Dρ(x).
    pub linearize: Kernel,
}

/// The kernels of all substeps.
pub(super) fn steps(formulas: &Formulas<'_>, scalars: &mut Scalars, hoisted: &mut Hoisted) -> Vec<StepKernels> {
    let mut steps: Vec<StepKernels> =
        formulas.substeps.iter().map(|substep| step(formulas, substep, scalars, hoisted)).collect();
    // what serves the inverse Legendre transform alone is never stepped
    for step in steps.iter_mut().skip(formulas.parts()) {
        (step.end, step.start_gradient, step.end_gradient, step.update) = (None, None, None, None);
    }
    steps
}

fn step<'g>(
    formulas: &Formulas<'g>,
    substep: &Substep<'g>,
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> StepKernels {
    let gradients = |potential: Expr<'g>| -> Vec<Expr<'g>> {
        formulas.model.configurations.iter().map(|leaf| potential.gradient(leaf.symbol)).collect()
    };
    let solves =
        substep.equations.iter().map(|equation| solve(formulas, substep, equation, scalars, hoisted)).collect();
    let stacked = |parts: &Option<Vec<Expr<'g>>>, scalars: &mut Scalars, hoisted: &mut Hoisted| {
        parts.as_ref().map(|parts| stack(scalars, hoisted, parts))
    };
    let start = stacked(&substep.start, scalars, hoisted);
    let end = stacked(&substep.end, scalars, hoisted);
    let start_gradient =
        substep.start.as_ref().map(|_| separate(scalars, hoisted, &gradients(substep.lagrangian.start)));
    let end_gradient = substep.end.as_ref().map(|_| separate(scalars, hoisted, &gradients(substep.lagrangian.end)));
    StepKernels {
        end_is_start: substep.start == substep.end,
        start,
        end,
        start_gradient,
        end_gradient,
        solves,
        increment: increment(formulas, scalars),
        advance: advance(formulas, scalars),
        update: update(formulas, substep, scalars),
    }
}

/// Vectors in one output, constants taken out.
fn stack(scalars: &mut Scalars, hoisted: &mut Hoisted, parts: &[Expr<'_>]) -> Kernel {
    let entries: Vec<Scalar> = grids(scalars, parts).into_iter().flat_map(|(_, entries)| entries).collect();
    kernel(scalars, &[(Shape::vector(entries.len()), entries)], Hoisting::Constants(hoisted))
}

fn separate(scalars: &mut Scalars, hoisted: &mut Hoisted, parts: &[Expr<'_>]) -> Kernel {
    let grids = grids(scalars, parts);
    kernel(scalars, &grids, Hoisting::Constants(hoisted))
}

fn solve<'g>(
    formulas: &Formulas<'g>,
    substep: &Substep<'g>,
    equation: &Equation<'g>,
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> Solve {
    let predict = match &equation.closed_form {
        Some(closed_form) => stack(scalars, hoisted, &[closed_form.coordinates]),
        None => stack(scalars, hoisted, &predictor(formulas, substep, equation)),
    };
    let sine_squared =
        equation.closed_form.as_ref().map(|closed_form| stack(scalars, hoisted, &[closed_form.sine_squared]));
    if sine_squared.is_some() {
        return Solve {
            dimension: equation.residual.shape().rows,
            components: components(formulas, equation),
            solution: equation.solution,
            prepare: kernel(scalars, &[], Hoisting::Nothing),
            predict,
            sine_squared,
            linearize: kernel(scalars, &[], Hoisting::Nothing),
        };
    }
    let residual = grids(scalars, &[equation.residual]).remove(0);
    let dimension = residual.0.rows;
    let columns: Vec<Expr<'g>> =
        directions(formulas, equation).iter().map(|direction| equation.directional.substitute(direction)).collect();
    let columns: Vec<Vec<Scalar>> = grids(scalars, &columns).into_iter().map(|(_, entries)| entries).collect();
    let shape = Shape::square(dimension);
    let jacobian = shape.positions().map(|(i, j)| columns[j][i]).collect();
    let mut terms = Hoisted::default();
    let linearize = kernel(scalars, &[residual, (shape, jacobian)], Hoisting::Terms(hoisted, &mut terms));
    let outputs: Vec<_> = terms.scalars.iter().map(|&term| (Shape::scalar(), vec![term])).collect();
    let prepare = kernel(scalars, &outputs, Hoisting::Constants(hoisted));
    Solve {
        dimension,
        components: components(formulas, equation),
        solution: equation.solution,
        prepare,
        predict,
        sine_squared,
        linearize,
    }
}

/// For each unknown of the equation, the replacement of the directions by the unit vector of that unknown.
fn directions<'g>(formulas: &Formulas<'g>, equation: &Equation<'g>) -> Vec<Vec<(Expr<'g>, Expr<'g>)>> {
    let graph = formulas.model.graph;
    let symbols: Vec<Expr<'g>> = equation.factors.iter().map(|&k| formulas.symbols.directions[k]).collect();
    let mut all = Vec::new();
    for moving in &symbols {
        for i in 0..moving.shape().rows {
            let value = |symbol: &Expr<'g>| match symbol == moving {
                true => graph.unit(symbol.shape(), i, 0),
                false => graph.zero(symbol.shape()),
            };
            all.push(symbols.iter().map(|symbol| (*symbol, value(symbol))).collect());
        }
    }
    all
}

/// The indices of the equation's components among those of all factors.
fn components(formulas: &Formulas<'_>, equation: &Equation<'_>) -> Vec<usize> {
    let mut offset = 0;
    let mut components = Vec::new();
    for (k, factor) in formulas.model.factors.iter().enumerate() {
        let dimension = factor.group.dimension();
        if equation.factors.contains(&k) {
            components.extend(offset..offset + dimension);
        }
        offset += dimension;
    }
    components
}

/// x = s·h·Σ⁻¹μ with s = dx/dξ at the identity: the solution to first order in h.
fn predictor<'g>(formulas: &Formulas<'g>, substep: &Substep<'g>, equation: &Equation<'g>) -> Vec<Expr<'g>> {
    let graph = formulas.model.graph;
    let components = components(formulas, equation);
    let shape = Shape::square(components.len());
    let block = |matrix: Expr<'g>| {
        let entry = |(i, j): (usize, usize)| matrix.entry(components[i], components[j]);
        graph.stack(shape, shape.positions().map(entry).collect())
    };
    let inertia = block(formulas.inertia);
    let momenta: Vec<Expr<'g>> = equation.factors.iter().map(|&k| formulas.symbols.momenta[k]).collect();
    let momentum: Vec<Expr<'g>> =
        momenta.iter().flat_map(|mu| (0..mu.shape().rows).map(move |i| mu.entry(i, 0))).collect();
    let velocity: Vec<Expr<'g>> = match is_diagonal(inertia) {
        true => (0..shape.rows).map(|i| momentum[i] / inertia.entry(i, i).expand()).collect(),
        false => {
            let inverse = block(inertia_inverse(formulas));
            let row =
                |i: usize| (0..shape.rows).fold(graph.integer(0), |sum, j| sum + inverse.entry(i, j) * momentum[j]);
            (0..shape.rows).map(row).collect()
        }
    };
    let mut slopes = Vec::new();
    for &k in &equation.factors {
        let group = formulas.model.factors[k].group;
        let (numerator, denominator) = group.chart().slope_at_identity();
        slopes.extend(std::iter::repeat_n(graph.rational(numerator, denominator * substep.parts), group.dimension()));
    }
    let h = formulas.model.step_size;
    velocity.into_iter().zip(slopes).map(|(velocity, slope)| slope * h * velocity).collect()
}

/// F − I of each factor, from the chart coordinates.
fn increment(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    let factors = formulas.model.factors.iter().zip(&formulas.symbols.charts);
    let increments: Vec<_> = factors
        .map(|(factor, x)| {
            let (numerator, denominator) = factor.group.chart().increment(factor.group, *x);
            numerator / denominator
        })
        .collect();
    plain(scalars, &increments)
}

/// The replacement of each group element by I + D (D for translations).
fn increments<'g>(formulas: &Formulas<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let factors = formulas.model.factors.iter().zip(&formulas.symbols.increments);
    factors.map(|(factor, increment)| (factor.symbol, from_increment(factor.group, *increment))).collect()
}

fn from_increment<'g>(group: Group, increment: Expr<'g>) -> Expr<'g> {
    match group.chart() {
        Chart::Cayley => group.identity(increment.graph()) + increment,
        Chart::Identity => increment,
    }
}

/// q⁺ = Φ_F(q) with F = I + D: for linear actions q + D q, without cancellation.
fn advance(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    let elements = increments(formulas);
    let images: Vec<_> = formulas.model.action.iter().map(|image| image.substitute(&elements).expand()).collect();
    plain(scalars, &images)
}

/// M⁺ = Ad*_{F⁻¹} M for a left action, Ad*_F M for a right one.
fn update(formulas: &Formulas<'_>, substep: &Substep<'_>, scalars: &mut Scalars) -> Option<Kernel> {
    if substep.unchanged.iter().all(|unchanged| *unchanged) {
        return None;
    }
    let elements = increments(formulas);
    let updates: Vec<_> = formulas
        .model
        .factors
        .iter()
        .zip(&formulas.symbols.momenta)
        .zip(&substep.unchanged)
        .map(|((factor, mu), unchanged)| match (unchanged, factor.side) {
            (true, _) => *mu,
            (false, Side::Left) => {
                factor.group.coadjoint(factor.group.inverse(factor.symbol), *mu).substitute(&elements).expand()
            }
            (false, Side::Right) => factor.group.coadjoint(factor.symbol, *mu).substitute(&elements).expand(),
        })
        .collect();
    Some(super::stack(scalars, &updates))
}

/// (TΦ_F)^{-*} p with F = I + D.
pub(super) fn cotangent_lift(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    let elements = increments(formulas);
    let lifts: Vec<_> = formulas.cotangent_lift.iter().map(|lift| lift.substitute(&elements).expand()).collect();
    plain(scalars, &lifts)
}
