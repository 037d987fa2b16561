//! The third stage: from the model to its formulas, by calculus on matrices and groups.
//!
//! Everything is derived from one discrete Lagrangian ℓd = K(t, h, q, F) + U₀(t, q) + U₁(t + h, Φ_F q), the cost with the potential
//! placed by the order, in the form of the discrete Clebsch problem that holds for every group: solve
//! r(F) = T* ∂_F K − J(q, ∂_q K) = N + J(q, ∂U₀) for F, move, and let N⁺ be the other trivialisation of ∂_F K (which is Ad* of
//! r where K does not depend on q) plus J(q⁺, ∂U₁).

mod action;
mod catalogue;
mod cayley;
mod choice;
mod clearing;
mod closed_form;
mod collocation;
mod control;
mod cost;
mod derivation;
mod discrete_lagrangian;
mod displacement;
mod edges;
mod energy;
mod equation;
mod equations;
mod exact;
mod force;
mod formula;
mod formulas;
mod increments;
mod latex;
mod matrix_form;
mod moves;
mod naming;
mod power;
mod predictor;
mod reference;
mod rows;
mod signature;
mod structure;
mod summation;
mod symbols;
mod symmetry;
mod tolerance;
mod trivialisation;
mod variation;
mod velocity;

use std::cell::OnceCell;

use clebsch_symbolic::{Expr, identity};

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::features::{self, Feature, Found};
use crate::model::{Mechanics, Model, Order, Steered};

pub use catalogue::{Entry, Heat, Id};
pub(crate) use cayley::of_increment as cayley_coordinates;
pub use choice::{Choice, StepOfChoice};
pub use collocation::Collocation;
pub use control::{Bend, Endpoint, InputStep, Jet, Steering};
pub use derivation::{Iteration, Lowered, derivation, derivation_of_control};
pub use discrete_lagrangian::DiscreteLagrangian;
pub use edges::EdgeMatrices;
pub use energy::Energy;
pub use equation::{MomentumEquation, Solution, Structure};
pub use exact::Splitting;
pub use force::EdgeForce;
pub use formula::{Formula, FormulaTable};
use formulas::is_timed;
pub use formulas::{Formulas, MechanicsFormulas, SteeredFormulas, Substep, SystemFormulas};
use increments::{from_increment, increments, inserted, inverse_by};
pub use matrix_form::MatrixForm;
pub use power::{Home, SiteTerm, Stencil, stencil};
pub(crate) use predictor::stacked;
pub use reference::Reference;
use rows::MOST_LISTED;
pub use symbols::{ChartBlock, Symbols};
pub use symmetry::{ConservedMomentum, Symmetries};
use trivialisation::Covector;
pub use variation::{EdgeDerivatives, Quantity};

