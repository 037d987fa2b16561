//! Rigid bodies on SO(3), right action, by the Cayley vector c = tan(θ/2)·axis and the ordinary inertia tensor.

use nalgebra::{Matrix3, Vector3};

use super::rotation::{hat, solve};

/// ½tr(J)I − J.
pub fn mass_matrix(inertia: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * (inertia.trace() / 2.0) - inertia
}

/// tr(𝒥)I − 𝒥, the inertia tensor of ½tr(J)I − J.
pub fn inertia(mass_matrix: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * mass_matrix.trace() - mass_matrix
}

/// F with h π^ = F𝒥 − 𝒥Fᵀ: Newton's method on Jc + c × Jc = h/2 (1 + |c|²) π from c = h/2 J⁻¹π.
pub fn drift(inertia: &Matrix3<f64>, h: f64, pi: &Vector3<f64>) -> Matrix3<f64> {
    let mut c = solve(inertia, pi) * (h / 2.0);
    for _ in 0..30 {
        let jc = inertia * c;
        let residual = jc + c.cross(&jc) - pi * (h / 2.0 * (1.0 + c.norm_squared()));
        let jacobian = inertia + hat(&c) * inertia - hat(&jc) - pi * c.transpose() * h;
        let correction = solve(&jacobian, &residual);
        c -= correction;
        if correction.norm() < 1e-17 + 1e-16 * c.norm() {
            break;
        }
    }
    let z = hat(&c);
    Matrix3::identity() + (z + z * z) * (2.0 / (1.0 + c.norm_squared()))
}

/// A heavy top: the torque mgl Γ × χ with Γ = Rᵀe_z, per unit time, in the body frame.
pub fn gravity_torque(weight: f64, center: &Vector3<f64>, r: &Matrix3<f64>) -> Vector3<f64> {
    (r.transpose() * Vector3::z()).cross(center) * weight
}

/// Half kick, drift, half kick for (R, π) with a torque that depends on R.
pub fn strang(
    inertia: &Matrix3<f64>,
    torque: impl Fn(&Matrix3<f64>) -> Vector3<f64>,
    h: f64,
    (r, pi): (Matrix3<f64>, Vector3<f64>),
) -> (Matrix3<f64>, Vector3<f64>) {
    let kicked = pi + torque(&r) * (h / 2.0);
    let f = drift(inertia, h, &kicked);
    let r = r * f;
    (r, f.transpose() * kicked + torque(&r) * (h / 2.0))
}

/// The seeds' step on (R, M): drift, then kick.
pub fn drift_kick(
    inertia: &Matrix3<f64>,
    torque: impl Fn(&Matrix3<f64>) -> Vector3<f64>,
    h: f64,
    (r, pi): (Matrix3<f64>, Vector3<f64>),
) -> (Matrix3<f64>, Vector3<f64>) {
    let f = drift(inertia, h, &pi);
    let r = r * f;
    (r, f.transpose() * pi + torque(&r) * h)
}
