//! Several extremals between the same endpoints.

use super::systems::{Bead, Flyer, Free};
use clebsch::{Clebsch, Error, Guess};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, SVector, Vector3};
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

/// Great circles the short way, the long way, and with full turns more: Morse's indices are 0, 1, 2, 3.
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

/// Between opposite points the extremals are a family, along which the action does not bend. The one that is found is a
/// great circle all the same, q_k = cos(kφ) q_0 + sin(kφ) e. Its middle vertex tells the direction e.
#[test]
fn half_circles_to_the_opposite_point() -> Result<(), Error> {
    let random = &mut Random::new(96);
    for (steps, half_turns) in
        [(2, 1.0), (3, 1.0), (10, 1.0), (101, 1.0), (1000, 1.0), (10, 3.0), (101, 3.0), (101, 5.0)]
    {
        let angle = half_turns * PI / steps as f64;
        let h = 0.6 / steps as f64;
        let stepper = Bead.into_stepper(h)?;
        let boundary = stepper.boundary();
        for _ in 0..if cfg!(feature = "heavy") { 20 } else { 5 } {
            let start: Vector3<f64> = random.unit();
            let across = start.cross(&random.vector()).normalize();
            // of a path that is neither quite a great circle nor of this length
            let velocity = (across + random.vector() * 1e-4) * (half_turns * PI / 0.6);
            let mut path = vec![boundary.rest(&start); steps];
            let extremal = boundary.solve(&start, &-start, Guess::Velocity(velocity), &mut path)?;
            let points = || extremal.nodes().iter().map(|node| *node.configuration()).chain([*extremal.end()]);
            let middle = steps / 2;
            let e = (points().nth(middle).expect("a vertex") - start * (middle as f64 * angle).cos()).normalize()
                * (middle as f64 * angle).sin().signum();
            let off = |(k, q): (usize, Vector3<f64>)| {
                let (sin, cos) = (k as f64 * angle).sin_cos();
                (q - start * cos - e * sin).norm()
            };
            let off = points().enumerate().map(off).fold(0.0, f64::max);
            assert!(off < 1e-12, "{off:.1e} from a great circle in {steps} steps: {extremal:?}");
            let action = 2.0 * steps as f64 * (angle / 2.0).sin().powi(2) / h;
            assert!((extremal.action() / action - 1.0).abs() < 1e-12, "{} is not {action}", extremal.action());
        }
    }
    Ok(())
}

/// The same together with a straight line, in whatever units of mass.
#[test]
fn half_circles_beside_other_motions() -> Result<(), Error> {
    let random = &mut Random::new(97);
    for mass in [1e-9, 1.0, 1e9] {
        let stepper = Flyer { mass, inertia: 1.0, pull: 0.0 }.into_stepper(0.03)?;
        let boundary = stepper.boundary();
        for _ in 0..20 {
            let (start, line): (Vector3<f64>, Vector3<f64>) = (random.unit(), random.vector());
            let across = start.cross(&random.vector()).normalize();
            let turn = across * (PI / 0.6);
            let velocity = SVector::<f64, 6>::from_fn(|i, _| if i < 3 { line[i] / 0.6 } else { turn[i - 3] });
            let (from, to) = ((line, start), (line * 2.0, -start));
            let mut path = [boundary.rest(&from); 20];
            let extremal = boundary.solve(&from, &to, Guess::Velocity(velocity), &mut path)?;
            let middle = extremal.nodes()[10].configuration().1;
            for (k, node) in extremal.nodes().iter().enumerate() {
                let (x, q) = node.configuration();
                let (sin, cos) = (k as f64 * PI / 20.0).sin_cos();
                let off = (q - start * cos - middle * sin).norm();
                assert!(off < 1e-12, "vertex {k} is {off:.1e} from a great circle: {extremal:?}");
                assert!((x - line * (1.0 + k as f64 / 20.0)).norm() < 1e-12, "vertex {k}: {extremal:?}");
            }
        }
    }
    Ok(())
}
