//! The systems that are solved and stepped.

#![allow(missing_docs)]

use clebsch::Clebsch;
use nalgebra::{Matrix3, Matrix6, Vector3};

/// P5: a free body.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (Matrix3::from_diagonal(&self.mass) * (F - I) * (F - I).transpose()).trace() / (2 * h),
    emit   = [boundary],
)]
pub struct Free {
    pub mass: Vector3<f64>,
}

/// P5v: a heavy top.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (Matrix3::from_diagonal(&self.mass) * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * R[(2, 2)],
    emit      = [boundary],
)]
pub struct Top {
    pub mass: Vector3<f64>,
    pub weight: f64,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    emit      = [tangent],
)]
pub struct HeavyTop {
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix3<f64>,
    pub weight: f64,
    pub center: Vector3<f64>,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.mass * self.length.powi(2) * (F - I).norm_squared() / (4 * h),
    potential = |q| self.mass * self.gravity * self.length * q.z,
    emit      = [tangent],
)]
pub struct Pendulum {
    pub mass: f64,
    pub length: f64,
    pub gravity: f64,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<3>, q: SE<3>| q * F,
    lagrangian = |xi| xi.dot(&(self.inertia * xi)) / 2,
    potential  = |q| self.weight * (q.rotation() * self.center).z + q.translation().norm_squared() / 2,
    emit       = [tangent],
)]
pub struct Vehicle {
    #[clebsch(symmetric)]
    pub inertia: Matrix6<f64>,
    pub weight: f64,
    pub center: Vector3<f64>,
}
