//! A chain of links on ball joints that hangs from a fixed point: clebsch, and rapier3d-f64 by multibody and by impulse joints.
//!
//! `cargo run --release --manifest-path tests/engines/Cargo.toml` takes three minutes. Each chain starts nearly level, at rest,
//! and moves for ten seconds. It prints the widest gap of a joint and the largest change of the energy. The time of a step
//! for each link is the least of three runs.

#[path = "../../benches/sites/chain.rs"]
#[allow(dead_code, reason = "the chain by hand is for the benchmark")]
mod chain;

use chain::{FAR, GRAVITY, HALF, INERTIA, MASS, NEAR, places};
use clebsch::Clebsch;
use nalgebra::{Rotation3, Vector3};
use rapier3d_f64::prelude::*;
use std::time::Instant;

/// The duration, seconds.
const TIME: f64 = 10.0;

struct Report {
    gap: f64,
    energy: f64,
    nanoseconds: f64,
}

fn ours<const N: usize>(h: f64) -> Report {
    let stepper = chain::chain::<N>().into_stepper(h).expect("regular");
    let room = vec![stepper.joint(); N];
    let sites = stepper.joined_sites(chain::storage(N), room).expect("a chain");
    let energy = sites.energy().expect("sites");
    let (steps, samples) = ((TIME / h).round() as u64, 1000);
    let mut report = Report { gap: 0.0, energy: 0.0, nanoseconds: f64::INFINITY };
    for _ in 0..3 {
        let mut sites = sites.clone();
        let mut spent = 0.0;
        for _ in 0..samples {
            let begun = Instant::now();
            sites.advance(steps / samples).expect("steps");
            spent += begun.elapsed().as_secs_f64();
            let at = |i: usize, point: Vector3<f64>| sites.configuration()[i].transform_point(&point.into()).coords;
            for i in 0..N {
                let before = if i > 0 { at(i - 1, FAR) } else { Vector3::zeros() };
                report.gap = report.gap.max((at(i, NEAR) - before).norm());
            }
            report.energy = report.energy.max((sites.energy().expect("sites") - energy).abs());
        }
        report.nanoseconds = report.nanoseconds.min(spent * 1e9 / steps as f64 / N as f64);
    }
    report
}

/// The joints of the engine.
#[derive(Clone, Copy, PartialEq)]
enum Joints {
    /// Each body has six coordinates, and impulses at the joints.
    Impulse,
    /// The coordinates are those of the joints, with the damping that a new joint has.
    Damped,
    /// The same without damping.
    Undamped,
}

