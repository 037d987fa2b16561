//! Measured orders. Errors lie between 1e-12 and 1e-1: above round-off, and below where the next power of h shows.

use crate::flat;
use crate::systems;
use clebsch::Clebsch;
use clebsch_tests::fixtures::exact_body::ExactBody;
use clebsch_tests::oracle::motion::{motion, slope};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::hat;
use nalgebra::{Matrix3, Quaternion, SVector, Vector3};

/// How long motions last.
const DURATION: f64 = 4.0;

/// Measures the slope of the error at the end over these numbers of steps, and that several steps at once are the same.
fn assert_order<S: Clebsch<Scalar = f64> + Clone>(
    system: &S,
    (q, mu): (S::Configuration, S::Momentum),
    counts: &[usize],
    error: impl Fn(&S::Configuration, &S::Momentum) -> f64,
) {
    let at = |&steps: &usize| {
        let stepper = system.stepper(DURATION / steps as f64).expect("a regular system");
        let start = stepper.state(q, mu).expect("a state");
        let mut state = start;
        for _ in 0..steps {
            state = stepper.step(&state).expect("a solvable step");
        }
        let at_once = stepper.advance(&start, steps).expect("solvable steps");
        let apart =
            error(at_once.configuration(), &at_once.momentum()) - error(state.configuration(), &state.momentum());
        assert!(apart.abs() < 1e-12, "{}: {steps} steps at once differ by {apart:e}", S::NAME);
        error(state.configuration(), &state.momentum())
    };
    let errors: Vec<f64> = counts.iter().map(at).collect();
    let points: Vec<(f64, f64)> =
        counts.iter().zip(&errors).map(|(&steps, error)| (-(steps as f64).log2(), error.log2())).collect();
    let measured = slope(&points);
    let list: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
    println!("{} of order {}: {measured:.3}, errors {}", S::NAME, S::ORDER, list.join(" "));
    let (first, last) = (errors[0], errors[errors.len() - 1]);
    assert!(last > 2e-13 && first < 0.1, "{}: errors {errors:?} do not show an order", S::NAME);
    let off = (measured - f64::from(S::ORDER)).abs();
    assert!(off < 0.06 * f64::from(S::ORDER), "{}: {measured:.3}, not {}", S::NAME, S::ORDER);
}

fn three<const N: usize>(y: &SVector<f64, N>, at: usize) -> Vector3<f64> {
    Vector3::new(y[at], y[at + 1], y[at + 2])
}

/// R' = R ω^, π' = π × ω + torque(t, R).
fn body(
    inertia: Matrix3<f64>,
    torque: impl Fn(f64, &Matrix3<f64>) -> Vector3<f64>,
    (r, pi): (Matrix3<f64>, Vector3<f64>),
    duration: f64,
) -> SVector<f64, 13> {
    let inverse = inertia.try_inverse().expect("a regular tensor");
    let velocity = |y: &SVector<f64, 13>| {
        let (r, pi) = (Matrix3::from_column_slice(&y.as_slice()[..9]), three(y, 9));
        let omega = inverse * pi;
        flat(&[(r * hat(&omega)).as_slice(), (pi.cross(&omega) + torque(y[12], &r)).as_slice(), &[1.0]])
    };
    motion(velocity, flat(&[r.as_slice(), pi.as_slice(), &[0.0]]), duration, 1000)
}

const MOMENTS: Vector3<f64> = Vector3::new(1.1, 2.0, 2.6);
const MOMENT: Vector3<f64> = Vector3::new(0.6, -0.3, 1.8);

fn start() -> (Matrix3<f64>, Vector3<f64>) {
    (Random::new(51).attitude::<3>(), Vector3::new(1.0, -1.5, 2.0))
}

fn off(r: &Matrix3<f64>, pi: &Vector3<f64>, exact: &SVector<f64, 13>) -> f64 {
    (r - Matrix3::from_column_slice(&exact.as_slice()[..9])).norm() + (pi - three(exact, 9)).norm()
}

/// The rotation matrix of a quaternion.
fn matrix(q: &Quaternion<f64>) -> Matrix3<f64> {
    let v = Vector3::new(q.i, q.j, q.k);
    Matrix3::identity() + hat(&v) * hat(&v) * 2.0 + hat(&v) * (2.0 * q.w)
}

