//! The closed form: uniform motion on a great circle.

use nalgebra::SVector;

/// q_k = cos(kθ) q_0 + sin(kθ) e, e the unit vector of the velocity.
#[derive(Clone, Copy, Debug)]
pub struct GreatCircle<const D: usize> {
    start: SVector<f64, D>,
    /// e; zero for a point at rest.
    direction: SVector<f64, D>,
    /// θ, the angle of a step, rad.
    pub angle: f64,
}

impl<const D: usize> GreatCircle<D> {
    /// From a point with a velocity; `angle` tells θ from the speed |w|, w the part of the velocity tangent to the sphere.
    pub fn new(start: SVector<f64, D>, velocity: SVector<f64, D>, angle: impl Fn(f64) -> f64) -> Self {
        let tangent = velocity - start * start.dot(&velocity);
        let speed = tangent.norm();
        let direction = if speed > 0.0 { tangent / speed } else { tangent };
        Self { start, direction, angle: angle(speed) }
    }

    /// q_k. The product kθ is rounded once, so that this is off by ε k θ at most, the size of one rounding a step.
    pub fn point(&self, step: u64) -> SVector<f64, D> {
        let (sin, cos) = (step as f64 * self.angle).sin_cos();
        self.start * cos + self.direction * sin
    }

    /// The part of `q` outside of the plane of the circle.
    pub fn outside(&self, q: &SVector<f64, D>) -> f64 {
        (q - self.start * self.start.dot(q) - self.direction * self.direction.dot(q)).norm()
    }
}
