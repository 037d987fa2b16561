//! Systems whose tangent maps are tested, and through whose steps other dual numbers are put too.

use clebsch::{Clebsch, Scalar};
use nalgebra::{Matrix3, Vector3};

/// An implicit step on a group that acts from the right.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    emit      = [tangent],
)]
pub struct Top<T: Scalar> {
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
}

/// Two edges a step: a discrete Lagrangian that is not time-symmetric.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| {
        let kinetic = (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h);
        kinetic + self.skew * (F[(1, 0)] - F[(0, 1)]).powi(3) / h
    },
    potential = |R| self.weight * (R * self.center).z,
    emit      = [tangent],
)]
pub struct Composed<T: Scalar> {
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
    pub skew: T,
}

/// The logarithm in the Lagrangian, and a potential that knows the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = exponential,
    potential      = |t, R| {
        let phase = self.orbital_rate * t;
        let zenith = R.transpose() * Vector3::new(phase.cos(), phase.sin(), 0);
        3 * self.orbital_rate.powi(2) / 2 * zenith.dot(&(self.inertia * zenith))
    },
    emit           = [tangent],
)]
pub struct Satellite<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub orbital_rate: T,
}
