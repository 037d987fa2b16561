//! The claims of the book, with both scalar types of rapier.

use attitudes_in_rapier::theory::{MOMENTS, RATE, STEP, attitude, turns_per_second};
use nalgebra::{UnitQuaternion, Vector3};

/// `$exact` is an error of a few roundings, `$rounding` that of many.
macro_rules! claims {
    ($engine:ident, $exact:literal, $rounding:literal) => {
        mod $engine {
            use super::{MOMENTS, RATE, STEP, turns_per_second};
            use attitudes_in_rapier::$engine::attitudes::Attitudes;
            use attitudes_in_rapier::$engine::rapier::prelude::*;
            use attitudes_in_rapier::$engine::scenes::*;
            use clebsch::Error;
            use nalgebra::Vector3;

            #[test]
            fn a_body_turns_over_as_often_as_theory_says() -> Result<(), Error> {
                let turns = turns_per_second(MOMENTS, RATE) * 1e5 * STEP;
                let ours = tumbling(By::Clebsch, 100_000)?;
                assert!((f64::from(ours.turns) - turns).abs() < 1.0, "{} of {turns}", ours.turns);
                assert!(ours.direction < $exact && ours.energy < $rounding, "{ours:?}");
                let engine = tumbling(By::Rapier, 100_000)?;
                assert!((f64::from(engine.turns) - turns).abs() > 20.0, "{} of {turns}", engine.turns);
                assert!(engine.direction > 1.0, "{engine:?}");
                Ok(())
            }

            #[test]
            fn a_body_with_turned_axes_about_a_point_off_its_origin_moves_as_by_euler() -> Result<(), Error> {
                for (rate, steps) in [
                    ([1.0, 4.0, -2.0], &[STEP][..]),
                    ([1.0, 4.0, -2.0], &[0.016, 0.021, 0.009]), // frames that vary
                    ([20.0, 90.0, -40.0], &[STEP]),             // 100 rad/s, 1.7 rad in each step
                ] {
                    let ours = thrown(By::Clebsch, rate, steps)?;
                    assert!(ours.attitude < $rounding && ours.momentum < $exact, "{ours:?}");
                    let engine = thrown(By::Rapier, rate, steps)?;
                    assert!(engine.attitude > 0.1 && engine.momentum > 1e-3, "{engine:?}");
                    assert!(ours.path < 10.0 * $rounding && engine.path < 10.0 * $rounding, "{ours:?} {engine:?}");
                    let replacing = thrown(By::Replacing, rate, steps)?;
                    assert!(replacing.path > 0.05, "its origin is not its centre of mass: {replacing:?}");
                }
                Ok(())
            }

            #[test]
            fn the_wheel_on_a_joint_goes_around_with_the_angular_velocity_of_theory() -> Result<(), Error> {
                let [ours, finer] = [gyroscope(By::Clebsch, STEP)?, gyroscope(By::Clebsch, STEP / 4.0)?];
                assert!((ours.angle - 1.0).abs() < 0.02 && ours.tilt < 0.03, "{ours:?}");
                // of first order, as the joint is
                assert!(
                    (finer.angle - 1.0).abs() < (ours.angle - 1.0).abs() / 3.0 && finer.tilt < ours.tilt / 3.0,
                    "{finer:?}"
                );
                let engine = gyroscope(By::Rapier, STEP)?;
                assert!((engine.angle - 1.0).abs() > 0.05 && engine.tilt > 0.5, "{engine:?}");
                Ok(())
            }

            #[test]
            fn contacts_add_the_moments_of_their_impulses() -> Result<(), Error> {
                let ours = collision(By::Clebsch)?;
                assert!(ours.contacts > 0 && ours.impulse > 0.5 && ours.balance < $exact, "{ours:?}");
                let engine = collision(By::Rapier)?;
                assert!(engine.balance > 1e-3, "{engine:?}");
                Ok(())
            }

            #[test]
            fn a_box_on_the_floor_stays_there() -> Result<(), Error> {
                let ours = resting(By::Clebsch)?;
                assert!(ours.creeping < 1e-9 && ours.rate < $rounding, "{ours:?}");
                let replacing = resting(By::Replacing)?;
                assert!(replacing.creeping > 1e-4, "without the corrections of rapier it creeps: {replacing:?}");
                Ok(())
            }

            #[test]
            fn a_stack_sleeps_and_wakes() -> Result<(), Error> {
                let ours = stack(By::Clebsch)?;
                let engine = stack(By::Rapier)?;
                assert!(ours.asleep_after.is_some() && engine.asleep_after.is_some(), "{ours:?} {engine:?}");
                assert!((ours.height - engine.height).abs() < 1e-3, "{ours:?} {engine:?}");
                assert_eq!((ours.woken, engine.woken), (5, 5));
                let replacing = stack(By::Replacing)?;
                assert!(replacing.asleep_after.is_none() && replacing.height < -1.0, "it falls down: {replacing:?}");
                Ok(())
            }

            #[test]
            fn torques_and_impulses_of_the_user_are_added() -> Result<(), Error> {
                let mut scene = Scene::new(By::Clebsch, 0.0);
                let handle = scene.insert(body([1.0, 2.0, 3.0], Rotation::IDENTITY, Vector::ZERO), None)?;
                scene.world.bodies[handle].set_angvel(Vector::new(2.0, 3.0, -1.0), true);
                scene.step()?;
                let mut expected = scene.spin(handle);
                let near = |scene: &Scene, expected: &Vector3<f64>| {
                    let difference = (scene.spin(handle) - expected).norm();
                    assert!(difference < $exact * 30.0, "{difference}");
                };
                near(&scene, &Vector3::new(2.0, 6.0, -3.0));

                scene.world.bodies[handle].apply_torque_impulse(Vector::new(0.5, -0.25, 1.0), true);
                expected += Vector3::new(0.5, -0.25, 1.0);
                scene.step()?;
                near(&scene, &expected);

                scene.world.bodies[handle].add_torque(Vector::new(1.0, 0.5, -0.25), true);
                for _ in 0..60 {
                    scene.step()?;
                    expected += Vector3::new(1.0, 0.5, -0.25) * STEP;
                    near(&scene, &expected);
                }
                Ok(())
            }

            #[test]
            fn damping_is_that_of_rapier() -> Result<(), Error> {
                let mut scene = Scene::new(By::Clebsch, 0.0);
                let axle = body([1.0, 2.0, 3.0], Rotation::IDENTITY, Vector::ZERO).angvel(Vector::new(0.0, 0.0, 5.0));
                let handle = scene.insert(axle.angular_damping(0.5), None)?;
                let mut expected = 15.0;
                for _ in 0..60 {
                    scene.step()?;
                    // rapier divides the steady angular velocity, that of its four substeps, by 1 + 0.5 dt
                    let half: f64 = expected / 3.0 * STEP / 8.0;
                    expected -= (1.0 - 1.0 / (1.0 + 0.5 * STEP)) * expected * half.tan() / half;
                }
                assert!((scene.spin(handle).z / expected - 1.0).abs() < $exact);
                Ok(())
            }

            #[test]
            fn a_body_whose_mass_changes_has_its_angular_velocity_still() -> Result<(), Error> {
                let mut scene = Scene::new(By::Clebsch, 0.0);
                let handle = scene.insert(body([1.0, 2.0, 3.0], Rotation::IDENTITY, Vector::ZERO), None)?;
                let rate = Vector::new(0.0, 0.0, 2.0);
                scene.world.bodies[handle].set_angvel(rate, true);
                scene.step()?;
                let mass = MassProperties::new(Vector::ZERO, 1.0, Vector::new(2.0, 4.0, 6.0));
                scene.world.bodies[handle].set_additional_mass_properties(mass, true);
                scene.world.bodies[handle].recompute_mass_properties_from_colliders(&scene.world.colliders);
                scene.step()?;
                let difference = (scene.world.bodies[handle].angvel() - rate).length();
                assert!(difference < $rounding, "{difference}");
                Ok(())
            }

            #[test]
            fn bodies_that_do_not_turn_freely_are_those_of_rapier() -> Result<(), Error> {
                let run = |by| {
                    let mut scene = Scene::new(by, 9.81);
                    let turned = |body: RigidBodyBuilder| body.angvel(Vector::new(0.3, 0.2, 0.1)).can_sleep(false);
                    let shape = || Some(ColliderBuilder::cuboid(0.5, 0.4, 0.3));
                    let handles = [
                        scene.insert(turned(RigidBodyBuilder::kinematic_velocity_based()), shape())?,
                        scene.insert(
                            turned(RigidBodyBuilder::fixed().translation(Vector::new(3.0, 0.0, 0.0))),
                            shape(),
                        )?,
                        scene.insert(
                            turned(RigidBodyBuilder::dynamic().translation(Vector::new(6.0, 0.0, 0.0)))
                                .enabled_rotations(true, false, true)
                                .gyroscopic_forces_enabled(false),
                            shape(),
                        )?,
                    ];
                    for _ in 0..60 {
                        scene.step()?;
                    }
                    Ok::<_, Error>(handles.map(|handle| *scene.world.bodies[handle].position()))
                };
                assert_eq!(run(By::Rapier)?, run(By::Clebsch)?);
                Ok(())
            }

            #[test]
            fn bodies_that_are_gone_and_steps_of_no_time_are_no_error() -> Result<(), Error> {
                let mut scene = Scene::new(By::Clebsch, 0.0);
                let [first, second] = [0, 1].map(|_| body([1.0, 2.0, 3.0], Rotation::IDENTITY, Vector::ZERO));
                let first = scene.insert(first.angvel(Vector::new(1.0, 2.0, 3.0)), None)?;
                let second = scene.insert(second.angvel(Vector::new(1.0, 2.0, 3.0)), None)?;
                scene.step()?;
                scene.world.remove_body(first);
                let (axes, _, rate) = scene.motion(second);
                scene.world.integration_parameters.dt = 0.0;
                scene.step()?;
                assert_eq!((axes, rate), (scene.motion(second).0, scene.motion(second).2));
                Ok(())
            }

            #[test]
            fn a_moment_that_is_0_and_a_rate_that_is_not_finite_are_errors() -> Result<(), Error> {
                let mut scene = Scene::new(By::Clebsch, 0.0);
                let rod = body([0.0, 1.0, 1.0], Rotation::IDENTITY, Vector::ZERO);
                assert!(matches!(scene.insert(rod, None), Err(Error::SingularKineticEnergy { .. })));
                let mut world = PhysicsWorld::new();
                let handle = world.insert_body(body([1.0, 2.0, 3.0], Rotation::IDENTITY, Vector::ZERO));
                let mut attitudes = Attitudes::default();
                attitudes.insert(handle, &mut world)?;
                world.bodies[handle].set_angvel(Vector::new(Real::NAN, 0.0, 0.0), true);
                assert!(matches!(attitudes.step(&mut world), Err(Error::NotFinite { .. })));
                Ok(())
            }
        }
    };
}

