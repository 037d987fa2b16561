//! Small turns of the body in the orbiting frame.

use crate::body::Orientation;
use crate::equations::Equations;
use crate::orbit::{Circle, frame};
use crate::{Momentum, Pose, halves};
use nalgebra::{Complex, ComplexField, Matrix3, Vector3};

/// Yaw, roll and pitch, and their rates.
#[derive(Clone, Copy, Debug)]
pub struct Tilt {
    /// The rotation vector from the orbiting frame to the principal axes, radians.
    pub angles: Vector3<f64>,
    /// The angular velocity in the orbiting frame, rad/s.
    pub rates: Vector3<f64>,
}

impl Tilt {
    /// Of a state.
    pub fn new(
        equations: &Equations,
        orientation: &Orientation,
        circle: &Circle,
        pose: &Pose,
        momentum: &Momentum,
    ) -> Self {
        let (linear, angular) = halves(momentum);
        let frame = frame(&pose.0, &linear);
        let turned = frame.transpose() * pose.1 * orientation.axes;
        let spin = frame.transpose() * pose.1 * equations.angular_velocity(&angular);
        Self { angles: rotation_vector(&turned), rates: spin - Vector3::z() * circle.rate }
    }
}

/// The rotation vector, to round-off for small angles too, where the trace says nothing.
fn rotation_vector(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let skew = rotation - rotation.transpose();
    let sine = Vector3::new(skew.m32, skew.m13, skew.m21) / 2.0;
    let angle = sine.norm().atan2((rotation.trace() - 1.0) / 2.0);
    if angle > 0.0 && sine.norm() > 0.0 { sine * (angle / sine.norm()) } else { sine }
}

/// The linear equations of an orientation, with time in units of 1/n:
/// ```text
/// pitch   θ̈ = −3k θ                                k   = (roll − yaw)/pitch
/// roll    ρ̈ = −4k₁ρ − (1 − k₁) ψ̇                   k₁ = (pitch − yaw)/roll
/// yaw     ψ̈ = −k₃ψ + (1 − k₃) ρ̇                    k₃ = (pitch − roll)/yaw
/// ```
/// Source: Hughes, §9.2; DeBra and Delp (1961).
#[derive(Clone, Copy, Debug)]
pub struct Linear {
    /// k
    pub pitch: f64,
    /// k₁
    pub roll: f64,
    /// k₃
    pub yaw: f64,
}

/// The fastest growing motion.
#[derive(Clone, Copy, Debug)]
pub struct Mode {
    /// Its root s, in units of n.
    pub root: Complex<f64>,
    /// Whether it is one of the pitch.
    pub is_pitch: bool,
}

impl Linear {
    /// Of an orientation.
    pub fn new(orientation: &Orientation) -> Self {
        let [yaw, roll, pitch] = orientation.moments.into();
        Self { pitch: (roll - yaw) / pitch, roll: (pitch - yaw) / roll, yaw: (pitch - roll) / yaw }
    }

    /// Pitch: s² = −3k. Roll and yaw: s⁴ + (1 + 3k₁ + k₁k₃) s² + 4k₁k₃ = 0.
    pub fn fastest(&self) -> Mode {
        let pitch = Complex::new(-3.0 * self.pitch, 0.0).sqrt();
        let (b, c) = (1.0 + 3.0 * self.roll + self.roll * self.yaw, 4.0 * self.roll * self.yaw);
        let split = Complex::new(b * b - 4.0 * c, 0.0).sqrt();
        // The larger of the two squares without cancellation, the other by their product.
        let larger = if b >= 0.0 { (-split - b) / 2.0 } else { (split - b) / 2.0 };
        let smaller = Complex::new(c, 0.0) / larger;
        let candidates = [(pitch, true), (larger.sqrt(), false), (smaller.sqrt(), false)];
        let [mut fastest, ..] = candidates;
        for candidate in candidates {
            let root = if candidate.0.re < 0.0 { -candidate.0 } else { candidate.0 };
            if root.re.is_finite() && root.re > fastest.0.re {
                fastest = (root, candidate.1);
            }
        }
        Mode { root: fastest.0, is_pitch: fastest.1 }
    }

    /// The part of a tilt that grows like the mode: its row eigenvector times the tilt. `mean_motion` is n.
    pub fn growing_part(&self, mode: &Mode, tilt: &Tilt, mean_motion: f64) -> f64 {
        let (angles, rates) = (tilt.angles, tilt.rates / mean_motion);
        let s = mode.root;
        if mode.is_pitch {
            return (s * angles.z + rates.z).modulus();
        }
        // (a, b, 1, d) for (ρ, ψ, ρ̇, ψ̇): times the matrix of the system it is s times itself.
        let d = (s * s + 4.0 * self.roll) / (s * (1.0 - self.yaw));
        let (a, b) = (-Complex::new(4.0 * self.roll, 0.0) / s, -d * self.yaw / s);
        (a * angles.y + b * angles.x + rates.y + d * rates.x).modulus()
    }
}
