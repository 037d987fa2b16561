//! The forces, the conserved quantities, and the parts that a problem does not need.

use super::{bounds, inputs, references};
use clebsch_symbolic::{Elements, IntoList};

use crate::derive::{ConstraintFormulas, MOST_LISTED, MechanicsFormulas, OnEdge, Substep};
use crate::model::{Constraint, Isotropy, Joint, Order, VelocityRows};

pub(super) fn forces(formulas: &MechanicsFormulas<'_>) -> String {
    let model = &formulas.model;
    if model.force.is_none() {
        return String::new();
    }
    let ends = if model.order == Order::First { "h·f at the end" } else { "half of h·f at each end" };
    let mut text = format!(
        "Forces act: {ends} of the step, with the velocity of the step at both (Lagrange–d'Alembert). \
         The step is not symplectic; the energy changes by the work of f, and the momenta that are conserved are those on which f does not act.\n",
    );
    let mut forces = formulas.substeps.iter().filter_map(|substep| substep.force.as_ref());
    if forces.any(|force| force.start_moving.is_some()) {
        text += "The part of f that depends on the velocity joins the momentum equation.\n";
    }
    if !model.inputs.is_empty() {
        text += &format!("Input: {}; `step` takes none for zero, `step_with` takes one.\n", inputs(model));
    }
    if model.control.is_some() {
        let bounds = bounds(model).map_or("without bounds".to_string(), |bounds| format!("within {bounds}"));
        let equations = match formulas.constraint {
            Some(_) => "momentum equation and of its constraint",
            None => "momentum equation",
        };
        text += &format!(
            "`control` chooses inputs of least price {bounds}: the step is differentiated twice, by the multipliers of its {equations}.\n"
        );
        let OnEdge { price, bounds } = formulas.steering.as_ref().map(|steering| steering.on_edge).unwrap_or_default();
        let taken = match (price, bounds) {
            (true, true) => Some("Price and bounds take"),
            (true, false) => Some("The price takes"),
            (false, true) => Some("The bounds take"),
            (false, false) => None,
        };
        text += &taken.map_or(String::new(), |taken| {
            format!("{taken} the velocity ξ(F)/h of the step, and are differentiated through its equation.\n")
        });
        let is_moving = model.endpoint.as_ref().is_some_and(|price| !price.velocities.is_empty());
        if is_moving {
            text += "The price of the end takes the velocity Σ⁻¹(N − A) of the momentum there.\n";
        }
        if model.target.as_ref().is_some_and(|target| !target.velocities.is_empty()) {
            text += "The target takes the velocity Σ⁻¹(N − A) of the momentum at the end.\n";
        }
        text += &references(model);
    }
    text
}

/// The constraint, how a step obeys it, and the properties that it leaves.
pub(super) fn constraint(formulas: &MechanicsFormulas<'_>) -> String {
    let (Some(constraint), Some(known)) = (&formulas.model.constraint, &formulas.constraint) else {
        return String::new();
    };
    let texts = |is_of_velocities: bool| {
        let own = constraint.equations.iter().filter(|equation| equation.is_of_velocities == is_of_velocities);
        let mut own: Vec<_> = own.map(|equation| equation.written.text.clone()).into_list();
        // one sequence has several equations
        own.dedup();
        own.join(", ")
    };
    let (of_places, of_velocities) = (texts(false), texts(true));
    let multipliers = if formulas.substeps.first().is_some_and(|substep| formulas.has_no_multiplier(substep)) {
        "Each of its rows is a coordinate of the step, so there is no multiplier to be found."
    } else {
        "The multipliers λ are no unknowns of the momentum equation: they are found from its residual."
    };
    let Some(VelocityRows { rows, values }) = constraint.velocities else {
        return format!(
            "Constraint on places: {of_places}. Its force Aᵀλ acts along its rows at both ends of the step, and q⁺ obeys it. \
             The velocity of N⁺ is tangent to it: A·Σ⁻¹·N⁺ = b at the end of the step.\n\
             {multipliers} The step is time-symmetric, symplectic on the momenta that are tangent to the constraint, and obeys it to rounding.\n"
        );
    };
    let q = formulas.model.configurations.each(|leaf| leaf.name.clone()).join(", ");
    let mean = if known.is_mean_of_rows {
        format!("the rows are the mean of those at {q} and {q}⁺")
    } else {
        format!("{q} is the mean of both ends")
    };
    let is_steady = !formulas.is_moving(rows) && !formulas.is_moving(values);
    let mean = if is_steady { String::new() } else { format!(", where {mean}") };
    let places = velocities_of_places(constraint, known);
    let not_symplectic =
        "It is not symplectic. Momenta are conserved along motions that the constraint allows at every configuration.";
    if constraint.places.is_some() {
        return format!(
            "Constraint on places: {of_places}. Constraint on velocities: {of_velocities}. \
             The force Aᵀλ of both acts along their rows at both ends of the step (Lagrange–d'Alembert). \
             q⁺ obeys the first. The velocity ξ(F)/h of the step obeys the second{mean}. \
             The velocity of N⁺ obeys both: A·Σ⁻¹·N⁺ = b at the end of the step.\n\
             {multipliers} The step is time-symmetric, and obeys both to rounding. {not_symplectic}\n{places}"
        );
    }
    format!(
        "Constraint: {of_velocities}. Its force Aᵀλ acts along its rows at both ends of the step (Lagrange–d'Alembert). The velocity ξ(F)/h of the step obeys it{mean}. \
         So does that of N⁺: A·Σ⁻¹·N⁺ = b at the end of the step.\n\
         {multipliers} The step is time-symmetric, and obeys the constraint to rounding. \
         {not_symplectic}\n{places}"
    )
}

