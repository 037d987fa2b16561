//! Refused problems, with their numbers.

use crate::group::unicycle;
use crate::linear::{Linear, double_integrator};
use clebsch::{Controlled, Error, Stage, Target};
use nalgebra::{Matrix3, SMatrix, Vector1, Vector2};

#[test]
fn plans_need_a_step() -> Result<(), Error> {
    let control = double_integrator::<0>(0.1).control(0.1)?;
    let start = Vector2::zeros();
    let mut plan: [Stage<Linear<2, 1, 0, 1>, 2, 1, 0>; 0] = [];
    let error = control.solve(&start, Target::Free, &mut plan).unwrap_err();
    assert_eq!(error, Error::PathLength { nodes: 0, per_step: 1 });
    Ok(())
}

#[test]
fn numbers_must_be_finite() -> Result<(), Error> {
    assert!(matches!(double_integrator::<0>(0.1).control(0.0).unwrap_err(), Error::StepSize { value: 0.0 }));
    assert!(matches!(double_integrator::<0>(0.1).control(f64::NAN).unwrap_err(), Error::StepSize { .. }));
    let control = double_integrator::<0>(0.1).control(0.1)?;
    let (start, broken) = (Vector2::zeros(), Vector2::new(f64::NAN, 0.0));
    let mut plan = [control.stage(&start); 5];
    let place = Error::NotFinite { name: "the place" };
    assert_eq!(control.solve(&broken, Target::Free, &mut plan).unwrap_err(), place);
    assert_eq!(control.solve(&start, Target::Place(broken), &mut plan).unwrap_err(), place);
    plan[3] = control.stage(&start).with_input(Vector1::new(f64::INFINITY));
    let error = control.solve(&start, Target::Free, &mut plan).unwrap_err();
    assert_eq!(error, Error::NotFinite { name: "the guessed inputs" });
    plan[3] = control.stage(&start).with_input(Vector1::new(1e200));
    let error = control.solve(&start, Target::Free, &mut plan).unwrap_err();
    assert_eq!(error, Error::NotFinite { name: "the price of the plan" });
    let error = control.solve_free_time(&start, Target::Free, -1.0..=1.0, &mut plan).unwrap_err();
    assert_eq!(error, Error::StepSize { value: -1.0 });
    Ok(())
}

/// Two masses, one driven, seen from an oblique frame: half of the places are out of reach.
#[test]
fn what_no_input_moves_is_not_controllable() -> Result<(), Error> {
    let frame = SMatrix::<f64, 2, 2>::new(0.8, -0.6, 0.6, 0.8);
    let system = Linear::<2, 1, 0, 2> {
        a: frame * SMatrix::<f64, 2, 2>::new(0.9, 0.3, 0.0, 1.1) * frame.transpose(),
        b: frame * Vector2::new(1.0, 0.0),
        ..reshaped()
    };
    let control = system.control(1.0)?;
    let start = frame * Vector2::new(0.0, 1.0);
    let mut plan = [control.stage(&start); 8];
    // the second component is 1.1⁸ whatever is done
    let free = 1.1_f64.powi(8);
    let found = control.solve(&start, Target::Place(frame * Vector2::new(3.0, free)), &mut plan)?;
    assert!(found.gap() < 1e-12, "{found:?}");
    let error = control.solve(&start, Target::Place(frame * Vector2::new(3.0, free + 0.5)), &mut plan).unwrap_err();
    assert!(matches!(error, Error::Uncontrollable { distance } if (0.49..0.6).contains(&distance)), "{error}");
    Ok(())
}

fn reshaped() -> Linear<2, 1, 0, 2> {
    Linear {
        a: SMatrix::identity(),
        b: SMatrix::zeros(),
        place_price: SMatrix::zeros(),
        input_price: SMatrix::identity(),
        end_price: SMatrix::zeros(),
        bound_place: SMatrix::zeros(),
        bound_input: SMatrix::zeros(),
        bound: SMatrix::zeros(),
    }
}

/// One wheel cannot turn a car: a group that is driven in one direction stays on its line.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: exponentials of jets, by series")]
fn a_car_without_a_wheel_stays_on_its_line() -> Result<(), Error> {
    let car = unicycle();
    let system = crate::group::Group::<1> { basis: car.basis, dual: car.dual };
    let control = system.control(0.1)?;
    let start = Matrix3::identity();
    let mut plan = [control.stage(&start); 10];
    let found = control.solve(&start, Target::Place(car.exp(&[2.0, 0.0, 0.0])), &mut plan)?;
    assert!((found.price() - 2.0).abs() < 1e-12 && found.gap() < 1e-14, "{found:?}");
    let error = control.solve(&start, Target::Place(car.exp(&[2.0, 0.5, 0.0])), &mut plan).unwrap_err();
    assert!(matches!(error, Error::Uncontrollable { distance } if distance > 0.1), "{error}");
    // after an error the guess is there again
    assert!(plan.iter().all(|stage| (stage.input()[0] - 2.0).abs() < 1e-12));
    Ok(())
}
