//! Several extremals between the same endpoints.

use super::systems::{Bead, Free};
use clebsch::{Clebsch, Error};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// Half a turn about a principal axis is made either way round, with N_0 = ±(J/h) sin(π/N).
#[test]
fn half_a_turn_either_way() -> Result<(), Error> {
    // J = (1, 2, 3)
    let (steps, h) = (40, 0.025);
    let stepper = Free { mass: Vector3::new(2.0, 1.0, 0.0) }.into_stepper(h)?;
    let boundary = stepper.boundary();
    let start = Matrix3::identity();
    let mut path = [boundary.rest(&start); 40];
    let ways = boundary.several::<12>(&start, &Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)), &mut path)?;
    let found: Vec<_> = ways.into_iter().flatten().collect();
    assert!(found.windows(2).all(|pair| pair[0].action <= pair[1].action));
    let momentum = (PI / f64::from(steps)).sin() / h;
    let action = f64::from(steps) * (1.0 - (PI / f64::from(steps)).cos()) / h;
    for (way, other) in [(&found[0], &found[1]), (&found[1], &found[0])] {
        assert!((way.action - action).abs() < 1e-10, "{}", way.action);
        assert!((way.momentum + other.momentum).amax() < 1e-9);
        assert!((way.momentum.x.abs() - momentum).abs() < 1e-9 && way.momentum.yz().amax() < 1e-9);
        assert_eq!(way.negative, 0);
        let again =
            boundary.solve(&start, &Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)), way.guess, &mut path)?;
        assert!((again.momentum() - way.momentum).amax() < 1e-9);
    }
    Ok(())
}

/// Great circles the short way, the long way, and with whole turns more: Morse's indices are 0, 1, 2, 3.
#[test]
fn great_circles_with_windings() -> Result<(), Error> {
    let stepper = Bead.into_stepper(0.02)?;
    let boundary = stepper.boundary();
    let (start, target) = (Vector3::x(), Vector3::new(1.1_f64.cos(), 1.1_f64.sin(), 0.0));
    let mut path = [boundary.rest(&start); 50];
    let ways = boundary.several::<6>(&start, &target, &mut path)?;
    let angles = [1.1, 2.0 * PI - 1.1, 2.0 * PI + 1.1, 4.0 * PI - 1.1];
    for (way, (index, angle)) in ways.iter().flatten().zip(angles.into_iter().enumerate()) {
        let expected = 50.0 * (1.0 - (angle / 50.0_f64).cos()) / 0.02;
        assert!((way.action - expected).abs() < 1e-9 * expected, "{} is not {expected}", way.action);
        assert_eq!(way.negative, index);
    }
    assert!(ways.iter().flatten().count() >= 2);
    // off the orbit no way leads
    let error = boundary.several::<2>(&start, &Vector3::new(2.0, 0.0, 0.0), &mut path);
    assert!(matches!(error, Err(Error::OffOrbit { .. })), "{error:?}");
    Ok(())
}
