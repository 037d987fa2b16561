//! Fixed endpoints on a sphere, where rotations about the target are free: great circles, and a pendulum with time.

use crate::driven_pendulum::DrivenPendulum;
use crate::{assert_near, is_long};
use clebsch::{Clebsch, Error, Guess, Stepper};
use core::f64::consts::PI;
use nalgebra::{Rotation3, Unit, Vector3};

fn free() -> DrivenPendulum {
    DrivenPendulum { mass: 2.0, length: 0.5, gravity: 0.0, shake: 0.0, rate: 0.0 }
}

fn start() -> Vector3<f64> {
    Vector3::new(0.36, 0.48, 0.8)
}

fn axis() -> Unit<Vector3<f64>> {
    Unit::new_normalize(start().cross(&Vector3::new(0.3, -1.0, 0.2)))
}

fn turned(angle: f64) -> Vector3<f64> {
    Rotation3::from_axis_angle(&axis(), angle) * start()
}

/// Along a great circle each step turns by θ/N and the momentum is mass·length² sin(θ/N)/h about its axis.
fn assert_great_circle<const N: usize>(
    stepper: &Stepper<DrivenPendulum>,
    angle: f64,
    guess: Guess<f64, 3>,
) -> Result<usize, Error> {
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start()); N];
    let extremal = boundary.solve(&start(), &turned(angle), guess, &mut path)?;
    let step = angle / N as f64;
    let momentum = axis().scale(0.5 * step.sin() / stepper.step_size());
    for (k, state) in extremal.states().enumerate() {
        // How well two points on the sphere tell their great circle.
        let tolerance = 1e-14 + 1e-15 / (angle / 2.0).cos().abs();
        assert_near!(state.configuration(), turned(k as f64 * step), tolerance.max(1e-13));
        assert_near!(state.momentum(), momentum, 2e-12);
    }
    let action = N as f64 * 0.5 * (1.0 - step.cos()) / stepper.step_size();
    assert!((extremal.action() - action).abs() < 1e-13 * action.max(1.0), "{} {action}", extremal.action());
    Ok(extremal.negative())
}

#[test]
fn great_circles() -> Result<(), Error> {
    let stepper = free().stepper(0.1)?;
    for angle in [0.0, 1e-9, 0.3, 1.5, 3.0, 3.13] {
        assert_eq!(assert_great_circle::<1>(&stepper, angle / 4.0, Guess::Geodesic)?, 0);
        assert_eq!(assert_great_circle::<2>(&stepper, angle / 2.0, Guess::Geodesic)?, 0);
        assert_eq!(assert_great_circle::<20>(&stepper, angle, Guess::Geodesic)?, 0);
    }
    Ok(())
}

/// Opposite points need a direction; beyond them the arc is extremal and not least: conjugate points are passed.
#[test]
fn long_arcs_need_a_guess() -> Result<(), Error> {
    let stepper = free().stepper(0.1)?;
    let undetermined = assert_great_circle::<20>(&stepper, PI, Guess::Geodesic);
    assert!(matches!(undetermined, Err(Error::UndeterminedDirection { distance }) if (distance - 2.0).abs() < 1e-12));
    let along = |angle: f64| Guess::Velocity(axis().scale(angle / 2.0));
    for angle in [PI, -PI] {
        for guess in [along(angle), along(0.9 * angle)] {
            let boundary = stepper.boundary();
            let mut path = [boundary.rest(&start()); 20];
            let extremal = boundary.solve(&start(), &-start(), guess, &mut path)?;
            // All great circles are solutions: that of the guess is found as well as round-off in a neutral direction lets it.
            let momentum = axis().scale(0.5 * (angle / 20.0).sin() / stepper.step_size());
            assert!(extremal.gap() < 1e-13 && extremal.residual() < 1e-11, "{extremal:?}");
            assert_near!(extremal.momentum(), momentum, 1e-5);
            // the momentum in space changes by the round-off at each of 19 vertices
            assert_near!(extremal.momentum(), extremal.final_momentum(), 20.0 * extremal.residual() + 1e-13);
        }
    }
    for (angle, index) in [(2.0, 0), (4.0, 1), (-4.0, 1), (6.0, 1), (7.0, 2)] {
        assert_eq!(assert_great_circle::<40>(&free().stepper(0.05)?, angle, along(angle))?, index, "{angle}");
    }
    Ok(())
}

