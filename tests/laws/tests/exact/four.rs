//! Bodies in four dimensions, whose steps have no error either.

use clebsch::{Clebsch, Error, Scalar};
use clebsch_tests::fixtures::exact_body4::ExactBody4;
use clebsch_tests::oracle::motion::motion;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix4, SVector, Vector4, Vector6};

/// The same, moved from the other side.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<4>, S: SO<4>| F * S,
    lagrangian     = |xi| (Matrix4::from_diagonal(&self.mass) * xi.matrix() * xi.matrix().transpose()).trace() / 2,
    discretization = exact,
)]
struct Mirrored {
    mass: Vector4<f64>,
}

/// A body over any scalar.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<4>, R: SO<4>| R * F,
    lagrangian     = |xi| (self.mass * xi.matrix() * xi.matrix().transpose()).trace() / 2,
    discretization = exact,
)]
struct Body<T: Scalar> {
    #[clebsch(symmetric)]
    mass: Matrix4<T>,
}

const PLANES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// The skew matrix with Ω_ji = ξ_(ij).
fn wedge(xi: &Vector6<f64>) -> Matrix4<f64> {
    let mut matrix = Matrix4::zeros();
    for (&(i, j), entry) in PLANES.iter().zip(xi.iter()) {
        (matrix[(j, i)], matrix[(i, j)]) = (*entry, -*entry);
    }
    matrix
}

fn start() -> (Matrix4<f64>, Vector6<f64>) {
    (Random::new(52).attitude::<4>(), Vector6::new(0.6, -1.0, 0.4, 1.2, -0.2, 1.0))
}

fn mass() -> Matrix4<f64> {
    let turn = Random::new(9).attitude::<4>();
    turn * Matrix4::from_diagonal(&Vector4::new(1.0, 1.5, 2.0, 2.5)) * turn.transpose()
}

/// R and the components of M after a time: R′ = RΩ, M′ = MΩ − ΩM with 2M = DΩ + ΩD, in principal axes.
fn followed(d: &Vector4<f64>, (r, mu): (Matrix4<f64>, Vector6<f64>), duration: f64) -> (Matrix4<f64>, Vector6<f64>) {
    let rate = |y: &SVector<f64, 22>| {
        let (r, mu) = (Matrix4::from_column_slice(&y.as_slice()[..16]), y.fixed_rows::<6>(16).into_owned());
        let omega = wedge(&Vector6::from_fn(|e, _| mu[e] / (d[PLANES[e].0] + d[PLANES[e].1])));
        let (turned, m) = (r * omega, wedge(&mu));
        let change = m * omega - omega * m;
        let change = PLANES.map(|(i, j)| change[(j, i)]);
        SVector::<f64, 22>::from_iterator(turned.iter().chain(&change).copied())
    };
    let y = SVector::<f64, 22>::from_iterator(r.iter().chain(mu.iter()).copied());
    let end = motion(rate, y, duration, 2000);
    (Matrix4::from_column_slice(&end.as_slice()[..16]), end.fixed_rows::<6>(16).into_owned())
}

#[test]
fn a_body_is_exact_at_any_step_size() {
    let d = Vector4::new(1.0, 1.5, 2.0, 2.5);
    let (r, mu) = start();
    let exact = followed(&d, (r, mu), 12.0);
    for steps in [1, 3, 12, 100] {
        let h = 12.0 / f64::from(steps);
        let stepper = ExactBody4 { mass: Matrix4::from_diagonal(&d) }.stepper(h).expect("regular");
        let start = stepper.state(r, mu).expect("a state");
        let ends = [
            stepper.trajectory(start).nth(steps as usize).expect("there").expect("steps"),
            stepper.advance(&start, steps as usize).expect("steps"),
        ];
        for end in ends {
            let error = (end.configuration() - exact.0).norm() + (end.momentum() - exact.1).norm();
            assert!(error < 2e-12, "{steps}: {error:e}");
        }
    }
}

