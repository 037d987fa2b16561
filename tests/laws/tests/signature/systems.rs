//! Declarations whose kinetic energy is positive for some parameters and not for others.

use clebsch::{Clebsch, Scalar};
use nalgebra::*;

/// The Moser–Veselov step.
#[derive(Debug)]
pub struct Chord;
/// Steps of order 6 whose drift is exact.
#[derive(Debug)]
pub struct Exact;
/// Compositions of order 4.
#[derive(Debug)]
pub struct Fourth;
/// Collocation.
#[derive(Debug)]
pub struct Collocated;

/// A body by its inertia tensor Σ = J.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action            = |F: SO<3>, R: SO<3>| R * F,
    lagrangian        = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential         = |R| R.column(2).z,
    method Chord      = (discretization = moser_veselov),
    method Exact      = (discretization = exact, order = 6),
    method Fourth     = (order = 4),
    method Collocated = (order = 16),
)]
pub struct Body<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
}

/// The same with an energy of any signs.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action       = |F: SO<3>, R: SO<3>| R * F,
    lagrangian   = |omega| omega.dot(&(self.inertia * omega)) / 2,
    signature    = indefinite,
    method Chord = (discretization = moser_veselov),
)]
pub struct BodyOfAnySigns {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
}

/// A body by its mass matrix: Σ = tr(𝕄) I − 𝕄.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    emit   = [boundary],
)]
pub struct BodyOfMasses {
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix3<f64>,
}

/// The same, the square without its transpose: Σ = 𝕄 − tr(𝕄) I.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (self.mass_matrix * (F - I) * (F - I)).trace() / (2 * h),
)]
pub struct ForgottenTranspose {
    pub mass_matrix: Matrix3<f64>,
}

/// The momentum of a body alone.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    emit       = [momentum],
)]
pub struct MomentumAlone {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
}

/// A shift and a turn that are coupled, whose matrix nothing is promised of.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<2>, q: SE<2>| q * F,
    lagrangian = |xi| xi.dot(&(self.mass * xi)) / 2,
)]
pub struct Coupled {
    pub mass: Matrix3<f64>,
}

/// A body in five dimensions, ten components, in matrix code.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<5>, R: SO<5>| R * F,
    lagrangian = |omega| (self.mass * omega.matrix() * omega.matrix().transpose()).trace() / 2,
    code       = matrices,
)]
pub struct Large {
    #[clebsch(symmetric)]
    pub mass: SMatrix<f64, 5, 5>,
}

/// A point on the sphere, Σ = κI.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| self.mass * (F - I).norm_squared() / (4 * h),
)]
pub struct Point<T: Scalar> {
    pub mass: T,
}

/// Polar coordinates around a hole, within which the metric is indefinite.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |x, v| self.mass * (v.x * v.x + (x.x * x.x - self.hole) * v.y * v.y) / 2,
    emit       = [boundary],
)]
pub struct Hole {
    pub mass: f64,
    pub hole: f64,
}

/// The same with both signs meant.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |x, v| self.mass * (v.x * v.x + (x.x * x.x - self.hole) * v.y * v.y) / 2,
    signature  = indefinite,
)]
pub struct HoleOfAnySigns {
    pub mass: f64,
    pub hole: f64,
}

/// A rocket, whose mass changes with the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<1>, x: Vector1| x + a,
    lagrangian = |t, v| (self.mass - self.rate * t) * v.norm_squared() / 2,
)]
pub struct Rocket {
    pub mass: f64,
    pub rate: f64,
}

/// A Lagrangian that is not quadratic: at rest Σ = m I.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| -self.mass * (1 - v.norm_squared()).sqrt(),
)]
pub struct Relativistic {
    pub mass: f64,
}

/// Particles with masses of their own.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
    cost      = |h, a| (0..N).map(|i| self.mass[i] * a[i].norm_squared() / (2 * h)).sum(),
    potential = |x| (0..N).map(|i| (x[(i + 1) % N] - x[i]).norm_squared() / 2).sum(),
)]
pub struct Ring<const N: usize> {
    pub mass: [f64; N],
}

/// Rockets that lose a kilogram each second.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
    cost      = |t, h, a| (0..N).map(|i| (self.mass[i] - t) * a[i].norm_squared() / (2 * h)).sum(),
    potential = |x| (0..N).map(|i| x[i].x).sum(),
)]
pub struct Rockets<const N: usize> {
    pub mass: [f64; N],
}

/// A particle whose thrust is chosen.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |a: Translation<2>, x: Vector2| x + a,
    cost     = |h, a| a.dot(&(self.mass * a)) / (2 * h),
    force_on = |thrust: Vector2| thrust,
    effort   = |h, thrust| h * thrust.norm_squared() / 2,
)]
pub struct Steered {
    #[clebsch(symmetric)]
    pub mass: Matrix2<f64>,
}

/// A cost that the antisymmetric part of the mass matrix changes, though not its kinetic energy: −tr(𝕄 (F − I)²)/2h.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| -(self.mass_matrix * (F - I) * (F - I)).trace() / (2 * h),
)]
pub struct Twisted {
    pub mass_matrix: Matrix3<f64>,
}