/// The momentum found leads to the target in time, from a start at any time; forces of the free rotation about the target vanish.
#[test]
fn a_driven_pendulum_is_thrown_to_a_target() -> Result<(), Error> {
    let pendulum = DrivenPendulum { mass: 2.0, length: 0.5, gravity: 9.81, shake: 5.0, rate: 7.0 };
    let stepper = pendulum.stepper(0.01)?;
    let mut momenta = [Vector3::zeros(); 2];
    for (time, found) in [0.0, 0.3].into_iter().zip(&mut momenta) {
        let boundary = stepper.boundary().starting_at(time)?;
        let mut path = [boundary.rest(&start()); 40];
        let extremal = boundary.solve(&start(), &turned(1.2), Guess::Geodesic, &mut path)?;
        let mut state = stepper.state_at(time, start(), *extremal.momentum())?;
        for expected in extremal.states() {
            assert_near!(state.configuration(), expected.configuration(), 1e-12);
            assert_near!(state.momentum(), expected.momentum(), 1e-11);
            assert!((state.time() - expected.time()).abs() < 1e-14);
            state = stepper.step(&state)?;
        }
        assert!(extremal.final_momentum().dot(&turned(1.2)).abs() < 1e-13);
        assert!(extremal.gap() < 1e-14 && extremal.iterations() <= 8, "{extremal:?}");
        *found = *extremal.momentum();
    }
    assert!((momenta[0] - momenta[1]).norm() > 1e-3);
    assert!(matches!(stepper.boundary().starting_at(f64::NAN), Err(Error::NotFinite { .. })));
    Ok(())
}

/// In more than half a period of swinging there and back, the direct way along the bottom is no minimum: the Hessian there is indefinite.
#[test]
fn paths_go_downhill_to_a_minimum() -> Result<(), Error> {
    let pendulum = DrivenPendulum { mass: 2.0, length: 0.5, gravity: 9.81, shake: 0.0, rate: 0.0 };
    let stepper = pendulum.stepper(0.02)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start()); 50];
    let (from, to) = (Vector3::new(0.6, 0.0, -0.8), Vector3::new(-0.6, 1e-3, -0.8).normalize());
    let extremal = boundary.solve(&from, &to, Guess::Geodesic, &mut path)?;
    assert_eq!(extremal.negative(), 0, "{extremal:?}");
    let mut state = stepper.state(from, *extremal.momentum())?;
    for expected in extremal.states() {
        assert_near!(state.configuration(), expected.configuration(), 1e-9);
        state = stepper.step(&state)?;
    }
    Ok(())
}

/// In the plane of symmetry no gradient leads out of it. The least action there is critical, and its index tells
/// whether it is least at all.
#[test]
fn symmetric_problems_end_in_symmetric_extremals() -> Result<(), Error> {
    let pendulum = DrivenPendulum { mass: 2.0, length: 0.5, gravity: 9.81, shake: 0.0, rate: 0.0 };
    for time in [0.6, 1.0, 1.7].into_iter().take(if cfg!(miri) { 1 } else { 3 }) {
        let stepper = pendulum.stepper(time / 50.0)?;
        let boundary = stepper.boundary();
        let mut path = [boundary.rest(&start()); 50];
        let (from, to) = (Vector3::new(0.6, 0.0, -0.8), Vector3::new(-0.6, 0.0, -0.8));
        let extremal = boundary.solve(&from, &to, Guess::Geodesic, &mut path)?;
        assert!(extremal.residual() < 1e-11 && extremal.gap() < 1e-13, "{time}: {extremal:?}");
        assert!(extremal.states().all(|state| state.configuration().y.abs() < 1e-9), "{time}");
    }
    Ok(())
}

/// Several periods of the pendulum, where full Newton steps lead nowhere: a minimum is found for all pairs of points.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: fifty problems of two hundred nodes")]
fn minima_over_long_times() -> Result<(), Error> {
    let pendulum = DrivenPendulum { mass: 2.0, length: 0.5, gravity: 9.81, shake: 5.0, rate: 7.0 };
    let stepper = pendulum.stepper(0.03)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start()); 200];
    for trial in (0..50).step_by(if is_long() { 1 } else { 10 }) {
        // points spread over the sphere by the golden angle
        let point = |k: f64| {
            let (z, turn) = (1.0 - (2.0 * k + 1.0) / 50.0, 2.399_963 * k);
            Vector3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z)
        };
        let (from, to) = (point(f64::from(trial)), point(f64::from((trial * 17 + 5) % 50)));
        let extremal = boundary.solve(&from, &to, Guess::Geodesic, &mut path)?;
        assert!(extremal.negative() == 0 && extremal.gap() < 1e-12, "{trial}: {extremal:?}");
        assert!(extremal.residual() < 1e-11 && extremal.iterations() < 100, "{trial}: {extremal:?}");
    }
    Ok(())
}

#[test]
fn points_out_of_reach_are_told() -> Result<(), Error> {
    let stepper = free().stepper(0.1)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start()); 3];
    let result = boundary.solve(&start(), &(start() * 1.5), Guess::Geodesic, &mut path);
    assert!(matches!(result, Err(Error::OffOrbit { .. })));
    // a path of rest is bent towards the target, but knows no way to the opposite point
    let result = boundary.solve(&start(), &-start(), Guess::Path, &mut path);
    assert!(matches!(result, Err(Error::Unreachable { distance }) if (distance - 2.0).abs() < 1e-12));
    Ok(())
}
