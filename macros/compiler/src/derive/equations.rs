//! The implicit equation in the chart: both trivialisations of ∂_F ℓd, denominators cleared, coupled blocks together.

use clebsch_symbolic::work::{self, Exhausted};
use clebsch_symbolic::{Chart, Elements, Expr, IntoList, Shape, identity, indexed};

use super::clearing;
use super::closed_form::{SolvedConstraint, closed_form, is_solved_by_predictor};
use super::equation::{DISTRIBUTED, Form, Momentum, MomentumEquation, Solution, Sources, is_diagonal};
use super::letters::Letters;
use super::{ChartBlock, ConstraintFormulas, exact, rotation, structure, tangent};

/// The equations of a substep, with the part of its constraint in them.
pub(super) struct Equations<'g> {
    /// The equations, in the order in which they are solved.
    pub equations: Vec<MomentumEquation<'g>>,
    /// The force of the constraint for each factor; `None` if there is none.
    pub reaction: Option<Vec<Expr<'g>>>,
    /// The coordinates that the constraint holds at zero: they have no equation.
    pub still: Vec<usize>,
}

/// The equations of a substep. Where the products of exponentials take much work, D(x) = F − I of these is substituted late.
pub(super) fn equations<'g>(sources: &Sources<'_, 'g>, momentum: &Momentum<'_, 'g>) -> Equations<'g> {
    if !sources.symbols.charts.contains(&Chart::Exponential) {
        return in_charts(sources, momentum);
    }
    let late = Sources { keeps_exponentials: true, ..*sources };
    work::within(EXPONENTIALS, || in_charts(sources, momentum)).unwrap_or_else(|Exhausted| in_charts(&late, momentum))
}

/// The work for the equations of a substep in the exponential chart, products distributed.
const EXPONENTIALS: u64 = 2_000_000;

fn in_charts<'g>(sources: &Sources<'_, 'g>, momentum: &Momentum<'_, 'g>) -> Equations<'g> {
    let (model, symbols) = (sources.model, &sources.symbols);
    let is_free_rotation = |block: &ChartBlock<'g>| exact::is_free_rotation(model, block.factor);
    let letters = Letters::new(sources, momentum);
    let Residuals { mut residuals, reaction, still, mut solved } = match momentum.constraint {
        Some(constraint) => constrained(sources, momentum, (constraint, &letters)),
        None => {
            let residuals = unconstrained(sources, momentum, &letters);
            Residuals { residuals, reaction: None, still: Vec::new(), solved: None }
        }
    };
    if !momentum.is_forced {
        substitute_explicit(sources, &mut residuals);
    }
    let may_clear = |block: &ChartBlock<'g>| momentum.constraint.is_none() && !is_free_rotation(block);
    for (residual, block) in residuals.iter_mut().zip(&symbols.blocks).filter(|(_, block)| may_clear(block)) {
        if let Some(rows) = clearing::of_rotation(sources, block, residual.rows) {
            *residual = Residual { rows, slope: None, cleared: true, ..*residual };
        }
    }
    let depends = |i: usize, j: usize| residuals[i].rows.depends_on(symbols.blocks[j].coordinates);
    let equations = structure::connected(residuals.len(), |i, j| depends(i, j) || depends(j, i))
        .into_iter()
        .map(|group| {
            let solved = solved.take_if(|_| group.len() == residuals.len());
            let equation = equation(sources, momentum, &residuals, group);
            match solved {
                Some(solved) => solved.solve(equation),
                None => equation,
            }
        })
        .filter_map(|equation| structure::without_still(sources, equation, &still))
        .flat_map(|equation| structure::specialised(sources, equation));
    Equations { equations: equations.into_list(), reaction, still }
}

/// The residuals of all blocks where every velocity is allowed.
fn unconstrained<'g>(
    sources: &Sources<'_, 'g>,
    momentum: &Momentum<'_, 'g>,
    letters: &Letters<'_, 'g>,
) -> Vec<Residual<'g>> {
    let (model, symbols) = (sources.model, &sources.symbols);
    let mut residuals: Vec<Residual<'g>> = Vec::new();
    for k in 0..model.factors.len() {
        let (residual, cleared) = if exact::is_free_rotation(model, k) {
            (model.graph.zero(symbols.momenta[k].shape()), true)
        } else {
            residual(sources, momentum, (k, letters))
        };
        residuals.extend(symbols.blocks.iter().filter(|block| block.factor == k).map(|block| {
            let start = block.offset - model.offset(k);
            let is_near = momentum.couples && letters.occur_in(residual);
            let rows = residual.block(start, 0, block.coordinates.shape());
            let slope = if is_near { tangent::directional(sources, letters, rows) } else { None };
            Residual { rows: letters.replaced(rows), slope, cleared, is_near }
        }));
    }
    residuals
}

