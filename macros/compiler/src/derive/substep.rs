//! A substep: one discrete Lagrangian with the formulas of its step.

use clebsch_symbolic::{Chart, Elements, Expr, IntoList, identity, indexed};

use super::equation::{Momentum, MomentumEquation, Solution, Sources};
use super::equations::Equations;
use super::force::total;
use super::symbols::{at_zero, identities, images};
use super::trivialisation::{self, Covector};
use super::{
    ConstraintFormulas, DiscreteLagrangian, EdgeDerivatives, EdgeForce, Symbols, SystemFormulas, cayley, equations,
    exact, variation,
};
use crate::diagnostic::{Diagnostics, bail};
use crate::model::features::{self, Feature, Found};
use crate::model::{ChartChoice, Discretization, Factor, Mechanics, System};

/// One discrete Lagrangian with the formulas of its step.
pub struct Substep<'g> {
    /// Its part of the step: h is to be read as h divided by this.
    pub divisor: i64,
    /// The discrete Lagrangian, in terms of the step h, not of the substep.
    pub lagrangian: DiscreteLagrangian<'g>,
    /// How much later than the step it starts.
    pub begins: Expr<'g>,
    /// How much later than the start of the step it ends.
    pub ends: Expr<'g>,
    /// The impulse before the solve for each factor, J(q, ∂U₀(q)) and `rest`, which is apart where sums are compensated; `None` if there is
    /// none.
    pub start: Option<Vec<Expr<'g>>>,
    /// −r(q, I) for each factor, the value of a coupled cost or a term A·ξ at F = I; `None` if it vanishes.
    pub rest: Option<Vec<Expr<'g>>>,
    /// J(q, ∂U₁(q)) for each factor, after the move; `None` if there is none.
    pub end: Option<Vec<Expr<'g>>>,
    /// The momentum equations, each for the factors that depend on each other.
    pub equations: Vec<MomentumEquation<'g>>,
    /// For each factor: whether both trivialisations of ∂_F K agree, so that the move leaves it as it is.
    pub unchanged: Vec<bool>,
    /// The momenta that a coupled cost adds in a move; `None` for other costs.
    pub coupling: Option<Coupling<'g>>,
    /// The force in addition to the potential; `None` if there is none.
    pub force: Option<EdgeForce<'g>>,
    /// The force Aᵀλ of the constraint, a function of q, x and the momentum μ to be solved for; `None` if there is none.
    pub reaction: Option<Vec<Expr<'g>>>,
    /// The coordinates that the constraint holds at zero: they have no equation.
    pub still: Vec<usize>,
    /// Aᵀμ, which brings the momentum after the step to the constraint at q⁺; `None` if there is none.
    pub projection: Option<Vec<Expr<'g>>>,
    /// Second derivatives of the discrete Lagrangian, where they are asked for.
    pub variation: Option<EdgeDerivatives<'g>>,
}

/// The momenta that a coupled cost K(q, q⁺, F) adds in a move, with symbols for q⁺.
pub struct Coupling<'g> {
    /// J(q, ∂_q K) for each factor, which r(F) lacks of ∂_F K.
    pub kick: Vec<Expr<'g>>,
    /// J(q⁺, ∂_q⁺ K) for each factor.
    pub arrival: Vec<Expr<'g>>,
    /// r⁺(F) − r(F) for each factor, with the other Legendre transform r⁺ = T* ∂_F K + J(q⁺, ∂_q⁺ K).
    pub change: Vec<Expr<'g>>,
}

