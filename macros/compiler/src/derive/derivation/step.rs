//! How a step goes and how accurate it is, in words.

use clebsch_symbolic::{Group, IntoElements};

use super::Lowered;
use super::equations::{how, part};
use crate::derive::{Collocation, MechanicsFormulas, MonitorFormulas, Solution};
use crate::model::{LeafSpace, Mechanics, Order};

const COMPENSATED: &str = "Sums are compensated: the rounding errors of q and N are stored, and added in the next step. Only the increments q⁺ − q and N⁺ − N are rounded.\n";

pub(super) fn scheme(formulas: &MechanicsFormulas<'_>, lowered: &Lowered) -> String {
    let model = &formulas.model;
    let mut text = format!("{}\n{}", order(formulas), stagger(formulas));
    if let Some(stages) = formulas.stages().or_else(|| formulas.stages_of_sites()).or_else(|| stages_of_field(formulas))
    {
        let is_free = formulas.moves_freely();
        text += &format!(
            "{stages} such steps of sizes γ_i h, the same forwards and backwards and some of them negative, make a step of order {}{}.\n",
            model.declared_order(),
            if is_free { "" } else { "; kicks between them are merged" }
        );
    }
    if let Some(collocation) = &formulas.collocation {
        return collocated(formulas, collocation);
    }
    if let Some(splitting) = &formulas.splitting {
        text = split(model.order, splitting.has_gradient);
    }
    if let Some(monitor) = &formulas.monitor {
        text = transformed(model, monitor);
    }
    if formulas.is_exact && !formulas.moves_freely() {
        text += "Between kicks a site moves exactly.\n";
    } else if formulas.is_exact {
        text = "No potential acts, and a step is the exact motion of the time h: there is no error in h.\n".to_string();
    }
    text += &equations(formulas, lowered);
    if formulas.is_compensated() {
        text += COMPENSATED;
    }
    text += &spaces(formulas);
    text += &tolerance(formulas);
    if let Some(most) = model.dials.limit() {
        text += &format!(
            "At most {most} iterations for each momentum equation, as asked for; a step that needs more is an error.\n"
        );
    }
    text
}

/// Of how many steps of second order a step of all sites of a field is composed, where it is.
fn stages_of_field(formulas: &MechanicsFormulas<'_>) -> Option<usize> {
    formulas.model.field.as_ref()?.order.stages()
}

/// How the momentum equations of a step are solved; both halves of a composed step tell the same, once.
fn equations(formulas: &MechanicsFormulas<'_>, lowered: &Lowered) -> String {
    let mut told: Vec<String> = Vec::new();
    let mut tell = |line: String| {
        if !told.contains(&line) {
            told.push(line);
        }
    };
    for (substep, iterations) in formulas.substeps.iter().zip(&lowered.iterations).take(formulas.stepped) {
        if !substep.still.is_empty() {
            let still = formulas.coordinates_of(&substep.still);
            tell(format!("At zero by the constraint, without an equation: {still}.\n"));
        }
        for (equation, iteration) in substep.equations.iter().zip(iterations) {
            let (part, how) = (part(formulas, equation), how(formulas, equation, iteration));
            tell(format!("The momentum equation for {part} {how}.\n"));
        }
        if formulas.keeps_momentum(substep) && !formulas.turns_whole() {
            tell("Both trivialisations of ∂K agree, so the momentum does not change in the drift.\n".to_string());
        }
    }
    told.concat()
}

