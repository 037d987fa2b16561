//! Systems with a constraint, generic so that dual numbers can be put through their steps.

use crate::systems::{symmetric, vector};
use clebsch::{Clebsch, Scalar};
#[cfg(feature = "heavy")]
use nalgebra::Matrix4;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// A sleigh on a slope that is pushed along its blade, with friction.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    lagrangian     = |xi| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + (xi.z + self.offset * xi.x).powi(2))) / 2,
    discretization = moser_veselov,
    potential      = |q| self.weight * q.translation().y,
    force          = |xi, push: Vector1| vector![-self.friction * xi.x, push.x - self.friction * xi.y, 0],
    constraint     = |xi| [xi.z == 0],
    emit           = [tangent],
)]
pub struct Sleigh<T: Scalar> {
    pub mass: T,
    pub inertia: T,
    pub offset: T,
    pub friction: T,
    pub weight: T,
}

/// Suslov's body with another axis, by steps of several methods.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential      = |R| self.weight * R[(2, 0)],
    constraint     = |omega| [omega.dot(&self.axis) == 0],
    discretization = exponential,
    emit           = [tangent],
)]
pub struct Suslov<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub weight: T,
    pub axis: Vector3<T>,
}

/// A ball that rolls on a turning table.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |(a, W): (Translation<2>, SO<3>), x: Vector2| x + a,
    cost           = |h, (a, W)| self.mass * a.norm_squared() / (2 * h) + self.inertia * (W - I).norm_squared() / (4 * h),
    constraint     = |x, (v, w)| [
        v.x - self.radius * w.y == -self.table_rate * x.y,
        v.y + self.radius * w.x == self.table_rate * x.x,
    ],
    discretization = projection,
    emit           = [tangent],
)]
pub struct Ball<T: Scalar> {
    pub mass: T,
    pub inertia: T,
    pub radius: T,
    pub table_rate: T,
}

/// A snakeboard whose rows depend on the angle of the wheels, and whose rotor is driven.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(F, a, b): (SE<2>, Translation<1>, Translation<1>), (q, rotor, wheel): (SE<2>, Vector1, Vector1)| (q * F, rotor + a, wheel + b),
    lagrangian = |(xi, r, w)| (self.mass * (self.length.powi(2) * xi.x.powi(2) + xi.y.powi(2) + xi.z.powi(2)) + self.rotor * (r.x.powi(2) + 2 * r.x * xi.x)) / 2 + self.wheel * w.x.powi(2),
    constraint = |wheel, (xi, r, w)| [xi.z == 0, self.length * wheel.x.cos() * xi.x + wheel.x.sin() * xi.y == 0],
    emit       = [tangent],
)]
pub struct Snakeboard<T: Scalar> {
    pub mass: T,
    pub length: T,
    pub rotor: T,
    pub wheel: T,
}

/// A body whose spatial angular velocity about a moving axis is given: Veselova's, in spatial momenta.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| F * R,
    lagrangian = |omega| self.inertia * omega.norm_squared() / 2,
    potential  = |R| self.weight * R[(0, 1)] * R[(2, 2)],
    constraint = |t, R, omega| [(R * Vector3::z()).dot(&omega) == self.rate * (1 + t)],
    order      = 4,
    emit       = [tangent],
)]
pub struct Veselova<T: Scalar> {
    pub inertia: T,
    pub weight: T,
    pub rate: T,
}

/// A charged mass on a sphere that grows, in a magnetic field that is not the same everywhere.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |x, v| self.mass * v.norm_squared() / 2 + self.charge * (x.x * (1 + x.z) * v.y - x.z * v.x),
    potential  = |x| self.mass * self.gravity * x.z,
    constraint = |t, x| [(x - self.pivot * t).norm_squared() == (self.length + self.growth * t).powi(2)],
    emit       = [tangent],
)]
pub struct Charge<T: Scalar> {
    pub mass: T,
    pub charge: T,
    pub gravity: T,
    pub pivot: Vector3<T>,
    pub length: T,
    pub growth: T,
}

/// Two bodies that hang by ball joints.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<3>; 2], q: [SE<3>; 2]| [q[0] * F[0], q[1] * F[1]],
    cost       = |h, F| (0..2).map(|i| {
        let turn = F[i].rotation() - I;
        ((turn * self.second_moments[i] * turn.transpose()).trace() + self.mass[i] * F[i].translation().norm_squared()) / (2 * h)
    }).sum(),
    potential  = |q| (0..2).map(|i| self.gravity * self.mass[i] * q[i].translation().z).sum(),
    constraint = |q| [
        q[0].rotation() * self.near[0] + q[0].translation() == Vector3::zeros(),
        q[1].rotation() * self.near[1] + q[1].translation() == q[0].rotation() * self.far + q[0].translation(),
    ],
    emit       = [tangent],
)]
pub struct Bodies<T: Scalar> {
    #[clebsch(symmetric)]
    pub second_moments: [Matrix3<T>; 2],
    pub mass: [T; 2],
    pub gravity: T,
    pub near: [Vector3<T>; 2],
    pub far: Vector3<T>,
}

