//! Lagrangians whose steps are implicit in many unknowns, or whose metric depends on the configuration.

use clebsch::Clebsch;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector4};

/// Foucault's pendulum: a point on a sphere in a turning frame.
#[derive(Clebsch, Clone)]
#[clebsch(
    action     = |F: SO<3>, q: Unit<Vector3>| F * q,
    lagrangian = |q, w| {
        let velocity = w.cross(&q) + self.rate.cross(&q);
        velocity.norm_squared() / 2 + w.dot(&q).powi(2) / 2
    },
    potential  = |q| self.gravity * q.z,
)]
pub struct Foucault {
    pub gravity: f64,
    pub rate: Vector3<f64>,
}

/// A metric on orbits of SO(2, 1), the hyperbolic plane among them.
#[derive(Clebsch, Clone)]
#[clebsch(
    action     = |F: SO<2, 1>, q: Vector3| F * q,
    lagrangian = |q, w| w.dot(&self.inertia.component_mul(&w)) / 2 * (1 + q.z * q.z),
    potential  = |q| self.stiffness * q.z,
)]
pub struct Hyperbolic {
    pub inertia: Vector3<f64>,
    pub stiffness: f64,
}

/// Three equal rigid links. Each hangs from the end of the previous one.
#[derive(Clebsch, Clone)]
#[clebsch(
    action     = |F: [SO<3>; 3], R: [SO<3>; 3]| [R[0] * F[0], R[1] * F[1], R[2] * F[2]],
    lagrangian = |R, w| {
        let first = R[0] * w[0].cross(&self.link);
        let second = first + R[1] * w[1].cross(&self.link);
        let third = second + R[2] * w[2].cross(&self.link);
        self.mass * (first.norm_squared() + second.norm_squared() + third.norm_squared()) / 2
            + (w[0].dot(&(self.inertia * w[0])) + w[1].dot(&(self.inertia * w[1])) + w[2].dot(&(self.inertia * w[2]))) / 2
    },
    potential  = |R| self.weight * ((R[0] * self.link).z * 3 + (R[1] * self.link).z * 2 + (R[2] * self.link).z),
)]
pub struct Chain {
    pub mass: f64,
    pub weight: f64,
    pub link: Vector3<f64>,
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
}

/// The step of order 4.
pub struct OrderFour;

/// Similarities of the plane, with a metric that depends on the translation.
#[derive(Clebsch, Clone)]
#[clebsch(
    action     = |F: Sim<2>, q: Sim<2>| F * q,
    lagrangian = |q, w| w.dot(&self.inertia.component_mul(&w)) / 2 * (1 + q.translation().norm_squared()),
    potential  = |q| self.stiffness.dot(&q.component_mul(&q)),
    method OrderFour = (order = 4),
)]
pub struct Similarity {
    pub inertia: Vector4<f64>,
    pub stiffness: Matrix3<f64>,
}

/// A body on SU(3), as real 6×6 matrices.
#[derive(Clebsch, Clone)]
#[clebsch(
    action     = |F: SU<3>, q: SU<3>| F * q,
    lagrangian = |q, w| w.dot(&self.inertia.component_mul(&w)) / 2,
    potential  = |q| self.stiffness.dot(&q),
)]
pub struct Unitary {
    pub inertia: SVector<f64, 8>,
    pub stiffness: SMatrix<f64, 6, 6>,
}