/// Derives the formulas of a model.
///
/// # Errors
/// A kinetic part that is degenerate, does not scale like an action, or is not quadratic.
pub fn derive(model: Model<'_>) -> Result<Formulas<'_>, Diagnostics> {
    match model {
        Model::Mechanics(model) => Ok(Formulas::Mechanics(Box::new(mechanics(*model)?))),
        Model::Steered(model) => Ok(Formulas::Steered(Box::new(steered(*model)))),
    }
}

fn mechanics(model: Mechanics<'_>) -> Result<MechanicsFormulas<'_>, Diagnostics> {
    variation::check(&model)?;
    let mut symbols = Symbols::new(&model, model.kinetic.discretization());
    let generator = action::generator(&model, &symbols);
    let momentum_map = action::momentum_map(&symbols, &generator);
    let steering = control::steering(&model, &symbols, &generator, &momentum_map);
    let endpoint = control::endpoint(&model, &symbols, &generator);
    let cost = cost::kinetic_cost(&model)?;
    let energy = energy::kinetic(&model, &symbols, cost)?;
    let lagrangian = discrete_lagrangian::separate(&model, cost);
    check_unmoved(&model, &lagrangian)?;
    let potential_energy = energy::potential(&model, &lagrangian)?;
    let inertia = energy::inertia(&symbols, energy.kinetic);
    let quantities = match model.emit.tangent {
        true => variation::quantities(&model, is_timed(&model, &lagrangian)),
        false => Vec::new(),
    };
    let variations = variation::Source {
        model: &model,
        symbols: &symbols,
        generator: &generator,
        momentum_map: &momentum_map,
        quantities: &quantities,
    };
    let sources = |divisor| equation::Sources {
        model: &model,
        symbols: &symbols,
        momentum_map: &momentum_map,
        inertia,
        divisor,
        forced: false,
    };
    let covector = force::covector(&model, &symbols.covectors, &momentum_map);
    let mut edges = discrete_lagrangian::substeps(&model, &lagrangian);
    let stepped = if edges.len() == 1 { 1 } else { 2 };
    if let Some(control) = model.control.as_ref().filter(|_| stepped == 2) {
        let price = (Feature::Effort, Found::at(control.written.place));
        return Err(features::refusal(price, (Feature::AdjointPair, Found::somewhere())).into());
    }
    let forces = |divisor| covector.as_ref().map(|covector| force::on_edge(&model, covector, divisor));
    if edges.len() == 1 && forces(1).is_some_and(|force| force.start_moving.is_some()) {
        // the Legendre transform of ℓd, without the force, is to be inverted
        edges.push((1, lagrangian));
    }
    let mut substeps: Vec<Substep<'_>> = edges
        .into_iter()
        .enumerate()
        .map(|(index, (divisor, lagrangian))| {
            let part = model.step_size / divisor;
            let begins = if index == 1 { part } else { model.graph.integer(0) };
            let force = if index < stepped { forces(divisor) } else { None };
            substep(sources(divisor), &variations, lagrangian, begins, force)
        })
        .collect();
    let impulse = |potential| action::impulse(&model, &symbols, &momentum_map, potential);
    let legendre_kick = impulse(lagrangian.end);
    let (legendre, legendre_next) = legendre(&sources(1), &lagrangian);
    let is_first = model.order == Order::First;
    let stagger = if is_first { impulse((lagrangian.end - lagrangian.start) / 2) } else { None };
    let is_staggered = stagger.is_some() && model.force.is_none() && lagrangian.balanced().is_time_symmetric(&model);
    let links = power::links(&model);
    let symmetries = symmetry::find(&model, &symbols, &generator, &lagrangian, inertia, (covector.as_deref(), &links));
    check_offers(&model, &symmetries)?;
    let splitting = exact::splitting(&sources(1), &lagrangian, &substeps);
    let is_exact = potential_energy.is_zero() && exact::drifts_exactly(&model, &symbols, &substeps);
    let is_free = action::is_free(&model, &symbols, &generator);
    let collocation = match is_exact {
        true => None,
        false => collocation::collocation(&sources(1), &energy, potential_energy, &generator, is_free)?,
    };
    closed_form::adopt_sine(&mut symbols, &mut substeps);
    equations::check_poles(&model, &symbols, &substeps)?;
    tolerance::check(&model, &substeps, collocation.is_some())?;
    let formulas = MechanicsFormulas {
        splitting,
        collocation,
        is_exact,
        stagger,
        is_staggered,
        legendre,
        legendre_next,
        legendre_kick,
        projection: match is_free {
            true => None,
            false => action::projection(&model, &symbols, &generator, &momentum_map),
        },
        is_free,
        coadjoint: action::coadjoint(&model, &symbols),
        cotangent_lift: action::cotangent_lift(&model, &symbols),
        uniform_inertia: energy::uniform(&symbols, energy.kinetic, inertia)
            .filter(|_| !equation::is_moving(&model, inertia)),
        inertia,
        system: SystemFormulas {
            model: model.system.clone(),
            symbols,
            generator,
            momentum_map,
            steering,
            endpoint,
            table: OnceCell::new(),
        },
        model,
        energy,
        potential_energy,
        links,
        symmetries,
        lagrangian,
        quantities,
        substeps,
        stepped,
        covector,
    };
    summation::check(&formulas)?;
    Ok(formulas)
}

/// What is left without mechanics: the action, and what the choice of inputs needs.
fn steered(model: Steered<'_>) -> SteeredFormulas<'_> {
    let symbols = Symbols::new(&model, None);
    let generator = action::generator(&model, &symbols);
    let momentum_map = action::momentum_map(&symbols, &generator);
    let system = SystemFormulas {
        model: model.system.clone(),
        steering: control::steering(&model, &symbols, &generator, &momentum_map),
        endpoint: control::endpoint(&model, &symbols, &generator),
        symbols,
        generator,
        momentum_map,
        table: OnceCell::new(),
    };
    SteeredFormulas { step: control::step(&model, &system), model, system }
}

/// A factor that moves no configuration has no side: its cost has to be invariant under conjugation.
fn check_unmoved<'g>(model: &Mechanics<'g>, lagrangian: &DiscreteLagrangian<'g>) -> Result<(), Diagnostics> {
    let (before, after) = trivialised(model, lagrangian);
    let agrees = trivialisation::agreement(model, &before, &after);
    let Some(factor) = model.factors.iter().zip(agrees).find(|(factor, agrees)| !factor.moves && !agrees) else {
        return Ok(());
    };
    let (name, group) = (&factor.0.name, factor.0.group.name(model.graph));
    let error = Diagnostic::new(factor.0.span, format!("the factor `{name}: {group}` moves nothing"))
        .help(format!("let it move a configuration, as in `R * {name}`, or give it a cost that is invariant under conjugation, as `({name} - I).norm_squared() / (2 * h)`"))
        .note(format!("without a configuration to move it has no side, and this cost is not the same for {name} and g*{name}*g⁻¹"));
    Err(error.into())
}

/// An offered symmetry has to be one.
fn check_offers(model: &Mechanics<'_>, symmetries: &Symmetries<'_>) -> Result<(), Diagnostics> {
    let Some(&index) = symmetries.refused.first() else { return Ok(()) };
    let offered = &model.symmetries[index];
    let (what, unchanged) = match model.force.is_some() {
        true => ("the cost, the potential and the force", "leaves all of them unchanged"),
        false => ("the cost and the potential", "leaves both unchanged"),
    };
    let error = Diagnostic::new(
        offered.written.place,
        format!("`{}` is not a symmetry of {what}", offered.written.text),
    )
    .help(format!("leave it out, or offer the part of the group that {unchanged}"))
    .note("it has to leave them unchanged for all values of the configuration, the group element and the parameters, and to move the configuration as some motion of the declared group does");
    Err(error.into())
}

fn substep<'g>(
    mut sources: equation::Sources<'_, 'g>,
    variations: &variation::Source<'_, 'g>,
    lagrangian: DiscreteLagrangian<'g>,
    begins: Expr<'g>,
    force: Option<EdgeForce<'g>>,
) -> Substep<'g> {
    let (model, momentum_map) = (sources.model, sources.momentum_map);
    let impulse = |potential: Expr<'g>| action::impulse(model, sources.symbols, momentum_map, potential);
    let (before, after) = trivialised(model, &lagrangian);
    let coupling =
        lagrangian.couples.then(|| action::coupling(model, sources.symbols, momentum_map, lagrangian.kinetic));
    // the part of the force that depends on the velocity joins the equation, at the time at which the whole step starts
    let moving = force.as_ref().and_then(|force| force.start_moving.as_ref()).map(|moving| -> Vec<Expr<'g>> {
        moving.iter().map(|part| -part.substitute(&[(model.time, model.time + begins)])).collect()
    });
    sources.forced = moving.is_some();
    let coupling = total(coupling, moving);
    let rest = at_rest(model, &before, coupling.as_deref());
    // impulses are functions of the time of the configuration, K of the time at which the whole step starts
    let earlier = |rest: &[Expr<'g>]| -> Vec<Expr<'g>> {
        rest.iter().map(|part| part.substitute(&[(model.time, model.time - begins)])).collect()
    };
    let changes = rest.iter().flatten().any(|part| part.depends_on(model.time));
    let other = lagrangian.couples || changes;
    let unchanged = match other {
        true => vec![false; model.factors.len()],
        false => trivialisation::agreement(model, &before, &after),
    };
    let ends = begins + model.step_size / sources.divisor;
    let varied = model.has_variations();
    Substep {
        variation: varied.then(|| variations.variation(&lagrangian, (begins, ends), force.as_ref())),
        begins,
        ends,
        divisor: sources.divisor,
        start: match summation::is_compensated(model) {
            // what comes back after the move is added for the solve alone, and stays out of the sums
            true => impulse(lagrangian.start),
            false => total(impulse(lagrangian.start), rest.as_ref().map(|rest| earlier(rest))),
        },
        end: impulse(lagrangian.end),
        equations: equations::equations(&sources, &before, coupling.as_deref()),
        other: other.then(|| components(model, &after)),
        unchanged,
        rest,
        force,
        lagrangian,
    }
}

