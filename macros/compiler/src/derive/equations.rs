//! The implicit equation in the chart: both trivialisations of ∂_F ℓd, denominators cleared, coupled blocks together.

use clebsch_symbolic::{Chart, Expr, Shape, identity};

use super::action::identities;
use super::clearing;
use super::closed_form::{closed_form, is_solved_by_predictor};
use super::equation::{
    MomentumEquation, Solution, Sources, chart_slope, is_diagonal, is_kept, is_moving, own_part, without_part,
};
use super::trivialisation::Covector;
use super::{Substep, Symbols, exact, structure};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{ChartChoice, Discretization, Mechanics};

/// The momentum equations of a substep.
///
/// `before` holds T* ∂_F K; `coupling` the components of −J(q, ∂_q K) that a coupled cost adds.
pub(super) fn equations<'g>(
    sources: &Sources<'_, 'g>,
    before: &[Covector<'g>],
    coupling: Option<&[Expr<'g>]>,
) -> Vec<MomentumEquation<'g>> {
    let (model, symbols) = (sources.model, sources.symbols);
    let mut residuals: Vec<Residual<'g>> = Vec::new();
    for k in 0..model.factors.len() {
        let (residual, cleared) = match exact::is_free_rotation(model, k) {
            true => (model.graph.zero(symbols.momenta[k].shape()), true),
            false => residual(sources, before, coupling, k),
        };
        residuals.extend(symbols.blocks.iter().filter(|block| block.factor == k).map(|block| {
            let start = block.offset - model.offset(k);
            Residual { rows: residual.block(start, 0, Shape::vector(block.dimension())), cleared }
        }));
    }
    if !sources.forced {
        substitute_explicit(sources, &mut residuals);
    }
    for (residual, block) in residuals.iter_mut().zip(&symbols.blocks) {
        if exact::is_free_rotation(model, block.factor) {
            continue;
        }
        if let Some(rows) = clearing::of_rotation(model, symbols, block, residual.rows) {
            *residual = Residual { rows, cleared: true };
        }
    }
    let depends = |i: usize, j: usize| residuals[i].rows.depends_on(symbols.blocks[j].coordinates);
    let groups = groups(residuals.len(), depends);
    groups
        .into_iter()
        .map(|group| equation(sources, before, &residuals, group))
        .flat_map(|equation| structure::specialised(sources, equation))
        .collect()
}

/// The residual of one block.
#[derive(Copy, Clone)]
struct Residual<'g> {
    rows: Expr<'g>,
    cleared: bool,
}

/// A block whose equation is linear is solved at once, x = s·h·Σ⁻¹μ, and its solution put into the others, where it often leaves
/// nothing: b × hM_v = 0 for a body about its centre of mass.
fn substitute_explicit<'g>(sources: &Sources<'_, 'g>, residuals: &mut [Residual<'g>]) {
    let (model, symbols) = (sources.model, sources.symbols);
    for i in 0..residuals.len() {
        let block = symbols.blocks[i];
        let others = |j: &usize| *j != i;
        if exact::is_free_rotation(model, block.factor) {
            continue;
        }
        let alone =
            !(0..residuals.len()).filter(others).any(|j| residuals[i].rows.depends_on(symbols.blocks[j].coordinates));
        if !alone || is_kept(symbols.charts[block.factor], is_moving(model, residuals[i].rows)) {
            continue;
        }
        let slope = residuals[i].rows.differential(&[(block.coordinates, block.direction)]).expand();
        let inertia = sources.inertia.block(block.offset, block.offset, Shape::square(block.dimension()));
        let linear = !slope.depends_on(block.coordinates) && !slope.depends_on(symbols.momenta[block.factor]);
        if !linear || is_moving(model, slope) || !is_diagonal(inertia) {
            continue;
        }
        let momentum = own_part(model, symbols, i);
        let (numerator, denominator) = chart_slope(model, symbols, i);
        let step = numerator * model.step_size / (denominator * sources.divisor);
        let graph = model.graph;
        let solution: Vec<Expr<'g>> =
            (0..block.dimension()).map(|a| step * momentum.entry(a, 0) / inertia.entry(a, a).expand()).collect();
        let solution = graph.stack(Shape::vector(block.dimension()), solution);
        for j in (0..residuals.len()).filter(others) {
            if !residuals[j].rows.depends_on(block.coordinates) {
                continue;
            }
            let inserted = residuals[j].rows.substitute(&[(block.coordinates, solution)]);
            let without = without_part(model, symbols, inserted, i);
            if identity::equal(&[inserted], &[without]) {
                residuals[j].rows = without.expand();
            }
        }
    }
}

