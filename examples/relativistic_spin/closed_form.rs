//! The motion in closed form, and the equation that it solves.

use crate::field::{Field, metric};
use nalgebra::{Matrix4, SVector, Vector4};

/// A frame with a charge at rest in it, in a constant field.
///
/// The frame turns with κ (𝓕′ + a 𝓑′), 𝓕′ the field that it sees and 𝓑′ the magnetic part of that. For a = 0 it is
/// carried by one exponential, and sees the same field for ever. The other factor is a rotation about the magnetic
/// field that is seen at the start:
/// ```text
/// Λ(τ) = exp(κτ 𝓕) Λ(0) exp(κaτ 𝓑′(0))
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ClosedForm {
    /// e/m, rad/(ns T).
    pub charge_to_mass: f64,
    /// a = (g − 2)/2.
    pub anomaly: f64,
    /// In the laboratory.
    pub field: Field,
    /// Λ(0).
    pub start: Matrix4<f64>,
}

impl ClosedForm {
    /// Λ at the proper time τ, ns.
    pub fn frame(&self, time: f64) -> Matrix4<f64> {
        let angle = self.charge_to_mass * time;
        let turning = self.field.seen_from(&self.start).turning();
        let after = exponential(&(turning.tensor() * (angle * self.anomaly)));
        exponential(&(self.field.tensor() * angle)) * self.start * after
    }

    /// The fastest rate of vectors that the frame carries, rad/ns.
    pub fn rate(&self) -> f64 {
        let seen = self.field.seen_from(&self.start).turning();
        self.charge_to_mass * (self.field.tensor().norm() + (self.anomaly * seen.magnetic.norm()).abs())
    }

    /// The equation of Bargmann, Michel and Telegdi for a velocity u and a spin s, one after the other.
    /// ```text
    /// du/dτ = κ 𝓕u,   ds/dτ = κ ((1 + a) 𝓕s + a (s·𝓕u) u)
    /// ```
    /// Source: *Precession of the polarization of particles moving in a homogeneous electromagnetic field* (1959).
    pub fn equation(&self) -> impl Fn(&SVector<f64, 8>) -> SVector<f64, 8> {
        let (tensor, a) = (self.field.tensor() * self.charge_to_mass, self.anomaly);
        move |unknowns| {
            let (u, s): (Vector4<f64>, Vector4<f64>) =
                (unknowns.fixed_rows::<4>(0).into(), unknowns.fixed_rows::<4>(4).into());
            let force = tensor * u;
            together(&force, &(tensor * s * (1.0 + a) + u * (a * s.dot(&(metric() * force)))))
        }
    }
}

/// exp A: the series at A/2ᵏ, whose norm is at most a half, squared k times. Relative to its size the error is ε times that of A.
fn exponential(a: &Matrix4<f64>) -> Matrix4<f64> {
    let halvings = (2.0 * a.norm()).log2().ceil().clamp(0.0, 64.0) as i32;
    let small = a * 2.0_f64.powi(-halvings);
    // Horner; 2⁻¹⁸/18! is far below ε
    let series = (1..=18).rev().fold(Matrix4::identity(), |sum, k| Matrix4::identity() + small * sum / f64::from(k));
    (0..halvings).fold(series, |power, _| power * power)
}

/// Two four-vectors in one.
pub fn together(u: &Vector4<f64>, s: &Vector4<f64>) -> SVector<f64, 8> {
    SVector::from_iterator(u.iter().chain(s.iter()).copied())
}
