//! How momentum equations are solved, in words.

use clebsch_symbolic::{Chart, Elements};

use super::Iteration;
use crate::derive::{MechanicsFormulas, MomentumEquation, RotatingBody, Solution, Structure};

/// The factors of an equation, with the components that are meant where it holds not all of them.
pub(super) fn part<'g>(formulas: &MechanicsFormulas<'g>, equation: &MomentumEquation<'g>) -> String {
    let whole: usize = equation.factors.iter().map(|&k| formulas.model.factors[k].group.dimension()).sum();
    let names: Vec<&str> = equation.factors.each(|&k| formulas.model.factors[k].name.as_str());
    let names = names.join(", ");
    if equation.residual.shape().rows == whole {
        return names;
    }
    format!("{names} in the coordinates {}", formulas.coordinates_of(&equation.components))
}

/// How an equation is solved, and in which chart.
pub(super) fn how(formulas: &MechanicsFormulas<'_>, equation: &MomentumEquation<'_>, iteration: &Iteration) -> String {
    let (own_chart, cleared) = (formulas.symbols.charts[equation.factors[0]], equation.form.cleared);
    let chart = match own_chart {
        Chart::Cayley if cleared => {
            "the Cayley chart, denominators cleared by the congruence with I − x^ (I + x^ for a left action)"
        }
        Chart::Cayley => "the Cayley chart",
        Chart::Affine => "the chart F = I + x^ (coordinates of the second kind), in which it is a polynomial",
        Chart::Product if cleared => {
            "the chart of Cayley's map for the rotation and of the translation as it is, denominators cleared by the congruence with I − x^"
        }
        Chart::Product => "the chart of Cayley's map for the rotation and of the translation as it is",
        Chart::Sine => "the chart of the sine",
        Chart::Root => "the chart F = (I + x^) det(I + x^)^(−1/n), as the Cayley map leaves the group",
        Chart::Exponential if cleared => "the exponential chart, freed of dexp⁻¹ by dexp",
        Chart::Exponential => "the exponential chart",
        Chart::Identity => "the coordinates of the translation",
    };
    match equation.solution {
        Solution::Explicit if equation.formula.is_some() && formulas.is_solved_after_others(equation) => {
            format!("is linear in {chart}, given the other coordinates: they are put in, no iteration")
        }
        Solution::Explicit if equation.formula.is_some() && !equation.is_affine(&formulas.symbols) => {
            format!("is triangular in {chart}: solved by substitution, no iteration")
        }
        Solution::Explicit if equation.formula.is_none() && own_chart == Chart::Exponential => {
            "is solved by the velocity itself, x = h Σ⁻¹μ, which commutes with the momentum: no iteration".to_string()
        }
        Solution::Explicit => format!("is linear in {chart}: solved explicitly, no iteration"),
        Solution::ClosedForm if formulas.constraint.is_some() => {
            "is solved in closed form, no iteration: y and ψ are affine in the sine of the turn, so a linear system gives λ, and the step turns one plane by θ, sin θ < 1".to_string()
        }
        Solution::ClosedForm => {
            let coordinates = if own_chart == Chart::Sine { ", which is the length of x" } else { "" };
            format!(
                "is solved in closed form: the kinetic energy is bi-invariant, so the step turns one plane by θ, sin θ = h|μ|/Σ < 1{coordinates}"
            )
        }
        Solution::Rotation(RotatingBody::FourSpace) => {
            "has one scalar unknown: B = F J, J = D/h with ΣΩ = DΩ + ΩD, obeys B² = M B + J², so e₁ = tr B gives the characteristic polynomial of B, and that gives F by one linear system of four equations; e₁ is found by Newton's method, and Hurwitz's criterion tells that it is the right root; short steps iterate an equation for x of low degree instead, which contracts like h|ω|".to_string()
        }
        Solution::Rotation(RotatingBody::Space { is_cayley: true, .. }) => {
            "has one scalar unknown: (1 + |x|²) A x = μ ± μ × x with A = 2Σ/h, x the Gibbs vector of the step, is linear in x once s = 1 + |x|² is known; s is the root of one function that increases, by Newton's method; where it need not increase, Newton's method for x follows the path from the identity".to_string()
        }
        Solution::Rotation(_) => {
            "has one scalar unknown: A x = μ + (μ·x) x ± μ × x with A = 2Σ/h, x the Gibbs vector of the step, is linear in x once κ = μ·x is known; κ is the least root of a polynomial of degree four, by a series for short steps and by Newton's method".to_string()
        }
        Solution::Linear => format!("is linear in {chart}: solved by one elimination, no iteration"),
        Solution::FreeRotation if formulas.turns_whole() => {
            "is solved by the free motion itself: F̃J̃ − J̃F̃ᵀ = m = h̃μ with J̃² = D² + β, F = exp(δm + κ⋆m) F̃; the constants of a motion are found once, from its Taylor series, and travel along with the state; then NF̃ = G with N and G polynomials of m, one division a step, no iteration, and no error in h".to_string()
        }
        Solution::FreeRotation => {
            "is solved by the free motion itself: d x − m × x = m for the Gibbs vector x, m = h μ/2, with d = diag(d_i) in principal axes; the d_i are power series in h² |μ|² and h² μ·Σ⁻¹μ, made once for the body; no iteration, and no error in h".to_string()
        }
        Solution::Newton if iteration.tries_fixed_point => format!(
            "is solved by the fixed-point iteration x ← x − s h Σ⁻¹ρ(x) in {chart}, s = dx/dξ, which contracts like h|ω|; by Newton's method \
             where it leaves more than a quarter of a correction{}",
            structure(&iteration.structure)
        ),
        Solution::Newton => format!("is solved by Newton's method in {chart}{}", structure(&iteration.structure)),
    }
}

/// The structure that its linear systems use.
fn structure(structure: &Structure) -> String {
    match structure {
        Structure::Dense => String::new(),
        Structure::Symmetric => "; its Jacobian is symmetric, LDLᵀ where it is definite".to_string(),
        Structure::Triangular(blocks) => {
            let sizes: Vec<String> = blocks.each(|block| block.len().to_string());
            format!("; its Jacobian is block triangular, with blocks of {} unknowns", sizes.join(", "))
        }
        Structure::Sylvester(n) => {
            format!("; its linear systems are Sylvester's equations, by the Schur form of {n}×{n} matrices")
        }
    }
}
