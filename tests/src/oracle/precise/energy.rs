//! The continuous system whose discretisation a problem is.

use super::dual::{Dual, along, constant};
use super::matrix::Matrix;
use super::problem::{Problem, elements};
use super::real::Real;

/// ℓ(t, q, ξ) = lim ℓd(t, h, q, exp hξ)/h as h → 0, with ξ in components.
///
/// It is extrapolated from eight steps, with an error of about 1e-26 in numbers of 32 digits and 1e-11 in `f64`.
pub fn continuous_lagrangian<P: Problem, R: Real>(problem: &P, t: R, q: &[Matrix<R>], xi: &[R]) -> R {
    let factors = problem.factors();
    let quotient = |&h: &f64| {
        let motion: Vec<_> = xi.iter().map(|&x| x * h).collect();
        problem.lagrangian(t, R::of(h), q, &elements(&factors, &motion)) * (1.0 / h)
    };
    let speed = xi.iter().map(|x| x.to_f64().abs()).fold(1.0, f64::max);
    let steps: Vec<f64> = (8..16).map(|k| f64::exp2(-f64::from(k) - speed.log2().ceil())).collect();
    let mut values: Vec<R> = steps.iter().map(quotient).collect();
    // Neville's scheme for the polynomial through all values, at h = 0
    for order in 1..steps.len() {
        for i in 0..steps.len() - order {
            let weight = R::of(steps[i + order]) / R::of(steps[i] - steps[i + order]);
            values[i] = values[i + 1] + (values[i + 1] - values[i]) * weight;
        }
    }
    values[0]
}

/// Pivots of ∂²ℓ/∂ξ² below this multiple of the largest entry are errors of the extrapolation.
const SINGULAR: f64 = 1e-7;

/// ⟨N, ξ⟩ − ℓ(t, q, ξ) where ∂ℓ/∂ξ = N: the energy at a momentum, if Newton's method finds its velocity.
pub fn energy<P: Problem, R: Real>(problem: &P, t: R, q: &[Matrix<R>], n: &[R]) -> Option<R> {
    let mut xi = vec![R::zero(); n.len()];
    for _ in 0..30 {
        let defect: Vec<_> = n.iter().zip(momentum(problem, t, q, &xi)).map(|(&n, m)| n - m).collect();
        let correction = inertia(problem, t, q, &xi).lift().solve_in_range(&Matrix::vector(&defect), SINGULAR);
        xi = xi.iter().zip(correction.entries()).map(|(&x, &d)| x + d).collect();
        if correction.size() < R::LAST_CORRECTION * Matrix::vector(&xi).size().max(1.0) {
            let pairing = Matrix::vector(n).dot(&Matrix::vector(&xi));
            return Some(pairing - continuous_lagrangian(problem, t, q, &xi));
        }
    }
    None
}

/// ∂ℓ/∂ξ.
fn momentum<P: Problem, R: Real>(problem: &P, t: R, q: &[Matrix<R>], xi: &[R]) -> Vec<R> {
    let (t, q) = (Dual::constant(t), constant(q));
    (0..xi.len()).map(|i| continuous_lagrangian(problem, t, &q, &along(xi, i)).slope).collect()
}

/// ∂²ℓ/∂ξ², rounded to `f64`.
fn inertia<P: Problem, R: Real>(problem: &P, t: R, q: &[Matrix<R>], xi: &[R]) -> Matrix<f64> {
    let q: Vec<_> = q.iter().map(|matrix| matrix.map(R::to_f64)).collect();
    let xi: Vec<_> = xi.iter().map(|x| x.to_f64()).collect();
    let (t, q) = (Dual::of(t.to_f64()), constant(&q));
    let columns: Vec<_> = (0..xi.len()).map(|j| momentum(problem, t, &q, &along(&xi, j))).collect();
    Matrix::from_fn(xi.len(), xi.len(), |i, j| columns[j][i].slope)
}
