//! Solutions of the momentum equation without iteration: one square root for bi-invariant energies, or the predictor itself.

use clebsch_symbolic::{Chart, Elements, Expr, Group, Shape, identity};

use super::equation::{MomentumEquation, SineForm, Solution, Sources};
use super::trivialisation::Covector;

/// Whether x = s·h·Σ⁻¹μ solves the equation: on a sphere with the exponential, for one.
pub(super) fn is_solved_by_predictor<'g>(sources: &Sources<'_, 'g>, blocks: &[usize], residual: Expr<'g>) -> bool {
    let velocity = sources.inertia.inverse() * sources.model.graph.below(&sources.symbols.momenta);
    let solution = |&i: &usize| {
        let block = sources.symbols.blocks[i];
        let step = sources.chart_step(i, sources.divisor);
        (block.coordinates, step * velocity.block(block.offset, 0, block.coordinates.shape()))
    };
    let solutions: Vec<_> = blocks.each(solution);
    identity::vanishes(residual.substitute(&solutions))
}

/// The closed form for a block of rotations with kinetic energy ½κ|ξ|² whose momenta turn one plane. These are SO(n) or
/// the rotations of SE(n) for n ≤ 3, spheres for every n, and unit quaternions. `None` if there is none.
///
/// x = a/(1 + √(1 − |a|²)) with a = hμ/Σ. It solves the equation hM = ½κ(F − Fᵀ) of a bi-invariant kinetic energy. Its
/// rotation by θ in one plane has sin θ = |a| and tan(θ/2) = |x|.
pub(super) fn closed_form<'g>(
    sources: &Sources<'_, 'g>,
    before: &Covector<'g>,
    equation: &MomentumEquation<'g>,
    i: usize,
) -> Option<MomentumEquation<'g>> {
    let residual = equation.residual;
    let (model, block) = (sources.model, sources.symbols.blocks[i]);
    let factor = &model.factors[block.factor];
    let start = block.offset - model.offset(block.factor);
    let kappa = sources.inertia.entry(block.offset, block.offset);
    let step = model.step_size / sources.divisor;
    let mu = sources.momentum_of_block(i);
    let f = factor.symbol;
    let sine = match (factor.group, sources.symbols.charts[block.factor]) {
        (Group::SpecialOrthogonal(_), Chart::Cayley) => factor.group.components(f) / 2,
        (Group::SpecialEuclidean(n), Chart::Product) if start == 0 => {
            Group::SpecialOrthogonal(n).components(f.block(0, 0, Shape::square(n))) / 2
        }
        // sin θ = 2 sin(θ/2) cos(θ/2)
        (Group::UnitQuaternions, Chart::Cayley) => 2 * (f.entry(3, 0) * f.block(0, 0, Shape::vector(3))),
        _ => return None,
    };
    let components = before.components(factor.group).block(start, 0, mu.shape());
    let others = (0..sources.symbols.blocks.len()).filter(|&j| j != i);
    let alone = others.fold(residual, |residual, j| sources.without_momentum_of_block(residual, j));
    if !identity::equal(&[components, residual], &[kappa * sine / step, alone]) {
        return None;
    }
    if let Group::SpecialOrthogonal(n) | Group::SpecialEuclidean(n) = factor.group
        && n > 3
    {
        let momentum = sources.momentum_map[block.factor].block(start, 0, mu.shape());
        let matrix = Group::SpecialOrthogonal(n).wedge(momentum);
        // a momentum that turns more than one plane has none
        identity::vanishes(matrix * matrix * matrix + momentum.dot(momentum) * matrix).then_some(())?;
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
    Some(MomentumEquation {
        solution: Solution::ClosedForm,
        formula: Some(sine / (one + (one - sine_squared).sqrt())),
        sine_squared: Some(sine_squared),
        sine: is_rotation.then(in_sine),
        ..equation.clone()
    })
}
