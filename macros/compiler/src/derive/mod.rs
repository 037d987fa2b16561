//! The third stage: from the model to its formulas, by calculus on matrices and groups.
//!
//! Everything is derived from one discrete Lagrangian ℓd = K(t, h, q, F) + U₀(t, q) + U₁(t + h, Φ_F q). K is the cost,
//! and the order places the potential. The form of a step is the discrete Clebsch problem, which holds for every group.
//! Solve r(F) = T* ∂_F K − J(q, ∂_q K) = N + J(q, ∂U₀) for F, and move. Then N⁺ is the other trivialisation of ∂_F K
//! plus J(q⁺, ∂U₁). If K does not depend on q, that trivialisation is Ad* of r.

mod appendix;
mod catalogue;
mod cayley;
mod choice;
mod clearing;
mod closed_form;
mod collocation;
mod constraint;
mod control;
mod cross;
mod degenerate;
mod derivation;
mod direction;
mod discrete_lagrangian;
mod energy;
mod equation;
mod equations;
mod exact;
mod field;
mod force;
mod formula;
mod formulas;
mod isotropy;
mod joints;
mod latex;
mod letters;
mod matrices;
mod midpoint;
mod monitor;
mod moves;
mod naming;
mod power;
mod predictor;
mod rotation;
mod rows;
mod signature;
mod splitting;
mod structure;
mod substep;
mod summation;
mod symbols;
mod symmetric;
mod symmetry;
mod system;
mod tangent;
mod trivialisation;
mod variation;
mod velocity;

use clebsch_symbolic::{Expr, IntoList};
use std::rc::Rc;

use crate::diagnostic::{Diagnostics, bail};
use crate::model::features::{self, Feature, Found};
use crate::model::{Discretization, Kinetic, Mechanics, Model, Order, Steered, System};

pub use appendix::appendix;
pub use catalogue::{Entry, Heat, Id, Reference};
pub use choice::{Choice, EndTarget, Endpoint, Jet, OnEdge, Steering, StepOfChoice};
pub use collocation::Collocation;
pub use constraint::{ConstraintFormulas, PlaceFormulas};
pub use control::{Bend, InputStep};
pub use derivation::{Iteration, Lowered, derivation, derivation_of_control};
use discrete_lagrangian::Cost;
pub use discrete_lagrangian::DiscreteLagrangian;
pub use energy::Energy;
use equation::Sources;
pub use equation::{MomentumEquation, RotatingBody, Solution, Structure};
pub use field::{EdgeFormulas, FieldFormulas, expanded};
pub use force::EdgeForce;
pub use formula::{Formula, FormulaTable};
use formulas::is_timed;
pub use formulas::{Formulas, MechanicsFormulas, SteeredFormulas};
pub use isotropy::Vertical;
pub use joints::{JointFormulas, JointRows};
pub use matrices::MatrixForm;
pub use midpoint::MidpointFormulas;
pub use monitor::MonitorFormulas;
pub use power::{Home, SiteTerm, Stencil, stencil};
use rows::MOST_LISTED;
pub use splitting::Splitting;
pub use substep::Substep;
pub use symbols::{ChartBlock, Symbols};
pub use symmetric::SymmetricParts;
pub use symmetry::{ConservedMomentum, Symmetries};
pub use system::SystemFormulas;
pub use variation::{ConstraintDerivatives, EdgeDerivatives, Quantity};

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

