//! The bodies of the scenes `slew` and `quadrotor`, the parameters of the latter, and a body that keeps its tilt.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Matrix4};

#[path = "../../../examples/quadrotor/declaration.rs"]
#[allow(dead_code, reason = "the scene uses all of it")]
mod quadrotors;
#[path = "../../../examples/slew/least_effort/declaration.rs"]
#[allow(dead_code, reason = "the scene uses all of it")]
mod slews;

pub use quadrotors::{Place, Quadrotor};
pub use slews::SteeredBody;

/// The Crazyflie of the scene `quadrotor`.
pub fn quadrotor() -> Quadrotor {
    let [xx, yy, zz, xy, xz, yz] = [16.571710e-6, 16.655602e-6, 29.261652e-6, 0.830806e-6, 0.718277e-6, 1.800197e-6];
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let mass = 0.028;
    let gravity = 9.81;
    let mut mass_matrix = Matrix4::zeros();
    let second = Matrix3::identity() * (inertia.trace() / 2.0) - inertia;
    mass_matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&second);
    mass_matrix[(3, 3)] = mass;
    let (arm, drag, hover, top) = (0.046 / 2.0_f64.sqrt(), 0.005_964_552, mass * gravity / 4.0, 0.1597);
    Quadrotor { mass_matrix, mass, gravity, arm, drag, hover, top }
}

/// A body that is to keep its tilt.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, torque| h * torque.norm_squared() / 2,
    bounds     = |R| [R[(2, 2)] == self.tilt],
)]
pub struct TiltedBody {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    /// The cosine of the angle between its third axis and the vertical.
    pub tilt: f64,
}
