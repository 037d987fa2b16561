//! What acts, what is conserved, and what a problem does not need.

use std::fmt::Write;

use crate::derive::{MOST_LISTED, MechanicsFormulas, Substep};
use crate::model::{Isotropy, Order};

/// What forces take away.
pub(super) fn forces(formulas: &MechanicsFormulas<'_>) -> String {
    let model = &formulas.model;
    if model.force.is_none() {
        return String::new();
    }
    let mut text = String::from(
        "Forces act: half of h·f at each end of the step, with the velocity of the step at both (Lagrange–d'Alembert). \
         The step is not symplectic; the energy changes by the work of f, and the momenta that are conserved are those on which f does not act.\n",
    );
    if model.order == Order::First {
        text = text.replace("half of h·f at each end", "h·f at the end");
    }
    let joins = formulas
        .substeps
        .iter()
        .any(|substep| substep.force.as_ref().is_some_and(|force| force.start_moving.is_some()));
    if joins {
        text += "The part of f that depends on the velocity joins the momentum equation.\n";
    }
    if !model.inputs.is_empty() {
        let names: Vec<&str> = model.inputs.iter().map(|leaf| leaf.name.as_str()).collect();
        let _ = writeln!(text, "Input: {}; `step` takes none for zero, `step_with` takes one.", names.join(", "));
    }
    if let Some(control) = &model.control {
        let bounds = match control.bounds.len() {
            0 => "without bounds".to_string(),
            1 => "within one bound".to_string(),
            count => format!("within {count} bounds"),
        };
        let _ = writeln!(
            text,
            "`control` chooses inputs of least price {bounds}: the step is differentiated twice, by the multipliers of its momentum equation."
        );
    }
    text
}

/// What is conserved, and what is not known to be.
pub(super) fn conserved(formulas: &MechanicsFormulas<'_>) -> String {
    let symmetries = &formulas.symmetries;
    let mut text = String::new();
    let summed = if formulas.model.power.is_some() { ", summed over all sites" } else { "" };
    match symmetries.conserved.as_slice() {
        [first, .., last] if symmetries.conserved.len() > MOST_LISTED => {
            let (count, from, to) = (symmetries.conserved.len(), &first.name, &last.name);
            let _ = writeln!(text, "Conserved: {count} momenta, from that {from}{summed} to that {to}{summed}.");
        }
        few => few.iter().for_each(|momentum| {
            let _ = writeln!(text, "Conserved: the momentum {}{summed}.", momentum.name);
        }),
    }
    if symmetries.conserved.is_empty() {
        let known = if symmetries.undecided { " that could be proved" } else { "" };
        let _ = writeln!(text, "Conserved: no momentum{known}, for general values of the parameters.");
    }
    for sentence in for_any_axis(&symmetries.special) {
        let _ = writeln!(text, "Conserved too: the momentum {sentence}.");
    }
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

/// What this problem does not need, and what was not proved.
pub(super) fn left_out(formulas: &MechanicsFormulas<'_>) -> String {
    let mut text = String::new();
    if formulas.potential_energy.is_zero() && formulas.links.is_empty() {
        text += "Left out: the kick, as there is no potential.\n";
    }
    if formulas.model.emit.momentum {
        text += "Left out, as asked for by `emit = [momentum]`: the configuration. A step solves for F and carries the momentum along.\n";
    } else if formulas.model.isotropy == Isotropy::Free && !formulas.is_free {
        text += "Left out, as asked for by `isotropy = free`: the check of 𝔤_q^⊥; motions that fix the configuration are motions too.\n";
    } else if formulas.is_free {
        text += "Left out: the check of 𝔤_q^⊥, as only the identity fixes a general configuration.\n";
    } else {
        text += "Some motions fix the configuration: state() demands momenta in 𝔤_q^⊥.\n";
    }
    let uncouples = |substep: &Substep<'_>| {
        let alone = substep.equations.iter().filter(|equation| !formulas.is_solved_after_others(equation));
        alone.count() > 1
    };
    if formulas.substeps.iter().all(uncouples) {
        text += "The momentum equation uncouples: one small solve for each part.\n";
    }
    text
}