/// The residuals of all blocks with a constraint. Products are not distributed, so that S⁻¹ is computed once in a step.
///
/// If each row says that a coordinate is zero, the others have their momentum equations as they are, y = 0. The force of
/// the constraint is then y in the coordinates that are zero.
fn constrained<'g>(
    sources: &Sources<'_, 'g>,
    momentum: &Momentum<'_, 'g>,
    (constraint, letters): (&ConstraintFormulas<'g>, &Letters<'_, 'g>),
) -> Residuals<'g> {
    let (graph, symbols) = (sources.model.graph, &sources.symbols);
    let factors = (0..sources.model.factors.len()).map(|k| residual(sources, momentum, (k, letters)).0);
    let difference = letters.replaced(graph.below(&factors.into_list()));
    let between = letters.replaced(constraint.between.substitute(&letters.elements).expand());
    let still = still(sources, constraint, between);
    let are_all = still.len() == between.shape().rows;
    let (whole, reaction) = if are_all {
        let entry = |(i, j)| if still.contains(&i) { difference.entry(i, j) } else { graph.integer(0) };
        let shape = difference.shape();
        (difference, graph.stack(shape, shape.positions().map(entry).into_list()))
    } else {
        (constraint.residual(difference, between), constraint.reaction(difference))
    };
    let rows = |block: &ChartBlock<'g>| {
        let rows = whole.block(block.offset, 0, block.coordinates.shape());
        if are_all { clearing::by_square(sources, block, rows) } else { rows }
    };
    let is_near = momentum.couples || !are_all;
    let residual = |block: &ChartBlock<'g>| Residual { rows: rows(block), slope: None, cleared: false, is_near };
    let may_be_affine = still.is_empty() && !momentum.couples;
    let affine = || SolvedConstraint::of(sources, (constraint, letters), [difference, between]);
    Residuals {
        residuals: symbols.blocks.each(residual),
        reaction: Some(sources.parted(reaction)),
        solved: may_be_affine.then(affine).flatten(),
        still,
    }
}

/// The coordinates that stay zero in a step: those of rows ξ_i = 0. There A has one entry, a number, b is zero, and ψ
/// vanishes with x_i.
///
/// Their equations go with them. Where the others hold, A Σ⁻¹ρ = ψ leaves ρ_i = 0.
fn still<'g>(sources: &Sources<'_, 'g>, constraint: &ConstraintFormulas<'g>, between: Expr<'g>) -> Vec<usize> {
    let Shape { rows, columns } = constraint.rows.shape();
    let component = |row: usize| {
        let entry = |i: usize| constraint.rows.entry(row, i);
        let mut others = (0..columns).filter(|&i| !identity::vanishes(entry(i)));
        let (only, None) = (others.next()?, others.next()) else { return None };
        let at_zero = (&[only][..], sources.model.graph.zero(Shape::vector(1)));
        let is_still = entry(only).as_number().is_some()
            && identity::vanishes(constraint.values.entry(row, 0))
            && identity::vanishes(structure::put_in(sources, at_zero, between.entry(row, 0)));
        is_still.then_some(only)
    };
    let mut still: Vec<usize> = (0..rows).filter_map(component).into_list();
    still.sort_unstable();
    still
}

/// The residuals of all blocks.
struct Residuals<'g> {
    residuals: Vec<Residual<'g>>,
    /// The force of the constraint for each factor; `None` if there is none.
    reaction: Option<Vec<Expr<'g>>>,
    /// The coordinates that the constraint holds at zero.
    still: Vec<usize>,
    /// The solution of all of them at once, where there is one.
    solved: Option<SolvedConstraint<'g>>,
}

