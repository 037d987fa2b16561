//! Entry points other than steps, given numbers that are broken or extreme: a typed error, or a finite result.

use clebsch::{Clebsch, Controlled, Error, Guess, Space, Target};
use clebsch_tests::fixtures::gravity_gradient::GravityGradient;
use clebsch_tests::fixtures::regulator::Regulator;
use clebsch_tests::fixtures::watched_top::WatchedTop;
use nalgebra::{Matrix3, Vector1, Vector2, Vector3};

const BROKEN: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const EXTREME: [f64; 8] = [1e150, -1e150, 1e200, f64::MAX, f64::MIN, 1e-200, f64::MIN_POSITIVE, 5e-324];

fn watched(weight: f64) -> WatchedTop {
    WatchedTop { mass: Vector3::new(1.0, 1.4, 1.9), weight }
}

#[test]
fn derivatives_are_finite_or_refused() {
    let (r, mut refused) = (Matrix3::identity(), 0);
    for value in EXTREME {
        let mass = Vector3::new(value, 1.4, 1.9);
        for (system, mu) in [
            (watched(value), Vector3::x()),
            (watched(1.0), Vector3::x() * value),
            (WatchedTop { mass, weight: 1.0 }, Vector3::y()),
        ] {
            for h in [0.1, value] {
                let Ok(stepper) = system.stepper(h) else { continue };
                let Ok(state) = stepper.state(r, mu) else { continue };
                match stepper.step_sensitivity(&state) {
                    Ok((next, tangent, sensitivity)) => {
                        let is_finite = next.configuration().all_finite() && next.momentum().all_finite();
                        let (a, b) = (tangent.motion_by_motion, tangent.motion_by_momentum);
                        let (c, d) = (tangent.momentum_by_motion, tangent.momentum_by_momentum);
                        assert!(
                            is_finite && [a, b, c, d].iter().all(|part| part.all_finite()),
                            "{system:?}, {mu}, {h}"
                        );
                        assert!(
                            sensitivity.motion.all_finite() && sensitivity.momentum.all_finite(),
                            "{system:?} {mu} {h}"
                        );
                    }
                    Err(_) => refused += 1,
                }
                assert_eq!(stepper.step_tangent(&state).is_err(), stepper.step_tangent_with(&state, &()).is_err());
            }
        }
    }
    assert!(refused > 5, "{refused}");
}

#[test]
fn times_are_finite() {
    let body = GravityGradient { inertia: Matrix3::identity(), orbital_rate: 0.8 };
    let (r, mu) = (Matrix3::identity(), Vector3::x());
    let stepper = body.stepper(0.1).expect("a body");
    for bad in BROKEN {
        let name = Error::NotFinite { name: "the time" };
        assert_eq!(stepper.state_at(bad, r, mu).err(), Some(name));
        assert_eq!(stepper.staggered_state_at(bad, r, mu).err(), Some(name));
        assert_eq!(stepper.cotangent_state_at(bad, r, r).err(), Some(name));
        assert_eq!(stepper.inverse_legendre_at(bad, &r, &mu).err(), Some(name));
    }
    // the clock overflows: the first half of a step is still finite
    let still = GravityGradient { inertia: Matrix3::identity() * 1e300, orbital_rate: 0.0 };
    let stepper = still.into_stepper(1e308).expect("a body");
    let late = stepper.state_at(f64::MAX, r, mu * 1e-10).expect("a state");
    let error = Some(Error::NotFinite { name: "the time after the step" });
    assert_eq!(stepper.step(&late).err(), error);
    assert_eq!(stepper.advance(&late, 1).err(), error);
}

#[test]
fn suggestions_end() {
    let stepper = watched(1.0).into_stepper(0.1).expect("a top");
    let state = stepper.state(Matrix3::identity(), Vector3::new(0.3, 0.2, 1.0)).expect("a state");
    for bad in [f64::NAN, f64::INFINITY, 0.0] {
        let refused = stepper.suggest_step_size(&state, 1e-3, bad);
        assert!(matches!(refused, Err(Error::NotFinite { .. })), "{bad}: {refused:?}");
    }
    for error in BROKEN.into_iter().chain(EXTREME) {
        for duration in [1.0, 1e150, 1e-200] {
            if let Ok(h) = stepper.suggest_step_size(&state, error, duration) {
                assert!(h.is_finite() && h != 0.0, "an error of {error} in {duration}: {h}");
            }
        }
    }
}

#[test]
fn endpoints_and_guesses_are_finite() {
    let stepper = watched(1.0).into_stepper(0.1).expect("a top");
    let (boundary, r) = (stepper.boundary(), Matrix3::identity());
    let mut path = [boundary.rest(&r); 4];
    for value in BROKEN.into_iter().chain(EXTREME) {
        let named = |name| (!value.is_finite()).then_some(Error::NotFinite { name });
        let velocity = Guess::Velocity(Vector3::x() * value);
        for (result, error) in [
            (
                boundary.solve(&(r * value), &r, Guess::Geodesic, &mut path).map(|found| found.action()),
                named("the configuration"),
            ),
            (
                boundary.solve(&r, &(r * value), Guess::Geodesic, &mut path).map(|found| found.action()),
                named("the configuration"),
            ),
            (boundary.solve(&r, &r, velocity, &mut path).map(|found| found.action()), named("the guessed velocity")),
        ] {
            match (result, error) {
                (Ok(action), None) => assert!(action.is_finite(), "{value}"),
                (Err(found), Some(error)) => assert_eq!(found, error, "{value}"),
                (Err(found), None) => assert!(!found.to_string().contains("by NaN"), "{value}: {found}"),
                (Ok(_), Some(error)) => panic!("{value} is taken: {error}"),
            }
        }
    }
}

#[test]
fn plans_of_extreme_numbers_are_finite_or_refused() {
    let ordinary = || Regulator { mass: 1.3, stiffness: 2.0, price: 0.5 };
    let start = Vector2::new(1.0, -0.4);
    for bad in BROKEN {
        assert!(matches!(
            Regulator { mass: bad, ..ordinary() }.control(0.1).err(),
            Some(Error::NotFinite { name: "mass" })
        ));
        assert!(matches!(ordinary().control(bad).err(), Some(Error::StepSize { .. })));
        let control = ordinary().control(0.1).expect("a regulator");
        assert!(control.follow(&start, &Vector1::new(bad)).is_err(), "an input of {bad}");
        assert!(control.follow(&(start * bad), &Vector1::new(0.0)).is_err(), "a place of {bad}");
    }
    for value in EXTREME {
        for system in [
            Regulator { mass: value, ..ordinary() },
            Regulator { stiffness: value, ..ordinary() },
            Regulator { price: value, ..ordinary() },
        ] {
            let Ok(control) = system.control(0.1) else { continue };
            if let Ok(next) = control.follow(&start, &Vector1::new(0.3)) {
                assert!(next.all_finite(), "{value}");
            }
            let mut plan = [control.stage(&start); 5];
            if let Ok(found) = control.solve(&start, Target::Free, &mut plan) {
                assert!(
                    found.price().is_finite() && found.stages().iter().all(|stage| stage.input().all_finite()),
                    "{value}"
                );
            }
        }
    }
}