claims!(double, 1e-12, 1e-10);
claims!(single, 1e-5, 1e-4);

/// The integration by Euler's equations turns a symmetric body by the closed form: exp(tL/J₁) exp(t(1/J₃ − 1/J₁)L₃ e₃).
#[test]
fn the_theory_has_the_closed_form_of_a_symmetric_body() {
    let (moments, rate, time) = (Vector3::new(2.0, 2.0, 3.0), Vector3::new(1.0, -2.0, 4.0), 3.0);
    let momentum = moments.component_mul(&rate);
    let expected = UnitQuaternion::from_scaled_axis(momentum * (time / 2.0))
        * UnitQuaternion::from_scaled_axis(Vector3::z() * (time * (1.0 / 3.0 - 1.0 / 2.0) * momentum.z));
    let found = attitude(moments, UnitQuaternion::identity(), rate, time);
    assert!(found.angle_to(&expected) < 1e-12, "{}", found.angle_to(&expected));
}

/// The glue is as short as the book says: lines that are neither empty nor a comment.
#[test]
fn the_glue_has_80_lines() {
    let is_code = |line: &&str| !line.trim().is_empty() && !line.trim().starts_with("//");
    assert!(include_str!("../src/attitudes.rs").lines().filter(is_code).count() <= 80);
}