/// A tractor with a trailer: a joint and wheels.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: [SE<2>; 2], q: [SE<2>; 2]| [q[0] * F[0], q[1] * F[1]],
    lagrangian     = |xi| (0..2).map(|i| self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + xi[i].z.powi(2))).sum() / 2,
    constraint     = [
        |q| [q[0].rotation() * self.hitch[0] + q[0].translation() == q[1].rotation() * self.hitch[1] + q[1].translation()],
        |xi| [(0..2).map(|i| xi[i].z == 0)],
    ],
    emit           = [tangent],
)]
pub struct Rig<T: Scalar> {
    pub mass: [T; 2],
    pub inertia: [T; 2],
    pub hitch: [Vector2<T>; 2],
}

/// A rattleback: rows that are no polynomial of the attitude.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<3>, q: SE<3>| q * F,
    lagrangian = |(omega, v)| (omega.dot(&(self.inertia * omega)) + self.mass * v.norm_squared()) / 2,
    potential  = |q| self.mass * q.translation().z,
    constraint = |q, (omega, v)| {
        let up = q.rotation().transpose() * Vector3::z();
        let scaled = self.axes.component_mul(&self.axes).component_mul(&up);
        let contact = self.height * Vector3::z() - scaled / up.dot(&scaled).sqrt();
        [v + omega.cross(&contact) == Vector3::zeros()]
    },
    emit       = [tangent],
)]
pub struct Rattleback<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub mass: T,
    pub axes: Vector3<T>,
    pub height: T,
}

/// A double pendulum in the plane with drag and a motor, by steps of sixth order.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: [Translation<2>; 2], x: [Vector2; 2]| [x[0] + a[0], x[1] + a[1]],
    lagrangian = |v| v[0].dot(&(self.inertia * v[0])) / 2 + self.mass * v[1].norm_squared() / 2,
    potential  = |x| self.mass * x[1].y + x[0].y,
    force_on   = |x, v, u: Vector1| [vector![-u.x * x[0].y, u.x * x[0].x], -self.drag * v[1]],
    constraint = |x| [
        x[0].norm_squared() == self.length.x.powi(2),
        (x[1] - x[0]).norm_squared() == self.length.y.powi(2),
    ],
    order      = 6,
    emit       = [tangent],
)]
pub struct Double<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix2<T>,
    pub mass: T,
    pub drag: T,
    pub length: Vector2<T>,
}

/// A double pendulum in its two angles, whose tip slides on a wire that moves: an inertia that changes with them.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |x, v| self.mass * (v.x.powi(2) + v.y.powi(2) / 2 + v.x * v.y * (x.x - x.y).cos()),
    potential  = |x| -self.mass * self.gravity * (2 * x.x.cos() + x.y.cos()),
    constraint = |t, x| [x.x.sin() + x.y.sin() == self.wire + self.rate * t],
    emit       = [tangent],
)]
pub struct Wire<T: Scalar> {
    pub mass: T,
    pub gravity: T,
    pub wire: T,
    pub rate: T,
}

/// A mechanism with a wheel, and an inertia that changes with place and time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |t, x, v| (1 + x.x.powi(2) + self.growth * t) * v.x.powi(2) / 2 + (2 + x.y.sin()) * v.y.powi(2) / 2 + self.coupling * v.x * v.y + v.z.powi(2) / 2,
    potential  = |x| x.x.sin() + x.z * x.y,
    force      = |v| -self.drag * v,
    constraint = |t, x, v| [v.x == x.y * v.y + self.growth * t * x.z],
    order      = 4,
    emit       = [tangent],
)]
pub struct Mechanism<T: Scalar> {
    pub growth: T,
    pub coupling: T,
    pub drag: T,
}

/// From the numbers in the order of its quantities.
pub fn sleigh<T: Scalar>(numbers: &[T]) -> Sleigh<T> {
    let [mass, inertia, offset, friction, weight] = first(numbers);
    Sleigh { mass, inertia, offset, friction, weight }
}

