//! A satellite on a circular orbit: the gravity gradient turns with the time. Its potential varies by a quarter of the kinetic energy.
//!
//! Declarations see it from space, where the direction u of the planet turns. Classical methods see it from the orbit's frame, where
//! nothing depends on the time.

use super::rotation::{
    Body, Compact, compact, compact_rates, defect, last_row, pack, pack_quaternion, rates, split, split_compact,
    tilted, tilted_quaternion, unpack_compact,
};
use crate::classical::{Equation, VectorField};
use crate::motion::Scene;
use crate::setting::{Setting, declared};
use clebsch::Clebsch;
use nalgebra::{Matrix3, Quaternion, Rotation3, SVector, Vector3, Vector6};
use std::hint::black_box;

const MOMENTS: Vector3<f64> = Vector3::new(1.0, 1.5, 2.0);
/// In the units of the orbital rate.
const VELOCITY: Vector3<f64> = Vector3::new(0.3, 0.4, 2.5);
const RATE: f64 = 1.0;
const TILT: f64 = 0.5;

struct ExactSecond;
struct ExactFourth;
struct ExactSixth;
struct ToleratedFourth;
struct ToleratedMedium;
struct ToleratedSixth;
struct MoserVeselovSecond;
struct MoserVeselovFourth;
struct MoserVeselovSixth;
struct MoserVeselovEighth;
struct Collocation;
struct QuaternionExactFourth;
struct QuaternionExactSixth;
struct QuaternionCollocation;
struct QuaternionCollocationLoose;

/// The attitude as a matrix: V = 3n²/2 y·Σy with y = Rᵀu.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |t, R| {
        let y = R.transpose() * vector![(self.rate * t).cos(), (self.rate * t).sin(), 0];
        3 * self.rate * self.rate / 2 * y.dot(&(self.inertia * y))
    },
    method ExactSecond        = (order = 2, discretization = exact),
    method ExactFourth        = (order = 4, discretization = exact),
    method ExactSixth         = (order = 6, discretization = exact),
    method ToleratedFourth    = (order = 4, discretization = exact, tolerance = 1e-7),
    method ToleratedMedium    = (order = 6, discretization = exact, tolerance = 1e-7),
    method ToleratedSixth     = (order = 6, discretization = exact, tolerance = 1e-10),
    method MoserVeselovSecond = (order = 2, discretization = moser_veselov),
    method MoserVeselovFourth = (order = 4, discretization = moser_veselov),
    method MoserVeselovSixth  = (order = 6, discretization = moser_veselov),
    method MoserVeselovEighth = (order = 8, discretization = moser_veselov),
    method Collocation        = (order = 16),
)]
struct Satellite {
    /// Inertia tensor about the centre of mass, kg·m².
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    /// The rate n of the orbit, 1/s.
    rate: f64,
}

/// The attitude as a unit quaternion.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |F: SU<2>, Q: SU<2>| Q * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |t, Q| {
        let y = Q.conjugate() * vector![(self.rate * t).cos(), (self.rate * t).sin(), 0];
        3 * self.rate * self.rate / 2 * y.dot(&(self.inertia * y))
    },
    method QuaternionExactFourth      = (order = 4, discretization = exact),
    method QuaternionExactSixth       = (order = 6, discretization = exact),
    method QuaternionCollocation      = (order = 16),
    method QuaternionCollocationLoose = (order = 16, tolerance = 1e-10),
)]
struct Turn {
    /// Inertia tensor about the centre of mass, kg·m².
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    /// The rate n of the orbit, 1/s.
    rate: f64,
}

