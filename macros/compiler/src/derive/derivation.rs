//! The constant `DERIVATION`: the derivation in words and formulas, its cost, and the parts that were left out and why.

mod conserved;
mod equations;
mod step;

use clebsch_symbolic::{Elements, Group, IntoList, Notation, Product};

use super::symbols::subscript;
use super::{MechanicsFormulas, SteeredFormulas, Structure};
use crate::model::{Discretization, Factor, Motion, RungeKutta, System};

/// The results of lowering that the derivation reports.
pub struct Lowered {
    /// How the code is written, and why: a sentence.
    pub form: String,
    /// The coefficients of ξᵢξⱼ, i ≤ j, in the kinetic energy, without those that are zero.
    /// `None` for matrix code and where they are too long to print.
    pub energy: Option<Vec<(usize, usize, Product)>>,
    /// Whether the gradient of a site of a power is gathered from the terms that read it. Of a field it is the force on a site,
    /// and its edges.
    pub is_gathered: bool,
    /// Whether steps of a point on a sphere are made in the point and its velocity, without the matrices of the group.
    pub turns_in_plane: bool,
    /// How the equations of each substep are iterated.
    pub iterations: Vec<Vec<Iteration>>,
    /// The operations of each kernel, one line each.
    pub costs: String,
}

/// How a momentum equation is iterated.
pub struct Iteration {
    /// The known structure of its Jacobian.
    pub structure: Structure,
    /// Whether x ← x − s h Σ⁻¹ρ(x) is tried before Newton's method.
    pub tries_fixed_point: bool,
}

/// The text of `DERIVATION`.
pub fn derivation(formulas: &MechanicsFormulas<'_>, lowered: &Lowered) -> String {
    let model = &formulas.model;
    let item = model.power.as_ref().map_or(&model.item, |power| &power.item);
    if formulas.rests() {
        let (edges, frames, table) = (edges(formulas, lowered), frames(model), formulas.table());
        let rest = "It has no cost: nothing moves it in time. It rests where no site feels a force, at a minimum of its energy.";
        return format!("{}\n\n{edges}{rest}\n{frames}\nFormulas\n\n{table}\nCost\n\n{}", item.ident, lowered.costs);
    }
    let system = [
        sites(formulas, lowered),
        edges(formulas, lowered),
        frames(model),
        energy(formulas, lowered),
        constant_in_space(formulas),
        vertical(formulas),
        conserved::forces(formulas),
        conserved::constraint(formulas),
        conserved::joints(formulas),
        conserved::conserved(formulas),
    ];
    let scheme = [step::scheme(formulas, lowered), form(formulas, lowered)];
    let left_out = conserved::left_out(formulas);
    format!(
        "{}\n\n{}\n{}\n{left_out}\nFormulas\n\n{}\nCost\n\n{}",
        item.ident,
        system.concat(),
        scheme.concat(),
        formulas.table(),
        lowered.costs,
    )
}

/// The form of a state if steps turn in a plane, and the form of the code.
fn form(formulas: &MechanicsFormulas<'_>, lowered: &Lowered) -> String {
    let is_pushed = formulas.substeps.iter().any(|substep| substep.start.is_some() || substep.end.is_some());
    let in_plane = match (lowered.turns_in_plane, is_pushed) {
        (true, true) => {
            "Steps are made in q and w ⊥ q, which a state holds in place of its momentum M = wqᵀ − qwᵀ: q⁺ = cq + aw, w⁺ = cw − a|w|²q, a = h/κ, c² = 1 − a²|w|².\n"
        }
        (true, false) => {
            "A state holds two vectors of the plane in which it turns in place of its momentum M = vuᵀ − uvᵀ, which stays: q⁺ = cq + aw, w = Mq, a = h/κ, c² = 1 − a²|w|².\n"
        }
        (false, _) => "",
    };
    format!("{in_plane}{}\n", lowered.form)
}

/// The description of a power.
fn sites(formulas: &MechanicsFormulas<'_>, lowered: &Lowered) -> String {
    let Some(power) = &formulas.model.power else { return String::new() };
    let length = &power.length;
    let equal = if power.is_uniform {
        "all with the same kinetic energy, whose constants are made once"
    } else {
        "whose fields differ, so that the constants of each are made in each step"
    };
    let added = if lowered.is_gathered {
        "the gradient of a site is gathered from the terms that read it"
    } else {
        "the share of a term is added at each of its sites"
    };
    let (summed, each) = match power.terms.len() {
        1 => ("a sum of one formula".to_string(), "it"),
        count => (format!("sums of {count} formulas"), "each"),
    };
    let terms = if power.terms.is_empty() {
        let joints = power.joints.is_some();
        if joints { "Joints tie them to each other." } else { "Nothing ties them to each other." }.to_string()
    } else {
        format!(
            "They are tied to each other by the potential, {summed}; {each} is differentiated once, and {added}, in loops: the code does not grow with {length}."
        )
    };
    format!("A power: {length} sites, {equal}. The following is about one site.\n{terms}\n")
}