/// The residual of one block.
#[derive(Copy, Clone)]
struct Residual<'g> {
    rows: Expr<'g>,
    /// Its derivative by the tangent of the chart.
    slope: Option<Expr<'g>>,
    cleared: bool,
    /// Whether it is written with D(x).
    is_near: bool,
}

/// A block whose equation is linear is solved at once, x = s·h·Σ⁻¹μ. Its solution is substituted into the others, where
/// it often leaves nothing: b × hM_v = 0 for a body about its centre of mass.
fn substitute_explicit<'g>(sources: &Sources<'_, 'g>, residuals: &mut [Residual<'g>]) {
    for i in 0..residuals.len() {
        let Some(solution) = explicit(sources, residuals, i) else { continue };
        let coordinates = sources.symbols.blocks[i].coordinates;
        for (_, residual) in residuals.iter_mut().enumerate().filter(|(j, _)| *j != i) {
            if !residual.rows.depends_on(coordinates) {
                continue;
            }
            let inserted = residual.rows.substitute(&[(coordinates, solution)]);
            let without = sources.without_momentum_of_block(inserted, i);
            if identity::equal(&[inserted], &[without]) {
                (residual.rows, residual.slope) = (without.expand(), None);
            }
        }
    }
}

/// The solution of a block whose equation is linear and holds no other coordinate.
fn explicit<'g>(sources: &Sources<'_, 'g>, residuals: &[Residual<'g>], i: usize) -> Option<Expr<'g>> {
    let (graph, symbols, block, rows) =
        (sources.model.graph, &sources.symbols, sources.symbols.blocks[i], residuals[i].rows);
    let holds_others = || (0..residuals.len()).any(|j| j != i && rows.depends_on(symbols.blocks[j].coordinates));
    if exact::is_free_rotation(sources.model, block.factor)
        || holds_others()
        || residuals[i].is_near
        || sources.keeps(symbols.charts[block.factor], sources.is_moving(rows))
    {
        return None;
    }
    let slope = rows.differential(&[(block.coordinates, block.direction)]);
    let slope = constant(slope, block).then(|| slope.expand())?;
    let inertia = sources.inertia.block(block.offset, block.offset, Shape::square(block.dimension()));
    let linear = !slope.depends_on(block.coordinates) && !slope.depends_on(symbols.momenta[block.factor]);
    if !linear || sources.is_moving(slope) || !is_diagonal(inertia) {
        return None;
    }
    let (momentum, step) = (sources.momentum_of_block(i), sources.chart_step(i, sources.divisor));
    let entry = |a: usize| step * momentum.entry(a, 0) / inertia.entry(a, a).expand();
    Some(graph.stack(block.coordinates.shape(), indexed(block.dimension(), entry)))
}

/// Whether a slope may be the same everywhere. A long one is not expanded to find out: it is evaluated at two places.
fn constant<'g>(slope: Expr<'g>, block: ChartBlock<'g>) -> bool {
    let is_short = work::within(SHORT, || slope.expand()).is_ok();
    is_short || !identity::varies_with(slope, block.coordinates)
}

/// The work to expand a slope that is short.
const SHORT: u64 = 50_000;

