//! Solutions of the momentum equation without iteration: one square root for bi-invariant energies, or the predictor itself.
//! A constraint that is affine in the sine adds a linear system for its multipliers.

use clebsch_symbolic::{Chart, Elements, Expr, Group, IntoList, Shape, identity};

use super::constraint::product;
use super::equation::{MomentumEquation, SineForm, Solution, Sources};
use super::letters::Letters;
use super::symbols::at_zero;
use super::trivialisation::Covector;
use super::{ChartBlock, ConstraintFormulas};

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
    let sine = sine(sources, &block)?;
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
    let is_rotation = matches!(factor.group, Group::SpecialOrthogonal(_));
    let in_sine = || SineForm {
        solution: sine,
        residual: kappa * block.coordinates / step - mu,
        directional: kappa * block.direction / step,
    };
    Some(MomentumEquation {
        solution: Solution::ClosedForm,
        formula: Some(half_turned(sine)),
        sine_squared: Some(sine.dot(sine)),
        sine: is_rotation.then(in_sine),
        ..equation.clone()
    })
}

/// a/(1 + √(1 − |a|²)), the tangent of half the angle from its sine.
fn half_turned(sine: Expr<'_>) -> Expr<'_> {
    let one = sine.graph().integer(1);
    sine / (one + (one - sine.dot(sine)).sqrt())
}

/// The sine a of a block of rotations, in the group element; `None` for other blocks.
fn sine<'g>(sources: &Sources<'_, 'g>, block: &ChartBlock<'g>) -> Option<Expr<'g>> {
    let factor = &sources.model.factors[block.factor];
    let is_first = block.offset == sources.model.offset(block.factor);
    let f = factor.symbol;
    Some(match (factor.group, sources.symbols.charts[block.factor]) {
        (Group::SpecialOrthogonal(_), Chart::Cayley) => factor.group.components(f) / 2,
        (Group::SpecialEuclidean(n), Chart::Product) if is_first => {
            Group::SpecialOrthogonal(n).components(f.block(0, 0, Shape::square(n))) / 2
        }
        // sin θ = 2 sin(θ/2) cos(θ/2)
        (Group::UnitQuaternions, Chart::Cayley) => 2 * (f.entry(3, 0) * f.block(0, 0, Shape::vector(3))),
        _ => return None,
    })
}

/// The solution of a step with a constraint that is affine in the sine of its rotation, as that of a ball which rolls.
///
/// The motion is g: x of translations, and the sine a of one rotation. There y = Σ g/h − μ, and ψ = ψ₀ + B g/h. So
///
/// ```text
/// B Σ⁻¹Aᵀ λ = −ψ₀ − B Σ⁻¹μ,    g = h Σ⁻¹(μ + Aᵀλ),    x = a/(1 + √(1 − |a|²))
/// ```
pub(super) struct SolvedConstraint<'g> {
    /// x of all blocks.
    formula: Expr<'g>,
    sine_squared: Expr<'g>,
    /// The equation in the chart of the sine.
    sine: SineForm<'g>,
}

impl<'g> SolvedConstraint<'g> {
    /// Of a step with y and ψ; `None` if they are not affine in such a g.
    pub(super) fn of(
        sources: &Sources<'_, 'g>,
        (constraint, letters): (&ConstraintFormulas<'g>, &Letters<'_, 'g>),
        [difference, between]: [Expr<'g>; 2],
    ) -> Option<SolvedConstraint<'g>> {
        let (graph, symbols) = (sources.model.graph, &sources.symbols);
        let [inertia, inverse] = constraint.inertia;
        let step = sources.model.step_size / sources.divisor;
        let sines: Vec<Option<Expr<'g>>> = symbols.blocks.each(|block| sine(sources, block));
        let mut turning = (0..sines.len()).filter(|&i| sines[i].is_some());
        let (turning, None) = (turning.next()?, turning.next()) else { return None };
        let block = symbols.blocks[turning];
        let is_rotation = matches!(sources.model.factors[block.factor].group, Group::SpecialOrthogonal(2 | 3));
        if !is_rotation || sources.is_moving(inertia) || constraint.places.is_some() {
            return None;
        }
        // the rotation alone has a closed form too: that of the sine
        let own = Shape::new(block.dimension(), inertia.shape().columns);
        let kappa = inertia.entry(block.offset, block.offset);
        let entry = |(i, j): (usize, usize)| if j == block.offset + i { kappa } else { graph.integer(0) };
        let uniform = graph.stack(own, own.positions().map(entry).into_list());
        if !identity::equal(&[inertia.block(block.offset, 0, own)], &[uniform]) {
            return None;
        }
        let motion = |(block, sine): (&ChartBlock<'g>, &Option<Expr<'g>>)| {
            sine.map_or(block.coordinates, |sine| letters.replaced(sine.substitute(&letters.elements)))
        };
        let motions = graph.below(&symbols.blocks.iter().zip(&sines).map(motion).into_list());
        let momenta = graph.below(&symbols.momenta);
        let at_zero = at_zero(symbols.blocks.iter().map(|block| block.coordinates));
        let start = between.substitute(&at_zero).expand();
        let directions: Vec<_> = symbols.blocks.each(|block| (block.coordinates, block.direction));
        let slope = between.differential(&directions).substitute(&at_zero);
        // B, with dx/dg = s/h at g = 0
        let column = |(i, k): (usize, usize)| {
            let unit = |(j, block): (usize, &ChartBlock<'g>)| {
                let shape = block.direction.shape();
                (block.direction, if i == j { graph.unit(shape, k, 0) } else { graph.zero(shape) })
            };
            let units: Vec<_> = symbols.blocks.iter().enumerate().map(unit).into_list();
            (slope.substitute(&units) * sources.chart_step(i, sources.divisor)).expand()
        };
        let components = symbols.blocks.iter().enumerate();
        let components = components.flat_map(|(i, block)| (0..block.dimension()).map(move |k| (i, k)));
        let rows = graph.beside(&components.map(column).into_list());
        let affine = |motions: Expr<'g>| [inertia * motions / step - momenta, start + rows * motions / step];
        let [linear, linear_between] = affine(motions);
        if !identity::equal(&[difference, between], &[linear, linear_between]) {
            return None;
        }
        let by_inertia = product(rows, inverse);
        let metric = product(by_inertia, constraint.rows.transpose());
        let right = -(start + by_inertia * momenta);
        let multipliers = if metric.shape().is_scalar() { right / metric } else { metric.inverse() * right };
        let solution = step * (inverse * (momenta + constraint.rows.transpose() * multipliers));
        let part = |block: &ChartBlock<'g>| solution.block(block.offset, 0, block.coordinates.shape());
        let sine = part(&block);
        let value = |(i, block): (usize, &ChartBlock<'g>)| {
            if i == turning { half_turned(part(block)) } else { part(block) }
        };
        let [difference, between] = affine(graph.below(&symbols.blocks.each(|block| block.coordinates)));
        let residual = constraint.residual(difference, between);
        Some(SolvedConstraint {
            formula: graph.below(&symbols.blocks.iter().enumerate().map(value).into_list()),
            sine_squared: sine.dot(sine),
            sine: SineForm { solution, residual, directional: residual.differential(&directions) },
        })
    }

    /// The equation of all blocks with this solution.
    pub(super) fn solve(self, equation: MomentumEquation<'g>) -> MomentumEquation<'g> {
        let SolvedConstraint { formula, sine_squared, sine } = self;
        MomentumEquation {
            solution: Solution::ClosedForm,
            formula: Some(formula),
            sine_squared: Some(sine_squared),
            sine: Some(sine),
            ..equation
        }
    }
}
