//! The quadrotor of the scene `quadrotor`, with a price of its distance from a track and with an obstacle to stay clear of.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Matrix4, Vector1, Vector3, Vector4, Vector6};

/// A quadrotor that follows a track past an obstacle that moves. A plan is given both step by step.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SE<3>, q: SE<3>| q * F,
    cost      = |h, F| ((F - I) * self.mass_matrix * (F - I).transpose()).trace() / (2 * h),
    potential = |q| self.mass * self.gravity * q.translation().z,
    force     = |u: Vector4| (
        vector![self.arm * (u.z + u.w - u.x - u.y), self.arm * (u.y + u.z - u.x - u.w), self.drag * (u.y + u.w - u.x - u.z)],
        vector![0, 0, u.x + u.y + u.z + u.w],
    ),
    effort    = |h, q, u, track: Vector3, attitude: Matrix3, thrust: Vector1| {
        let off = (q.translation() - track).norm_squared() / self.length.powi(2);
        let turned = (q.rotation() - attitude).norm_squared() / (2 * self.turn.powi(2));
        h * (off + turned + (u - thrust.x * vector![1, 1, 1, 1]).norm_squared() / self.hover.powi(2)) / 2
    },
    endpoint  = |q, (w, v), place: Vector3, velocity: Vector3| {
        let off = (q.translation() - place).norm_squared() / self.length.powi(2);
        let drift = (q.rotation() * v - velocity).norm_squared() / self.speed.powi(2);
        self.end_time * (off + drift + w.norm_squared() / self.spin.powi(2)) / 2
    },
    bounds    = |q, u, obstacle: Vector3, apart: Vector1| [
        0 <= u.x, u.x <= self.top,
        0 <= u.y, u.y <= self.top,
        0 <= u.z, u.z <= self.top,
        0 <= u.w, u.w <= self.top,
        apart.x.powi(2) <= (q.translation() - obstacle).norm_squared(),
    ],
)]
pub struct Follower {
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
    /// The distance from the track that is as dear as a rotor at rest, m.
    pub length: f64,
    /// The same of a turn from the attitude of the track, rad.
    pub turn: f64,
    /// The same of a velocity at the end, m/s.
    pub speed: f64,
    /// The same of an angular velocity at the end, rad/s.
    pub spin: f64,
    /// The weight of the end, s.
    pub end_time: f64,
}

/// Pose, and momenta (angular, linear) in the body frame.
pub type Place = (Matrix4<f64>, Vector6<f64>);
/// Thrusts of the rotors, N.
pub type Thrusts = Vector4<f64>;
/// Place, attitude and thrust of a rotor on the track, place of the obstacle, and least distance from it; m, N.
pub type Reference = (Vector3<f64>, Matrix3<f64>, Vector1<f64>, Vector3<f64>, Vector1<f64>);
/// The quadrotor with its step size.
pub type Steering = clebsch::Control<Follower, 12, 4, 9>;
/// One step of a plan.
pub type Stage = clebsch::Stage<Follower, 12, 4, 9>;