impl<'g> Coupling<'g> {
    fn new(sources: &Sources<'_, 'g>, by_ends: Expr<'g>) -> Coupling<'g> {
        let model = sources.model;
        let (before, after) = trivialisation::of_all(model, by_ends);
        let (before, after) = (trivialisation::components(model, &before), trivialisation::components(model, &after));
        let kick = sources.momenta_of(sources.gradients(by_ends));
        let arrival = sources.arrival(by_ends);
        let change = |k: usize| (after[k] - before[k] + kick[k] + arrival[k]).expand();
        Coupling { change: (0..model.factors.len()).map(change).into_list(), kick, arrival }
    }
}

impl<'g> Substep<'g> {
    /// The substep of a discrete Lagrangian that starts `begins` after the step.
    pub(super) fn new(
        sources: Sources<'_, 'g>,
        variations: &variation::Source<'_, 'g>,
        lagrangian: DiscreteLagrangian<'g>,
        begins: Expr<'g>,
        (force, constraint): (Option<EdgeForce<'g>>, Option<&ConstraintFormulas<'g>>),
    ) -> Substep<'g> {
        let model = sources.model;
        // no congruence clears the denominators of coupled costs: their Cayley coordinates are letters
        let letters = if lagrangian.couples { cayley::replacements(model) } else { Vec::new() };
        let kinetic = lagrangian.by_ends.substitute(&letters);
        let (before, after) = trivialisation::of_all(model, kinetic);
        let coupling = lagrangian.couples.then(|| sources.coupling(kinetic));
        // the part of the force that depends on the velocity joins the equation, at the time at which the step starts
        let moving = force
            .as_ref()
            .and_then(|force| force.start_moving.as_ref())
            .map(|moving| -> Vec<Expr<'g>> { moving.each(|part| -sources.later(*part, begins)) });
        let is_forced = moving.is_some() || constraint.is_some();
        let coupling = total(coupling, moving);
        let rest = at_rest(model, &before, coupling.as_deref());
        let unchanged: Vec<bool> = indexed(model.factors.len(), |k| agree(model, (&before, &after), k));
        let momentum =
            Momentum { before, coupling, rest: rest.clone(), couples: lagrangian.couples, is_forced, constraint };
        let Equations { equations, reaction, still } = equations::equations(&sources, &momentum);
        // impulses are functions of the time of the configuration, K of the time at which the step starts
        let earlier = |rest: &Vec<Expr<'g>>| rest.each(|part| sources.later(*part, -begins));
        let ends = begins + model.step_size / sources.divisor;
        Substep {
            unchanged,
            coupling: lagrangian.couples.then(|| Coupling::new(&sources, kinetic)),
            variation: model
                .has_variations()
                .then(|| variations.variation(&lagrangian, (begins, ends), (force.as_ref(), constraint))),
            begins,
            ends,
            divisor: sources.divisor,
            start: if model.is_compensated() {
                // a term that comes back after the move is added for the solve alone, and stays out of the sums
                sources.impulse(lagrangian.start)
            } else {
                total(sources.impulse(lagrangian.start), rest.as_ref().map(earlier))
            },
            end: sources.impulse(lagrangian.end),
            equations,
            reaction,
            still,
            projection: constraint.map(|constraint| sources.parted(constraint.projection())),
            rest,
            force,
            lagrangian,
        }
    }
}

/// Whether both trivialisations of a factor have the same components.
fn agree<'g>(model: &System<'g>, (before, after): (&[Covector<'g>], &[Covector<'g>]), k: usize) -> bool {
    let group = model.factors[k].group;
    identity::equal(&[before[k].components(group)], &[after[k].components(group)])
}

/// A factor that moves no configuration has no side: its cost has to be invariant under conjugation.
pub(super) fn check_unmoved<'g>(model: &System<'g>, lagrangian: &DiscreteLagrangian<'g>) -> Result<(), Diagnostics> {
    let (before, after) = trivialisation::of_all(model, lagrangian.kinetic);
    // terms are ordered by when they were made: the components of all factors are made here
    let has_sides = |k: &usize| !agree(model, (&before, &after), *k) && !model.factors[*k].moves;
    let Some(k) = (0..model.factors.len()).find(has_sides) else { return Ok(()) };
    let factor = &model.factors[k];
    let (name, group) = (&factor.name, factor.group.name(model.graph));
    bail!(factor.span, "the factor `{name}: {group}` moves nothing";
        help "let it move a configuration, as in `R * {name}`, or give it a cost that is invariant under conjugation, as `({name} - I).norm_squared() / (2 * h)`";
        note "without a configuration to move it has no side, and this cost is not the same for {name} and g*{name}*g⁻¹");
}

/// −r(q, I), of a cost that couples or of a Lagrangian with a term that is linear in the velocity; `None` if it vanishes.
fn at_rest<'g>(model: &System<'g>, before: &[Covector<'g>], coupling: Option<&[Expr<'g>]>) -> Option<Vec<Expr<'g>>> {
    let mut at_identity = identities(model);
    if coupling.is_some() {
        let letters = (0..model.factors.len()).map(|k| cayley::symbol(model, k));
        at_identity.extend(at_zero(letters));
        at_identity.extend(images(model).into_iter().zip(model.configurations.iter().map(|leaf| leaf.symbol)));
    }
    let of_factor = |(k, factor): (usize, &Factor<'g>)| {
        let kinetic = before[k].components(factor.group);
        let whole = coupling.map_or(kinetic, |coupling| kinetic + coupling[k]);
        let value = whole.substitute(&at_identity).expand();
        if identity::vanishes(value) { value.graph().zero(value.shape()) } else { -value }
    };
    let rest: Vec<_> = model.factors.iter().enumerate().map(of_factor).into_list();
    rest.iter().any(|part| !identity::vanishes(*part)).then_some(rest)
}

