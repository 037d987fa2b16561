//! The body with torques, as the macro is given it.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};

/// A body that is turned by torques about its axes, each of them bounded; the price is ½ |u|² a second.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, torque| h * torque.norm_squared() / 2,
    bounds     = |torque| [
        -self.top <= torque.x, torque.x <= self.top,
        -self.top <= torque.y, torque.y <= self.top,
        -self.top <= torque.z, torque.z <= self.top,
    ],
)]
pub struct SteeredBody {
    /// Inertia tensor about the centre of mass, body frame, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    /// The largest torque about each axis, N·m.
    pub top: f64,
}

/// Attitude, and momentum in the body frame.
pub type Place = (Matrix3<f64>, Vector3<f64>);
/// The body with its step size.
pub type Steering = clebsch::Control<SteeredBody, 6, 3, 6>;
/// One step of a plan.
pub type Stage = clebsch::Stage<SteeredBody, 6, 3, 6>;
