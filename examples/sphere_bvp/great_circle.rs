//! The closed form: uniform motion on a great circle, and the polygon with N equal steps inscribed in it.

use nalgebra::SVector;
use std::f64::consts::{PI, TAU};

/// q(s) = cos(sΘ) q_0 + sin(sΘ) e for s from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct GreatCircle<const D: usize> {
    start: SVector<f64, D>,
    /// e, a unit vector at a right angle to the start.
    pub direction: SVector<f64, D>,
    /// Θ, the angle of the arc, rad.
    pub angle: f64,
}

impl<const D: usize> GreatCircle<D> {
    /// The shortest arc between two unit vectors that are neither equal nor opposite.
    pub fn between(start: SVector<f64, D>, target: SVector<f64, D>) -> Self {
        let cosine = start.dot(&target);
        let across = target - start * cosine;
        Self { start, direction: across.normalize(), angle: across.norm().atan2(cosine) }
    }

    /// Half a turn from a point to the opposite one in a direction at a right angle to it.
    pub fn half(start: SVector<f64, D>, direction: SVector<f64, D>) -> Self {
        Self { start, direction, angle: PI }
    }

    /// The arc with the same ends the other way round.
    pub fn other_way(&self) -> Self {
        Self { direction: -self.direction, angle: TAU - self.angle, ..*self }
    }

    /// The arc with the same ends and one more turn.
    pub fn one_more_turn(&self) -> Self {
        Self { angle: self.angle + TAU, ..*self }
    }

    /// The arc of the same length that sets out towards a point.
    pub fn towards(&self, point: &SVector<f64, D>) -> Self {
        Self { direction: Self::between(self.start, *point).direction, ..*self }
    }

    /// q(s).
    pub fn point(&self, s: f64) -> SVector<f64, D> {
        let (sin, cos) = (s * self.angle).sin_cos();
        self.start * cos + self.direction * sin
    }

    /// q(1); the point opposite to the start to the last bit.
    pub fn end(&self) -> SVector<f64, D> {
        if self.angle == PI { -self.start } else { self.point(1.0) }
    }

    /// The unit vector along the arc at q(s).
    pub fn tangent(&self, s: f64) -> SVector<f64, D> {
        let (sin, cos) = (s * self.angle).sin_cos();
        self.direction * cos - self.start * sin
    }

    /// The action of the polygon with N steps of h, J·s for unit mass: a step costs |Δq|²/(2h) = (1 − cos φ)/h with φ = Θ/N.
    ///
    /// The cost ‖F − I‖²/(4h) of the rotations that make a step is least for the one in the plane of both points.
    pub fn action(&self, steps: usize, h: f64) -> f64 {
        let half = self.angle / (2.0 * steps as f64);
        2.0 * steps as f64 * half.sin().powi(2) / h
    }

    /// The speed that the momentum of the polygon stands for, 1/s: sin φ/h.
    pub fn speed(&self, steps: usize, h: f64) -> f64 {
        (self.angle / steps as f64).sin() / h
    }

    /// The Morse index: D − 2 directions across the arc, each with a conjugate point at every half turn; `None` where the end is one.
    ///
    /// The same for the polygon with φ < π/2. Its Jacobi fields sin(kφ) vanish where those of the arc do. The Hessian
    /// across the arc has the eigenvalues 2(cos φ − cos(jπ/N))/h, j = 1 … N − 1.
    pub fn index(&self) -> Option<usize> {
        (self.angle % PI != 0.0).then_some((D - 2) * (self.angle / PI) as usize)
    }
}
