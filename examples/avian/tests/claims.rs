//! The claims of the book on bodies in avian.

use attitudes_in_avian::attitudes::{AttitudePlugin, Turned};
use attitudes_in_avian::theory::{MOMENTS, RATE, attitude, turns_per_second};
use avian3d::math::{Quaternion as Turn, Vector};
use avian3d::prelude::*;
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::time::Duration;

/// A sixtieth of a second, as six substeps of as many nanoseconds.
const STEP: Duration = Duration::from_nanos(6 * 2_777_778);

/// A world without rendering. Each update is a step.
fn world(gravity: f32, step: Duration) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, PhysicsPlugins::new(PostUpdate), AttitudePlugin));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
    app.insert_resource(Gravity(Vector::NEG_Z * gravity));
    app.finish();
    app
}

fn principal(moments: [f64; 3], axes: Turn, rate: [f64; 3]) -> impl Bundle {
    let moments = Vec3::from(moments.map(|x| x as f32));
    let rate = AngularVelocity(Vector::from(rate.map(|x| x as f32)));
    (RigidBody::Dynamic, Mass(1.0), AngularInertia::new_with_local_frame(moments, axes), rate, SleepingDisabled)
}

/// Attitude and angular velocity in the world.
fn motion(app: &App, body: Entity) -> (UnitQuaternion<f64>, Vector3<f64>) {
    let rotation = app.world().get::<Rotation>(body).expect("a body").0;
    let rate = app.world().get::<AngularVelocity>(body).expect("a body").0;
    (UnitQuaternion::new_normalize(Quaternion::from(rotation).cast()), Vector3::from(rate).cast())
}

struct Tumbling {
    turns: u32,
    direction: f64,
}

fn tumbling(by_clebsch: bool, steps: u32) -> Tumbling {
    let mut app = world(0.0, STEP);
    let body = app.world_mut().spawn(principal(MOMENTS, Turn::IDENTITY, RATE)).id();
    if by_clebsch {
        app.world_mut().entity_mut(body).insert(Turned::default());
    }
    let moments = Vector3::from(MOMENTS);
    let start = moments.component_mul(&Vector3::from(RATE));
    let (mut report, mut before) = (Tumbling { turns: 0, direction: 0.0 }, RATE[1]);
    app.update(); // the first update takes no time
    for _ in 0..steps {
        app.update();
        let (axes, rate) = motion(&app, body);
        let rate = axes.inverse() * rate;
        let spin = axes * moments.component_mul(&rate);
        report.turns += u32::from(rate.y * before < 0.0);
        report.direction = report.direction.max(spin.cross(&start).norm().atan2(spin.dot(&start)));
        before = rate.y;
    }
    report
}

#[test]
fn a_body_turns_over_as_often_as_theory_says() {
    let steps = 20_000;
    let turns = turns_per_second(MOMENTS, RATE) * STEP.as_secs_f64() * f64::from(steps);
    let [ours, engine] = [true, false].map(|by_clebsch| tumbling(by_clebsch, steps));
    println!("turns: theory {turns:.1}, clebsch {}, avian {}", ours.turns, engine.turns);
    println!("angle of L to the start, rad: clebsch {:.1e}, avian {:.1e}", ours.direction, engine.direction);
    assert!((f64::from(ours.turns) - turns).abs() < 1.0, "{} of {turns}", ours.turns);
    assert!(ours.direction < 1e-5, "{}", ours.direction);
    assert!((f64::from(engine.turns) - turns).abs() > 2.0, "{} of {turns}", engine.turns);
    assert!(engine.direction > 0.1, "{}", engine.direction);
}

#[test]
fn a_body_with_turned_axes_about_a_point_off_its_origin_moves_as_by_euler() {
    let axes = Turn::from_scaled_axis(Vec3::new(0.3, -0.8, 0.5));
    let centre = Vec3::new(0.3, -0.2, 0.5);
    let velocity = Vector::new(0.25, -0.5, 1.0);
    let mut app = world(0.0, STEP);
    let body = (
        principal(MOMENTS, axes, [1.0, 4.0, -2.0]),
        CenterOfMass(centre),
        LinearVelocity(velocity),
        Rotation(Turn::from_scaled_axis(Vec3::new(0.5, 0.25, -1.0))),
        Turned::default(),
    );
    let body = app.world_mut().spawn(body).id();
    let place = |app: &App| {
        let [position, rotation] = [app.world().get::<Position>(body).expect("a body").0, centre];
        position + app.world().get::<Rotation>(body).expect("a body").0 * rotation
    };
    app.update();
    let (start, rate) = motion(&app, body);
    let from = place(&app);
    for _ in 0..600 {
        app.update();
    }
    let time = 600.0 * STEP.as_secs_f64();
    let frame = UnitQuaternion::new_normalize(Quaternion::from(axes).cast());
    let principal = start * frame;
    let expected = attitude(Vector3::from(MOMENTS), principal, principal.inverse() * rate, time) * frame.inverse();
    let error = motion(&app, body).0.angle_to(&expected);
    let path = (place(&app) - from - velocity * time as f32).length();
    println!("thrown body after 10 s: {error:.1e} rad, {path:.1e} m");
    assert!(error < 1e-4 && path < 1e-3, "{error} rad, {path} m");
}

