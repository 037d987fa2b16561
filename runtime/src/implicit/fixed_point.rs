//! The implicit equation by fixed-point iteration with the constant inverse of its Jacobian at the identity.

use super::{Equation, allowed, select, size, solve_after, with_derivatives};
use crate::space::larger;
use crate::{Error, Mask, Scalar};
use nalgebra::SVector;

/// Iterations that are tried before Newton's method: each leaves at most a quarter of the correction.
const QUICK: u32 = 32;

/// The solution ξ of ρ(ξ; `target`) = 0 that is connected to ξ = 0, by ξ ← ξ − Σ⁻¹ρ(ξ).
///
/// For equations with ρ(ξ; μ) = (Σ + O(μ)) ξ − μ + O(μ ξ²), whose [`predict`](Equation::predict) is Σ⁻¹μ. An iteration contracts like h|ω|, and
/// takes a residual and no linear system. Where corrections do not shrink to a quarter each time, [`solve`](super::solve) takes over.
///
/// Accuracy: later corrections would add up to less than twice [`Equation::tolerance`] of ξ, by default half a unit in its last place.
///
/// # Errors
/// Those of [`solve`](super::solve).
#[inline]
pub fn solve_fixed_point<T: Scalar, E: Equation<T, M>, const M: usize>(
    equation: &E,
    target: &SVector<T, M>,
) -> Result<SVector<T, M>, Error> {
    let (xi, solved, made) = contract(equation, target, allowed(QUICK, E::limit(), 0));
    if !solved.all() {
        return solve_at_last(equation, target, &xi, solved, made);
    }
    Ok(if T::DERIVATIVES == 0 { xi } else { with_derivatives(equation, target, xi) })
}

/// The lanes that do not contract in `made` iterations, by [`solve`](super::solve).
#[cold]
#[inline(never)]
pub(crate) fn solve_at_last<T: Scalar, const M: usize>(
    equation: &impl Equation<T, M>,
    target: &SVector<T, M>,
    xi: &SVector<T, M>,
    solved: T::Mask,
    made: u32,
) -> Result<SVector<T, M>, Error> {
    match solve_after(equation, target, made) {
        Ok(others) => Ok(select(solved, xi, &others)),
        Err(_) if solved.any() => Ok(select(solved, xi, &SVector::from_element(T::from_f64(f64::NAN)))),
        Err(error) => Err(error),
    }
}

/// The iteration: ξ, the lanes in which it is the solution, and how many residuals were taken. Lanes that do not
/// contract by four are given up. Corrections then add up to at most a third of the predictor. So ξ stays where the
/// Jacobian is near Σ, and on the branch of ξ = 0. After a correction Δ with the ratio r to the one before, those to
/// come add up to r|Δ|/(1 − r) ≤ 4r|Δ|/3.
#[inline]
fn contract<T: Scalar, E: Equation<T, M>, const M: usize>(
    equation: &E,
    target: &SVector<T, M>,
    most: u32,
) -> (SVector<T, M>, T::Mask, u32) {
    let (mut open, mut solved, mut made) = (T::Mask::everywhere(), T::Mask::nowhere(), 0);
    let terms = equation.prepare(target);
    let mut xi = equation.predict(target);
    let mut before = size(&xi);
    let [quarter, negligible] = [T::from_ratio(1, 4), E::tolerance()];
    let visible = larger(T::EPSILON, negligible);
    while made < most {
        T::iterated();
        made += 1;
        let correction = equation.predict(&equation.residual(&terms, &xi));
        xi = select(open, &(xi - correction), &xi);
        let (now, scale) = (size(&correction), size(&xi));
        let ratio = now / before;
        // all comparisons are written so that NaN leads to no solution
        let seen = now.at_most(visible * scale);
        let contracts = ratio.at_most(quarter);
        let arrived = open & (seen | contracts & (now * ratio).at_most(negligible * scale));
        (solved, open) = (solved | arrived, open & contracts & !arrived);
        if !open.any() {
            break;
        }
        before = now;
    }
    (xi, solved, made)
}