/// One test for each order and system, with the numbers of steps. Each order has two systems or more, and each system two
/// orders or more. The feature `heavy` adds all others.
macro_rules! orders {
    ($name:ident:
        $(#[$of_top:meta])? top $top:expr,
        $(#[$of_quaternions:meta])? quaternions $quaternions:expr, mirrored $mirrored:expr,
        $(#[$of_satellite:meta])? satellite $satellite:expr,
        $(#[$of_flying:meta])? flying $flying:expr,
        $(#[$of_points:meta])? points $points:expr, opaque $opaque:expr
    ) => {
        mod $name {
            use super::*;

            $(#[$of_top])?
            #[test]
            fn a_top() {
                let turn = Random::new(7).attitude::<3>();
                let inertia = turn * Matrix3::from_diagonal(&MOMENTS) * turn.transpose();
                let inertia = (inertia + inertia.transpose()) / 2.0;
                let (weight, center) = (3.0, Vector3::new(0.2, -0.1, 0.6));
                let torque = |_: f64, r: &Matrix3<f64>| r.row(2).transpose().cross(&center) * weight;
                let exact = body(inertia, torque, start(), DURATION);
                assert_order(&systems::$name::Top { inertia, weight, center }, start(), &$top, |r, pi| {
                    off(r, pi, &exact)
                });
            }

            $(#[$of_quaternions])?
            #[test]
            fn quaternions_and_motions_from_the_left() {
                let torque = |_: f64, r: &Matrix3<f64>| r.row(2).transpose().cross(&MOMENT);
                let (r, pi) = start();
                let exact = body(Matrix3::from_diagonal(&MOMENTS), torque, (r, pi), DURATION);
                let rotation = nalgebra::UnitQuaternion::from_matrix(&r).into_inner();
                let top = systems::$name::QuaternionTop { moments: MOMENTS, moment: MOMENT };
                assert_order(&top, (rotation, pi), &$quaternions, |q, pi| off(&matrix(q), pi, &exact));
                // S = Rᵀ moves by S' = −ω^ S: its momentum is −π
                let top = systems::$name::MirroredTop { moments: MOMENTS, moment: MOMENT };
                assert_order(&top, (r.transpose(), -pi), &$mirrored, |s, mu| off(&s.transpose(), &-mu, &exact));
            }

            $(#[$of_satellite])?
            #[test]
            fn a_satellite_that_the_time_turns() {
                let rate = 0.7;
                let torque = |t: f64, r: &Matrix3<f64>| {
                    let zenith = r.transpose() * Vector3::new((rate * t).cos(), (rate * t).sin(), 0.0);
                    zenith.cross(&MOMENTS.component_mul(&zenith)) * (3.0 * rate * rate)
                };
                let exact = body(Matrix3::from_diagonal(&MOMENTS), torque, start(), DURATION);
                let satellite = systems::$name::Satellite { moments: MOMENTS, orbital_rate: rate };
                assert_order(&satellite, start(), &$satellite, |r, pi| off(r, pi, &exact));
            }

            $(#[$of_flying])?
            #[test]
            fn a_body_that_flies() {
                let (mass, hook, stiffness) = (1.5, Vector3::new(0.3, 0.1, -0.4), 2.0);
                let velocity = |y: &SVector<f64, 18>| {
                    let (r, pi) = (Matrix3::from_column_slice(&y.as_slice()[6..15]), three(y, 15));
                    let omega = pi.component_div(&MOMENTS);
                    let pull = -(three(y, 0) + r * hook) * stiffness;
                    let torque = hook.cross(&(r.transpose() * pull));
                    let turned = r * hat(&omega);
                    let pi = pi.cross(&omega) + torque;
                    flat(&[(three(y, 3) / mass).as_slice(), pull.as_slice(), turned.as_slice(), pi.as_slice()])
                };
                let (r, pi) = start();
                let (x, p) = (Vector3::new(0.4, -0.7, 0.2), Vector3::new(0.5, 0.3, -0.6));
                let begin = flat(&[x.as_slice(), p.as_slice(), r.as_slice(), pi.as_slice()]);
                let exact = motion(velocity, begin, DURATION, 1000);
                let momentum = SVector::<f64, 6>::from_iterator(p.iter().chain(pi.iter()).copied());
                let system = systems::$name::Flying { mass, moments: MOMENTS, hook, stiffness };
                assert_order(&system, ((x, r), momentum), &$flying, |(x, r), mu| {
                    let found = flat::<18>(&[x.as_slice(), &mu.as_slice()[..3], r.as_slice(), &mu.as_slice()[3..]]);
                    (found - exact).norm()
                });
            }

            $(#[$of_points])?
            #[test]
            fn a_pendulum() {
                let (gravity, waves) = (2.0, 0.8);
                let gradient = |q: Vector3<f64>| Vector3::new(waves * q.y, waves * q.x, gravity);
                let velocity = |y: &SVector<f64, 6>| {
                    let (q, n) = (three(y, 0), three(y, 3));
                    flat(&[n.cross(&q).as_slice(), (-q.cross(&gradient(q))).as_slice()])
                };
                let q = Vector3::new(0.0, 0.8, -0.6);
                let n = q.cross(&Vector3::new(1.2, 0.3, 0.4));
                let exact = motion(velocity, flat(&[q.as_slice(), n.as_slice()]), DURATION, 1000);
                let off =
                    |q: &Vector3<f64>, n: &Vector3<f64>| (q - three(&exact, 0)).norm() + (n - three(&exact, 3)).norm();
                assert_order(&systems::$name::Pendulum { gravity, waves }, (q, n), &$points, off);
                assert_order(&systems::$name::OpaquePendulum { gravity, waves }, (q, n), &$opaque, off);
            }
        }
    };
}

orders! { second:
    top [256, 512, 1024],
    #[cfg(feature = "heavy")] quaternions [256, 512, 1024], mirrored [256, 512, 1024],
    #[cfg(feature = "heavy")] satellite [256, 512, 1024],
    #[cfg(feature = "heavy")] flying [256, 512, 1024],
    points [128, 256, 512], opaque [128, 256, 512]
}
orders! { fourth:
    top [32, 64, 128],
    quaternions [32, 64, 128], mirrored [32, 64, 128],
    #[cfg(feature = "heavy")] satellite [32, 64, 128],
    flying [32, 64, 128],
    points [16, 32, 64], opaque [16, 32, 64]
}
orders! { sixth:
    top [16, 32, 64],
    #[cfg(feature = "heavy")] quaternions [12, 24, 48], mirrored [12, 24, 48],
    satellite [16, 32, 64],
    #[cfg(feature = "heavy")] flying [16, 32, 64],
    points [12, 24, 48], opaque [16, 32, 64]
}
orders! { eighth:
    #[cfg(feature = "heavy")] top [16, 32],
    quaternions [16, 32], mirrored [16, 32],
    #[cfg(feature = "heavy")] satellite [16, 32],
    flying [16, 32],
    #[cfg(feature = "heavy")] points [12, 24, 48], opaque [12, 24, 48]
}
orders! { sixteenth:
    top [4, 5, 6, 7],
    #[cfg(feature = "heavy")] quaternions [3, 4, 5], mirrored [4, 5, 6, 7],
    satellite [6, 7, 8],
    #[cfg(feature = "heavy")] flying [4, 5, 6, 7],
    points [4, 5, 6, 7], opaque [4, 5, 6, 7]
}

/// A free body has no error in h, whatever the step: turns of 0.02 to 9 rad a step.
#[test]
fn a_free_body_is_exact_at_any_step_size() {
    let moments = Vector3::new(1.0, 2.0, 3.0);
    let duration = 8.0;
    let near = 0.75_f64.sqrt();
    // about each axis, across, and on the separatrix, where energy is |π|²/(2 J₂)
    let starts = [[0.1, 0.2, 2.0], [2.0, 0.1, 0.1], [0.01, 2.0, 0.02], [1.0, -1.5, 2.0], [0.5, 2.0, near]];
    for pi in starts.map(Vector3::from) {
        let r = Random::new(3).attitude::<3>();
        let exact = body(Matrix3::from_diagonal(&moments), |_, _| Vector3::zeros(), (r, pi), duration);
        for steps in [1, 3, 8, 64, 512] {
            let stepper = ExactBody { moments }.stepper(duration / f64::from(steps)).expect("a regular body");
            let mut state = stepper.state(r, pi).expect("a state");
            for _ in 0..steps {
                state = stepper.step(&state).expect("a step");
            }
            let error = off(state.configuration(), &state.momentum(), &exact);
            assert!(error < 1e-12, "{steps} steps from {pi:?}: {error:e}");
        }
    }
}