/// ρ_k(x): the components of T* ∂_F K − J(q, ∂_q K), less their value at F = I, less μ.
///
/// They are freed of denominators by A (…) C where that is possible. The second value says whether they were.
fn residual<'g>(
    sources: &Sources<'_, 'g>,
    before: &[Covector<'g>],
    coupling: Option<&[Expr<'g>]>,
    k: usize,
) -> (Expr<'g>, bool) {
    let (model, symbols) = (sources.model, sources.symbols);
    let factor = &model.factors[k];
    let group = factor.group;
    // F = I + D in a chart with roots: what cancels in F − I does so before D(x) is put in
    let late: Vec<(Expr<'g>, Expr<'g>)> = (0..model.factors.len())
        .filter(|&j| is_kept(symbols.charts[j], coupling.is_some()))
        .map(|j| (symbols.increments[j], symbols.chart_increment(model, j)))
        .collect();
    let element = |j: usize| match late.iter().any(|(increment, _)| *increment == symbols.increments[j]) {
        true => model.factors[j].group.identity(model.graph) + symbols.increments[j],
        false => symbols.chart_element(model, j),
    };
    let mut elements: Vec<_> = (0..model.factors.len()).map(|j| (model.factors[j].symbol, element(j))).collect();
    elements.extend((0..model.factors.len()).map(|j| (symbols.logarithms[j], symbols.stacked_coordinates(j))));
    let array = before[k].array.substitute(&elements).expand();
    let mu = symbols.momenta[k] + at_identity(model, before, coupling, k);
    let mut plain = group.components(array).expand() - mu;
    if symbols.charts[k] == Chart::Product {
        plain = plain.blockwise().expand();
    }
    if let Some(coupling) = coupling {
        plain = plain + coupling[k].substitute(&elements).expand();
    }
    if let Some((gradient, slope)) = before[k].logarithmic {
        // dexp_y^T leaves ∂K/∂y as it is where ad_y^T does: ∂K/∂y = μ, for bi-invariant energies
        let (y, zero) = (symbols.logarithms[k], model.graph.zero(symbols.momenta[k].shape()));
        let invariant =
            identity::equal(&[group.ad(y).transpose() * gradient, group.components(before[k].array)], &[zero; 2]);
        if coupling.is_none() && invariant {
            return ((gradient.substitute(&elements) - mu).expand(), true);
        }
        // freed of dexp⁻¹ by dexp, which is regular near the identity
        let (gradient, slope) = (gradient.substitute(&elements), slope.substitute(&elements));
        let freed = slope.transpose() * plain;
        return match late.is_empty() {
            true => (gradient.expand() + freed.expand(), true),
            false => ((gradient + freed).substitute(&late), true),
        };
    }
    if coupling.is_some() || !late.is_empty() {
        return (plain.substitute(&late), false);
    }
    match clearing::by_congruence(model, symbols, k, (array, mu, plain)) {
        Some(cleared) => (cleared, true),
        None => (clearing::of_quaternions(&symbols.coordinates(k), group, plain), false),
    }
}

/// r(q, I), the momentum of the motion that rests.
pub(super) fn at_identity<'g>(
    model: &Mechanics<'g>,
    before: &[Covector<'g>],
    coupling: Option<&[Expr<'g>]>,
    k: usize,
) -> Expr<'g> {
    let kinetic = before[k].components(model.factors[k].group);
    let whole = coupling.map_or(kinetic, |coupling| kinetic + coupling[k]);
    let value = whole.substitute(&identities(model)).expand();
    if identity::vanishes(value) { value.graph().zero(value.shape()) } else { value }
}

/// The finest partition of 0..count in which what depends on each other is together.
fn groups(count: usize, depends: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut label: Vec<usize> = (0..count).collect();
    for k in 0..count {
        for j in 0..count {
            if depends(k, j) && label[k] != label[j] {
                let (keep, merge) = (label[k].min(label[j]), label[k].max(label[j]));
                label.iter_mut().filter(|entry| **entry == merge).for_each(|entry| *entry = keep);
            }
        }
    }
    let members = |leader: usize| (0..count).filter(|&k| label[k] == leader).collect::<Vec<_>>();
    (0..count).map(members).filter(|group| !group.is_empty()).collect()
}

fn equation<'g>(
    sources: &Sources<'_, 'g>,
    before: &[Covector<'g>],
    residuals: &[Residual<'g>],
    blocks: Vec<usize>,
) -> MomentumEquation<'g> {
    let (model, symbols) = (sources.model, sources.symbols);
    if let [only] = blocks.as_slice()
        && exact::is_free_rotation(model, symbols.blocks[*only].factor)
    {
        return exact::equation(sources, *only);
    }
    let components: Vec<usize> = blocks.iter().flat_map(|&i| symbols.blocks[i].components()).collect();
    let shape = Shape::vector(components.len());
    let mut residual = model.graph.zero(shape);
    let mut row = 0;
    for &i in &blocks {
        residual = residual + residuals[i].rows.embed(shape, row, 0);
        row += symbols.blocks[i].dimension();
    }
    let cleared = blocks.iter().all(|&i| residuals[i].cleared);
    let mut equation = MomentumEquation::new(sources, components, residual, cleared);
    let moves = equation.moves;
    let closed_form = match blocks.as_slice() {
        [only] if !moves && !sources.forced => closed_form(sources, before, residual, *only),
        _ => None,
    };
    equation.solution = match &closed_form {
        Some(_) => Solution::ClosedForm,
        // where Σ changes with the configuration there is no predictor
        _ if is_moving(model, sources.inertia) => Solution::Newton,
        None if !moves && is_solved_by_predictor(sources, &blocks, residual) => Solution::Explicit,
        None => Solution::Newton,
    };
    equation.formula = closed_form.as_ref().map(|closed_form| closed_form.coordinates);
    equation.sine = closed_form.as_ref().and_then(|closed_form| closed_form.sine);
    equation.sine_squared = closed_form.map(|closed_form| closed_form.sine_squared);
    equation
}

/// Velocities by Cayley's map have poles in the exponential chart, which Cayley's own has not.
pub(super) fn check_poles(
    model: &Mechanics<'_>,
    symbols: &Symbols<'_>,
    substeps: &[Substep<'_>],
) -> Result<(), Diagnostics> {
    let by_cayley = model.kinetic.discretization() == Some(Discretization::Cayley);
    let chosen = model.dials.chart.as_ref().filter(|chart| by_cayley && chart.value == ChartChoice::Exponential);
    let coordinates: Vec<Expr<'_>> = symbols.blocks.iter().map(|block| block.coordinates).collect();
    let has_poles = |equation: &MomentumEquation<'_>| {
        equation.solution == Solution::Newton && equation.residual.has_poles_in(&coordinates)
    };
    let Some(chosen) = chosen else { return Ok(()) };
    features::check((Feature::ExponentialChart, Found::at(chosen.span)), |feature| {
        let mut equations = substeps.iter().flat_map(|substep| &substep.equations);
        Found::when(feature == Feature::Poles && equations.any(has_poles))
    })
}