/// The description of a field.
fn edges(formulas: &MechanicsFormulas<'_>, lowered: &Lowered) -> String {
    let Some(field) = &formulas.field else { return String::new() };
    let directions = match field.edges.len() {
        1 => "one direction",
        2 => "two directions",
        _ => "three directions",
    };
    let found = if lowered.is_gathered {
        "The force on a site is found from all of its edges at once; where some are missing, edge by edge."
    } else {
        "The force of each edge is added at both of its sites."
    };
    format!(
        "A field: a site at each place of a grid with {directions}, and an edge from each site to the next. The following is about one site.\n\
         An edge of the energy U(q, q⁺) pushes its site by f = −J(q, ∂₁U), and the next one by f⁺ = −J(q⁺, ∂₂U). {found}\n"
    )
}

fn inputs(model: &System<'_>) -> String {
    model.inputs.each(|leaf| leaf.name.as_str()).join(", ")
}

/// The sentences about references, each with its end of line; none where none are read.
fn references(model: &System<'_>) -> String {
    let told = [(&model.reference, "each step", "refer"), (&model.end_reference, "the end", "with_end_reference")];
    let told = told.into_iter().filter(|((_, leaves), ..)| !leaves.is_empty()).map(|((_, leaves), of, by)| {
        let names = leaves.each(|leaf| leaf.name.as_str()).join(", ");
        format!("References of {of}: {names}; `{by}` gives them.\n")
    });
    told.collect()
}

/// `one bound`, `2 equations and 3 bounds, and a soft one where that pays`; `None` where nothing is bounded.
fn bounds(model: &System<'_>) -> Option<String> {
    let control = model.control.as_ref()?;
    let (soft, equations) = (control.soft_bounds(), control.equations());
    let counted = |count: usize, of: &str| match count {
        0 => None,
        1 => Some(format!("one {of}")),
        count => Some(format!("{count} {of}s")),
    };
    let hard = [counted(equations, "equation"), counted(control.bounds.len() - soft - equations, "bound")];
    let hard = hard.into_iter().flatten().into_list().join(" and ");
    match (hard.is_empty(), counted(soft, "soft bound")) {
        (false, Some(soft)) => Some(format!("{hard}, and {soft} where that pays")),
        (true, Some(soft)) => Some(format!("{soft} where that pays")),
        (false, None) => Some(hard),
        (true, None) => None,
    }
}

/// The text of a system whose configuration inputs move.
pub fn derivation_of_control(formulas: &SteeredFormulas<'_>, costs: &str) -> String {
    let model = &formulas.model;
    let motion = match &model.motion {
        Motion::Controls { discretization: Discretization::Exponential, .. } => {
            "A step moves the configuration by F = exp(h ξ(u)), exact where the input stays as it is."
        }
        Motion::Controls { .. } => {
            "A step moves the configuration by F = (I − h/2 ξ(u))⁻¹(I + h/2 ξ(u)), of second order in h."
        }
        Motion::Dynamics { from: Some((_, RungeKutta::Classical)), .. } => {
            "A step integrates q′ = f(t, q, u) by the classical Runge–Kutta method, of fourth order in h where the input stays as it is."
        }
        Motion::Dynamics { from: Some((_, RungeKutta::Midpoint)), .. } => {
            "A step integrates q′ = f(t, q, u) by the explicit midpoint rule, of second order in h."
        }
        Motion::Dynamics { .. } => "A step moves the configuration to f(t, h, q, u), by the translation F = f − q.",
    };
    let bounds = bounds(model).map_or(String::new(), |bounds| format!(" and keep {bounds}"));
    format!(
        "{}\n\n{}Inputs: {}; chosen are those of least price among all that reach the target{bounds}.\n{motion}\n{}\nFormulas\n\n{}\nCost\n\n{costs}",
        model.item.ident,
        frames(model),
        inputs(model),
        references(model),
        formulas.table(),
    )
}

