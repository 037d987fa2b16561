//! A spherical pendulum: a bob on a rod.

use crate::refusal::{Refusal, finite, positive};
use crate::run::{Run, Scene, Shown};
use clebsch::Clebsch;
use nalgebra::Vector3;

/// A spherical pendulum: its momentum is the angular momentum m l² q × q̇.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.mass * self.length.powi(2) * (F - I).norm_squared() / (4 * h),
    potential = |q| self.mass * self.gravity * self.length * q.z,
)]
pub struct SphericalPendulum {
    /// Mass of the bob, kg.
    pub mass: f64,
    /// Length of the rod, m.
    pub length: f64,
    /// g, m/s².
    pub gravity: f64,
}

/// Mass of the bob, kg.
const MASS: f64 = 1.0;

/// Acceleration of free fall, m/s².
const GRAVITY: f64 = 9.81;

/// Begins at an angle from the lowest point, in radians, with a push to the side, in m/s.
///
/// # Errors
/// A number is not finite, or length or step size are not positive.
pub fn start(amplitude: f64, push: f64, length: f64, step_size: f64) -> Result<Box<dyn Shown>, Refusal> {
    finite(&[amplitude, push])?;
    positive(&[length, step_size])?;
    let bob = Vector3::new(amplitude.sin(), 0.0, -amplitude.cos());
    let momentum = bob.cross(&Vector3::y()) * (MASS * length * push);
    let pendulum = SphericalPendulum { mass: MASS, length, gravity: GRAVITY };
    Ok(Box::new(Run::new(pendulum.into_stepper(step_size)?, bob, momentum)?))
}

impl Scene for SphericalPendulum {
    /// The momentum about the vertical.
    fn conserved(_: &Vector3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(0.0, 0.0, momentum.z)
    }

    fn drawn(bob: &Vector3<f64>) -> impl Iterator<Item = f64> {
        bob.data.0.into_iter().flatten()
    }
}
