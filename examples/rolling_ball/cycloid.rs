//! The closed form: a circle about a centre that drifts along the table, never down it.
//!
//! The contact pushes along the table. Newton's law for the ball, and the derivative of rolling, leave one equation for the velocity.
//! ```text
//! v′ = κ e₃ × v + g,    κ = Ω I / (I + m r²),    g = m r² / (I + m r²) times the pull of gravity along the table
//! ```
//! With the drift d = e₃ × g / κ this is (v − d)′ = κ e₃ × (v − d).

use nalgebra::{Rotation2, Vector2};

/// The path of a ball on a table.
#[derive(Clone, Copy, Debug)]
pub struct Cycloid {
    /// κ, rad/s.
    pub rate: f64,
    /// Of the centre, m/s.
    pub drift: Vector2<f64>,
    /// Metres.
    pub radius: f64,
    centre: Vector2<f64>,
    from_centre: Vector2<f64>,
}

impl Cycloid {
    /// From a place and a velocity at the start. `roundness` is I/(m r²), 2/5 of a solid ball; `slope` is g sin(tilt).
    pub fn new(table_rate: f64, slope: f64, roundness: f64, place: Vector2<f64>, velocity: Vector2<f64>) -> Self {
        let rate = table_rate * roundness / (1.0 + roundness);
        let gravity = Vector2::new(0.0, -slope / (1.0 + roundness));
        let drift = left_of(gravity) / rate;
        // v − d = κ e₃ × (x − c)
        let from_centre = -left_of(velocity - drift) / rate;
        Self { rate, drift, radius: from_centre.norm(), centre: place - from_centre, from_centre }
    }

    /// Where the centre is after some time.
    pub fn centre(&self, time: f64) -> Vector2<f64> {
        self.centre + self.drift * time
    }

    /// Where the ball is after some time.
    pub fn place(&self, time: f64) -> Vector2<f64> {
        self.centre(time) + Rotation2::new(self.rate * time) * self.from_centre
    }

    /// The angle of one step about the centre.
    ///
    /// On an edge with the velocity u the step says u − v = ½h (κ e₃ × u + g), and the same for v⁺ − u. So v − d turns by
    /// (1 + ia)/(1 − ia) with a = ½hκ, and places turn about the same centre.
    pub fn angle_of_step(&self, h: f64) -> f64 {
        2.0 * (h * self.rate / 2.0).atan()
    }
}

/// e₃ × v
fn left_of(v: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}
