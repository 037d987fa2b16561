//! Which momentum equations are solved by x ← x − s·h·Σ⁻¹ρ(x), a step of Newton's method with the Jacobian at the identity.
//!
//! The iteration contracts like h|ω|: for h|ω| from 0.001 to 0.05 it takes five to eight residuals where Newton's method takes two
//! linearisations with their linear systems, whose code is long.

use super::made::separate;
use super::{Code, Hoisted, Hoisting, Kernel, Scalars, matrices};
use crate::derive::{MechanicsFormulas, MomentumEquation, Solution};
use crate::model::Solver;

/// A linearisation with its linear system has to cost as many residuals, or Newton's method is taken.
const RESIDUALS: usize = 3;

/// A function of a matrix counts for as many operations.
const MATRIX_FUNCTION: usize = 1000;

/// What Newton's method needs.
pub(super) struct Newton<'a> {
    pub(super) linearize: &'a Kernel,
    pub(super) predict: Option<&'a Kernel>,
}

/// The kernel of ρ(x) alone, where an equation is solved with it: asked for, or by the number of operations.
pub(super) fn residual<'g>(
    formulas: &MechanicsFormulas<'g>,
    equation: &MomentumEquation<'g>,
    newton: &Newton<'_>,
    scalars: &mut Scalars,
    (hoisted, terms): (&mut Hoisted, &mut Hoisted),
) -> Option<Kernel> {
    // the predictor is s·h·Σ⁻¹ in the unknowns themselves
    let serves = equation.is_inertial && !equation.moves && equation.coupled.is_empty();
    let (predict, solver) =
        (newton.predict.filter(|_| serves)?, formulas.model.dials.solver.as_ref().map(|solver| solver.value));
    if solver == Some(Solver::Newton) {
        return None;
    }
    let (mut constants, mut more) = (hoisted.clone(), terms.clone());
    let residual =
        separate(scalars, &[formulas.residual_by_halves(equation)], Hoisting::Terms(&mut constants, &mut more));
    let m = equation.components.len();
    let iteration = operations(&residual) + operations(predict) + 4 * m;
    let linearization = operations(newton.linearize) + 2 * m * m * (m + 3) / 3;
    let is_chosen = solver == Some(Solver::FixedPoint) || linearization >= RESIDUALS * iteration;
    is_chosen.then(|| {
        (*hoisted, *terms) = (constants, more);
        residual
    })
}

/// The same where whole matrices are kept: its own terms, as nothing is taken out.
pub(super) fn residual_of_matrices<'g>(
    formulas: &MechanicsFormulas<'g>,
    equation: &MomentumEquation<'g>,
    predict: Option<&Kernel>,
) -> Option<Kernel> {
    let serves = equation.is_inertial && !equation.moves && equation.coupled.is_empty() && predict.is_some();
    // a linear system costs more than many residuals
    let is_asked = formulas.model.dials.solver.as_ref().map(|solver| solver.value) != Some(Solver::Newton);
    (serves && is_asked && equation.solution == Solution::Newton).then(|| matrices::kernel(&[equation.residual]))
}

/// The operations of a kernel, with those of the functions of matrices that it calls.
fn operations(kernel: &Kernel) -> usize {
    let calls = kernel.locals.iter().filter(|code| matches!(code, Code::Call(..))).count();
    kernel.cost().total() + MATRIX_FUNCTION * calls
}