/// S = Rᵀ moves by Fᵀ from the left, and its spatial momentum is −M.
#[test]
fn both_sides_agree() {
    let d = Vector4::new(1.0, 1.5, 2.0, 2.5);
    let (r, mu) = start();
    let exact = followed(&d, (r, mu), 3.0);
    let stepper = Mirrored { mass: d }.stepper(0.5).expect("regular");
    let end = stepper.advance(&stepper.state(r.transpose(), -mu).expect("a state"), 6).expect("steps");
    assert!((end.configuration().transpose() - exact.0).norm() < 2e-12);
    assert!((end.momentum() + exact.1).norm() < 2e-12);
}

/// Turned axes, another step size, the cotangent bundle and the Legendre transforms: one motion.
#[test]
fn all_ways_lead_to_the_same_place() {
    let (r, mu) = start();
    let body = ExactBody4 { mass: mass() };
    let (whole, half) = (body.stepper(1.0).expect("regular"), body.stepper(0.5).expect("regular"));
    let state = whole.state(r, mu).expect("a state");
    let next = whole.step(&state).expect("a step");
    // a state of another stepper brings along the constants of another step
    let twice = half.advance(&state, 2).expect("steps");
    assert!((next.configuration() - twice.configuration()).norm() < 1e-14);
    assert!((next.momentum() - twice.momentum()).norm() < 1e-14);
    // ⟨p, RΩ⟩ = ½ ⟨RM, RΩ⟩ summed over both halves of M
    let p = r * wedge(&mu) / 2.0;
    let lifted = whole.step_symmetric(&whole.cotangent_state(r, p).expect("a state")).expect("a step");
    assert!((lifted.configuration() - next.configuration()).norm() < 1e-14);
    assert!((body.momentum_map(lifted.configuration(), lifted.covector()) - next.momentum()).norm() < 1e-14);
    let f = r.transpose() * next.configuration();
    assert!((body.legendre(1.0, 0.0, &r, &f) - mu).norm() < 1e-12);
    assert!((body.legendre_next(1.0, 0.0, &r, &f) - next.momentum()).norm() < 1e-12);
}

#[test]
fn invariants_stay() {
    let (r, mu) = start();
    let stepper = ExactBody4 { mass: mass() }.stepper(1.5).expect("regular");
    let state = stepper.state(r, mu).expect("a state");
    let end = stepper.advance(&state, 10_000).expect("steps");
    let spatial = |r: &Matrix4<f64>, mu: &Vector6<f64>| r * wedge(mu) * r.transpose();
    let moved = spatial(end.configuration(), &end.momentum()) - spatial(&r, &mu);
    assert!(moved.norm() < 1e-11, "{:e}", moved.norm());
    assert!((stepper.energy(&end) / stepper.energy(&state) - 1.0).abs() < 1e-12);
}

#[test]
fn single_precision_and_errors() {
    let body = Body { mass: mass().map(|entry| entry as f32) };
    let (r, mu) = start();
    let stepper = body.stepper(0.5).expect("regular");
    let state = stepper.state(r.map(|entry| entry as f32), mu.map(|entry| entry as f32)).expect("a state");
    let end = stepper.advance(&state, 20).expect("steps");
    let wide = Body { mass: mass() }.stepper(0.5).expect("regular");
    let wanted = wide.advance(&wide.state(r, mu).expect("a state"), 20).expect("steps");
    assert!((end.configuration().map(f64::from) - wanted.configuration()).norm() < 1e-4);

    let far = wide.state(r, mu * 1e6).expect("a state");
    assert!(matches!(wide.step(&far), Err(Error::Unsolvable { step_size: Some(0.5), .. })));
    assert!(matches!(wide.advance(&far, 3), Err(Error::Unsolvable { .. })));
    let flat = ExactBody4 { mass: Matrix4::from_diagonal(&Vector4::new(0.0, 0.0, 1.0, 2.0)) };
    assert!(matches!(flat.stepper(0.5), Err(Error::SingularKineticEnergy { .. })));
}
