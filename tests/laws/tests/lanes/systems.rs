//! The systems that are stepped on lanes: implicit, in closed form, coupled, with the time, of several factors, composed.

use clebsch::{Clebsch, Scalar};
#[cfg(feature = "heavy")]
use nalgebra::Matrix4;
use nalgebra::{Matrix3, Vector3};

/// An implicit step of three unknowns without kicks.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = moser_veselov,
)]
pub struct Body<T: Scalar> {
    pub moments: Vector3<T>,
}

/// The same with sums that keep their rests.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = moser_veselov,
    summation      = compensated,
)]
pub struct CompensatedBody<T: Scalar> {
    pub moments: Vector3<T>,
}

/// The same with an iteration that ends early, at another number of steps in each lane.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = moser_veselov,
    tolerance      = 1e-6,
)]
pub struct TolerantBody<T: Scalar> {
    pub moments: Vector3<T>,
}

/// The same by fixed points.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = moser_veselov,
    solver         = fixed_point,
    tolerance      = 1e-6,
)]
pub struct FixedBody<T: Scalar> {
    pub moments: Vector3<T>,
}

/// Three unknowns with kicks.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
)]
pub struct Top<T: Scalar> {
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
}

/// The same in eleven steps.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    order     = 6,
)]
pub struct SixthTop<T: Scalar> {
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
}

/// A motion without an error in h; each state brings along its constants.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = exact,
)]
pub struct ExactBody<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
}

/// The same in four dimensions.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<4>, R: SO<4>| R * F,
    lagrangian     = |omega| (self.mass * omega.matrix() * omega.matrix().transpose()).trace() / 2,
    discretization = exact,
)]
pub struct ExactBody4<T: Scalar> {
    #[clebsch(symmetric)]
    pub mass: Matrix4<T>,
}

/// An exact drift between kicks with force gradients.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential      = |R| self.weight * (R * self.center).z,
    discretization = exact,
    order          = 4,
)]
pub struct SplitTop<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
}

/// Sweeps over the stages of order 16, as many as each lane needs.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SU<2>, Q: SU<2>| Q * F,
    lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    potential  = |Q| self.weight * (Q * Vector3::z()).z,
    order      = 16,
)]
pub struct CollocatedTop<T: Scalar> {
    pub moments: Vector3<T>,
    pub weight: T,
}

/// A closed form with a limit, sin θ < 1.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.mass * self.length.powi(2) * (F - I).norm_squared() / (4 * h),
    potential = |q| self.mass * self.gravity * self.length * q.z,
)]
pub struct Pendulum<T: Scalar> {
    pub mass: T,
    pub length: T,
    pub gravity: T,
}

/// Six unknowns.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<4>, R: SO<4>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct Body4<T: Scalar> {
    #[clebsch(symmetric)]
    pub j_d: Matrix4<T>,
}

/// The exponential chart, and a torque in time through elementary functions.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = exponential,
    potential      = |t, R| self.weight * t.cos() * R[(2, 0)] + (R[(0, 1)] / 2).exp() / (2 + R[(1, 1)]).sqrt(),
)]
pub struct Satellite<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub weight: T,
}

/// Two factors: an explicit one, and a rotation.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(a, F): (Translation<3>, SO<3>), (x, R): (Vector3, SO<3>)| (x + a, R * F),
    lagrangian = |(v, omega)| self.mass * v.norm_squared() / 2 + omega.dot(&(self.inertia * omega)) / 2,
    potential = |(x, R)| (x + R * self.arm).norm_squared().powi(2),
)]
pub struct Flyer<T: Scalar> {
    pub mass: T,
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub arm: Vector3<T>,
}
