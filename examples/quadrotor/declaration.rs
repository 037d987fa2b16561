//! The quadrotor as the macro is given it.
//!
//! On SE(3) the unrolled cost of Moser and Veselov limits the derivatives of a step to 2600 operations. The Lagrangian
//! by Cayley's map of SE(3) would need more than the 20000 that are unrolled.

use clebsch::Clebsch;
use nalgebra::{Matrix4, Vector4, Vector6};

/// A rigid body with four rotors that push along its third axis, none of them downwards, in uniform gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SE<3>, q: SE<3>| q * F,
    cost      = |h, F| ((F - I) * self.mass_matrix * (F - I).transpose()).trace() / (2 * h),
    potential = |q| self.mass * self.gravity * q.translation().z,
    force     = |u: Vector4| (
        vector![self.arm * (u.z + u.w - u.x - u.y), self.arm * (u.y + u.z - u.x - u.w), self.drag * (u.y + u.w - u.x - u.z)],
        vector![0, 0, u.x + u.y + u.z + u.w],
    ),
    effort    = |h, u| h * (u - self.hover * vector![1, 1, 1, 1]).norm_squared() / (2 * self.hover * self.hover),
    bounds    = |u| [
        0 <= u.x, u.x <= self.top,
        0 <= u.y, u.y <= self.top,
        0 <= u.z, u.z <= self.top,
        0 <= u.w, u.w <= self.top,
    ],
)]
pub struct Quadrotor {
    /// ½ tr(J) I − J and the mass, about the centre of mass, kg·m², kg.
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix4<f64>,
    /// kg
    pub mass: f64,
    /// m/s²
    pub gravity: f64,
    /// Rotors from the axes of the body, m.
    pub arm: f64,
    /// Torque about the third axis for a thrust, m.
    pub drag: f64,
    /// Thrust of a rotor at hover, N.
    pub hover: f64,
    /// The largest thrust of a rotor, N.
    pub top: f64,
}

/// Pose, and momenta (angular, linear) in the body frame.
pub type Place = (Matrix4<f64>, Vector6<f64>);
/// Thrusts of the rotors, N.
pub type Thrusts = Vector4<f64>;
/// The quadrotor with its step size.
pub type Steering = clebsch::Control<Quadrotor, 12, 4, 8>;
/// One step of a plan.
pub type Stage = clebsch::Stage<Quadrotor, 12, 4, 8>;
