//! A spherical pendulum of unit mass and length.

use crate::classical::{Equation, VectorField};
use crate::motion::Scene;
use crate::setting::{Setting, declared};
use clebsch::Clebsch;
use nalgebra::{SVector, Vector3, Vector6};
use std::hint::black_box;

const POSITION: Vector3<f64> = Vector3::new(0.0, 1.0, 0.0);
const MOMENTUM: Vector3<f64> = Vector3::new(1.0, 0.0, 0.5);

/// Position and angular momentum q × q̇.
type Bob = SVector<f64, 6>;

struct ChordFirst;
struct ChordSecond;
struct ChordFourth;
struct ChordSixth;
struct ChordEighth;
struct CayleyFirst;
struct CayleySecond;
struct CayleyFourth;
struct CayleySixth;
struct CayleyEighth;
struct ExponentialFirst;
struct ExponentialSecond;
struct ExponentialFourth;
struct ExponentialSixth;
struct ExponentialEighth;
struct Collocation;

/// A point on the unit sphere, by the chord of the rotation of a step.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.mass * (F - I).norm_squared() / (4 * h),
    potential = |q| self.mass * self.gravity * q.z,
    method ChordFirst  = (order = 1),
    method ChordSecond = (order = 2),
    method ChordFourth = (order = 4),
    method ChordSixth  = (order = 6),
    method ChordEighth = (order = 8),
)]
struct Chord {
    /// Mass of the bob, kg.
    mass: f64,
    /// g, m/s².
    gravity: f64,
}

/// The same point by its Lagrangian, in one form after another.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |F: SO<3>, q: Unit<Vector3>| F * q,
    lagrangian = |omega| self.mass * omega.norm_squared() / 2,
    potential  = |q| self.mass * self.gravity * q.z,
    method CayleyFirst       = (order = 1, discretization = cayley),
    method CayleySecond      = (order = 2, discretization = cayley),
    method CayleyFourth      = (order = 4, discretization = cayley),
    method CayleySixth       = (order = 6, discretization = cayley),
    method CayleyEighth      = (order = 8, discretization = cayley),
    method ExponentialFirst  = (order = 1, discretization = exponential),
    method ExponentialSecond = (order = 2, discretization = exponential),
    method ExponentialFourth = (order = 4, discretization = exponential),
    method ExponentialSixth  = (order = 6, discretization = exponential),
    method ExponentialEighth = (order = 8, discretization = exponential),
    method Collocation       = (order = 16),
)]
struct Pendulum {
    /// Mass of the bob, kg.
    mass: f64,
    /// g, m/s².
    gravity: f64,
}

/// Every form in every order.
fn declarations(gravity: f64) -> Vec<Box<dyn Setting<6>>> {
    let start = (POSITION, MOMENTUM);
    let chord = Chord { mass: 1.0, gravity };
    let pendulum = Pendulum { mass: 1.0, gravity };
    vec![
        declared(ChordFirst, "chord", chord, start, pack),
        declared(ChordSecond, "chord", chord, start, pack),
        declared(ChordFourth, "chord", chord, start, pack),
        declared(ChordSixth, "chord", chord, start, pack),
        declared(ChordEighth, "chord", chord, start, pack),
        declared(CayleyFirst, "cayley", pendulum, start, pack),
        declared(CayleySecond, "cayley", pendulum, start, pack),
        declared(CayleyFourth, "cayley", pendulum, start, pack),
        declared(CayleySixth, "cayley", pendulum, start, pack),
        declared(CayleyEighth, "cayley", pendulum, start, pack),
        declared(ExponentialFirst, "exponential", pendulum, start, pack),
        declared(ExponentialSecond, "exponential", pendulum, start, pack),
        declared(ExponentialFourth, "exponential", pendulum, start, pack),
        declared(ExponentialSixth, "exponential", pendulum, start, pack),
        declared(ExponentialEighth, "exponential", pendulum, start, pack),
        declared(Collocation, "collocation", pendulum, start, pack),
        declared(ExponentialFirst, "exponential synchronized", pendulum, start, pack).synchronized(),
    ]
}

/// q̇ = n × q and the torque of the weight.
#[derive(Clone)]
struct Falling {
    gravity: f64,
}

impl VectorField<6> for Falling {
    #[inline(always)]
    fn rates(&self, y: &Bob) -> Bob {
        let (q, n) = split(y);
        pack(&n.cross(&q), &(Vector3::new(-q.y, q.x, 0.0) * self.gravity))
    }
}

/// g = 1.
pub fn scene() -> Scene<6> {
    let gravity = black_box(1.0);
    let field = Falling { gravity };
    let mut settings = declarations(gravity);
    settings.extend(Equation { field: field.clone(), start: pack(&POSITION, &MOMENTUM), flat: |y| *y }.settings());
    Scene {
        name: "pendulum",
        title: "spherical pendulum",
        duration: 100.0,
        start: pack(&POSITION, &MOMENTUM),
        field: Box::new(move |y| field.rates(y)),
        energy: Box::new(move |y| split(y).1.norm_squared() / 2.0 + gravity * y[2]),
        momenta: |y| Vector6::new(y[5], 0.0, 0.0, 0.0, 0.0, 0.0),
        constraint: |y| (split(y).0.norm_squared() - 1.0).abs(),
        split: 3,
        momentum_size: MOMENTUM.norm(),
        closed_form: None,
        known: None,
        reference_steps: 100_000,
        longer: 10,
        least_error: 0.0,
        shows_sixteen: true,
        settings,
    }
}

fn pack(q: &Vector3<f64>, n: &Vector3<f64>) -> Bob {
    Bob::new(q.x, q.y, q.z, n.x, n.y, n.z)
}

fn split(y: &Bob) -> (Vector3<f64>, Vector3<f64>) {
    (Vector3::new(y[0], y[1], y[2]), Vector3::new(y[3], y[4], y[5]))
}
