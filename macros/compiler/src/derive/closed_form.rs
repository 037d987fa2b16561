//! Solutions of the momentum equation without iteration: one square root for bi-invariant energies, or the predictor itself.

use clebsch_symbolic::{Chart, Expr, Group, Shape, identity};

use super::equation::{MomentumEquation, SineForm, Sources, chart_slope, is_moving, own_part, without_part};
use super::trivialisation::Covector;
use super::{Substep, Symbols};
use crate::model::Mechanics;

/// x = a/(1 + √(1 − |a|²)) with a = hμ/Σ: the equation hM = ½κ(F − Fᵀ) of a bi-invariant kinetic energy, whose rotation by θ
/// in one plane has sin θ = |a| and tan(θ/2) = |x|.
pub(super) struct ClosedForm<'g> {
    /// x(μ).
    pub(super) coordinates: Expr<'g>,
    /// |a|², which has to be below one.
    pub(super) sine_squared: Expr<'g>,
    /// The same in the chart of the sine, where the group has it.
    pub(super) sine: Option<SineForm<'g>>,
}

/// Whether x = s·h·Σ⁻¹μ solves the equation: on a sphere with the exponential, for one.
pub(super) fn is_solved_by_predictor<'g>(sources: &Sources<'_, 'g>, blocks: &[usize], residual: Expr<'g>) -> bool {
    let (model, symbols) = (sources.model, sources.symbols);
    if is_moving(model, sources.inertia) {
        return false;
    }
    let total = sources.inertia.shape().rows;
    let momentum = symbols.momenta.iter().zip(0..).fold(model.graph.zero(Shape::vector(total)), |sum, (mu, k)| {
        sum + mu.embed(Shape::vector(total), model.offset(k), 0)
    });
    let velocity = sources.inertia.inverse() * momentum;
    let solution = |&i: &usize| {
        let block = symbols.blocks[i];
        let (numerator, denominator) = chart_slope(sources.model, sources.symbols, i);
        let step = numerator * model.step_size / (denominator * sources.divisor);
        (block.coordinates, step * velocity.block(block.offset, 0, Shape::vector(block.dimension())))
    };
    let solutions: Vec<_> = blocks.iter().map(solution).collect();
    identity::vanishes(residual.substitute(&solutions))
}

/// The closed form for a block of rotations with kinetic energy ½κ|ξ|² whose momenta turn one plane: SO(n) or the rotations of
/// SE(n) for n ≤ 3, spheres for every n, and unit quaternions.
pub(super) fn closed_form<'g>(
    sources: &Sources<'_, 'g>,
    before: &[Covector<'g>],
    residual: Expr<'g>,
    i: usize,
) -> Option<ClosedForm<'g>> {
    let (model, symbols) = (sources.model, sources.symbols);
    let block = symbols.blocks[i];
    let factor = &model.factors[block.factor];
    let start = block.offset - model.offset(block.factor);
    let kappa = sources.inertia.entry(block.offset, block.offset);
    let step = model.step_size / sources.divisor;
    let mu = own_part(model, symbols, i);
    let f = factor.symbol;
    let sine = match (factor.group, symbols.charts[block.factor]) {
        (Group::SpecialOrthogonal(_), Chart::Cayley) => factor.group.components(f) / 2,
        (Group::SpecialEuclidean(n), Chart::Product) if start == 0 => {
            Group::SpecialOrthogonal(n).components(f.block(0, 0, Shape::square(n))) / 2
        }
        // sin θ = 2 sin(θ/2) cos(θ/2)
        (Group::UnitQuaternions, Chart::Cayley) => 2 * (f.entry(3, 0) * f.block(0, 0, Shape::vector(3))),
        _ => return None,
    };
    let components = before[block.factor].components(factor.group).block(start, 0, mu.shape());
    let alone = without_others(model, symbols, residual, i);
    if !identity::equal(&[components, residual], &[kappa * sine / step, alone]) {
        return None;
    }
    let plane = match factor.group {
        Group::SpecialOrthogonal(n) | Group::SpecialEuclidean(n) if n > 3 => {
            let momentum = sources.momentum_map[block.factor].block(start, 0, mu.shape());
            let matrix = Group::SpecialOrthogonal(n).wedge(momentum);
            identity::vanishes(matrix * matrix * matrix + momentum.dot(momentum) * matrix)
        }
        _ => true,
    };
    if !plane {
        return None;
    }
    let sine = step * mu / kappa;
    let sine_squared = sine.dot(sine);
    let one = model.graph.integer(1);
    let is_rotation = matches!(factor.group, Group::SpecialOrthogonal(_));
    let in_sine = || SineForm {
        solution: sine,
        residual: kappa * block.coordinates / step - mu,
        directional: kappa * block.direction / step,
    };
    let coordinates = sine / (one + (one - sine_squared).sqrt());
    Some(ClosedForm { coordinates, sine_squared, sine: is_rotation.then(in_sine) })
}

/// Takes the chart of the sine for the rotations that every substep solves in closed form: there the solution needs no root and the
/// increment one division, where Cayley's chart has the tangent of half the angle to be undone.
pub(super) fn adopt_sine<'g>(symbols: &mut Symbols<'g>, substeps: &mut [Substep<'g>]) {
    let count = substeps.len();
    for block in symbols.blocks.clone() {
        let mut own: Vec<&mut MomentumEquation<'g>> = substeps
            .iter_mut()
            .filter_map(|substep| {
                substep.equations.iter_mut().find(|equation| equation.components.iter().copied().eq(block.components()))
            })
            .filter(|equation| equation.sine.is_some())
            .collect();
        if own.len() < count {
            continue;
        }
        symbols.charts[block.factor] = Chart::Sine;
        for equation in &mut own {
            let Some(form) = equation.sine else { continue };
            (equation.residual, equation.directional) = (form.residual, form.directional);
            equation.formula = Some(form.solution);
            equation.sine_squared = Some(block.coordinates.norm_squared());
        }
    }
}

/// An expression with all momenta but that of a block set to zero.
fn without_others<'g>(model: &Mechanics<'g>, symbols: &Symbols<'g>, expression: Expr<'g>, i: usize) -> Expr<'g> {
    let others = (0..symbols.blocks.len()).filter(|&j| j != i);
    others.fold(expression, |expression, j| without_part(model, symbols, expression, j))
}
