//! Random bodies from a seed, the same on every machine.

use clebsch_examples::noise::Noise;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// A sequence of random bodies.
pub struct Random {
    noise: Noise,
}

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self { noise: Noise::new(seed) }
    }

    /// Between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.noise.uniform()
    }

    /// Of length one, any direction as likely as another.
    pub fn direction(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.noise.normal()).normalize()
    }

    /// Any attitude as likely as another.
    pub fn attitude(&mut self) -> Matrix3<f64> {
        let [w, x, y, z] = [0; 4].map(|_| self.noise.normal());
        UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_rotation_matrix().into_inner()
    }
}