fn stack(by_clebsch: bool) -> (App, Vec<Entity>, Option<u32>) {
    let mut app = world(9.81, STEP);
    let ground = (RigidBody::Static, Collider::cuboid(100.0, 100.0, 2.0), Position(Vector::NEG_Z));
    app.world_mut().spawn(ground);
    let mut boxes = Vec::new();
    for i in 0..3 {
        let place = Position(Vector::new(0.0, 0.0, 0.35 + 0.62 * i as f32));
        let body = app.world_mut().spawn((RigidBody::Dynamic, Collider::cuboid(1.0, 0.8, 0.6), place)).id();
        if by_clebsch {
            app.world_mut().entity_mut(body).insert(Turned::default());
        }
        boxes.push(body);
    }
    let mut asleep = None;
    for step in 0..3600 {
        app.update();
        if boxes.iter().all(|&body| app.world().get::<Sleeping>(body).is_some()) {
            asleep = Some(step);
            break;
        }
    }
    (app, boxes, asleep)
}

#[test]
fn a_stack_sleeps_and_wakes() {
    let (mut ours, boxes, asleep) = stack(true);
    let (engine, others, of_engine) = stack(false);
    println!("three boxes sleep after steps: clebsch {asleep:?}, avian {of_engine:?}");
    assert!(asleep.is_some() && of_engine.is_some());
    for (&a, &b) in boxes.iter().zip(&others) {
        let [a, b] = [(&ours, a), (&engine, b)].map(|(app, body)| app.world().get::<Position>(body).expect("a box").0);
        assert!((a - b).length() < 1e-3, "{a} {b}");
    }
    ours.world_mut().entity_mut(boxes[2]).insert(AngularVelocity(Vector::new(0.0, 0.0, 2.0)));
    ours.world_mut().commands().queue(WakeBody(boxes[2]));
    ours.update();
    ours.update();
    assert!(boxes.iter().any(|&body| ours.world().get::<Sleeping>(body).is_none()));
}

#[test]
fn bodies_that_do_not_turn_freely_are_those_of_avian() {
    let run = |by_clebsch: bool| {
        let mut app = world(9.81, STEP);
        let rate = AngularVelocity(Vector::new(0.3, 0.2, 0.1));
        let bodies = [RigidBody::Kinematic, RigidBody::Static, RigidBody::Dynamic].map(|kind| {
            let locked = LockedAxes::new().lock_rotation_y();
            let body = app.world_mut().spawn((kind, Collider::cuboid(1.0, 0.8, 0.6), rate, locked)).id();
            if by_clebsch {
                app.world_mut().entity_mut(body).insert(Turned::default());
            }
            app.world_mut().entity_mut(body).insert(CollisionLayers::NONE);
            body
        });
        for _ in 0..60 {
            app.update();
        }
        bodies.map(|body| *app.world().get::<Rotation>(body).expect("a body"))
    };
    assert_eq!(run(true), run(false));
}

/// Two boxes collide. The relative changes of their angular momentum about the origin, and of that of one about its centre
/// of mass. Steps are parts of the usual one.
fn collision(by_clebsch: bool, parts: u32) -> [f64; 2] {
    let mut app = world(0.0, STEP / parts);
    let bodies = [([-2.0, 0.3, 0.1], 3.0), ([0.0, 0.0, 0.0], 0.0)].map(|(place, speed)| {
        let smooth = (Friction::ZERO, Restitution::ZERO, SleepingDisabled);
        let moving = (LinearVelocity(Vector::X * speed), AngularVelocity(Vector::new(1.0, 2.0, -speed)));
        let shape = (RigidBody::Dynamic, Collider::cuboid(1.0, 0.8, 0.6), Position(Vector::from(place)));
        let body = app.world_mut().spawn((shape, smooth, moving)).id();
        if by_clebsch {
            app.world_mut().entity_mut(body).insert(Turned::default());
        }
        body
    });
    let spin = |app: &App, body: Entity| {
        let (axes, rate) = motion(app, body);
        let inertia = app.world().get::<ComputedAngularInertia>(body).expect("a body").tensor();
        let inertia = nalgebra::Matrix3::from(Mat3::from(inertia)).cast::<f64>();
        axes * (inertia * (axes.inverse() * rate))
    };
    let orbit = |app: &App, body: Entity| {
        let place = Vector3::from(app.world().get::<Position>(body).expect("a body").0).cast::<f64>();
        let velocity = Vector3::from(app.world().get::<LinearVelocity>(body).expect("a body").0).cast::<f64>();
        place.cross(&velocity) * f64::from(app.world().get::<ComputedMass>(body).expect("a body").value())
    };
    let total = |app: &App| bodies.map(|body| spin(app, body) + orbit(app, body)).iter().sum::<Vector3<f64>>();
    app.update();
    let (before, first) = (total(&app), spin(&app, bodies[0]));
    for _ in 0..120 * parts {
        app.update();
    }
    [(total(&app) - before).norm() / before.norm(), (spin(&app, bodies[0]) - first).norm() / first.norm()]
}

#[test]
fn contacts_change_the_angular_momentum_of_two_bodies_by_opposite_amounts() {
    let [[ours, change], [engine, _], [finer, _]] = [collision(true, 1), collision(false, 1), collision(true, 8)];
    println!(
        "two boxes collide, relative change of the total L: clebsch {ours:.1e}, avian {engine:.1e}, of one box {change:.1e}"
    );
    println!("the same with an eighth of the step: clebsch {finer:.1e}");
    assert!(change > 0.1, "they collide: {change}");
    // bodies move between the impulse and the end of its step, so the total changes by a part of first order
    assert!(ours < 1e-2 && finer < ours / 5.0, "{ours} {finer}");
}
