//! States that go from one method to another.

use clebsch::{Clebsch, Declared, Error, Method, State, Stepper};
use clebsch_tests::fixtures::three_ways::{Fine, Quick, ThreeWays};
use nalgebra::{Matrix3, Vector3};

use crate::systems::driven;

fn top() -> ThreeWays {
    ThreeWays { moments: Vector3::new(2.0, 2.0, 1.0), weight: 3.0, center: Vector3::new(0.0, 0.0, 0.5) }
}

/// Code that is written for any system uses the declared dials, and code that is written for any method uses all.
fn energy<S: Clebsch<Scalar = f64>>(stepper: &Stepper<S>, state: &State<S>) -> f64 {
    stepper.energy(state)
}

fn late_energy<S: Clebsch<Scalar = f64>, M: Method<S>>(stepper: &Stepper<S, M>, state: &State<S, M>) -> f64 {
    stepper.synchronized_energy(&stepper.advance(state, 50).expect("steps"))
}

#[test]
fn the_declared_dials_are_a_method() {
    let by_name: Stepper<ThreeWays, Declared> = top().stepper_by(0.01).expect("a top");
    let stepper: Stepper<ThreeWays> = top().stepper(0.01).expect("a top");
    let start = stepper.state(Matrix3::identity(), Vector3::new(0.1, 0.0, 6.0)).expect("a state");
    assert_eq!(stepper.step(&start), by_name.step(&start));
    assert_eq!(energy(&stepper, &start), energy(&by_name, &start));
    let of = |order: u32, derivation: &str| (order, derivation.lines().next().map(String::from));
    assert_eq!((ThreeWays::ORDER, <Fine as Method<ThreeWays>>::ORDER, <Quick as Method<ThreeWays>>::ORDER), (2, 6, 1));
    assert_eq!(of(2, ThreeWays::DERIVATION), (2, Some("ThreeWays".into())));
    assert_eq!(of(6, <Fine as Method<ThreeWays>>::DERIVATION), (6, Some("ThreeWays by Fine".into())));
}

/// A state and the reading of it by a method are the same body: q and the momentum that belongs to it.
#[test]
fn states_convert_by_the_synchronised_momentum() {
    let second = top().stepper(0.01).expect("a top");
    let fine = top().stepper_by::<Fine>(0.05).expect("a top");
    let quick = top().stepper_by::<Quick>(0.002).expect("a top");
    let start = second.state(Matrix3::identity(), Vector3::new(2.0, 0.0, 6.0)).expect("a state");
    let start = second.advance(&start, 33).expect("steps");
    let by_fine = fine.state_of(&second, &start).expect("a state");
    assert_eq!((by_fine.configuration(), by_fine.momentum()), (start.configuration(), start.momentum()));
    let by_quick = quick.state_of(&fine, &by_fine).expect("a state");
    assert!((by_quick.momentum() - start.momentum()).norm() > 1e-4, "half a kick ahead");
    let back = second.state_of(&quick, &by_quick).expect("a state");
    assert!((back.momentum() - start.momentum()).norm() < 1e-14);
    let whole = second.energy(&start);
    assert!((late_energy(&fine, &by_fine) - whole).abs() < 1e-6);
    assert!((late_energy(&quick, &by_quick) - whole).abs() < 1e-3);
}

#[test]
fn converted_states_have_their_time() {
    let system = driven::together::System { amplitude: 0.7 };
    let coarse = system.stepper(0.1).expect("a particle");
    let fine = system.stepper_by::<driven::together::Sixth>(0.1).expect("a particle");
    let state = coarse.state_at(0.5, Vector3::x(), Vector3::y()).expect("a state");
    let late = coarse.advance(&state, 7).expect("steps");
    assert_eq!(fine.state_of(&coarse, &late).expect("a state").time(), late.time());
}

#[test]
fn what_has_left_its_space_is_refused() {
    let near = top().stepper(0.01).expect("a top");
    let heavy = ThreeWays { weight: f64::MAX, ..top() }.stepper_by::<Quick>(0.5).expect("a top");
    let start = near.state(Matrix3::identity(), Vector3::new(0.1, 0.0, 6.0)).expect("a state");
    let far = ThreeWays { center: Vector3::new(1e200, 0.0, 0.0), ..heavy.system().clone() };
    let found = far.stepper_by::<Quick>(0.5).and_then(|stepper| stepper.state_of(&near, &start));
    assert!(matches!(found, Err(Error::NotFinite { .. })), "{found:?}");
}
