//! The periods of a free rigid body by elliptic integrals: a check that shares nothing with the integration.

use crate::periods::Periods;
use clebsch_examples::elliptic::complete;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The motion of a free rigid body with moments A ≤ B ≤ C, L² = |π|² and E2 = π·J⁻¹π, twice the energy.
///
/// In a long-axis mode, L² < B E2, the body momentum circulates about A, and ω_A is a multiple of dn. Otherwise it
/// circulates about C, and ω_A is a multiple of cn. Source: Landau and Lifshitz, *Mechanics*, §37.
#[derive(Clone, Copy, Debug)]
pub struct Tumbling {
    a: f64,
    b: f64,
    c: f64,
    /// L²
    square: f64,
    /// E2
    double_energy: f64,
}

impl Tumbling {
    /// For principal moments and a body momentum.
    pub fn new(moments: &Vector3<f64>, momentum: &Vector3<f64>) -> Self {
        let mut sorted = [moments.x, moments.y, moments.z];
        sorted.sort_by(f64::total_cmp);
        let [a, b, c] = sorted;
        let double_energy = momentum.dot(&momentum.component_div(moments));
        Self { a, b, c, square: momentum.norm_squared(), double_energy }
    }

    /// Whether the body rotates about its long axis, that of the smallest moment.
    pub fn is_about_long_axis(&self) -> bool {
        self.square < self.double_energy * self.b
    }

    /// L² − A E2 ≥ 0.
    fn above(&self) -> f64 {
        (self.square - self.double_energy * self.a).max(0.0)
    }

    /// C E2 − L² ≥ 0.
    fn below(&self) -> f64 {
        (self.double_energy * self.c - self.square).max(0.0)
    }

    /// The parameter m of the elliptic functions, from 0 for a steady rotation to 1 on the separatrix.
    pub fn parameter(&self) -> f64 {
        let (long, short) = ((self.b - self.a) * self.below(), (self.c - self.b) * self.above());
        if self.is_about_long_axis() { short / long } else { long / short }
    }

    /// The period with which the body momentum circulates, 4K(m) over the rate of the elliptic functions. With it, the
    /// mean period with which the long axis turns about the spatial momentum.
    ///
    /// That axis turns at the rate L (E2 − Aω_A²)/(L² − A²ω_A²). The mean is L/A + L (E2 − L²/A)/D · Π(n, m)/K(m), with
    /// D the least value of L² − A²ω_A². `None` at rest, in steady rotation about the long axis, on the separatrix and
    /// for a sphere.
    pub fn periods(&self) -> Option<Periods<f64>> {
        let Self { a, b, c, square, double_energy } = *self;
        let m = self.parameter();
        let (factor, modulus) =
            if self.is_about_long_axis() { ((b - a) * self.below(), m) } else { ((c - b) * self.above(), 1.0) };
        let rate = (factor / (a * b * c)).sqrt();
        let least = c * self.above() / (c - a);
        let n = -a * self.below() / (c - a) * modulus / least;
        let integrals = complete(n, m)?;

        let l = square.sqrt();
        let precession_rate = l / a + l * (double_energy - square / a) / least * integrals.third_over_first;
        let (rotation, precession) = (4.0 * integrals.first / rate, TAU / precession_rate);
        (rotation.is_finite() && precession.is_finite()).then_some(Periods { rotation, precession })
    }
}

/// The moments of the body whose exact motion, attitude included, the Moser–Veselov steps of length h follow up to
/// O(h⁴). 1/I_j becomes σ/I_j + δ, with σ = 1 + h²(e₁E2 − e₂L²/2)/6 and δ = h²(e₃L² − e₂E2/2)/6. The e_i are the
/// elementary symmetric functions of the 1/I_j.
///
/// Source: Hairer and Vilmart, *Preprocessed discrete Moser–Veselov algorithm for the full dynamics of a rigid body* (2006).
pub fn as_stepped(moments: &Vector3<f64>, momentum: &Vector3<f64>, h: f64) -> Vector3<f64> {
    let x = moments.map(f64::recip);
    let (e1, e2, e3) = (x.sum(), x.x * x.y + x.y * x.z + x.z * x.x, x.product());
    let (square, double_energy) = (momentum.norm_squared(), momentum.dot(&momentum.component_mul(&x)));
    let sigma = 1.0 + h * h / 6.0 * (e1 * double_energy - e2 * square / 2.0);
    let delta = h * h / 6.0 * (e3 * square - e2 * double_energy / 2.0);
    x.map(|x| (sigma * x + delta).recip())
}
