//! Fixed endpoints at the ends of the possible: few steps, tiny ones, steps at the bound of solvability. Then endpoints
//! that coincide, that are opposite or out of reach, other scalars and representations.

use super::pairs::{Bob, Body4};
use super::systems::{AnyTop, QuaternionTop, Swivel, Top};
use super::{rotation, shot, slewed};
use clebsch::{Clebsch, Error, Guess};
use clebsch_tests::oracle::near::assert_near;
use core::f64::consts::{FRAC_PI_2, PI};
use nalgebra::{Matrix3, Matrix4, Quaternion, UnitQuaternion, Vector3, Vector4};

fn top() -> Top {
    Top { mass: Vector3::new(2.0, 1.0, 0.0), weight: 1.0 }
}

/// The least action in f64 is that in f32 to the digits that f32 has, and gap and residual are its round-off.
#[test]
fn single_precision() -> Result<(), Error> {
    let single = AnyTop::<f32> { mass: Vector3::new(2.0, 1.0, 0.0), weight: 1.0 };
    let stepper = single.stepper(0.02)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&Matrix3::identity()); 50];
    let extremal = boundary.solve(&Matrix3::identity(), &slewed().cast(), Guess::Geodesic, &mut path)?;
    println!("{extremal:?}");
    assert!((extremal.action() - 6.832_031_2).abs() < 1e-4);
    assert!(extremal.gap() < 5e-6 && extremal.residual() < 1e-4 && extremal.negative() == 0, "{extremal:?}");
    assert!(extremal.iterations() <= 8);
    Ok(())
}

/// Both representations of a top have the same extremal; a quaternion and its opposite are the same attitude.
#[test]
fn quaternions() -> Result<(), Error> {
    let quaternions = QuaternionTop { inertia: Vector3::new(1.0, 2.0, 3.0), weight: 1.0 };
    let (matrices, quaternions) = (top().into_stepper(0.02)?, quaternions.into_stepper(0.02)?);
    let boundary = matrices.boundary();
    let mut path = [boundary.rest(&Matrix3::identity()); 50];
    let expected = boundary.solve(&Matrix3::identity(), &slewed(), Guess::Geodesic, &mut path)?;
    let target = UnitQuaternion::from_matrix(&slewed()).into_inner();
    let boundary = quaternions.boundary();
    let mut path = [boundary.rest(&Quaternion::identity()); 50];
    let found = boundary.solve(&Quaternion::identity(), &target, Guess::Geodesic, &mut path)?;
    println!("{found:?}");
    assert!((found.action() - expected.action()).abs() < 1e-12);
    assert_near(found.momentum(), expected.momentum(), 1e-12, "momentum by quaternions");
    assert_eq!(found.negative(), 0);
    shot(&quaternions, &found, 1e-11)
}

/// One step leaves nothing free, two one vertex.
#[test]
fn one_step_and_two() -> Result<(), Error> {
    let stepper = top().into_stepper(0.1)?;
    let boundary = stepper.boundary();
    let (start, turn) = (rotation(Vector3::new(0.3, -0.2, 0.5)), rotation(Vector3::new(0.2, -0.4, 0.3)));
    let mut path = [boundary.rest(&start)];
    let extremal = boundary.solve(&start, &(start * turn), Guess::Geodesic, &mut path)?;
    assert_near(extremal.nodes()[0].increment(), &(turn - Matrix3::identity()), 1e-15, "the only edge");
    shot(&stepper, &extremal, 1e-13)?;
    let mut path = [boundary.rest(&start); 2];
    shot(&stepper, &boundary.solve(&start, &(start * turn), Guess::Geodesic, &mut path)?, 1e-13)?;

    let stepper = Bob { gravity: 9.81 }.into_stepper(0.05)?;
    let boundary = stepper.boundary();
    let (from, to) = (Vector3::new(0.6, 0.0, -0.8), Vector3::new(0.48, 0.36, -0.8));
    let mut path = [boundary.rest(&from); 2];
    for steps in [1, 2] {
        let extremal = boundary.solve(&from, &to, Guess::Geodesic, &mut path[..steps])?;
        assert!(extremal.gap() < 1e-15 && extremal.negative() == 0, "{extremal:?}");
        shot(&stepper, &extremal, 1e-13)?;
    }
    Ok(())
}

/// Bodies that are thrown to come back to their start.
#[test]
fn endpoints_that_coincide() -> Result<(), Error> {
    for steps in [1, 7, 40, 200] {
        let stepper = top().into_stepper(0.4 / steps as f64)?;
        let boundary = stepper.boundary();
        let q = rotation(Vector3::new(0.9, 0.4, -0.5));
        let mut path = vec![boundary.rest(&q); steps];
        let extremal = boundary.solve(&q, &q, Guess::Geodesic, &mut path)?;
        assert!(extremal.gap() < 1e-14 && extremal.negative() == 0, "{steps}: {extremal:?}");
        shot(&stepper, &extremal, 1e-11)?;

        let stepper = Bob { gravity: 1.0 }.into_stepper(0.4 / steps as f64)?;
        let boundary = stepper.boundary();
        let q = Vector3::new(0.6, 0.0, -0.8);
        let mut path = vec![boundary.rest(&q); steps];
        let extremal = boundary.solve(&q, &q, Guess::Geodesic, &mut path)?;
        assert!(extremal.gap() < 1e-14 && extremal.negative() == 0, "{steps}: {extremal:?}");
        // thrown up, against the pull down, along the meridian
        assert!(extremal.momentum().x.abs() + extremal.momentum().z.abs() < 1e-14);
        shot(&stepper, &extremal, 1e-11)?;
    }
    Ok(())
}

