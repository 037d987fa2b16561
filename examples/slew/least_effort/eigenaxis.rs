//! Turns about the fixed axis from rest to rest, for comparison.
//!
//! With the angle θ(t) about the axis e the torque is u = J e θ̈ + θ̇² e × J e. Its two parts are at right angles:
//! |u|² = |J e|² θ̈² + |e × J e|² θ̇⁴. ∫ θ̈² dt ≥ 12 θ₁²/T³, with equality for θ = θ₁ (3s² − 2s³), s = t/T. So no such
//! turn, bounded or not, costs less than 6 |J e|² θ₁²/T³.

use super::problem::Problem;
use nalgebra::Vector3;

/// Points of the quadrature of Simpson, which is exact for the polynomial but for its last power.
const PARTS: u32 = 2000;

/// The smoothest turn about the fixed axis.
#[derive(Clone, Copy, Debug)]
pub struct Eigenaxis {
    /// The least price of every turn about this axis, N²·m²·s.
    pub least: f64,
    /// The price of the turn with least ∫ θ̈², N²·m²·s.
    pub smooth: f64,
    /// The largest torque about an axis of the body that it needs, N·m.
    pub largest_torque: f64,
}

impl Eigenaxis {
    /// For a problem.
    pub fn new(problem: &Problem) -> Self {
        let (angle, duration) = (problem.turn.norm(), problem.duration);
        let axis = problem.turn / angle;
        let along = problem.body.inertia * axis;
        let across = axis.cross(&along);
        let torque = |s: f64| -> Vector3<f64> {
            let (rate, acceleration) = (6.0 * s * (1.0 - s) * angle, 6.0 * (1.0 - 2.0 * s) * angle);
            (along * acceleration + across * rate.powi(2)) / duration.powi(2)
        };
        let torques: Vec<_> = (0..=PARTS).map(|k| torque(f64::from(k) / f64::from(PARTS))).collect();
        let simpson = |w: &[Vector3<f64>]| w[0].norm_squared() + 4.0 * w[1].norm_squared() + w[2].norm_squared();
        let sum: f64 = torques.windows(3).step_by(2).map(simpson).sum();
        Self {
            least: 6.0 * along.norm_squared() * angle.powi(2) / duration.powi(3),
            smooth: sum / 3.0 * duration / f64::from(PARTS) / 2.0,
            largest_torque: torques.iter().map(|torque| torque.amax()).fold(0.0, f64::max),
        }
    }
}