fn mechanics(mut model: Mechanics<'_>) -> Result<MechanicsFormulas<'_>, Diagnostics> {
    variation::check(&model)?;
    let has_rows = model.constraint.as_ref().is_some_and(|constraint| constraint.velocities.is_some());
    let of_rows = has_rows.then(|| force::discretization_of_velocity(&model));
    let mut system = system(model.system.clone(), of_rows.or_else(|| model.kinetic.discretization()));
    if let Kinetic::Lagrangian { energy, .. } = &mut model.kinetic {
        *energy = cross::shortened(*energy);
    }
    let KineticPart { declared, cost, energy, inertia, vertical } = kinetic_part(&mut model, &system)?;
    let at_rest = declared.kinetic.substitute(&symbols::identities(&model));
    let lagrangian = discrete_lagrangian::separate(&model, cost);
    // symmetries and Legendre transforms are those of the declared cost
    let declared = if declared == cost { lagrangian } else { discrete_lagrangian::separate(&model, declared) };
    substep::check_unmoved(&model, &lagrangian)?;
    let covector = force::covector(&model, &system);
    let field = field::of(&model, &system, cost.kinetic, covector.as_deref())?;
    let potential_energy = match &model.field {
        Some(field) => field.potential.unwrap_or_else(|| model.graph.integer(0)),
        None => energy::potential(&model, &declared, at_rest)?,
    };
    let pushes = (potential_energy, covector.as_deref());
    let constraint = ConstraintFormulas::of(&model, &system, (&energy, inertia), pushes)?;
    let joints = joints::of(&model, &system, (&energy, inertia), pushes)?;
    let is_timed = is_timed(&model, &lagrangian);
    let quantities = if model.emit.tangent { variation::quantities(&model, is_timed) } else { Vec::new() };
    check_velocities_of_end(&model, &energy)?;
    let chosen = variation::Source { model: &model, system: &system, quantities: &[] }.chosen_by_velocity();
    system.steering = chosen.or(system.steering);
    system.endpoint = system.price_of_end_velocity(&energy, inertia).or(system.endpoint);
    system.target = system.target_of_velocity(&energy, inertia).or(system.target);
    let variations = variation::Source { model: &model, system: &system, quantities: &quantities };
    let sources = |divisor| Sources { model: &model, system: &system, inertia, divisor, keeps_exponentials: false };
    let mut edges = discrete_lagrangian::substeps(&model, &lagrangian, &declared);
    constraint::check_adjoint(&model, &edges)?;
    let stepped = if edges.len() == 1 { 1 } else { 2 };
    if let Some(control) = model.control.as_ref().filter(|_| stepped == 2) {
        let price = (Feature::Effort, Found::at(control.written.place));
        return Err(features::refusal(price, (Feature::AdjointPair, Found::somewhere())).into());
    }
    let forces = |divisor| covector.as_ref().map(|covector| force::on_edge(&model, covector, divisor));
    let is_pushed = constraint.is_some() || forces(1).is_some_and(|force| force.start_moving.is_some());
    if edges.len() == 1 && is_pushed {
        // the Legendre transform of ℓd, without the force, is to be inverted
        edges.push((1, lagrangian));
    }
    let substep = |(index, (divisor, lagrangian))| {
        let begins = if index == 1 { model.step_size / divisor } else { model.graph.integer(0) };
        let of_step = index < stepped;
        let pushes = (forces(divisor).filter(|_| of_step), constraint.as_ref().filter(|_| of_step));
        Substep::new(sources(divisor), &variations, lagrangian, begins, pushes)
    };
    let mut substeps: Vec<Substep<'_>> = edges.into_iter().enumerate().map(substep).into_list();
    let legendre_kick = system.impulse(lagrangian.end);
    let (legendre, legendre_next) = substep::legendre(&model, &system, &declared);
    let is_first = model.order == Order::First;
    let stagger = if is_first { system.impulse((lagrangian.end - lagrangian.start) / 2) } else { None };
    let is_staggered = stagger.is_some() && model.force.is_none() && declared.balanced().is_time_symmetric(&model);
    let links = power::links(&model);
    let mut tied = joints::entries(&model);
    tied.extend(power::links(&model));
    tied.extend(field::terms(&model));
    let pushes = (covector.as_deref(), constraint.as_ref());
    let symmetries = symmetry::find(&sources(1), &declared, pushes, &tied);
    check_offers(&model, &symmetries)?;
    let splitting = splitting::splitting(&sources(1), &lagrangian, &substeps);
    let is_exact =
        !energy::pushes(&model, potential_energy) && splitting::drifts_exactly(&model, &system.symbols, &substeps);
    let monitor = MonitorFormulas::of(&sources(1), &energy, &substeps[..stepped], potential_energy)?;
    let is_free = system.is_free();
    let collocation =
        if is_exact { None } else { collocation::collocation(&sources(1), &energy, potential_energy, is_free)? };
    substep::adopt_sine(&mut system.symbols, &mut substeps);
    substep::check_poles(&model, &system.symbols, &substeps)?;
    substep::check_tolerance(&model, &substeps, collocation.is_some())?;
    let uniform_inertia = energy::uniform(&system.symbols, energy.kinetic, inertia);
    let symmetric = SymmetricParts::of(&model, model.kinetic.energy(), energy.kinetic);
    let formulas = MechanicsFormulas {
        projection: if is_free { None } else { system.projection() },
        coadjoint: system.coadjoint(),
        cotangent_lift: system.cotangent_lift(),
        uniform_inertia: uniform_inertia.filter(|_| !system.is_moving(inertia)),
        system,
        model,
        is_free,
        inertia,
        energy,
        symmetric,
        potential_energy,
        stagger,
        is_staggered,
        links,
        symmetries,
        lagrangian,
        legendre,
        legendre_next,
        legendre_kick,
        quantities,
        substeps,
        stepped,
        splitting,
        monitor,
        collocation,
        is_exact,
        covector,
        constraint,
        joints,
        field,
        vertical,
    };
    summation::check(&formulas)?;
    Ok(formulas)
}

/// The velocity at the end is a formula of the momentum there, and is priced where inputs are chosen.
fn check_velocities_of_end<'g>(model: &Mechanics<'g>, energy: &Energy<'g>) -> Result<(), Diagnostics> {
    let price = model.endpoint.iter().map(|price| (Feature::VelocityOfEnd, &price.velocities, &price.written));
    let target = model.target.iter().map(|target| (Feature::VelocityOfTarget, &target.velocities, &target.written));
    price.chain(target).try_for_each(|(feature, velocities, written)| {
        let Some(velocity) = velocities.first() else { return Ok(()) };
        features::check((feature, Found::at(written.place).named(velocity)), |feature| match feature {
            Feature::Boundary => Found::when(model.emit.boundary),
            Feature::GeneralLagrangian => Found::when(energy.general.is_some()),
            _ => None,
        })
    })
}