/// F⁻ℓd, and F⁺ℓd without its last kick, of the declared discrete Lagrangian.
pub(super) fn legendre<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    lagrangian: &DiscreteLagrangian<'g>,
) -> (Vec<Expr<'g>>, Vec<Expr<'g>>) {
    let (before, after) = trivialisation::of_all(model, lagrangian.by_ends);
    let mut before = trivialisation::components(model, &before);
    let mut after = trivialisation::components(model, &after);
    // with the symbol μ for the momentum of the free motion that makes F
    for k in (0..model.factors.len()).filter(|&k| exact::is_free_rotation(model, k)) {
        before[k] = system.symbols.momenta[k];
        after[k] = system.carried(k, before[k]);
    }
    if lagrangian.couples {
        let coupling = system.coupling(lagrangian.by_ends);
        before.iter_mut().zip(coupling).for_each(|(before, coupling)| *before = *before + coupling);
        let arrival = system.arrival(lagrangian.by_ends);
        after.iter_mut().zip(arrival).for_each(|(after, arrival)| *after = *after + arrival);
        let arrived: Vec<_> = system.symbols.images.iter().copied().zip(model.action.iter().copied()).into_list();
        before.iter_mut().chain(&mut after).for_each(|part| *part = part.substitute(&arrived));
    }
    if let Some(start) = system.impulse(lagrangian.start) {
        before.iter_mut().zip(start).for_each(|(before, start)| *before = *before - start);
    }
    (before, after)
}

/// Takes the chart of the sine for the rotations that every substep solves in closed form. There the solution needs no
/// root and the increment one division. In Cayley's chart the tangent of half the angle has to be converted.
pub(super) fn adopt_sine<'g>(symbols: &mut Symbols<'g>, substeps: &mut [Substep<'g>]) {
    let count = substeps.len();
    for block in symbols.blocks.clone() {
        let mut own = Vec::new();
        for equation in substeps.iter_mut().flat_map(|substep| &mut substep.equations) {
            if let Some(form) = equation.sine
                && block.components().all(|component| equation.components.contains(&component))
            {
                own.push((equation, form));
            }
        }
        if own.len() < count {
            continue;
        }
        symbols.charts[block.factor] = Chart::Sine;
        for (equation, form) in own {
            (equation.residual, equation.directional) = (form.residual, form.directional);
            equation.formula = Some(form.solution);
            equation.sine_squared = Some(block.coordinates.norm_squared());
        }
    }
}

/// Velocities by Cayley's map have poles in the exponential chart, which Cayley's own has not.
pub(super) fn check_poles(
    model: &Mechanics<'_>,
    symbols: &Symbols<'_>,
    substeps: &[Substep<'_>],
) -> Result<(), Diagnostics> {
    let by_cayley = model.kinetic.discretization() == Some(Discretization::Cayley);
    let chosen = model.dials.chart.as_ref().filter(|chart| by_cayley && chart.value == ChartChoice::Exponential);
    let coordinates: Vec<Expr<'_>> = symbols.blocks.each(|block| block.coordinates);
    let has_poles = |equation: &MomentumEquation<'_>| {
        equation.solution == Solution::Newton && equation.residual.has_poles_in(&coordinates)
    };
    let Some(chosen) = chosen else { return Ok(()) };
    features::check((Feature::ExponentialChart, Found::at(chosen.span)), |feature| {
        let mut equations = substeps.iter().flat_map(|substep| &substep.equations);
        Found::when(feature == Feature::Poles && equations.any(has_poles))
    })
}

/// A tolerance ends an iteration, or the series of the free rotations between kicks; a number of iterations limits one.
pub(super) fn check_tolerance(
    model: &Mechanics<'_>,
    substeps: &[Substep<'_>],
    collocates: bool,
) -> Result<(), Diagnostics> {
    let solutions: Vec<Solution> =
        substeps.iter().flat_map(|s| &s.equations).map(|equation| equation.solution).into_list();
    let is_iterated = collocates || solutions.contains(&Solution::Newton);
    if let Some(iterations) = &model.dials.iterations {
        let asked = (Feature::Iterations, Found::at(iterations.span));
        features::check(asked, |feature| Found::when(feature == Feature::ExplicitEquation && !is_iterated))?;
    }
    let Some(tolerance) = &model.dials.tolerance else { return Ok(()) };
    let turns_freely = solutions.contains(&Solution::FreeRotation);
    // without kicks d is found once, to round-off
    let is_series = turns_freely && model.potential.is_some();
    features::check((Feature::Tolerance, Found::at(tolerance.span)), |feature| match feature {
        _ if is_iterated || is_series => None,
        Feature::FreeMotion => Found::when(turns_freely),
        Feature::ExplicitEquation => Found::when(!turns_freely),
        _ => None,
    })
}
