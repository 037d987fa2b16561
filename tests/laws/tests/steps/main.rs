//! The derived steps are the hand-written ones, over many steps. Spheres have closed forms, and bodies Newton's method
//! on a Cayley vector. SO(4) has a Riccati equation, and two bodies the method of Störmer and Verlet.
//!
//! Two computations of one step differ by a few units in the last place, which then grow like the distance of two
//! nearby motions. For these regular ones it grows linearly, with a factor of h times the number of steps and the rates
//! of the problem. With 1000 steps of 0.01 to 0.05 that makes 1e-13 to 1e-12.

mod products;
mod transformed;

use clebsch::{Clebsch, State, Stepper};
use clebsch_tests::fixtures::first_order_top::FirstOrderTop;
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::neumann::Neumann;
use clebsch_tests::fixtures::paper_pendulum::PaperPendulum;
use clebsch_tests::fixtures::rigid_body4::RigidBody4;
use clebsch_tests::fixtures::sphere_geodesic::SphereGeodesic;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::oracle::near::{assert_near, distance};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::{components, skew};
use clebsch_tests::oracle::{body, riccati, sphere};
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4, Vector6};

const STEPS: usize = 1000;

/// The state after `STEPS` steps.
fn last<S: Clebsch>(stepper: &Stepper<S>, q: S::Configuration, mu: S::Momentum) -> (S::Configuration, S::Momentum) {
    let start = stepper.state(q, mu).expect("a state");
    let states: Result<Vec<State<S>>, _> = stepper.trajectory(start).skip(STEPS).take(1).collect();
    states.expect("solvable steps").remove(0).into_parts()
}

/// The result of `STEPS` applications of a hand-written step.
fn repeat<T>(start: T, step: impl Fn(T) -> T) -> T {
    (0..STEPS).fold(start, |state, _| step(state))
}

#[test]
fn free_rigid_body() {
    let mut random = Random::new(11);
    let inertia = body::inertia(&random.inertia());
    let (r, pi) = (random.attitude(), random.vector::<3>() * 2.0);
    let stepper = FreeRigidBody { inertia }.stepper(0.05).expect("a regular body");
    let found = last(&stepper, r, pi);
    let expected = repeat((r, pi), |state| body::strang(&inertia, |_| Vector3::zeros(), 0.05, state));
    println!("free body: {:.1e} {:.1e}", distance(&found.0, &expected.0), distance(&found.1, &expected.1));
    assert_near(&found.0, &expected.0, 1e-12, "R");
    assert_near(&found.1, &expected.1, 1e-12, "π");
}

/// Both orders, at an attitude and with parameters that have no symmetry.
#[test]
fn heavy_top() {
    let mut random = Random::new(12);
    let (mass_matrix, weight, center) = (random.inertia(), 1.3, random.vector());
    let inertia = body::inertia(&mass_matrix);
    let (r, pi) = (random.attitude(), random.vector::<3>());
    let torque = |r: &Matrix3<f64>| body::gravity_torque(weight, &center, r);
    let stepper = HeavyTop { mass_matrix, weight, center }.stepper(0.02).expect("a regular top");
    let found = last(&stepper, r, pi);
    let expected = repeat((r, pi), |state| body::strang(&inertia, torque, 0.02, state));
    println!("heavy top: {:.1e} {:.1e}", distance(&found.0, &expected.0), distance(&found.1, &expected.1));
    assert_near(&found.0, &expected.0, 1e-12, "R at order 2");
    assert_near(&found.1, &expected.1, 1e-12, "π at order 2");

    let stepper = FirstOrderTop { mass_matrix, weight, center }.stepper(0.02).expect("a regular top");
    let found = last(&stepper, r, pi);
    let expected = repeat((r, pi), |state| body::drift_kick(&inertia, torque, 0.02, state));
    assert_near(&found.0, &expected.0, 1e-12, "R at order 1, the papers' (q, M)");
    assert_near(&found.1, &expected.1, 1e-12, "π at order 1, the papers' (q, M)");
}

#[test]
fn rigid_body_in_four_dimensions() {
    let mut random = Random::new(13);
    let j_d: Matrix4<f64> = random.inertia();
    let (r, m) = (random.attitude::<4>(), skew::<4, 6>(&random.vector()));
    let stepper = RigidBody4 { j_d }.stepper(0.05).expect("a regular body");
    let found = last(&stepper, r, components(&m));
    let expected = repeat((r, m), |(r, m)| {
        let f = riccati::drift(&j_d, 0.05, &m);
        (r * f, f.transpose() * m * f)
    });
    let momentum = RigidBody4::momentum_matrix(&found.1);
    println!("SO(4): {:.1e} {:.1e}", distance(&found.0, &expected.0), distance(&momentum, &expected.1));
    assert_near(&found.0, &expected.0, 1e-12, "R");
    assert_near(&momentum, &expected.1, 1e-12, "M");
}

/// The paper's normalisation and the physical one, with mass and length.
#[test]
fn spherical_pendulums() {
    let (q, n) = (Vector3::y(), Vector3::new(1.0, 0.0, 0.5));
    let gravity = |_: &Vector3<f64>| Vector3::z() * 9.81;
    let stepper = PaperPendulum { gravity: 9.81 }.stepper(0.01).expect("a pendulum");
    let found = last(&stepper, q, n * 2.0);
    // w = N × q, and the kick follows the drift
    let expected = repeat((q, n.cross(&q)), |state| {
        let (q, w) = sphere::drift(0.01, state);
        sphere::kick(0.01, &gravity(&q), (q, w))
    });
    println!("paper: {:.1e}", distance(&found.0, &expected.0));
    assert_near(&found.0, &expected.0, 1e-12, "q of the paper");
    assert_near(&found.1, &(expected.0.cross(&expected.1) * 2.0), 3e-12, "2N of the paper");

    let (mass, length) = (0.7, 1.6);
    let stepper = SphericalPendulum { mass, length, gravity: 9.81 }.stepper(0.01).expect("a pendulum");
    let inertia = mass * length * length;
    let found = last(&stepper, q, n * inertia);
    let expected = repeat((q, n.cross(&q)), |state| sphere::strang(|q| gravity(q) / length, 0.01, state));
    assert_near(&found.0, &expected.0, 1e-12, "q with mass and length");
    assert_near(&found.1, &(expected.0.cross(&expected.1) * inertia), 3e-12, "N with mass and length");
}

#[test]
fn points_on_the_three_sphere() {
    let mut random = Random::new(14);
    let q = random.unit::<4>();
    let w = random.vector::<4>();
    let w = w - q * q.dot(&w);
    let momentum = |q: &Vector4<f64>, w: &Vector4<f64>| -> Vector6<f64> {
        components(&((w * q.transpose() - q * w.transpose()) / 2.0))
    };
    let stepper = SphereGeodesic.stepper(0.05).expect("a sphere");
    let found = last(&stepper, q, momentum(&q, &w));
    let expected = repeat((q, w), |state| sphere::drift(0.05, state));
    assert_near(&found.0, &expected.0, 1e-12, "a geodesic");

    let stiffness = random.inertia();
    let stepper = Neumann { stiffness }.stepper(0.05).expect("a sphere");
    let found = last(&stepper, q, momentum(&q, &w));
    let expected = repeat((q, w), |state| sphere::strang(|q| stiffness * q, 0.05, state));
    println!("Neumann: {:.1e}", distance(&found.0, &expected.0));
    assert_near(&found.0, &expected.0, 1e-12, "q in a potential");
    assert_near(&found.1, &momentum(&expected.0, &expected.1), 1e-12, "M in a potential");
}
