//! Random systems: declarations of the fixtures with parameters of order one.

use crate::arbitrary::{definite, vector};
use clebsch::{Clebsch, Scalar};
use clebsch_tests::fixtures::damped_body::DampedBody;
use clebsch_tests::fixtures::first_order_top::FirstOrderTop;
use clebsch_tests::fixtures::generic_body::GenericBody;
use clebsch_tests::fixtures::gravity_gradient::GravityGradient;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::underwater_vehicle::UnderwaterVehicle;
use clebsch_tests::fixtures::watched_top::WatchedTop;
use nalgebra::{Matrix3, Vector2, Vector3};
use proptest::prelude::*;

/// The step size of all of them.
pub const H: f64 = 0.05;

/// A particle on a spring whose end moves; where it ends, and when, has a price.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<2>, x: Vector2| x + a,
    cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
    potential = |t, x| self.stiffness * (x - t * self.drift).norm_squared() / 2,
    endpoint  = |t, x| self.price * t + self.pull * (x - self.goal).norm_squared() / 2,
    emit      = [tangent, boundary],
)]
pub struct PulledParticle {
    /// Mass, kg.
    pub mass: f64,
    /// Stiffness of the spring, N/m.
    pub stiffness: f64,
    /// Velocity of its end, m/s.
    pub drift: Vector2<f64>,
    /// Price of the time, W.
    pub price: f64,
    /// Price of missing the goal, N/m.
    pub pull: f64,
    /// The goal, m.
    pub goal: Vector2<f64>,
}

/// Particles that swing by less than half a period in a time of three.
pub fn particles() -> BoxedStrategy<PulledParticle> {
    let numbers = (1.0_f64..2.0, 0.1_f64..0.8, vector(0.5), 0.1_f64..1.0, 0.1_f64..2.0, vector(2.0));
    let particle =
        |(mass, stiffness, drift, price, pull, goal)| PulledParticle { mass, stiffness, drift, price, pull, goal };
    numbers.prop_map(particle).boxed()
}

/// Tops, their masses near one.
pub fn tops() -> BoxedStrategy<WatchedTop> {
    (vector::<3>(0.5), 0.1_f64..3.0)
        .prop_map(|(mass, weight)| WatchedTop { mass: mass.add_scalar(1.0), weight })
        .boxed()
}

/// The inertia tr(M) I − M of a top.
pub fn inertia_of(top: &WatchedTop) -> Matrix3<f64> {
    Matrix3::from_diagonal(&(-top.mass).add_scalar(top.mass.sum()))
}

/// Pendulums of various masses and lengths.
pub fn pendulums() -> BoxedStrategy<SphericalPendulum> {
    let numbers = (0.5_f64..2.0, 0.5_f64..2.0, 0.1_f64..3.0);
    numbers.prop_map(|(mass, length, gravity)| SphericalPendulum { mass, length, gravity }).boxed()
}

/// Vehicles with inertia of their own in every direction.
pub fn vehicles() -> BoxedStrategy<UnderwaterVehicle> {
    let numbers = (definite::<6>(), 0.1_f64..3.0, vector(1.0));
    numbers.prop_map(|(inertia, weight, center)| UnderwaterVehicle { inertia, weight, center }).boxed()
}

/// Satellites on circular orbits.
pub fn satellites() -> BoxedStrategy<GravityGradient> {
    (definite::<3>(), 0.1_f64..1.0)
        .prop_map(|(inertia, orbital_rate)| GravityGradient { inertia, orbital_rate })
        .boxed()
}

/// Tops in steps of order 1.
pub fn staggered_tops() -> BoxedStrategy<FirstOrderTop> {
    let numbers = (definite::<3>(), 0.1_f64..3.0, vector(1.0));
    numbers.prop_map(|(mass_matrix, weight, center)| FirstOrderTop { mass_matrix, weight, center }).boxed()
}

/// Bodies with torques that damp and others that are put in.
pub fn damped_bodies() -> BoxedStrategy<DampedBody> {
    (definite::<3>(), 0.0_f64..1.0).prop_map(|(inertia, damping)| DampedBody { inertia, damping }).boxed()
}

/// A top over any scalar, the same in all lanes.
pub fn generic_top<T: Scalar>(mass: &Matrix3<f64>, weight: f64, center: &Vector3<f64>) -> GenericBody<T> {
    GenericBody { mass_matrix: mass.map(T::from_f64), weight: T::from_f64(weight), center: center.map(T::from_f64) }
}
