//! The implicit equation by fixed-point iteration with the constant inverse of its Jacobian at the identity.

use super::{Equation, size, solve};
use crate::{Error, Scalar};
use nalgebra::SVector;

/// Iterations that are tried before Newton's method: each leaves at most a quarter of the correction.
const QUICK: usize = 32;

/// The solution ξ of ρ(ξ; `target`) = 0 that is connected to ξ = 0, by ξ ← ξ − Σ⁻¹ρ(ξ).
///
/// For equations with ρ(ξ; μ) = (Σ + O(μ)) ξ − μ + O(μ ξ²), whose [`predict`](Equation::predict) is Σ⁻¹μ. An iteration contracts like
/// h|ω|, and takes a residual in place of a Jacobian and a linear system. Where corrections do not shrink to a quarter each time,
/// [`solve`] takes over from the start.
///
/// Accuracy: what later corrections would add up to is below half a unit in the last place of ξ.
///
/// # Errors
/// Those of [`solve`].
#[inline]
pub fn solve_fixed_point<T: Scalar, const M: usize>(
    equation: &impl Equation<T, M>,
    target: &SVector<T, M>,
) -> Result<SVector<T, M>, Error> {
    match contract(equation, target) {
        Some(xi) => Ok(xi),
        None => solve_at_last(equation, target),
    }
}

#[cold]
#[inline(never)]
fn solve_at_last<T: Scalar, const M: usize>(
    equation: &impl Equation<T, M>,
    target: &SVector<T, M>,
) -> Result<SVector<T, M>, Error> {
    solve(equation, target)
}

/// The iteration: `None` as soon as it does not contract by a factor of four.
///
/// Corrections then add up to at most a third of the predictor, so that ξ stays where the Jacobian is near Σ and on the branch of ξ = 0.
/// After a correction Δ with the ratio r to the one before, those to come add up to r|Δ|/(1 − r) ≤ 4r|Δ|/3.
#[inline]
fn contract<T: Scalar, E: Equation<T, M>, const M: usize>(
    equation: &E,
    target: &SVector<T, M>,
) -> Option<SVector<T, M>> {
    let terms = equation.prepare(target);
    let mut xi = equation.predict(target);
    let mut before = size(&xi);
    let [quarter, negligible] = [T::from_ratio(1, 4), T::EPSILON * T::from_ratio(1, 4)];
    for _ in 0..QUICK {
        let correction = equation.predict(&equation.residual(&terms, &xi));
        xi -= correction;
        let (now, scale) = (size(&correction), size(&xi));
        // all comparisons are written so that NaN leads to `None`
        if now <= T::EPSILON * scale {
            return Some(xi);
        }
        let ratio = now / before;
        let contracts = ratio <= quarter;
        if !contracts {
            return None;
        }
        if now * ratio <= negligible * scale {
            return Some(xi);
        }
        before = now;
    }
    None
}