fn declarations(inertia: Matrix3<f64>, rate: f64) -> Vec<Box<dyn Setting<12>>> {
    let satellite = Satellite { inertia, rate };
    let turn = Turn { inertia, rate };
    let start = (tilted(TILT), inertia * VELOCITY);
    let turned = (tilted_quaternion(TILT), inertia * VELOCITY);
    vec![
        declared(ExactSecond, "exact", satellite, start, pack).seen_from(orbit),
        declared(ExactFourth, "exact", satellite, start, pack).seen_from(orbit),
        declared(ExactSixth, "exact", satellite, start, pack).seen_from(orbit),
        declared(QuaternionExactFourth, "quaternion exact", turn, turned, pack_quaternion).seen_from(orbit),
        declared(QuaternionExactSixth, "quaternion exact", turn, turned, pack_quaternion).seen_from(orbit),
        declared(MoserVeselovSecond, "moser_veselov", satellite, start, pack).seen_from(orbit),
        declared(MoserVeselovFourth, "moser_veselov", satellite, start, pack).seen_from(orbit),
        declared(MoserVeselovSixth, "moser_veselov", satellite, start, pack).seen_from(orbit),
        declared(MoserVeselovEighth, "moser_veselov", satellite, start, pack).seen_from(orbit),
        declared(Collocation, "collocation", satellite, start, pack).seen_from(orbit),
        declared(QuaternionCollocation, "quaternion collocation", turn, turned, pack_quaternion).seen_from(orbit),
        // series of drifts that end early
        declared(ToleratedFourth, "exact", satellite, start, pack).to(1e-7).seen_from(orbit),
        declared(ToleratedMedium, "exact", satellite, start, pack).to(1e-7).seen_from(orbit),
        declared(ToleratedSixth, "exact", satellite, start, pack).to(1e-10).seen_from(orbit),
        // sweeps that end early
        declared(QuaternionCollocationLoose, "quaternion collocation", turn, turned, pack_quaternion)
            .to(1e-10)
            .seen_from(orbit),
    ]
}

/// The same motion in axes that turn with the orbit.
fn orbit(time: f64, y: &Body) -> Body {
    let (attitude, momentum) = split(y);
    pack(&(Rotation3::from_axis_angle(&Vector3::z_axis(), -RATE * time).matrix() * attitude), &momentum)
}

/// Euler's equations with the torque 3n² y × Σy, and the turn of the body in the orbit's frame, ω − Aᵀn.
#[derive(Clone)]
struct Orbiting {
    moments: Vector3<f64>,
    inverse: Vector3<f64>,
    rate: f64,
    /// 3n²
    gradient: f64,
}

impl VectorField<7> for Orbiting {
    #[inline(always)]
    fn rates(&self, y: &Compact) -> Compact {
        let (attitude, momentum) = split_compact(y);
        let omega = self.inverse.component_mul(&momentum);
        let down = first_row(&attitude);
        let torque = (down * self.gradient).cross(&self.moments.component_mul(&down));
        let turn = omega - last_row(&attitude) * self.rate;
        compact_rates(&attitude, &turn, &(momentum.cross(&omega) + torque))
    }
}

/// The centre of mass on a circle, the planet along the first axis of the orbit's frame.
pub fn scene() -> Scene<12> {
    let (inertia, rate) = (Matrix3::from_diagonal(&black_box(MOMENTS)), black_box(RATE));
    let inverse = inertia.map(|entry| if entry == 0.0 { 0.0 } else { 1.0 / entry });
    let momentum = inertia * VELOCITY;
    let field = move |y: &_| {
        let (attitude, momentum) = split(y);
        let (omega, down) = (inverse * momentum, attitude.row(0).transpose());
        let turn = omega - attitude.row(2).transpose() * rate;
        rates(&attitude, &turn, &(momentum.cross(&omega) + down.cross(&(inertia * down)) * (3.0 * rate * rate)))
    };
    // Jacobi's integral, the energy in the turning frame
    let energy = move |y: &_| {
        let (attitude, momentum) = split(y);
        let down = attitude.row(0).transpose();
        let potential = 1.5 * rate * rate * down.dot(&(inertia * down));
        momentum.dot(&(inverse * momentum)) / 2.0 + potential - rate * (attitude * momentum).z
    };
    let mut settings = declarations(inertia, rate);
    let start = compact(&tilted_quaternion(TILT), &momentum);
    let equation =
        Orbiting { moments: inertia.diagonal(), inverse: inverse.diagonal(), rate, gradient: 3.0 * rate * rate };
    settings.extend(Equation { field: equation, start, flat: unpack_compact }.settings());
    Scene {
        name: "satellite",
        title: "satellite",
        duration: 50.0,
        start: pack(&tilted(TILT), &momentum),
        field: Box::new(field),
        energy: Box::new(energy),
        momenta: |_: &SVector<f64, 12>| Vector6::zeros(),
        constraint: defect,
        split: 9,
        momentum_size: momentum.norm(),
        closed_form: None,
        known: None,
        reference_steps: 200_000,
        longer: 40,
        least_error: 0.0,
        shows_sixteen: false,
        settings,
    }
}

/// The first row of the rotation.
#[inline(always)]
fn first_row(q: &Quaternion<f64>) -> Vector3<f64> {
    let (i, j, k, w) = (q.i, q.j, q.k, q.w);
    Vector3::new(w * w + i * i - j * j - k * k, 2.0 * (i * j - w * k), 2.0 * (i * k + w * j))
}
