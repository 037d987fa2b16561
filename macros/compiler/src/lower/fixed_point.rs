//! Which momentum equations are solved by x ← x − s·h·Σ⁻¹ρ(x), a step of Newton's method with the Jacobian at the identity.
//!
//! The iteration contracts like h|ω|: for h|ω| from 0.001 to 0.05 it takes five to eight residuals where Newton's method takes two
//! linearisations with their linear systems, whose code is long.

use super::{Code, Kernel};
use crate::derive::{MechanicsFormulas, MomentumEquation};
use crate::model::Solver;

/// A linearisation with its linear system has to cost as many residuals, or Newton's method is taken.
const RESIDUALS: usize = 3;

/// A function of a matrix counts for as many operations.
const MATRIX_FUNCTION: usize = 1000;

/// Whether ρ alone may be tried: Newton's method is not asked for, and the predictor is s·h·Σ⁻¹ in the unknowns themselves.
pub(super) fn serves(formulas: &MechanicsFormulas<'_>, equation: &MomentumEquation<'_>) -> bool {
    let is_asked = solver(formulas) != Some(Solver::Newton);
    is_asked && equation.is_inertial && !equation.moves && equation.coupled.is_empty()
}

/// Whether it is tried: asked for, or by the number of operations.
pub(super) fn is_chosen(
    formulas: &MechanicsFormulas<'_>,
    (residual, predict): (&Kernel, &Kernel),
    linearize: &Kernel,
    unknowns: usize,
) -> bool {
    let iteration = operations(residual) + operations(predict) + 4 * unknowns;
    let linearization = operations(linearize) + 2 * unknowns * unknowns * (unknowns + 3) / 3;
    solver(formulas) == Some(Solver::FixedPoint) || linearization >= RESIDUALS * iteration
}

fn solver(formulas: &MechanicsFormulas<'_>) -> Option<Solver> {
    formulas.model.dials.solver.as_ref().map(|solver| solver.value)
}

/// The operations of a kernel, with those of the functions of matrices that it calls.
fn operations(kernel: &Kernel) -> usize {
    let calls = kernel.locals.iter().filter(|code| matches!(code, Code::Call(..))).count();
    kernel.cost().total() + MATRIX_FUNCTION * calls
}