/// No way to an opposite point is the shortest, whatever the number of steps; a velocity chooses one.
#[test]
fn opposite_endpoints_need_a_direction() -> Result<(), Error> {
    let stepper = Bob { gravity: 1.0 }.into_stepper(0.01)?;
    let boundary = stepper.boundary();
    let q = Vector3::new(0.6, 0.0, -0.8);
    let mut path = [boundary.rest(&q); 40];
    for steps in [1, 2, 40] {
        let result = boundary.solve(&q, &-q, Guess::Geodesic, &mut path[..steps]);
        assert!(matches!(result, Err(Error::UndeterminedDirection { distance }) if (distance - 2.0).abs() < 1e-14));
    }
    let velocity = Guess::Velocity(Vector3::new(0.0, 3.0, 0.0) / 0.4);
    let extremal = boundary.solve(&q, &-q, velocity, &mut path)?;
    assert!(extremal.gap() < 1e-14, "{extremal:?}");
    shot(&stepper, &extremal, 1e-9)?;

    let stepper = Body4 { mass: Vector4::new(1.0, 1.5, 2.0, 2.5) }.into_stepper(0.05)?;
    let boundary = stepper.boundary();
    let start = Matrix4::identity();
    let mut path = [boundary.rest(&start); 20];
    for (signs, distance) in [([-1.0, -1.0, 1.0, 1.0], 8.0_f64.sqrt()), ([-1.0; 4], 4.0)] {
        let result = boundary.solve(&start, &Matrix4::from_diagonal(&signs.into()), Guess::Geodesic, &mut path);
        let Err(Error::UndeterminedDirection { distance: told }) = result else { panic!("{result:?}") };
        assert!((told - distance).abs() < 1e-14);
    }
    Ok(())
}

/// Over steps without duration the action is that of the shortest way, ½·d²/T, to the digits that a short step leaves.
#[test]
fn tiny_steps() -> Result<(), Error> {
    for h in [1e-4, 1e-8, 1e-12] {
        let stepper = Bob { gravity: 1.0 }.into_stepper(h)?;
        let boundary = stepper.boundary();
        let (from, to) = (Vector3::x(), Vector3::new(0.6, 0.8, 0.0));
        let mut path = [boundary.rest(&from); 50];
        let extremal = boundary.solve(&from, &to, Guess::Geodesic, &mut path)?;
        let (angle, time) = (0.8_f64.atan2(0.6), 50.0 * h);
        assert!((extremal.action() * time / (angle * angle / 2.0) - 1.0).abs() < 1e-4, "{h}: {extremal:?}");
        assert!(extremal.gap() < 1e-14 && extremal.residual() * time < 1e-14, "{h}: {extremal:?}");
    }
    Ok(())
}

/// A bob turns by less than a quarter in a step of a given momentum, and up to there each path is found. Beyond, a path
/// is an extremal too, but of a momentum that steps take otherwise.
#[test]
fn steps_at_the_bound_of_solvability() -> Result<(), Error> {
    let stepper = Bob { gravity: 0.0 }.into_stepper(0.1)?;
    let boundary = stepper.boundary();
    let towards = |angle: f64| Vector3::new(angle.cos(), angle.sin(), 0.0);
    let mut path = [boundary.rest(&Vector3::x()); 2];
    for angle in [1.5, 1.57, FRAC_PI_2 - 1e-7] {
        let extremal = boundary.solve(&Vector3::x(), &towards(angle), Guess::Geodesic, &mut path[..1])?;
        assert_near(extremal.momentum(), &(Vector3::z() * (angle.sin() / 0.1)), 1e-13, "momentum of a turn");
        assert_eq!(extremal.negative(), 0);
    }
    let extremal = boundary.solve(&Vector3::x(), &towards(3.1), Guess::Geodesic, &mut path)?;
    assert_near(extremal.momentum(), &(Vector3::z() * (1.55_f64.sin() / 0.1)), 1e-12, "momentum of two turns");
    let extremal = boundary.solve(&Vector3::x(), &towards(2.0), Guess::Geodesic, &mut path[..1])?;
    assert_near(extremal.momentum(), &(Vector3::z() * (2.0_f64.sin() / 0.1)), 1e-13, "momentum beyond the bound");
    let (q, mu) = (Vector3::x(), *extremal.momentum());
    let stepped = stepper.step(&stepper.state(q, mu)?)?;
    assert_near(stepped.configuration(), &towards(PI - 2.0), 1e-13, "the step of this momentum");
    Ok(())
}

/// The orbit of a point is a sphere about the origin: a target on another one is as far as the radii differ.
#[test]
fn targets_on_other_orbits_are_told_with_their_distance() -> Result<(), Error> {
    let stepper = Swivel { inertia: 1.0 }.into_stepper(0.1)?;
    let boundary = stepper.boundary();
    let (from, to) = (Vector3::new(2.0, 0.0, 0.0), Vector3::new(0.0, 3.0, 0.0));
    for steps in [1, 2, 10, 64] {
        let mut path = vec![boundary.rest(&from); steps];
        let result = boundary.solve(&from, &to, Guess::Geodesic, &mut path);
        let Err(Error::Unreachable { distance }) = result else { panic!("{steps}: {result:?}") };
        assert!((distance - 1.0).abs() < 1e-7, "{steps}: {distance}");
        let found = boundary.solve(&from, &(to * (2.0 / 3.0)), Guess::Geodesic, &mut path)?;
        assert!(found.gap() < 1e-13);
    }
    Ok(())
}
