//! A heavy top on a fixed point, with methods of order 2, 4 and 6.

use crate::refusal::{Refusal, finite, positive};
use crate::run::{Run, Scene, Shown};
use clebsch::{Clebsch, Declared, Method};
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Steps of order 4.
pub struct Fourth;

/// Steps of order 6.
pub struct Sixth;

/// A rigid body turning about a fixed pivot in uniform gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    method Fourth = (order = 4),
    method Sixth  = (order = 6),
)]
pub struct HeavyTop {
    /// ½tr(J)I − J = ∫ρρᵀdm about the pivot, kg·m².
    pub mass_matrix: Matrix3<f64>,
    /// Weight times the distance from the pivot to the centre of mass, N·m.
    pub weight: f64,
    /// The direction of the centre of mass, body frame.
    pub center: Vector3<f64>,
}

/// Moments of inertia about the pivot, kg·m².
const INERTIA: Vector3<f64> = Vector3::new(1.0, 1.0, 0.5);

/// Weight times the distance from the pivot to the centre of mass, N·m.
const WEIGHT: f64 = 1.0;

/// Begins at a tilt from the vertical, in radians, with a spin about the body axis, in rad/s.
///
/// # Errors
/// A number is not finite, the step size is not positive, or no method has this order.
pub fn start(spin: f64, tilt: f64, step_size: f64, order: u32) -> Result<Box<dyn Shown>, Refusal> {
    match order {
        2 => start_by::<Declared>(spin, tilt, step_size),
        4 => start_by::<Fourth>(spin, tilt, step_size),
        6 => start_by::<Sixth>(spin, tilt, step_size),
        _ => Err(Refusal::NoOrder),
    }
}

fn start_by<M: Method<HeavyTop> + 'static>(spin: f64, tilt: f64, step_size: f64) -> Result<Box<dyn Shown>, Refusal> {
    finite(&[spin, tilt])?;
    positive(&[step_size])?;
    let mass_matrix = Matrix3::from_diagonal(&INERTIA.map(|moment| INERTIA.sum() / 2.0 - moment));
    let top = HeavyTop { mass_matrix, weight: WEIGHT, center: Vector3::z() };
    let attitude = Rotation3::from_axis_angle(&Vector3::x_axis(), tilt).into_inner();
    let momentum = INERTIA.component_mul(&(Vector3::z() * spin));
    Ok(Box::new(Run::new(top.into_stepper_by::<M>(step_size)?, attitude, momentum)?))
}

impl Scene for HeavyTop {
    /// The momentum about the vertical, and the momentum about the body axis.
    fn conserved(attitude: &Matrix3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new((attitude * momentum).z, momentum.z, 0.0)
    }

    fn drawn(attitude: &Matrix3<f64>) -> impl Iterator<Item = f64> {
        let [first, second, third] = attitude.transpose().data.0;
        first.into_iter().chain(second).chain(third)
    }
}