/// T* ∂_F K before the step and after it, for each factor.
fn trivialised<'g>(
    model: &Mechanics<'g>,
    lagrangian: &DiscreteLagrangian<'g>,
) -> (Vec<Covector<'g>>, Vec<Covector<'g>>) {
    (0..model.factors.len()).map(|k| trivialisation::trivialisations(model, lagrangian.kinetic, k)).unzip()
}

fn components<'g>(model: &Mechanics<'g>, covectors: &[Covector<'g>]) -> Vec<Expr<'g>> {
    model.factors.iter().zip(covectors).map(|(factor, covector)| covector.components(factor.group)).collect()
}

/// −r(q, I), of a cost that couples or of a Lagrangian with a term that is linear in the velocity; `None` if it vanishes.
fn at_rest<'g>(model: &Mechanics<'g>, before: &[Covector<'g>], coupling: Option<&[Expr<'g>]>) -> Option<Vec<Expr<'g>>> {
    let rest: Vec<_> = (0..model.factors.len()).map(|k| -equations::at_identity(model, before, coupling, k)).collect();
    rest.iter().any(|part| !identity::vanishes(*part)).then_some(rest)
}

/// The sum of two impulses.
fn total<'g>(one: Option<Vec<Expr<'g>>>, other: Option<Vec<Expr<'g>>>) -> Option<Vec<Expr<'g>>> {
    match (one, other) {
        (Some(one), Some(other)) => Some(one.into_iter().zip(other).map(|(a, b)| a + b).collect()),
        (one, other) => one.or(other),
    }
}

/// F⁻ℓd, and F⁺ℓd without its last kick, of the declared discrete Lagrangian.
fn legendre<'g>(
    sources: &equation::Sources<'_, 'g>,
    lagrangian: &DiscreteLagrangian<'g>,
) -> (Vec<Expr<'g>>, Vec<Expr<'g>>) {
    let (model, momentum_map) = (sources.model, sources.momentum_map);
    let (before, after) = trivialised(model, lagrangian);
    let (mut before, mut after) = (components(model, &before), components(model, &after));
    for k in (0..model.factors.len()).filter(|&k| exact::is_free_rotation(model, k)) {
        (before[k], after[k]) = exact::legendre(model, sources.symbols, k);
    }
    if lagrangian.couples {
        let coupling = action::coupling(model, sources.symbols, momentum_map, lagrangian.kinetic);
        before.iter_mut().zip(coupling).for_each(|(before, coupling)| *before = *before + coupling);
    }
    if let Some(start) = action::impulse(model, sources.symbols, momentum_map, lagrangian.start) {
        before.iter_mut().zip(start).for_each(|(before, start)| *before = *before - start);
    }
    (before, after)
}
