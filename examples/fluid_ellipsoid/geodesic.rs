//! The equations of the continuous drop, written for q and q̇: nothing here is derived by the macro.

use clebsch_examples::reference::{Solution, solve};
use nalgebra::{Matrix3, SVector};

/// q⁻¹, for det q = 1 and near it.
fn inverse(q: &Matrix3<f64>) -> Matrix3<f64> {
    q.try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN))
}

/// q̈ = λ q⁻ᵀ, the pressure that keeps the volume: λ = tr((q⁻¹q̇)²)/|q⁻¹|², from d²/dt² ln det q = 0.
pub fn acceleration(q: &Matrix3<f64>, velocity: &Matrix3<f64>) -> Matrix3<f64> {
    let inverse = inverse(q);
    let rate = inverse * velocity;
    inverse.transpose() * ((rate * rate).trace() / inverse.norm_squared())
}

/// The motion by extrapolation: (q, q̇) by columns.
pub fn motion(q: &Matrix3<f64>, velocity: &Matrix3<f64>, duration: f64, rate: f64) -> Solution<18> {
    let field = |y: &SVector<f64, 18>| {
        let (q, velocity) = halves(y);
        stack(&velocity, &acceleration(&q, &velocity))
    };
    solve(field, stack(q, velocity), duration, rate)
}

/// q and q̇.
pub fn halves(y: &SVector<f64, 18>) -> (Matrix3<f64>, Matrix3<f64>) {
    (Matrix3::from_column_slice(&y.as_slice()[..9]), Matrix3::from_column_slice(&y.as_slice()[9..]))
}

fn stack(q: &Matrix3<f64>, velocity: &Matrix3<f64>) -> SVector<f64, 18> {
    SVector::from_iterator(q.iter().chain(velocity.iter()).copied())
}

/// The momentum ⟨m q̇qᵀ, E⟩ in the basis E₁₁ − E₂₂, E₂₂ − E₃₃, E₁₂, E₁₃, E₂₁, E₂₃, E₃₁, E₃₂.
pub fn momentum(mass: f64, q: &Matrix3<f64>, velocity: &Matrix3<f64>) -> SVector<f64, 8> {
    let p = velocity * q.transpose() * mass;
    SVector::from([p.m11 - p.m22, p.m22 - p.m33, p.m12, p.m13, p.m21, p.m23, p.m31, p.m32])
}

/// ε m |q| |q̇|: the rounding error of the momentum in a step.
pub fn rounding(mass: f64, q: &Matrix3<f64>, velocity: &Matrix3<f64>) -> f64 {
    f64::EPSILON * mass * q.norm() * velocity.norm()
}

/// q̇ of a momentum: q̇qᵀ is the momentum plus the multiple of I with which tr(q⁻¹q̇) = 0.
pub fn velocity(mass: f64, q: &Matrix3<f64>, n: &SVector<f64, 8>) -> Matrix3<f64> {
    let inverse = inverse(q);
    // The diagonal up to a multiple of I.
    let (first, second) = (n[0] + n[1], n[1]);
    let deviator = Matrix3::new(first, n[2], n[3], n[4], second, n[5], n[6], n[7], 0.0) / mass;
    let shift = (inverse * deviator * inverse.transpose()).trace() / inverse.norm_squared();
    (deviator - Matrix3::identity() * shift) * inverse.transpose()
}

/// m (q̇qᵀ)_ij − m (q̇qᵀ)_ji, the angular momentum, and m (qᵀq̇)_ij − m (qᵀq̇)_ji, the circulation. (i, j) = (2, 1),
/// (3, 1), (3, 2): about e₃, −e₂ and e₁.
pub fn momenta(mass: f64, q: &Matrix3<f64>, velocity: &Matrix3<f64>) -> [f64; 6] {
    let skew = |p: Matrix3<f64>| [p.m21 - p.m12, p.m31 - p.m13, p.m32 - p.m23].map(|entry| mass * entry);
    let ([a, b, c], [d, e, f]) = (skew(velocity * q.transpose()), skew(q.transpose() * velocity));
    [a, b, c, d, e, f]
}
