//! The three gaits, and the motion of the board by the equation of its momentum: no constraint and no multiplier is in it.
//!
//! The wheels allow the velocities (ω, v) = s (sin φ, l cos φ), whatever the rotor does. The momentum p belongs to this direction.
//! ```text
//! p = s (m l² cos²φ + I sin²φ) + J ψ′ sin φ,    p′ = φ′ (s (I − m l²) sin φ cos φ + J ψ′ cos φ)
//! ```
//! The first equation gives s, which is the local form of the connection and the part of p.

use crate::Snakeboard;
use nalgebra::SVector;

/// How many swings of the rotor and of the wheels are in a cycle.
#[derive(Clone, Copy, Debug)]
pub struct Gait {
    /// Its name.
    pub name: &'static str,
    /// Of the rotor, of the wheels.
    pub swings: [f64; 2],
}

/// One swing each drives forwards, two against one turn on the spot, three against two park sideways.
pub const GAITS: [Gait; 3] = [
    Gait { name: "drive", swings: [1.0, 1.0] },
    Gait { name: "rotate", swings: [2.0, 1.0] },
    Gait { name: "park", swings: [3.0, 2.0] },
];

/// Place x, y, heading, momentum p and time.
pub type Reduced = SVector<f64, 5>;

impl Snakeboard {
    /// How fast rotor and wheels turn, rad/s.
    pub fn rates_at(&self, time: f64) -> [f64; 2] {
        [0, 1].map(|i| self.swings[i] * self.rates[i] * (self.rates[i] * time).cos())
    }

    /// The change of all that is not shape.
    pub fn reduced(&self, y: &Reduced) -> Reduced {
        let [_, _, heading, momentum, time] = *y.as_ref();
        let [rotor, turning] = self.rates_at(time);
        let (sin, cos) = (self.swings.y * (self.rates.y * time).sin()).sin_cos();
        let along = self.mass * self.length.powi(2);
        let s = (momentum - self.rotor * rotor * sin) / (along * cos * cos + self.inertia * sin * sin);
        let push = turning * (s * (self.inertia - along) * sin * cos + self.rotor * rotor * cos);
        let v = s * self.length * cos;
        Reduced::from([v * heading.cos(), v * heading.sin(), s * sin, push, 1.0])
    }
}
