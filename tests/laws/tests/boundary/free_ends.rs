//! Free ends: the last momentum is −∂φ/∂q, against closed forms and against the fixed endpoints that they are.

use super::systems::{Catch, Hurry, Spring};
use clebsch::{Clebsch, Error, Guess};
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{Matrix3, Rotation3, Vector2, Vector3};

/// A free particle that pays κ/2 |x − g|² ends where the pull of the spring is its momentum: x = (m x₀/T + κ g)/(m/T + κ).
#[test]
fn a_particle_is_pulled_by_its_price() {
    let (mass, stiffness, time) = (1.7, 2.3, 0.8);
    let goal = Vector2::new(1.0, -2.0);
    let stepper = Spring { mass, stiffness, goal }.into_stepper(time / 20.0).expect("regular");
    let start = Vector2::new(0.4, 0.3);
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start); 20];
    let extremal = boundary.solve_free(&start, Guess::Geodesic, &mut path).expect("an extremal");
    let expected = (start * (mass / time) + goal * stiffness) / (mass / time + stiffness);
    assert_near(extremal.end(), &expected, 1e-14, "the end");
    assert_near(extremal.momentum(), &((goal - expected) * stiffness), 1e-13, "the momentum");
    let action = mass * (expected - start).norm_squared() / (2.0 * time);
    let price = stiffness * (expected - goal).norm_squared() / 2.0;
    assert!((extremal.action() - action - price).abs() < 1e-14);
    assert_eq!((extremal.negative(), extremal.gap()), (0, 0.0));
    assert!(extremal.iterations() <= 2, "{}", extremal.iterations());
}

/// A top that falls and pays for the attitude that it is caught in.
#[test]
fn a_top_is_caught() -> Result<(), Error> {
    let goal = *Rotation3::from_scaled_axis(Vector3::new(0.9, -1.2, 0.4)).matrix();
    let stiffness = 3.0;
    let system =
        Catch { mass_matrix: Vector3::new(2.0, 1.0, 0.5), weight: Vector3::new(0.3, 0.1, 1.0), stiffness, goal };
    let stepper = system.into_stepper(0.02)?;
    let boundary = stepper.boundary();
    let start = Matrix3::identity();
    let mut path = [boundary.rest(&start); 60];
    let free = boundary.solve_free(&start, Guess::Geodesic, &mut path)?;
    assert_eq!(free.negative(), 0);
    // φ = −κ tr(RᵀG), ⟨∂φ, R ξ^⟩ = −κ tr((R ξ^)ᵀ G)
    let a = free.end().transpose() * goal;
    let slope = Vector3::new(a.m32 - a.m23, a.m13 - a.m31, a.m21 - a.m12) * -stiffness;
    assert_near(free.final_momentum(), &-slope, 1e-12, "the last momentum");
    let (end, momentum) = (*free.end(), *free.momentum());
    let action = free.action() + stiffness * (end.transpose() * goal).trace();
    let fixed = boundary.solve(&start, &end, Guess::Path, &mut path)?;
    assert!((fixed.action() - action).abs() < 1e-12);
    assert_near(fixed.momentum(), &momentum, 1e-11, "the same path");
    // no other end is better
    for k in 0..6 {
        let turn = Rotation3::from_scaled_axis(Vector3::ith(k % 3, if k < 3 { 1e-3 } else { -1e-3 }));
        let other = end * turn.matrix();
        let least = boundary.solve(&start, &other, Guess::Path, &mut path)?.action();
        assert!(
            least - stiffness * (other.transpose() * goal).trace()
                > action - stiffness * (end.transpose() * goal).trace()
        );
    }
    Ok(())
}

/// m d²/(2T) + c T is least at T = d √(m/2c).
#[test]
fn time_has_a_price() -> Result<(), Error> {
    let (mass, price) = (1.7, 2.3);
    let (start, target) = (Vector2::new(0.4, 0.3), Vector2::new(1.9, -0.8));
    let expected = (target - start).norm() * f64::sqrt(mass / (2.0 * price));
    for first in [0.01, 0.3] {
        let stepper = Hurry { mass, price }.into_stepper(first)?;
        let boundary = stepper.boundary();
        let mut path = [boundary.rest(&start); 20];
        let h = boundary.free_time(&start, Some(&target), 1e-3..=1.0, Guess::Geodesic, &mut path)?;
        assert!((20.0 * h - expected).abs() < 1e-9 * expected, "{} is not {expected}", 20.0 * h);
        let stepper = Hurry { mass, price }.into_stepper(h)?;
        let boundary = stepper.boundary();
        let extremal = boundary.solve(&start, &target, Guess::Path, &mut path)?;
        // the energy is the price of the time
        assert!((stepper.energy(&extremal.states().next().expect("a start")) - price).abs() < 1e-8);
    }
    // at a limit the price falls beyond it
    let stepper = Hurry { mass, price }.into_stepper(0.01)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start); 20];
    let h = boundary.free_time(&start, Some(&target), 1e-3..=0.02, Guess::Geodesic, &mut path)?;
    assert_eq!(h, 0.02);
    let error = boundary.free_time(&start, Some(&target), 0.1..=-0.1, Guess::Geodesic, &mut path);
    assert!(matches!(error, Err(Error::StepSize { .. })), "{error:?}");
    Ok(())
}
