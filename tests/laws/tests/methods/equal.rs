//! The same bits, whichever way a method is declared.

use clebsch::{Clebsch, Method, Stepper};
use nalgebra::{Matrix3, SVector, Vector3};

use crate::systems::{driven, free, pendulum, sphere, top};

const STEPS: usize = 100;

/// Debug prints show every bit of a number.
pub fn print(value: impl std::fmt::Debug) -> String {
    format!("{value:?}")
}

/// All that a stepper gives from (q, N).
fn told<S: Clebsch<Scalar = f64>, M: Method<S>>(
    stepper: &Stepper<S, M>,
    q: &S::Configuration,
    mu: &S::Momentum,
    p: &S::Configuration,
) -> Vec<String> {
    let start = stepper.state(*q, *mu).expect("a state");
    let late: Vec<_> = stepper.trajectory(start).take(STEPS).map(|state| print(state.expect("a step"))).collect();
    let last = stepper.advance(&start, STEPS).expect("steps");
    let element = stepper.inverse_legendre_at(0.25, q, mu).expect("a step");
    let covector = stepper.cotangent_state(*q, *p).expect("a state");
    let told = [
        print(stepper.energy(&last)),
        print(stepper.synchronized(&last)),
        print(stepper.synchronized_energy(&last)),
        print(last),
        print(stepper.legendre_at(0.25, q, &element)),
        print(stepper.legendre_next_at(0.25, q, &element)),
        print(element),
        print(stepper.step_symmetric(&covector)),
        print(M::ORDER),
        print(M::IS_FREE_MOTION),
    ];
    late.into_iter().chain(told).collect()
}

/// The error of a step that is too long for its momentum.
fn refused<S: Clebsch<Scalar = f64>, M: Method<S>>(
    stepper: &Stepper<S, M>,
    q: &S::Configuration,
    mu: &S::Momentum,
) -> String {
    print(stepper.state(*q, *mu).and_then(|state| stepper.advance(&state, STEPS)))
}

macro_rules! assert_equal {
    ($module:ident $fields:tt, $q:expr, $mu:expr, $p:expr, $h:expr, [$($method:ident)*]) => { $({
        let together = $module::together::System $fields;
        let apart = $module::apart::$method $fields;
        let (q, mu, p) = ($q, $mu, $p);
        let one = together.stepper_by::<$module::together::$method>($h).expect("a system");
        let other = apart.stepper($h).expect("a system");
        for (one, other) in told(&one, &q, &mu, &p).iter().zip(&told(&other, &q, &mu, &p)) {
            assert_eq!(one, other, stringify!($module $method));
        }
        let one = together.stepper_by::<$module::together::$method>(30.0 * $h).expect("a system");
        let other = apart.stepper(30.0 * $h).expect("a system");
        assert_eq!(refused(&one, &q, &(10.0 * mu)), refused(&other, &q, &(10.0 * mu)), stringify!($module $method));
        let name = concat!("System by ", stringify!($method));
        assert_eq!(
            <$module::together::$method as Method<$module::together::System>>::DERIVATION,
            <$module::apart::$method as Clebsch>::DERIVATION.replacen(stringify!($method), name, 1),
        );
    })* };
}

pub fn attitude() -> Matrix3<f64> {
    *nalgebra::Rotation3::from_euler_angles(0.3, 1.1, -0.4).matrix()
}

#[test]
fn tops() {
    assert_equal!(
        top { moments: Vector3::new(1.0, 2.0, 2.5), weight: 3.0, center: Vector3::new(0.1, 0.0, 0.7) },
        attitude(), Vector3::new(0.5, -2.0, 4.0), attitude() * Matrix3::new(0.0, 1.0, 2.0, -1.0, 0.0, 0.5, -2.0, -0.5, 0.0), 0.02,
        [Fine Rough First Second Fourth Charted Tolerant Sixteenth Written]
    );
}

#[test]
fn free_bodies() {
    assert_equal!(
        free { moments: Vector3::new(1.0, 2.0, 2.5) },
        attitude(), Vector3::new(0.5, -2.0, 4.0), attitude() * Matrix3::new(0.0, 1.0, 2.0, -1.0, 0.0, 0.5, -2.0, -0.5, 0.0), 0.02,
        [Exact Kept Sixth]
    );
}

#[test]
fn pendulums() {
    let q = Vector3::new(0.6, 0.0, -0.8);
    assert_equal!(
        pendulum { gravity: 9.81 },
        q, Vector3::new(0.4, 0.5, 0.3), Vector3::new(0.1, 0.2, 0.3), 0.02,
        [First Second Eighth]
    );
}

#[test]
fn points_on_large_spheres() {
    let q = SVector::<f64, 9>::from_fn(|i, _| if i == 0 { 1.0 } else { 0.0 });
    let p = SVector::<f64, 9>::from_fn(|i, _| if i == 0 { 0.0 } else { 0.1 * i as f64 });
    let system = sphere::together::System { gravity: 9.81 };
    let mu = system.momentum_map(&q, &p);
    assert_equal!(sphere { gravity: 9.81 }, q, mu, p, 0.02, [First Second Fourth]);
}

#[test]
fn driven_particles() {
    assert_equal!(
        driven { amplitude: 0.7 },
        Vector3::new(0.6, 0.0, -0.8), Vector3::new(0.4, 0.5, 0.3), Vector3::new(0.1, 0.2, 0.3), 0.02,
        [First Sixth]
    );
}