fn engine(n: usize, h: f64, joints: Joints) -> Report {
    let mut report = Report { gap: 0.0, energy: 0.0, nanoseconds: f64::INFINITY };
    for _ in 0..3 {
        let mut bodies = RigidBodySet::new();
        let (mut impulse, mut multibody) = (ImpulseJointSet::new(), MultibodyJointSet::new());
        let ground = bodies.insert(RigidBodyBuilder::fixed().build());
        let (mut handles, mut turns) = (Vec::new(), vec![Rotation::IDENTITY]);
        for (turn, place) in places(n) {
            let turn = nalgebra::UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
            let turn = Rotation::from_xyzw(turn.i, turn.j, turn.k, turn.w);
            turns.push(turn);
            let pose = Pose::from_parts(Vector::new(place.x, place.y, place.z), turn);
            let mass =
                MassProperties::new(Vector::new(0., 0., 0.), MASS, Vector::new(INERTIA[0], INERTIA[1], INERTIA[2]));
            let mut body =
                RigidBodyBuilder::dynamic().pose(pose).additional_mass_properties(mass).can_sleep(false).build();
            body.enable_gyroscopic_forces(true);
            handles.push(bodies.insert(body));
        }
        for i in 0..n {
            let (before, anchor) = if i == 0 { (ground, 0.0) } else { (handles[i - 1], HALF) };
            // the coordinates of a multibody start at 0, whatever the pose of the body is
            let between = turns[i].inverse() * turns[i + 1];
            let joint = SphericalJointBuilder::new()
                .local_frame1(Pose::from_parts(Vector::new(0., 0., anchor), between))
                .local_frame2(Pose::from_parts(Vector::new(0., 0., -HALF), Rotation::IDENTITY));
            if joints == Joints::Impulse {
                impulse.insert(before, handles[i], joint, true);
            } else {
                multibody.insert(before, handles[i], joint, true);
            }
        }
        // each joint that is inserted sets its own damping, so this is last
        if joints == Joints::Undamped {
            let of_chain = multibody.rigid_body_link(handles[0]).expect("a joint").multibody;
            multibody.get_multibody_mut(of_chain).expect("a multibody").damping_mut().fill(0.0);
        }
        let parameters = IntegrationParameters { dt: h, ..Default::default() };
        let mut pipeline = PhysicsPipeline::new();
        let (mut islands, mut broad, mut narrow) = (IslandManager::new(), BroadPhaseBvh::new(), NarrowPhase::new());
        let (mut colliders, mut soft, mut ccd) = (ColliderSet::new(), SoftBodySet::new(), CCDSolver::new());
        let energy = |bodies: &RigidBodySet| -> f64 {
            handles
                .iter()
                .map(|&handle| {
                    let body = &bodies[handle];
                    let omega = body.rotation().inverse() * body.angvel();
                    let v = body.linvel();
                    (MASS * v.dot(v)
                        + INERTIA[0] * omega.x * omega.x
                        + INERTIA[1] * omega.y * omega.y
                        + INERTIA[2] * omega.z * omega.z)
                        / 2.0
                        + MASS * GRAVITY * body.translation().z
                })
                .sum()
        };
        let first = energy(&bodies);
        let (steps, samples) = ((TIME / h).round() as u64, 1000);
        let mut spent = 0.0;
        for _ in 0..samples {
            let begun = Instant::now();
            for _ in 0..steps / samples {
                pipeline.step(
                    Vector::new(0., 0., -GRAVITY),
                    &parameters,
                    &mut islands,
                    &mut broad,
                    &mut narrow,
                    &mut bodies,
                    &mut colliders,
                    &mut impulse,
                    &mut multibody,
                    &mut soft,
                    &mut ccd,
                    &(),
                    &(),
                );
            }
            spent += begun.elapsed().as_secs_f64();
            let at = |i: usize, z: f64| *bodies[handles[i]].position() * Vector::new(0., 0., z);
            for i in 0..n {
                let before = if i > 0 { at(i - 1, HALF) } else { Vector::new(0., 0., 0.) };
                report.gap = report.gap.max((at(i, -HALF) - before).length());
            }
            report.energy = report.energy.max((energy(&bodies) - first).abs());
        }
        report.nanoseconds = report.nanoseconds.min(spent * 1e9 / steps as f64 / n as f64);
    }
    report
}

fn print(name: &str, n: usize, h: f64, report: Report) {
    let Report { gap, energy, nanoseconds } = report;
    println!("{n:>6}  {name:<18} {h:>8} {gap:>10.1e} {energy:>10.1e} {nanoseconds:>10.0}");
}

fn compare<const N: usize>() {
    for h in [1e-3, 2.5e-4] {
        print("clebsch", N, h, ours::<N>(h));
        print("impulse joints", N, h, engine(N, h, Joints::Impulse));
    }
    // these take a minute for more
    if N <= 10 {
        print("multibody joints", N, 1e-3, engine(N, 1e-3, Joints::Damped));
        for h in [1e-3, 2.5e-4] {
            print("without damping", N, h, engine(N, h, Joints::Undamped));
        }
    }
}

fn main() {
    println!("{:>6}  {:<18} {:>8} {:>10} {:>10} {:>10}", "links", "", "h / s", "gap / m", "energy / J", "ns / link");
    compare::<2>();
    compare::<10>();
    compare::<30>();
}
