//! Derivatives of the steps of a method, and paths of least action in them: those of a struct that is declared with its dials.

use clebsch::{Clebsch, Differentiated, Guess, Sensitive, Stepper, Variational};
use nalgebra::{SVector, Vector3};

use crate::equal::{attitude, print};
use crate::systems::{varied, varied_top};

/// The derivatives of a few steps from (q, N).
fn derivatives<S, B, const M: usize, const P: usize>(
    stepper: &Stepper<S, B>,
    q: &S::Configuration,
    mu: &SVector<f64, M>,
) -> Vec<String>
where
    S: Sensitive<M, P> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
    B: Differentiated<S, M>,
{
    let mut state = stepper.state(*q, *mu).expect("a state");
    let mut told = Vec::new();
    for _ in 0..5 {
        let (next, tangent, sensitivity) = stepper.step_sensitivity::<P>(&state).expect("a step");
        assert_eq!(stepper.step_tangent(&state).expect("a step"), (next, tangent));
        told.push(print((next.configuration(), next.momentum(), tangent, sensitivity)));
        state = next;
    }
    told
}

macro_rules! assert_equal {
    ($module:ident $fields:tt, $dimension:literal, $quantities:literal, $q:expr, $mu:expr, [$($method:ident)*]) => { $({
        let together = $module::together::System $fields.into_stepper_by::<$module::together::$method>(0.02);
        let apart = $module::apart::$method $fields.into_stepper(0.02);
        let one = derivatives::<_, _, $dimension, $quantities>(&together.expect("a system"), &$q, &$mu);
        let other = derivatives::<_, _, $dimension, $quantities>(&apart.expect("a system"), &$q, &$mu);
        for (step, (one, other)) in one.iter().zip(&other).enumerate() {
            assert_eq!(one, other, "step {step} of {}", stringify!($module $method));
        }
    })* };
}

#[test]
fn tangent_maps() {
    let q = Vector3::new(0.6, 0.0, -0.8);
    assert_equal!(varied { gravity: 9.81 }, 3, 2, q, Vector3::new(0.4, 0.5, 0.3), [First Second]);
    assert_equal!(
        varied_top { moments: Vector3::new(1.0, 2.0, 2.5), weight: 3.0, center: Vector3::new(0.1, 0.0, 0.7) },
        3, 8, attitude(), Vector3::new(0.5, -2.0, 4.0), [First Charted Fourth]
    );
}

/// A throw of the bob from one point to another.
fn throw<S, B>(stepper: &Stepper<S, B>) -> String
where
    S: Variational<3> + Clebsch<Scalar = f64, Configuration = Vector3<f64>, Momentum = Vector3<f64>>,
    B: Differentiated<S, 3>,
{
    let (from, to) = (Vector3::new(0.0, 0.6, -0.8), Vector3::new(0.8, 0.0, 0.6));
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&from); 20];
    let extremal = boundary.solve(&from, &to, Guess::Geodesic, &mut path).expect("an extremal");
    let last = stepper.advance(&extremal.states().next().expect("a state"), 20).expect("steps");
    assert!((last.configuration() - to).norm() < 1e-12, "the method of the path steps along it");
    print((extremal.action(), extremal.iterations(), extremal.momentum(), extremal.final_momentum()))
}

#[test]
fn fixed_endpoints() {
    let together = || varied::together::System { gravity: 9.81 };
    let by_method = throw(&together().into_stepper_by::<varied::together::First>(0.02).expect("a pendulum"));
    let apart = varied::apart::First { gravity: 9.81 };
    assert_eq!(by_method, throw(&apart.into_stepper(0.02).expect("a pendulum")));
    assert_ne!(by_method, throw(&together().into_stepper(0.02).expect("a pendulum")), "another method");
}

/// A method whose steps have no derivatives may stand next to those that have.
#[test]
fn some_methods_have_no_derivatives() {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action    = |F: SO<3>, q: Unit<Vector3>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| self.gravity * q.z,
        emit      = [boundary, tangent],
        method Sixteenth = (order = 16),
    )]
    struct Pendulum {
        gravity: f64,
    }
    struct Sixteenth;

    let system = Pendulum { gravity: 9.81 };
    let (q, mu) = (Vector3::new(0.6, 0.0, -0.8), Vector3::new(0.4, 0.5, 0.3));
    let (stepper, exact) = (system.stepper(1e-3).expect("a pendulum"), system.stepper_by::<Sixteenth>(0.1));
    let exact = exact.expect("a pendulum");
    let late = stepper.advance(&stepper.state(q, mu).expect("a state"), 100).expect("steps");
    let by_sixteenth = exact.step(&exact.state(q, mu).expect("a state")).expect("a step");
    assert!((late.configuration() - by_sixteenth.configuration()).norm() < 1e-5);
    assert!(stepper.step_tangent(&late).is_ok());
}