/// Which frame momenta are in, factor by factor.
fn frames(model: &System<'_>) -> String {
    let frame = |factor: &Factor<'_>| {
        let (name, group, side) = (&factor.name, factor.group.name(model.graph), factor.side);
        if factor.moves {
            let frame = side.frame();
            format!(
                "{name} in {group} acts from the {side}: momenta and velocities are {frame}, in the basis of {group}.\n"
            )
        } else {
            format!(
                "{name} in {group} moves no configuration; its cost is invariant under conjugation, so it has no side.\n"
            )
        }
    };
    let frames: String = model.factors.iter().map(frame).collect();
    let points = model.configurations.iter().zip(&model.action);
    let still = points.filter(|(leaf, moved)| model.action.len() > 1 && leaf.symbol == **moved);
    let still: String = still.map(|(leaf, _)| format!("Nothing moves {}: it stays as it is.\n", leaf.name)).collect();
    frames + &still + "⟨A, E⟩ stands for the components tr(AᵀE_i); x^ for Σ x_i E_i; h for the step.\n"
}

/// The kinetic energy in coordinates, to check the meaning of the cost.
fn energy(formulas: &MechanicsFormulas<'_>, lowered: &Lowered) -> String {
    let velocities = formulas.symbols.algebra.iter();
    let names: Vec<String> =
        velocities.flat_map(|xi| (1..=xi.shape().rows).map(move |i| format!("{xi}{}", subscript(i)))).into_list();
    let term = |(i, j, coefficient): &(usize, usize, Product)| {
        let square = if i == j { format!("{}²", names[*i]) } else { format!("{}·{}", names[*i], names[*j]) };
        let mut term = coefficient.clone();
        term.multiply(&Product::scalar(square));
        term
    };
    let refused =
        if formulas.is_definite() { ", and `stepper()` refuses it without `signature = indefinite`" } else { "" };
    let symmetric = formulas.symmetric.sentences();
    let parameters = formulas.parameters_of_signature();
    let signature = match formulas.signature() {
        Some((_, 0)) => format!("positive definite for {parameters}"),
        Some((0, _)) => format!("negative definite for {parameters}{refused}"),
        Some((positive, negative)) => {
            format!(
                "indefinite, of signature ({positive}, {negative}) for {parameters}: extremals are no minima{refused}"
            )
        }
        None => "of a signature that depends on the parameters".to_string(),
    };
    let Some(terms) = &lowered.energy else { return format!("Kinetic energy is {signature}.{symmetric}\n") };
    let terms = Product::sum(terms.each(term), Notation::Unicode, true).written(Notation::Unicode);
    let to_second_order = if formulas.energy.general.is_some() { " to second order" } else { "" };
    let linear = if formulas.energy.gyroscopic.is_zero() { "" } else { ", and a part that is linear in the velocity" };
    format!("Kinetic energy in these coordinates{to_second_order}: {terms}{linear}. It is {signature}.{symmetric}\n")
}

/// The frame of a constant inertia of rotations from the left: the usual inertia of a body turns with it.
fn constant_in_space(formulas: &MechanicsFormulas<'_>) -> String {
    let model = &formulas.model;
    let ([factor], [leaf]) = (model.factors.as_slice(), model.configurations.as_slice()) else { return String::new() };
    let Factor { name, group, symbol, .. } = factor;
    let is_rigid = matches!(group, Group::SpecialOrthogonal(3..) | Group::UnitQuaternions | Group::SpecialEuclidean(_));
    // points are no frames: no product of F and q has to exist
    let is_frame = leaf.symbol.shape() == symbol.shape();
    let turns_frames = is_rigid && is_frame && model.action[0] == group.compose(*symbol, leaf.symbol);
    if !turns_frames || formulas.uniform_inertia.is_some() || formulas.inertia_moves() {
        return String::new();
    }
    format!(
        "The inertia is constant in space and does not turn with {q}. A rigid body has an inertia that is constant in the body: its action is {q}·{name}, from the right.\n",
        q = leaf.name
    )
}

/// The reason for a vertical term.
fn vertical(formulas: &MechanicsFormulas<'_>) -> String {
    let Some(vertical) = &formulas.vertical else { return String::new() };
    let names = vertical.factors.each(|&k| formulas.model.factors[k].name.as_str()).join(", ");
    let (depends, when, alone) = if formulas.model.kinetic.discretization().is_some() {
        ("Lagrangian depends on the velocity through ξ_Q(q) alone", "along every motion", "Lagrangian")
    } else {
        ("cost depends on F through Φ_F(q) alone", "in every step", "cost")
    };
    format!(
        "The {depends}: motions of {names} that leave q unchanged, ξ in 𝔤_q, have no kinetic energy. The vertical term W gives it to them. \
         Momenta lie in 𝔤_q^⊥, so W and its derivative are 0 {when}: q moves as by the {alone} without it.\n"
    )
}
