//! States that violate a constraint, rows that depend on each other, and the repair of momenta.

use clebsch::{Clebsch, Error};
use clebsch_tests::fixtures::{chaplygin_sleigh::ChaplyginSleigh, rolling_ball::RollingBall, suslov::Suslov};
use nalgebra::{Matrix3, Vector2, Vector3, Vector5};

#[test]
fn a_velocity_off_the_constraint_is_refused_with_its_size() -> Result<(), Error> {
    let stepper = ChaplyginSleigh { mass: 1.5, inertia: 0.4, offset: 0.6 }.into_stepper(0.1)?;
    let refused = stepper.state_moving(Matrix3::identity(), Vector3::new(1.0, 0.5, 0.25));
    let Err(Error::ConstraintViolated { violation, tolerance }) = refused else { panic!("{refused:?}") };
    assert!((violation - 0.25).abs() < 1e-15 && tolerance < 1e-6, "{violation} {tolerance}");
    // rest obeys a linear constraint
    assert!(stepper.state(Matrix3::identity(), Vector3::zeros()).is_ok());
    Ok(())
}

/// The repair changes the kinetic energy least: Σ⁻¹(N⁺ − N) is Σ⁻¹Aᵀκ, perpendicular to allowed velocities in Σ.
#[test]
fn projection_repairs_momenta() -> Result<(), Error> {
    let inertia = Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9);
    let stepper = Suslov { inertia }.into_stepper(0.1)?;
    let momentum = Vector3::new(0.4, -0.6, 0.9);
    assert!(matches!(stepper.state(Matrix3::identity(), momentum), Err(Error::ConstraintViolated { .. })));
    let repaired = stepper.project(Matrix3::identity(), momentum)?.momentum();
    assert!(stepper.state(Matrix3::identity(), repaired).is_ok());
    let change = repaired - momentum;
    assert!(change.x.abs() < 1e-15 && change.y.abs() < 1e-15, "{change}");
    let omega = inertia.try_inverse().unwrap() * repaired;
    assert!(omega.z.abs() < 1e-15, "{omega}");
    Ok(())
}

/// A step of a ball that is too long for its momentum names the part of it that has a step, and the longest step.
/// Far from the axis the table turns a ball at rest too fast: no part of the momentum has a step.
#[test]
fn steps_too_long_for_a_turning_table_name_the_longest() -> Result<(), Error> {
    let ball = RollingBall { mass: 1.3, inertia: 0.7, radius: 0.5, table_rate: 0.9 };
    let momentum = Vector5::new(0.2, 0.4, 0.1, -0.3, 0.35);
    let step = |h: f64, place: Vector2<f64>| -> Result<(), Error> {
        let stepper = ball.stepper(h)?;
        stepper.step(&stepper.project(place, momentum)?).map(drop)
    };
    let far = Vector2::new(3.0, -2.0);
    let Err(Error::StepTooLong { step_size, solvable_step: Some(longest) }) = step(50.0, far) else {
        panic!("{:?}", step(50.0, far))
    };
    assert!(step_size == 50.0 && longest > 0.1 && longest < 50.0, "{step_size} {longest}");
    assert!(step(longest, far).is_ok() && step(longest * 1.03, far).is_err(), "{longest}");

    let near = Vector2::new(0.3, -0.2);
    let Err(Error::Unsolvable { solvable_fraction, solvable_step: Some(longest), .. }) = step(3.0, near) else {
        panic!("{:?}", step(3.0, near))
    };
    assert!(step(longest, near).is_ok() && step(longest * 1.03, near).is_err(), "{longest}");
    let stepper = ball.stepper(3.0)?;
    let whole = stepper.project(near, momentum)?.momentum();
    // the sine itself, by hand: y = Σ g/h − N = Aᵀλ and ψ = 0 in (a, s)
    let (m, inertia, r, rate, h) = (ball.mass, ball.inertia, ball.radius, ball.table_rate, 3.0);
    let sine = |mu: Vector5<f64>| {
        let rows = nalgebra::Matrix2x5::new(1.0, 0.0, 0.0, -r, 0.0, 0.0, 1.0, r, 0.0, 0.0);
        let table = nalgebra::Matrix2::new(0.0, -rate, rate, 0.0);
        let sigma = nalgebra::Matrix5::from_diagonal(&Vector5::new(m, m, inertia, inertia, inertia));
        let mut bordered = nalgebra::SMatrix::<f64, 7, 7>::zeros();
        bordered.fixed_view_mut::<5, 5>(0, 0).copy_from(&(sigma / h));
        bordered.fixed_view_mut::<5, 2>(0, 5).copy_from(&-rows.transpose());
        let mut slope = rows / h;
        let turned = slope.fixed_view::<2, 2>(0, 0) - table / 2.0;
        slope.fixed_view_mut::<2, 2>(0, 0).copy_from(&turned);
        bordered.fixed_view_mut::<2, 5>(5, 0).copy_from(&slope);
        let mut right = nalgebra::SVector::<f64, 7>::zeros();
        right.fixed_rows_mut::<5>(0).copy_from(&mu);
        right.fixed_rows_mut::<2>(5).copy_from(&(table * near));
        bordered.lu().solve(&right).map(|solution| solution.fixed_rows::<3>(2).norm())
    };
    let found = sine(whole * solvable_fraction).expect("a regular system");
    assert!((found - 1.0).abs() < 1e-12, "{found}");
    Ok(())
}

mod crossing {
    use clebsch::Clebsch;

    /// Two equations that are one on the line x = y.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: Translation<2>, x: Vector2| x + a,
        lagrangian = |v| self.mass * v.norm_squared() / 2,
        constraint = |x, v| [v.x == v.y, x.x * v.x == x.y * v.y],
    )]
    pub struct Crossing {
        pub mass: f64,
    }
}

#[test]
fn rows_that_depend_on_each_other_are_refused_with_their_rank() -> Result<(), Error> {
    let stepper = crossing::Crossing { mass: 2.0 }.into_stepper(0.1)?;
    assert!(stepper.state(Vector2::new(1.0, 2.0), Vector2::zeros()).is_ok());
    let refused = Error::DependentConstraints { rank: 1, rows: 2 };
    assert_eq!(stepper.state(Vector2::new(1.0, 1.0), Vector2::zeros()).err(), Some(refused));
    assert_eq!(stepper.project(Vector2::new(1.0, 1.0), Vector2::zeros()).err(), Some(refused));
    assert!(refused.to_string().starts_with("the 2 rows of the constraint have rank 1"));
    Ok(())
}
