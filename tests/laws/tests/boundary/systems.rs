//! The systems between fixed endpoints: each takes another way through the compiler.

use clebsch::{Clebsch, Scalar};
use nalgebra::{Matrix3, Vector2, Vector3};

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (Matrix3::from_diagonal(&self.mass) * (F - I) * (F - I).transpose()).trace() / (2 * h),
    emit   = [boundary],
)]
pub struct Free {
    pub mass: Vector3<f64>,
}

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
    cost      = |h, F| {
        let kinetic = (Matrix3::from_diagonal(&self.mass) * (F - I) * (F - I).transpose()).trace() / (2 * h);
        kinetic + self.skew * (F[(1, 0)] - F[(0, 1)]).powi(3) / h
    },
    potential = |R| self.weight * R[(2, 2)],
    emit      = [boundary],
)]
pub struct Composed {
    pub mass: Vector3<f64>,
    pub skew: f64,
    pub weight: f64,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&self.inertia.component_mul(&omega)) / 2,
    discretization = exponential,
    potential      = |t, R| {
        let phase = self.orbital_rate * t;
        let zenith = R.transpose() * Vector3::new(phase.cos(), phase.sin(), 0);
        3 * self.orbital_rate.powi(2) / 2 * zenith.dot(&self.inertia.component_mul(&zenith))
    },
    emit           = [boundary],
)]
pub struct Satellite {
    pub inertia: Vector3<f64>,
    pub orbital_rate: f64,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<3>, q: SE<3>| q * F,
    lagrangian = |(omega, v)| (omega.dot(&self.inertia.component_mul(&omega)) + v.dot(&self.mass.component_mul(&v))) / 2,
    potential  = |q| self.weight * q[(2, 2)],
    emit       = [boundary],
)]
pub struct Vehicle {
    pub inertia: Vector3<f64>,
    pub mass: Vector3<f64>,
    pub weight: f64,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(a, F): (Translation<3>, SO<3>), (x, q): (Vector3, Unit<Vector3>)| (x + a, F * q),
    cost      = |h, (a, F)| (2 * self.mass * a.norm_squared() + self.inertia * (F - I).norm_squared()) / (4 * h),
    potential = |(x, q)| self.pull * x.dot(&q),
    emit      = [boundary],
)]
pub struct Flyer {
    pub mass: f64,
    pub inertia: f64,
    pub pull: f64,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(F, G): (SO<3>, SO<3>), (p, q): (Unit<Vector3>, Unit<Vector3>)| (F * p, G * q),
    cost      = |h, (F, G)| ((F - I).norm_squared() + (G - I).norm_squared()) / (4 * h),
    potential = |(p, q)| p.z + 2 * q.z + self.coupling * p.dot(&q),
    emit      = [boundary],
)]
pub struct Chain {
    pub coupling: f64,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<3>, x: Vector3| x + a,
    cost   = |h, a| self.mass * a.norm_squared() / (2 * h),
    emit   = [boundary],
)]
pub struct Point {
    pub mass: f64,
}

/// The top by unit quaternions.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SU<2>, Q: SU<2>| Q * F,
    cost      = |h, F| 2 * F.imag().dot(&self.inertia.component_mul(&F.imag())) / h,
    potential = |Q| self.weight * (Q * Vector3::new(0, 0, 1)).z,
    emit      = [boundary],
)]
pub struct QuaternionTop {
    pub inertia: Vector3<f64>,
    pub weight: f64,
}

/// The top over any scalar.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (Matrix3::from_diagonal(&self.mass) * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * R[(2, 2)],
    emit      = [boundary],
)]
pub struct AnyTop<T: Scalar> {
    pub mass: Vector3<T>,
    pub weight: T,
}

/// A point that turns about the origin at any distance from it.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, x: Vector3| F * x,
    cost   = |h, F| self.inertia * (F - I).norm_squared() / (4 * h),
    emit   = [boundary],
)]
pub struct Swivel {
    pub inertia: f64,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |a: Translation<2>, x: Vector2| x + a,
    cost     = |h, a| self.mass * a.norm_squared() / (2 * h),
    endpoint = |x| self.stiffness * (x - self.goal).norm_squared() / 2,
    emit     = [boundary],
)]
pub struct Spring {
    pub mass: f64,
    pub stiffness: f64,
    pub goal: Vector2<f64>,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (Matrix3::from_diagonal(&self.mass_matrix) * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| (R * self.weight).z,
    endpoint  = |R| -self.stiffness * (R.transpose() * self.goal).trace(),
    emit      = [boundary],
)]
pub struct Catch {
    pub mass_matrix: Vector3<f64>,
    pub weight: Vector3<f64>,
    pub stiffness: f64,
    pub goal: Matrix3<f64>,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    emit   = [boundary],
)]
pub struct Bead;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |a: Translation<2>, x: Vector2| x + a,
    cost     = |h, a| self.mass * a.norm_squared() / (2 * h),
    endpoint = |t, x| self.price * t,
    emit     = [boundary],
)]
pub struct Hurry {
    pub mass: f64,
    pub price: f64,
}
