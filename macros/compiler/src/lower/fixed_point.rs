//! Which momentum equations are solved by x ← x − s·h·Σ⁻¹ρ(x), a step of Newton's method with the Jacobian at the identity.
//!
//! The iteration contracts like h|ω|: for h|ω| from 0.001 to 0.05 it takes five to eight residuals where Newton's method takes two
//! linearisations with their linear systems, whose code is long.

use super::kernel::kernel;
use super::{Hoisted, Hoisting, Kernel, Scalar, Scalars};
use crate::derive::{Equation, Formulas};
use crate::model::Solver;
use clebsch_symbolic::Shape;

/// A linearisation with its linear system has to cost as many residuals, or Newton's method is taken.
const RESIDUALS: usize = 3;

/// What Newton's method needs.
pub(super) struct Newton<'a> {
    pub(super) linearize: &'a Kernel,
    pub(super) predict: Option<&'a Kernel>,
    /// ρ(x).
    pub(super) residual: &'a (Shape, Vec<Scalar>),
}

/// The kernel of ρ(x) alone, where an equation is solved with it: asked for, or by the number of operations.
pub(super) fn residual(
    formulas: &Formulas<'_>,
    equation: &Equation<'_>,
    newton: &Newton<'_>,
    scalars: &mut Scalars,
    (hoisted, terms): (&mut Hoisted, &mut Hoisted),
) -> Option<Kernel> {
    // the predictor is s·h·Σ⁻¹ in the unknowns themselves
    let serves = equation.is_inertial && !equation.moves && equation.coupled.is_empty();
    let (predict, solver) = (newton.predict.filter(|_| serves)?, formulas.model.solver);
    if solver == Some(Solver::Newton) {
        return None;
    }
    let (mut constants, mut more) = (hoisted.clone(), terms.clone());
    let outputs = std::slice::from_ref(newton.residual);
    let residual = kernel(scalars, outputs, Hoisting::Terms(&mut constants, &mut more));
    let m = equation.components.len();
    let iteration = residual.cost().total() + predict.cost().total() + 4 * m;
    let linearization = newton.linearize.cost().total() + 2 * m * m * (m + 3) / 3;
    let is_chosen = solver == Some(Solver::FixedPoint) || linearization >= RESIDUALS * iteration;
    is_chosen.then(|| {
        (*hoisted, *terms) = (constants, more);
        residual
    })
}