/// As [`sleigh`].
pub fn suslov<T: Scalar>(numbers: &[T]) -> Suslov<T> {
    Suslov { inertia: symmetric(numbers), weight: numbers[6], axis: vector(&numbers[7..10]) }
}

/// As [`sleigh`].
pub fn ball<T: Scalar>(numbers: &[T]) -> Ball<T> {
    let [mass, inertia, radius, table_rate] = first(numbers);
    Ball { mass, inertia, radius, table_rate }
}

/// As [`sleigh`].
#[cfg(feature = "heavy")]
pub fn snakeboard<T: Scalar>(numbers: &[T]) -> Snakeboard<T> {
    let [mass, length, rotor, wheel] = first(numbers);
    Snakeboard { mass, length, rotor, wheel }
}

/// As [`sleigh`].
#[cfg(feature = "heavy")]
pub fn veselova<T: Scalar>(numbers: &[T]) -> Veselova<T> {
    let [inertia, weight, rate] = first(numbers);
    Veselova { inertia, weight, rate }
}

/// As [`sleigh`].
pub fn charge<T: Scalar>(numbers: &[T]) -> Charge<T> {
    let ([mass, charge, gravity], [length, growth]) = (first(numbers), first(&numbers[6..]));
    Charge { mass, charge, gravity, pivot: vector(&numbers[3..6]), length, growth }
}

/// As [`sleigh`].
#[cfg(feature = "heavy")]
pub fn bodies<T: Scalar>(numbers: &[T]) -> Bodies<T> {
    Bodies {
        second_moments: [symmetric(numbers), symmetric(&numbers[6..])],
        mass: first(&numbers[12..]),
        gravity: numbers[14],
        near: [vector(&numbers[15..18]), vector(&numbers[18..21])],
        far: vector(&numbers[21..24]),
    }
}

/// As [`sleigh`].
pub fn rig<T: Scalar>(numbers: &[T]) -> Rig<T> {
    let hitch = |numbers: &[T]| Vector2::new(numbers[0], numbers[1]);
    let (mass, inertia) = (first(numbers), first(&numbers[2..]));
    Rig { mass, inertia, hitch: [hitch(&numbers[4..]), hitch(&numbers[6..])] }
}

/// As [`sleigh`].
pub fn rattleback<T: Scalar>(numbers: &[T]) -> Rattleback<T> {
    Rattleback { inertia: symmetric(numbers), mass: numbers[6], axes: vector(&numbers[7..10]), height: numbers[10] }
}

/// As [`sleigh`].
pub fn double<T: Scalar>(numbers: &[T]) -> Double<T> {
    let [mass, drag, upper, lower] = first(&numbers[3..]);
    Double { inertia: symmetric(numbers), mass, drag, length: Vector2::new(upper, lower) }
}

/// As [`sleigh`].
pub fn wire<T: Scalar>(numbers: &[T]) -> Wire<T> {
    let [mass, gravity, wire, rate] = first(numbers);
    Wire { mass, gravity, wire, rate }
}

/// As [`sleigh`].
pub fn mechanism<T: Scalar>(numbers: &[T]) -> Mechanism<T> {
    let [growth, coupling, drag] = first(numbers);
    Mechanism { growth, coupling, drag }
}

/// φ of [`Wire`] at the time t.
pub fn place_of_wire<T: Scalar>(wire: &Wire<T>, t: T, x: &Vector2<T>) -> Vec<T> {
    vec![x.x.sin() + x.y.sin() - wire.wire - wire.rate * t]
}

/// The first N numbers.
fn first<T: Scalar, const N: usize>(numbers: &[T]) -> [T; N] {
    std::array::from_fn(|i| numbers[i])
}

/// φ of [`Charge`] at the time t.
pub fn place_of_charge<T: Scalar>(charge: &Charge<T>, t: T, x: &Vector3<T>) -> Vec<T> {
    let radius = charge.length + charge.growth * t;
    let arm = x - charge.pivot * t;
    vec![arm.dot(&arm) - radius * radius]
}

/// φ of [`Bodies`].
#[cfg(feature = "heavy")]
pub fn places_of_bodies<T: Scalar>(bodies: &Bodies<T>, _: T, q: &[Matrix4<T>; 2]) -> Vec<T> {
    let point = |q: &Matrix4<T>, a: &Vector3<T>| (q * a.push(T::one())).fixed_rows::<3>(0).into_owned();
    let upper = point(&q[0], &bodies.near[0]);
    let joint = point(&q[1], &bodies.near[1]) - point(&q[0], &bodies.far);
    upper.iter().chain(joint.iter()).copied().collect()
}
