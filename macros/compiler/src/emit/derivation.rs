//! The constant `DERIVATION`: the derivation in words and formulas, what it costs, and what was left out and why.

use std::fmt::Write;

use crate::derive::Solution;
use crate::lower::Program;
use crate::model::{Model, Order, Side};

/// The text of `DERIVATION`.
pub fn derivation(program: &Program<'_>) -> String {
    let mut text = String::new();
    // by construction: writing to a string does not fail
    let _ = write!(
        text,
        "{}\n\n{}\n{}\n{}\nFormulas\n\n{}\nCost\n\n{}",
        program.formulas.model.item.ident,
        frames(&program.formulas.model),
        scheme(program),
        left_out(program),
        program.formulas,
        costs(program),
    );
    text
}

/// Which frame momenta are in, factor by factor.
fn frames(model: &Model<'_>) -> String {
    let mut text = String::new();
    for factor in &model.factors {
        let (side, frame) = match factor.side {
            Side::Left => ("left", "spatial"),
            Side::Right => ("right", "body"),
        };
        let _ = writeln!(
            text,
            "{} in {} acts from the {side}: momenta and velocities are {frame}, in the basis of {}.",
            factor.name,
            factor.group.name(),
            factor.group.name(),
        );
    }
    text + "⟨A, E⟩ stands for the components tr(AᵀE_i); x^ for Σ x_i E_i; h for the step.\n"
}

/// How a step goes and how accurate it is.
fn scheme(program: &Program<'_>) -> String {
    let model = &program.formulas.model;
    let order = match (model.order, program.formulas.parts()) {
        (Order::First, _) => "First order as asked for: drift, then kick, −h·V at the end of the step.",
        (Order::Second, 1) if program.formulas.potential_energy.is_zero() => {
            "The discrete Lagrangian is time-symmetric, K(h, F) = −K(−h, F⁻¹), so the step is of second order."
        }
        (Order::Second, 1) => {
            "The discrete Lagrangian is time-symmetric, K(h, F) = −K(−h, F⁻¹), with −h/2·V at each end: half kick, drift, half kick, second order, one gradient a step."
        }
        (Order::Second, _) => {
            "The discrete Lagrangian is not time-symmetric, ℓd(q, F; h) ≠ −ℓd(Φ_F q, F⁻¹; −h): half a step is composed with half a step of its adjoint, which is of second order and costs two solves."
        }
    };
    let mut text = format!("{order}\n");
    let mut told: Vec<String> = Vec::new();
    for (substep, kernels) in program.formulas.substeps.iter().zip(&program.steps).take(program.formulas.parts()) {
        for equation in &substep.equations {
            let names: Vec<&str> = equation.factors.iter().map(|&k| model.factors[k].name.as_str()).collect();
            let how = match equation.solution {
                Solution::Explicit => "is linear in the chart: solved explicitly".to_string(),
                Solution::ClosedForm => {
                    "is solved in closed form: the kinetic energy is bi-invariant, so the step turns one plane by θ, sin θ = h|μ|/Σ < 1".to_string()
                }
                Solution::Newton if equation.cleared.iter().all(|cleared| *cleared) => {
                    "is solved by Newton's method in the Cayley chart, denominators cleared by the congruence with I − x^ (I + x^ for a left action)".to_string()
                }
                Solution::Newton => "is solved by Newton's method in the chart".to_string(),
            };
            told.push(format!("The momentum equation for {} {how}.\n", names.join(", ")));
        }
        if kernels.update.is_none() {
            told.push("Both trivialisations of ∂K agree, so the momentum does not change in the drift.\n".to_string());
        }
    }
    // both halves of a composed step tell the same
    let first = told.iter().enumerate().filter(|(position, line)| !told[..*position].contains(line));
    text.extend(first.map(|(_, line)| line.as_str()));
    text
}

/// What this problem does not need, and what was not proved.
fn left_out(program: &Program<'_>) -> String {
    let formulas = &program.formulas;
    let mut text = String::new();
    if formulas.potential_energy.is_zero() {
        text += "Left out: the kick, as there is no potential.\n";
    }
    if formulas.is_free {
        text += "Left out: the check of 𝔤_q^⊥, as only the identity fixes a general configuration.\n";
    } else {
        text += "Some motions fix the configuration: state() demands momenta in 𝔤_q^⊥.\n";
    }
    if formulas.substeps.iter().all(|substep| substep.equations.len() == formulas.model.factors.len())
        && formulas.model.factors.len() > 1
    {
        text += "The factors do not couple in the momentum equation: one small solve for each.\n";
    }
    text
}

/// The operations of each kernel.
fn costs(program: &Program<'_>) -> String {
    let kernels = program.kernels();
    let width = kernels.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    kernels.iter().map(|(name, kernel)| format!("{name:width$}  {}\n", kernel.cost())).collect()
}
