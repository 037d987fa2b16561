//! The tractor and its trailer, as the macro is given them.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector2, Vector6};

/// A tractor with a trailer on a hitch. The wheels of both do not slip sideways, and the hitch joins two points.
///
/// The origin of each body is between its wheels, with x ahead. Its velocity is (ω, v_x, v_y) in its frame.
/// The inputs are the thrust along the tractor, N, and a torque on it, N m.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<2>; 2], q: [SE<2>; 2]| [q[0] * F[0], q[1] * F[1]],
    lagrangian = |xi| (0..2).map(|i| {
        let across = xi[i].z + self.offset[i] * xi[i].x;
        (self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + across.powi(2))) / 2
    }).sum(),
    constraint = [
        |q| [q[0].rotation() * self.hitch[0] + q[0].translation() == q[1].rotation() * self.hitch[1] + q[1].translation()],
        |xi| [(0..2).map(|i| xi[i].z == 0)],
    ],
    force      = |u: Vector2| [vector![u.y, u.x, 0], vector![0, 0, 0]],
    effort     = |h, u| h * (u.x.powi(2) + (u.y / self.arm).powi(2)) / 2,
    bounds     = |q, u| [
        -self.top_thrust <= u.x, u.x <= self.top_thrust,
        -self.top_torque <= u.y, u.y <= self.top_torque,
        self.least_cosine <= (q[0].rotation() * Vector2::x()).dot(&(q[1].rotation() * Vector2::x())),
    ],
)]
pub struct TractorTrailer {
    /// Masses of tractor and trailer, kg.
    pub mass: [f64; 2],
    /// Moments of inertia about the centres of mass, kg·m².
    pub inertia: [f64; 2],
    /// The centres of mass ahead of the wheels, m.
    pub offset: [f64; 2],
    /// The hitch in the frame of each body, m.
    pub hitch: [Vector2<f64>; 2],
    /// Torque over this arm costs as much as thrust, m.
    pub arm: f64,
    /// The largest thrust, N.
    pub top_thrust: f64,
    /// The largest torque, N m.
    pub top_torque: f64,
    /// The cosine of the largest angle between both bodies.
    pub least_cosine: f64,
}

/// Poses of tractor and trailer.
pub type Poses = [Matrix3<f64>; 2];
/// Poses, and momenta in the body frames.
pub type Place = (Poses, Vector6<f64>);
/// The rig with its step size.
pub type Steering = clebsch::Control<TractorTrailer, 12, 2, 5>;
/// One step of a plan.
pub type Stage = clebsch::Stage<TractorTrailer, 12, 2, 5>;
