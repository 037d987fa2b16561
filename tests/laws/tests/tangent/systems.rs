//! The systems whose tangent maps are tested, generic so that dual numbers can be put through their steps.

use clebsch::{Clebsch, Scalar};
use nalgebra::{Matrix3, Matrix6, SMatrix, Vector3};

#[path = "shared.rs"]
mod shared;
#[cfg(feature = "heavy")]
#[path = "sixth.rs"]
mod sixths;

pub use shared::{Composed, Satellite, Top};
#[cfg(feature = "heavy")]
pub use sixths::Sixth;

/// A closed form on a sphere, whose points motions fix, with an action from the left.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.inertia * (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z + q.x.powi(3) / 3,
    isotropy  = free,
    emit      = [tangent],
)]
pub struct Pendulum<T: Scalar> {
    pub inertia: T,
    pub gravity: T,
}

/// Six coupled unknowns on SE(3).
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<3>, q: SE<3>| q * F,
    lagrangian = |xi| xi.dot(&(self.inertia * xi)) / 2,
    potential  = |q| self.weight * (q.rotation() * self.center).z + q.translation().norm_squared() / 2,
    emit       = [tangent],
)]
pub struct Vehicle<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix6<T>,
    pub weight: T,
    pub center: Vector3<T>,
}

/// An inertia that depends on the attitude and on the time: a coupled cost.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| F * R,
    cost      = |t, h, R, F| {
        let size = (1 + self.growth * (t + h / 2)) * (3 + R[(2, 2)] + (F * R)[(2, 2)]) / 3;
        self.inertia * size * (F - I).norm_squared() / (4 * h)
    },
    potential = |R| self.weight * R[(0, 1)],
    emit      = [tangent],
)]
pub struct Growing<T: Scalar> {
    pub growth: T,
    pub inertia: T,
    pub weight: T,
}

/// Explicit steps of a product, one of whose factors is a group of unit quaternions.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(a, F): (Translation<3>, SU<2>), (x, q): (Vector3, SU<2>)| (x + a, q * F),
    lagrangian = |(v, omega)| (self.mass * v.norm_squared() + omega.dot(&self.moments.component_mul(&omega))) / 2,
    potential = |(x, q)| (x + q * Vector3::z()).norm_squared() / 2 + x.z,
    emit      = [tangent],
)]
pub struct Flyer<T: Scalar> {
    pub mass: T,
    pub moments: Vector3<T>,
}

/// A unipotent group.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: Heisenberg<1>, q: Heisenberg<1>| q * F,
    lagrangian = |v| v.dot(&(self.mass * v)) / 2,
    potential  = |q| q[(0, 1)].powi(2) / 2 + q[(0, 2)] * q[(1, 2)],
    emit       = [tangent],
)]
pub struct Nil<T: Scalar> {
    #[clebsch(symmetric)]
    pub mass: SMatrix<T, 3, 3>,
}

/// Drag, a torque that depends on attitude and time, and a force on the configuration with an input.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |t, R, omega| R.transpose() * Vector3::new(t.cos(), t.sin(), 1) - self.drag * omega.norm_squared() * omega,
    force_on   = |R, omega, u: Vector2| R * (u.x * I + omega.cross_matrix()) * R[(0, 1)] + u.y * Matrix3::new(1, 2, 3, 4, 5, 6, 7, 8, 9),
    emit       = [tangent],
)]
pub struct Steered<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub drag: T,
}

/// Five steps of two edges in one.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<3>, x: Vector3| x + a,
    cost   = |t, h, x, a| a.norm_squared() / (2 * h) - h * self.stiffness * (x.norm_squared() + t * x.x).powi(2) / 4,
    force  = |v, u: Vector2| vector![u.x, u.y, 0] - self.drag * v,
    order  = 4,
    emit   = [tangent],
)]
pub struct Fourth<T: Scalar> {
    pub stiffness: T,
    pub drag: T,
}

/// The symmetric matrix with this upper triangle, row by row.
pub fn symmetric<T: Scalar, const N: usize>(upper: &[T]) -> SMatrix<T, N, N> {
    // rows before row i hold N, N − 1, …, N − i + 1 numbers
    let place = |i: usize, j: usize| i * N - i * (i + 1) / 2 + j;
    SMatrix::from_fn(|i, j| upper[place(i.min(j), i.max(j))])
}

pub fn vector<T: Scalar>(entries: &[T]) -> Vector3<T> {
    Vector3::from_column_slice(entries)
}

/// From the numbers in the order of its quantities; later numbers are not read.
pub fn top<T: Scalar>(numbers: &[T]) -> Top<T> {
    Top { mass_matrix: symmetric(numbers), weight: numbers[6], center: vector(&numbers[7..10]) }
}

/// As [`top`].
pub fn pendulum<T: Scalar>(numbers: &[T]) -> Pendulum<T> {
    Pendulum { inertia: numbers[0], gravity: numbers[1] }
}

/// As [`top`].
pub fn composed<T: Scalar>(numbers: &[T]) -> Composed<T> {
    let Top { mass_matrix, weight, center } = top(numbers);
    Composed { mass_matrix, weight, center, skew: numbers[10] }
}

/// As [`top`].
pub fn vehicle<T: Scalar>(numbers: &[T]) -> Vehicle<T> {
    Vehicle { inertia: symmetric(numbers), weight: numbers[21], center: vector(&numbers[22..25]) }
}

/// As [`top`].
pub fn satellite<T: Scalar>(numbers: &[T]) -> Satellite<T> {
    Satellite { inertia: symmetric(numbers), orbital_rate: numbers[6] }
}

/// As [`top`].
pub fn growing<T: Scalar>(numbers: &[T]) -> Growing<T> {
    Growing { growth: numbers[0], inertia: numbers[1], weight: numbers[2] }
}

/// As [`top`].
pub fn flyer<T: Scalar>(numbers: &[T]) -> Flyer<T> {
    Flyer { mass: numbers[0], moments: vector(&numbers[1..4]) }
}

/// As [`top`].
pub fn nil<T: Scalar>(numbers: &[T]) -> Nil<T> {
    Nil { mass: symmetric(numbers) }
}

/// As [`top`].
pub fn steered<T: Scalar>(numbers: &[T]) -> Steered<T> {
    Steered { inertia: symmetric(numbers), drag: numbers[6] }
}

/// As [`top`].
#[cfg(feature = "heavy")]
pub fn sixth<T: Scalar>(numbers: &[T]) -> Sixth<T> {
    Sixth { inertia: symmetric(numbers), rate: numbers[6] }
}

/// As [`top`].
pub fn fourth<T: Scalar>(numbers: &[T]) -> Fourth<T> {
    Fourth { stiffness: numbers[0], drag: numbers[1] }
}