/// The order of a step of the discrete Lagrangian, and why.
fn order(formulas: &MechanicsFormulas<'_>) -> &'static str {
    let second = if formulas.model.order == Order::First { Order::First } else { Order::Second };
    match (second, formulas.stepped) {
        (Order::First, _) => "First order as asked for: drift, then kick, −h·V at the end of the step.",
        (Order::Second, 1) if formulas.lagrangian.couples => {
            "The discrete Lagrangian is time-symmetric, ℓd(q, F; h) = −ℓd(Φ_F q, F⁻¹; −h), so the step is of second order. The cost couples configuration and group element: r(F) = T*∂_F K − J(q, ∂_q K) = N is solved, and N⁺ is the other trivialisation of ∂_F K."
        }
        (Order::Second, 1) if formulas.moves_freely() => {
            "The discrete Lagrangian is time-symmetric, K(h, F) = −K(−h, F⁻¹), so the step is of second order."
        }
        (Order::Second, 1) => {
            "The discrete Lagrangian is time-symmetric, K(h, F) = −K(−h, F⁻¹), with −h/2·V at each end: half kick, drift, half kick, second order, one gradient a step."
        }
        _ => {
            "The discrete Lagrangian is not time-symmetric, ℓd(q, F; h) ≠ −ℓd(Φ_F q, F⁻¹; −h): half a step is composed with half a step of its adjoint, which is of second order and costs two solves."
        }
    }
}

/// By how much the momentum of a step of first order is ahead of its configuration.
fn stagger(formulas: &MechanicsFormulas<'_>) -> &'static str {
    if formulas.stagger.is_none() {
        return "";
    }
    match (formulas.is_staggered, formulas.model.force.is_some()) {
        (true, _) => {
            "The momentum N is ahead of its configuration by half of that kick. Taken back by it, π = N − ½ J(q, ∂(U₁ − U₀)), it is that of the step of second order, \
             half kick, drift, half kick: `synchronized` reads π, and `staggered_state` starts from it.\n"
        }
        (false, true) => {
            "`synchronized` takes back half of the kick of the potential alone; the motion stays of first order, as the force acts with the velocity before it.\n"
        }
        (false, false) => {
            "`synchronized` takes back half of that kick; the motion stays of first order, as the cost is not time-symmetric.\n"
        }
    }
}

/// The reason why configurations stay on their spaces.
fn spaces(formulas: &MechanicsFormulas<'_>) -> String {
    let is = |which: fn(&LeafSpace) -> bool| formulas.model.configurations.iter().any(|leaf| which(&leaf.space));
    let (mut what, mut how) = (Vec::new(), Vec::new());
    if is(|space| matches!(space, LeafSpace::Group(group) if group.is_orthogonal())) {
        what.push("orthogonal matrices");
        how.push("by R(3I − RᵀR)/2 once |R(1, …, 1)|² is off N by 8Nε");
    }
    if is(|space| *space == LeafSpace::Orthonormal) {
        what.push("orthonormal columns");
        how.push("by X(3I − XᵀX)/2 once |X(1, …, 1)|² is off their number k by 8kε");
    }
    if is(|space| matches!(space, LeafSpace::Projector(_))) {
        what.push("projectors");
        how.push("by 3P² − 2P³ once |P(1, …, 1)|² is off (1, …, 1)·P(1, …, 1) by 8nε");
    }
    if is(|space| matches!(space, LeafSpace::Unit | LeafSpace::Group(Group::UnitQuaternions))) {
        what.push("vectors of length one");
        how.push("by q(3 − |q|²)/2 once |q|² is off by 8ε");
    }
    if is(|space| *space == LeafSpace::Symmetric) {
        what.push("symmetric matrices");
        how.push("by their entries above the diagonal");
    }
    if what.is_empty() {
        return String::new();
    }
    let (what, how) = (what.join(" and "), how.join(", "));
    format!("Rounding is taken off {what}, {how}: they stay there for any number of steps of (q, N).\n")
}

/// The properties that an iteration preserves although it ends early, and those that it does not.
fn tolerance(formulas: &MechanicsFormulas<'_>) -> String {
    let Some(tolerance) = &formulas.model.dials.tolerance else { return String::new() };
    let kept = formulas.conserved_by_any_element();
    let kept: Vec<&str> = kept.into_each(|momentum| momentum.name.as_str());
    let kept = if kept.is_empty() {
        "No momentum is conserved to rounding".to_string()
    } else {
        format!("As N⁺ is Ad* of N, conserved to rounding all the same: the momentum {}", kept.join("; "))
    };
    let mut equations = formulas.substeps.iter().flat_map(|substep| &substep.equations);
    let (ends, x) = if equations.any(|equation| equation.solution == Solution::FreeRotation) {
        ("Series of d end before terms that are below", "d")
    } else {
        ("Iterations end before a correction that is below", "x")
    };
    format!(
        "{ends} {:e} of {x}, as asked for. F lies on its group whatever {x} is. {kept}. The energy and other momenta drift, as the step is not symplectic.\n",
        tolerance.value
    )
}

/// A step whose time follows a monitor.
fn transformed(model: &Mechanics<'_>, monitor: &MonitorFormulas<'_>) -> String {
    let composed = match model.order.stages() {
        None => "It is symmetric, of second order.".to_string(),
        Some(stages) => format!("{stages} of these, of sizes γ_i h, make a step of order {}.", model.order),
    };
    let half = if monitor.drifts_exactly {
        "A step is half a drift, kick, half a drift"
    } else {
        "A step is half a kick, drift, half a kick"
    };
    let kind = if monitor.is_logarithmic {
        "g·(V₀ − V) is constant: in s the step is symplectic, that of the logarithmic Hamiltonian"
    } else {
        "It is reversible, and symplectic only for exact drifts and monitors c/(V₀ − V)"
    };
    format!(
        "The time follows the monitor g(q): dt = g ds, in steps of the size h of s. W starts as 1/g. A drift takes the time h/W. A kick is that of the time h·g, with W⁺ = W − γ·(μ + μ⁺)/2. {half}, each of which conserves momenta. {composed} {kind}.\n"
    )
}

fn collocated(formulas: &MechanicsFormulas<'_>, collocation: &Collocation<'_>) -> String {
    let mut text = String::from(
        "Hamilton's equations on T*Q, those of the continuous Clebsch problem, are collocated at the eight nodes of Gauss and Legendre: order 16, symplectic. \
         Quantities that are quadratic in (q, p) are conserved, such as the momenta of symmetries and the orbit of q. A step starts from a covector p with J(q, p) = N; N⁺ − N = J(q⁺, p⁺) − J(q, p).\n",
    );
    if collocation.is_affine {
        text += "The action moves the origin: J is affine in q.\n";
    }
    let most = formulas.model.dials.limit().unwrap_or(64);
    let until = match &formulas.model.dials.tolerance {
        None => "only rounding changes".to_string(),
        Some(tolerance) => format!(
            "the step changes by less than {:e} of q and p, as asked for: that much is missing to a symplectic step, and \
             energy, momenta and the orbit drift with it",
            tolerance.value
        ),
    };
    text += &format!("Slopes are found by sweeps over all stages, {most} at most, until {until}.\n");
    if formulas.is_compensated() {
        text += COMPENSATED;
    }
    text + &spaces(formulas)
}

fn split(order: Order, has_gradient: bool) -> String {
    let (kicks, kind) = match (order, has_gradient) {
        (Order::Sixth, true) => (7, "with force gradients, of order (8, 6, 6) in V, V² and V³"),
        (_, true) => (4, "with force gradients at the nodes of Gauss and Legendre, of order (8, 4) in V and V²"),
        (Order::Sixth, false) => (10, "without force gradients, as the potential is opaque"),
        (_, false) => (7, "without force gradients, as the potential is opaque"),
    };
    format!(
        "The drift is exact, so drifts and kicks in turn make a step of order {order}: {kicks} kicks {kind}, the same forwards and backwards. A part a of the drift with the momentum μ is the full drift with the momentum a μ.\n"
    )
}