/// The kinetic part of a model.
struct KineticPart<'g> {
    /// The cost K as declared.
    declared: Cost<'g>,
    /// The cost with the vertical term.
    cost: Cost<'g>,
    /// The continuous Lagrangian, with the vertical term.
    energy: Energy<'g>,
    /// Its Σ, which is regular.
    inertia: Expr<'g>,
    vertical: Option<Vertical<'g>>,
}

/// The kinetic part of a model, with the vertical term where its kinetic energy vanishes on the isotropy.
fn kinetic_part<'g>(model: &mut Mechanics<'g>, system: &SystemFormulas<'g>) -> Result<KineticPart<'g>, Diagnostics> {
    let declared = discrete_lagrangian::cost(model);
    let energy = energy::kinetic(model, system);
    let Some(vertical) = energy.as_ref().ok().and_then(|energy| isotropy::vertical(model, system, energy)) else {
        let (cost, energy) = (declared?, energy?);
        let inertia = energy::inertia(&system.symbols, energy.kinetic);
        energy::check_rank(model, system, inertia)?;
        return Ok(KineticPart { declared: cost, cost, energy, inertia, vertical: None });
    };
    vertical.fill(model);
    let cost = discrete_lagrangian::cost(model)?;
    // a Lagrangian has the vertical term before it is discretised
    let declared = if model.kinetic.discretization().is_some() { cost } else { declared? };
    let energy = energy::kinetic(model, system)?;
    let inertia = energy::inertia(&system.symbols, energy.kinetic);
    energy::check_rank(model, system, inertia)?;
    Ok(KineticPart { declared, cost, energy, inertia, vertical: Some(vertical) })
}

/// The formulas of the action and of prices alone.
fn system<'g>(model: Rc<System<'g>>, discretization: Option<Discretization>) -> SystemFormulas<'g> {
    let mut system = SystemFormulas::new(model, discretization);
    system.steering = system.chosen_by();
    system.endpoint = system.price_of_end();
    system.target = system.target();
    system
}

/// The formulas without mechanics: the action, and those for the choice of inputs.
fn steered(model: Steered<'_>) -> SteeredFormulas<'_> {
    let system = system(model.system.clone(), None);
    SteeredFormulas { step: control::step(&model, &system), model, system }
}

/// An offered symmetry has to be one.
fn check_offers(model: &Mechanics<'_>, symmetries: &Symmetries<'_>) -> Result<(), Diagnostics> {
    let Some(&index) = symmetries.refused.first() else { return Ok(()) };
    let offered = &model.symmetries[index];
    let (what, unchanged) = if model.constraint.is_some() {
        (
            "the cost, the potential and the constraint",
            "leaves cost and potential unchanged and is allowed by the constraint",
        )
    } else if model.force.is_some() {
        ("the cost, the potential and the force", "leaves all of them unchanged")
    } else {
        ("the cost and the potential", "leaves both unchanged")
    };
    bail!(offered.written.place, "`{}` is not a symmetry of {what}", offered.written.text;
        help "leave it out, or offer the part of the group that {unchanged}";
        note "it has to leave them unchanged for all configurations, group elements and parameters, and move the configuration as a motion of the declared group does");
}