/// The equations of velocities that are those of places, with the advice to write these.
fn velocities_of_places(constraint: &Constraint<'_>, known: &ConstraintFormulas<'_>) -> String {
    let mut texts: Vec<&str> = Vec::new();
    let mut first = 0;
    for equation in constraint.equations.iter().filter(|equation| equation.is_of_velocities) {
        let mut own = first..first + equation.count;
        let is_new = !texts.contains(&equation.written.text.as_str());
        if own.all(|i| known.of_places.contains(&i)) && is_new {
            texts.push(&equation.written.text);
        }
        first += equation.count;
    }
    if texts.is_empty() {
        return String::new();
    }
    let subject = if texts.len() == 1 { "is the velocity" } else { "are velocities" };
    format!(
        "{} {subject} of places φ(q) = c: the motions that remain are closed under brackets (Frobenius). A step keeps c up to O(h²). \
         Where a formula for φ is known, write it without the velocity: a step then solves it to rounding.\n",
        texts.join(", ")
    )
}

/// The joints of a power, and how a step obeys them.
pub(super) fn joints(formulas: &MechanicsFormulas<'_>) -> String {
    let joints = formulas.model.power.as_ref().and_then(|power| power.joints.as_ref());
    let Some(joints) = joints else { return String::new() };
    let text = |joint: &Joint<'_>| match joint.term.indices() {
        indices if indices.is_empty() => joint.written.text.clone(),
        indices => format!("{} for {indices}", joint.written.text),
    };
    let texts = joints.all.each(text).join(", ");
    let (sites, blocks) = match (joints.is_tree, joints.is_ring) {
        (true, _) => ("the sites of a tree", "eliminated from the leaves to the root"),
        (_, true) => ("neighbours", "block tridiagonal, with a block in each corner"),
        _ => ("neighbours", "block tridiagonal"),
    };
    let loops = match joints.loops {
        0 => String::new(),
        count => format!(
            " Loops close by {count} of the equations: they are a border of S, with a dense matrix of {count}x{count}."
        ),
    };
    format!(
        "Joints between {sites}: {texts}. Their forces Aᵀλ act along their rows at both ends of the step, and q⁺ obeys them. \
         The velocity of N⁺ is tangent to them: A·Σ⁻¹·N⁺ = b at the end of the step.\n\
         The multipliers are found by sweeps over all sites, λ ← λ − S⁻¹φ(q⁺)/h. S = A·Σ⁻¹·Aᵀ at q is {blocks}: a sweep takes O(N) operations.{loops} \
         The step is time-symmetric, symplectic on the momenta that are tangent to the joints, and obeys them to rounding.\n"
    )
}

/// The conserved quantities, and those that are not known to be conserved.
pub(super) fn conserved(formulas: &MechanicsFormulas<'_>) -> String {
    let symmetries = &formulas.symmetries;
    let summed = if formulas.has_sites() { ", summed over all sites" } else { "" };
    let mut text = match symmetries.conserved.as_slice() {
        [] => {
            let known = if symmetries.undecided { " that could be proved" } else { "" };
            format!("Conserved: no momentum{known}, for general values of the parameters.\n")
        }
        [first, .., last] if symmetries.conserved.len() > MOST_LISTED => {
            let (count, from, to) = (symmetries.conserved.len(), &first.name, &last.name);
            format!("Conserved: {count} momenta, from that {from}{summed} to that {to}{summed}.\n")
        }
        few => few.iter().map(|momentum| format!("Conserved: the momentum {}{summed}.\n", momentum.name)).collect(),
    };
    text.extend(for_any_axis(&symmetries.special).iter().map(|name| format!("Conserved too: the momentum {name}.\n")));
    if symmetries.undecided {
        text += "Not proved: whether more momenta are conserved; roots and functions are compared by their arguments alone.\n";
    }
    text
}

/// Sentences that say the same of e1, e2 and e3 become one of ek.
fn for_any_axis(sentences: &[String]) -> Vec<String> {
    let general =
        |sentence: &String| ["e1", "e2", "e3"].iter().fold(sentence.clone(), |text, axis| text.replace(axis, "ek"));
    let mut told: Vec<String> = Vec::new();
    for sentence in sentences {
        let alike = sentences.iter().filter(|other| general(other) == general(sentence)).count();
        let text = if alike == 3 { format!("{}, k = 1, 2, 3", general(sentence)) } else { sentence.clone() };
        if !told.contains(&text) {
            told.push(text);
        }
    }
    told
}

/// The parts that this problem does not need, and the facts that were not proved.
pub(super) fn left_out(formulas: &MechanicsFormulas<'_>) -> String {
    let mut text = String::new();
    if formulas.moves_freely() {
        text += "Left out: the kick, as there is no potential.\n";
    }
    text += if formulas.model.emit.momentum {
        "Left out, as asked for by `emit = [momentum]`: the configuration. A step solves for F and carries the momentum along.\n"
    } else if formulas.model.isotropy == Isotropy::Free && !formulas.is_free {
        "Left out, as asked for by `isotropy = free`: the check of 𝔤_q^⊥; motions that fix the configuration are motions too.\n"
    } else if formulas.is_free {
        "Left out: the check of 𝔤_q^⊥, as only the identity fixes a general configuration.\n"
    } else {
        "Some motions fix the configuration: state() demands momenta in 𝔤_q^⊥.\n"
    };
    let uncouples = |substep: &Substep<'_>| {
        let alone = substep.equations.iter().filter(|equation| !formulas.is_solved_after_others(equation));
        alone.count() > 1
    };
    if formulas.substeps.iter().all(uncouples) {
        text += "The momentum equation uncouples: one small solve for each part.\n";
    }
    text
}
