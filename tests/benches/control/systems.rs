//! The systems: a car, a body with bounded torques, and a quadrotor.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Matrix4};

/// A car that turns and drives forwards.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    controls       = |u: Vector2| vector![u.x, u.y, 0],
    cost           = |h, u| h * u.norm_squared() / 2,
    bounds         = |u| [-self.top <= u.x, u.x <= self.top, 0 <= u.y],
    discretization = exponential,
)]
pub struct Car {
    pub top: f64,
}

/// A body that bounded torques turn.
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
pub struct Body {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    pub top: f64,
}

#[path = "../../../examples/quadrotor/declaration.rs"]
#[allow(dead_code, reason = "the scene uses all of it")]
mod declaration;
pub use declaration::{Place, Quadrotor};

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
