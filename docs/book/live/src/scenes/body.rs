//! A free rigid body: a book that is thrown with a spin about one of its axes.

use crate::refusal::{Refusal, positive};
use crate::run::{Run, Scene, Shown};
use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};

/// A body that nothing acts on.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = moser_veselov,
)]
pub struct RigidBody {
    /// Inertia tensor about the centre of mass, body frame, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
}

/// Angular velocity at the start, body frame, rad/s: about the second axis, with a small error of the throw about the first.
const VELOCITY: Vector3<f64> = Vector3::new(0.02, 2.0, 0.0);

/// Begins with these moments of inertia, in kg·m².
///
/// # Errors
/// A number is not finite or not positive, or no body has these moments.
pub fn start(moments: [f64; 3], step_size: f64) -> Result<Box<dyn Shown>, Refusal> {
    positive(&moments)?;
    positive(&[step_size])?;
    let moments = Vector3::from(moments);
    if moments.max() > moments.sum() - moments.max() {
        return Err(Refusal::NoBody);
    }
    let body = RigidBody { inertia: Matrix3::from_diagonal(&moments) };
    let momentum = moments.component_mul(&VELOCITY);
    Ok(Box::new(Run::new(body.into_stepper(step_size)?, Matrix3::identity(), momentum)?))
}

impl Scene for RigidBody {
    /// The momentum in space.
    fn conserved(attitude: &Matrix3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
        attitude * momentum
    }

    fn drawn(attitude: &Matrix3<f64>) -> impl Iterator<Item = f64> {
        let [first, second, third] = attitude.transpose().data.0;
        first.into_iter().chain(second).chain(third)
    }
}
