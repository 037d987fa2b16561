//! Steps of order 4, 6 and 8: measured orders on nonlinear problems, against exact motions, and the invariants of every
//! order.
//!
//! Errors lie between 1e-12 and 1e-1. This is above round-off, and below where the next power of h shows by more than a
//! tenth of an order or two.

use crate::flat;
use clebsch::{Clebsch, Error};
use clebsch_tests::oracle::motion::{motion, order};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::hat;
use nalgebra::{Matrix3, SVector, Vector2, Vector3};

/// Measures the slope of the error at the end over these numbers of steps.
fn assert_order<S: Clebsch<Scalar = f64> + Clone>(
    system: &S,
    (q, mu): (S::Configuration, S::Momentum),
    input: &S::Input,
    counts: &[usize],
    error: impl Fn(&S::Configuration, &S::Momentum) -> f64,
) {
    let at = |&steps: &usize| {
        let stepper = system.stepper(DURATION / steps as f64).expect("a regular system");
        let mut state = stepper.state(q, mu).expect("a state");
        for _ in 0..steps {
            state = stepper.step_with(&state, input).expect("a solvable step");
        }
        error(state.configuration(), &state.momentum())
    };
    let errors: Vec<f64> = counts.iter().map(at).collect();
    let measured = order(&errors);
    let list: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
    println!("{} of order {}: {measured:.3}, errors {}", S::NAME, S::ORDER, list.join(" "));
    let (first, last) = (errors[0], errors[errors.len() - 1]);
    assert!(last > 2e-13 && first < 0.1, "{}: errors {errors:?} do not show an order", S::NAME);
    let off = (measured - f64::from(S::ORDER)).abs();
    assert!(off < 0.05 * f64::from(S::ORDER), "{}: {measured:.3}, not {}", S::NAME, S::ORDER);
}

/// The numbers of steps over which the error of an order falls from a part of the motion to where rounding is far.
fn counts(order: u32) -> [usize; 3] {
    match order {
        4 => [96, 192, 384],
        6 => [32, 64, 128],
        _ => [16, 32, 64],
    }
}

/// How long motions last.
const DURATION: f64 = 4.0;

fn three<const N: usize>(y: &SVector<f64, N>, at: usize) -> Vector3<f64> {
    Vector3::new(y[at], y[at + 1], y[at + 2])
}

/// R' = R ω^, π' = π × ω + torque(R, ω).
fn body(
    inertia: Matrix3<f64>,
    torque: impl Fn(&Matrix3<f64>, &Vector3<f64>) -> Vector3<f64>,
    (r, pi): (Matrix3<f64>, Vector3<f64>),
) -> SVector<f64, 12> {
    let inverse = inertia.try_inverse().expect("a regular tensor");
    let velocity = |y: &SVector<f64, 12>| {
        let (r, pi) = (Matrix3::from_column_slice(&y.as_slice()[..9]), three(y, 9));
        let omega = inverse * pi;
        flat(&[(r * hat(&omega)).as_slice(), (pi.cross(&omega) + torque(&r, &omega)).as_slice()])
    };
    motion(velocity, flat(&[r.as_slice(), pi.as_slice()]), DURATION, 1000)
}