/// ρ_k(x): the components of T* ∂_F K − J(q, ∂_q K), less their value at F = I, less μ.
///
/// They are freed of denominators by A (…) C where that is possible. The second value says whether they were. Increments that are
/// substituted late are symbols in them.
fn residual<'g>(
    sources: &Sources<'_, 'g>,
    momentum: &Momentum<'_, 'g>,
    (k, letters): (usize, &Letters<'_, 'g>),
) -> (Expr<'g>, bool) {
    let (model, symbols) = (sources.model, &sources.symbols);
    let Momentum { before, coupling, rest, .. } = momentum;
    let group = model.factors[k].group;
    let elements = &letters.elements;
    let array = before[k].array.substitute(elements).expand();
    let mu = rest.as_ref().map_or(symbols.momenta[k], |rest| symbols.momenta[k] - rest[k]);
    let mut plain = group.components(array).expand() - mu;
    if let Some(rational) = before[k].rational {
        plain = plain + rational.map.substitute(elements).expand();
    }
    if symbols.charts[k] == Chart::Product {
        plain = plain.blockwise().expand();
    }
    if let Some(coupling) = coupling {
        plain = plain + coupling[k].substitute(elements).expand();
    }
    if momentum.couples {
        plain = letters.near(plain);
    }
    if momentum.constraint.is_some() {
        // the residual itself, not a multiple that is free of denominators
        let logarithmic = before[k]
            .logarithmic
            .map(|(gradient, slope)| (slope.transpose().inverse() * gradient).substitute(elements));
        return (logarithmic.map_or(plain, |part| part + plain), false);
    }
    if let Some((gradient, slope)) = before[k].logarithmic {
        // dexp_y^T leaves ∂K/∂y as it is where ad_y^T does: ∂K/∂y = μ, for bi-invariant energies
        let (y, zero) = (symbols.logarithms[k], model.graph.zero(symbols.momenta[k].shape()));
        let invariant =
            identity::equal(&[group.ad(y).transpose() * gradient, group.components(before[k].array)], &[zero; 2]);
        if coupling.is_none() && invariant {
            return ((gradient.substitute(elements) - mu).expand(), true);
        }
        // freed of dexp⁻¹ by dexp, which is regular near the identity
        let (gradient, slope) = (gradient.substitute(elements), slope.substitute(elements));
        let freed = slope.transpose() * plain;
        let expanded = || work::within(DISTRIBUTED, || gradient.expand() + freed.expand()).ok();
        let expanded = letters.increments.is_empty().then(expanded).flatten();
        return (expanded.unwrap_or(gradient + freed), true);
    }
    if coupling.is_some() || !letters.increments.is_empty() {
        return (plain, false);
    }
    match clearing::by_congruence(sources, k, (array, mu, plain)) {
        Some(cleared) => (cleared, true),
        None => (clearing::of_quaternions(&symbols.coordinates(k), group, plain), false),
    }
}

/// Whether D(x) is substituted late in one of these blocks because of its length alone.
fn factors_keep(sources: &Sources<'_, '_>, blocks: &[usize]) -> bool {
    let chart = |i: &usize| sources.symbols.charts[sources.symbols.blocks[*i].factor];
    sources.keeps_exponentials && blocks.iter().any(|i| chart(i) == Chart::Exponential)
}

fn equation<'g>(
    sources: &Sources<'_, 'g>,
    momentum: &Momentum<'_, 'g>,
    residuals: &[Residual<'g>],
    blocks: Vec<usize>,
) -> MomentumEquation<'g> {
    let symbols = &sources.symbols;
    if let [only] = blocks[..]
        && exact::is_free_rotation(sources.model, symbols.blocks[only].factor)
    {
        return exact::equation(sources, only);
    }
    let components: Vec<usize> = blocks.iter().flat_map(|&i| symbols.blocks[i].components()).into_list();
    let rows: Vec<_> = blocks.each(|&i| residuals[i].rows);
    let residual = sources.model.graph.below(&rows);
    let cleared = blocks.iter().all(|&i| residuals[i].cleared);
    let is_near = blocks.iter().any(|&i| residuals[i].is_near);
    // no products are distributed either where D(x) is substituted late
    let is_near = is_near || factors_keep(sources, &blocks);
    let mut equation = MomentumEquation::new(sources, components, residual, Form { cleared, is_near });
    let slopes: Option<Vec<_>> = blocks.iter().map(|&i| residuals[i].slope).collect();
    if let Some(slopes) = slopes {
        equation.directional = sources.model.graph.below(&slopes);
    }
    if let [only] = blocks[..]
        && !equation.moves
        && !momentum.is_forced
        && let Some(closed_form) = closed_form(sources, &momentum.before[symbols.blocks[only].factor], &equation, only)
    {
        return closed_form;
    }
    // these dials are about iterations for x
    let dials = &sources.model.dials;
    let asks_for_iterations = dials.solver.is_some() || dials.tolerance.is_some() || dials.iterations.is_some();
    if let [only] = blocks[..]
        && !momentum.is_forced
        && momentum.constraint.is_none()
        && !asks_for_iterations
        && let Some(rotating) = rotation::rotating(sources, &equation, only)
    {
        return rotating;
    }
    // where Σ changes with the configuration there is no predictor
    if !sources.is_moving(sources.inertia) && !equation.moves && is_solved_by_predictor(sources, &blocks, residual) {
        equation.solution = Solution::Explicit;
    }
    equation
}