/// The tests of one order. That of six is for the feature `heavy` alone: chains with constraints measure it by default.
macro_rules! orders {
    ($name:ident, $order:literal) => {
        mod $name {
            use super::*;
            use crate::systems::$name::{Damped, Driven, Lopsided, Pendulum, Top};

            #[test]
            fn a_top() {
                let inertia = Matrix3::new(1.1, 0.1, 0.0, 0.1, 2.0, -0.2, 0.0, -0.2, 2.6);
                let (weight, center) = (3.0, Vector3::new(0.2, -0.1, 0.6));
                let start = (Random::new(51).attitude::<3>(), Vector3::new(1.0, -1.5, 2.0));
                let exact = body(inertia, |r, _| -weight * center.cross(&(r.transpose() * Vector3::z())), start);
                let error =
                    |r: &Matrix3<f64>, pi: &Vector3<f64>| (flat::<12>(&[r.as_slice(), pi.as_slice()]) - exact).amax();
                assert_order(&Top { inertia, weight, center }, start, &(), &counts($order), error);
            }

            #[test]
            fn a_pendulum() {
                let (q, n, gravity) = (Vector3::y(), Vector3::new(1.0, 0.0, 0.5), 2.0);
                let velocity = |y: &SVector<f64, 6>| {
                    let (q, n) = (three(y, 0), three(y, 3));
                    flat(&[n.cross(&q).as_slice(), (-q.cross(&Vector3::z()) * gravity).as_slice()])
                };
                let exact = motion(velocity, flat(&[q.as_slice(), n.as_slice()]), DURATION, 1000);
                let error =
                    |q: &Vector3<f64>, mu: &Vector3<f64>| (flat::<6>(&[q.as_slice(), mu.as_slice()]) - exact).amax();
                assert_order(&Pendulum { gravity }, (q, n), &(), &counts($order), error);
            }

            #[test]
            fn a_driven_particle() {
                let (x, p, rate) = (Vector2::new(1.0, 0.2), Vector2::new(0.3, 0.8), 3.0);
                let velocity = |y: &SVector<f64, 5>| {
                    let (x, p, t) = (Vector2::new(y[0], y[1]), Vector2::new(y[2], y[3]), y[4]);
                    let force = -x * x.norm_squared() + Vector2::x() * (rate * t).cos();
                    flat(&[p.as_slice(), force.as_slice(), &[1.0]])
                };
                let exact = motion(velocity, flat(&[x.as_slice(), p.as_slice(), &[0.0]]), DURATION, 1000);
                let error = |x: &Vector2<f64>, p: &Vector2<f64>| {
                    (flat::<4>(&[x.as_slice(), p.as_slice()]) - exact.fixed_rows::<4>(0)).amax()
                };
                // order 6 is a splitting here: in the steps of a composition its error is rounding
                let counts = if $order == 6 { [16, 32, 64] } else { counts($order) };
                assert_order(&Driven { rate }, (x, p), &(), &counts, error);
            }

            #[test]
            fn a_cost_that_is_not_its_own_adjoint() {
                let (x, p, stiffness) = (Vector2::new(1.0, 0.2), Vector2::new(0.3, 0.8), 3.0);
                let velocity = |y: &SVector<f64, 4>| {
                    let (x, p) = (Vector2::new(y[0], y[1]), Vector2::new(y[2], y[3]));
                    flat(&[p.as_slice(), (-x * (stiffness * x.norm_squared())).as_slice()])
                };
                let exact = motion(velocity, flat(&[x.as_slice(), p.as_slice()]), DURATION, 1000);
                let error =
                    |x: &Vector2<f64>, p: &Vector2<f64>| (flat::<4>(&[x.as_slice(), p.as_slice()]) - exact).amax();
                assert_order(&Lopsided { stiffness }, (x, p), &(), &counts($order), error);
            }

            #[test]
            fn a_damped_body() {
                let (inertia, damping) = (Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6)), 0.4);
                let torque = Vector3::new(0.5, -0.3, 0.8);
                let start = (Random::new(52).attitude::<3>(), Vector3::new(1.0, -1.5, 2.0));
                let exact = body(inertia, |_, omega| torque - omega * damping, start);
                let error =
                    |r: &Matrix3<f64>, pi: &Vector3<f64>| (flat::<12>(&[r.as_slice(), pi.as_slice()]) - exact).amax();
                assert_order(&Damped { inertia, damping }, start, &torque, &counts($order), error);
            }

            /// The vertical momentum and the group stay to rounding, the step is reversible, and (q, p) goes where (q,
            /// N) goes.
            #[test]
            fn what_is_kept() -> Result<(), Error> {
                let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6));
                let top = Top { inertia, weight: 3.0, center: Vector3::new(0.2, -0.1, 0.6) };
                let (forward, back) = (top.stepper(0.05)?, top.stepper(-0.05)?);
                let start = forward.state(Random::new(53).attitude::<3>(), Vector3::new(1.0, -1.5, 2.0))?;
                let vertical = |state: &clebsch::State<Top>| (state.configuration() * state.momentum()).z;
                let mut state = start;
                for _ in 0..200 {
                    state = forward.step(&state)?;
                }
                assert!((vertical(&state) - vertical(&start)).abs() < 1e-12);
                let defect = state.configuration().transpose() * state.configuration() - Matrix3::identity();
                assert!(defect.amax() < 1e-12);
                for _ in 0..200 {
                    state = back.step(&state)?;
                }
                assert!((state.configuration() - start.configuration()).amax() < 1e-9);
                assert!((state.momentum() - start.momentum()).amax() < 1e-9);

                let pendulum = Pendulum { gravity: 2.0 };
                let stepper = pendulum.stepper(0.05)?;
                let (q, p) = (Vector3::y(), Vector3::new(0.3, 0.0, -0.8));
                let mut covector = stepper.cotangent_state(q, p)?;
                let mut state = stepper.state(q, pendulum.momentum_map(&q, &p))?;
                for _ in 0..50 {
                    (covector, state) = (stepper.step_symmetric(&covector)?, stepper.step(&state)?);
                }
                assert!((covector.configuration() - state.configuration()).amax() < 1e-12);
                let momentum = pendulum.momentum_map(covector.configuration(), covector.covector());
                assert!((momentum - state.momentum()).amax() < 1e-12);
                Ok(())
            }
        }
    };
}

orders!(fourth, 4);
#[cfg(feature = "heavy")]
orders!(sixth, 6);
orders!(eighth, 8);
