//! A chain of links on ball joints that hangs from a fixed point: clebsch, and rapier3d-f64 by multibody and by impulse joints.
//!
//! `cargo run --release --manifest-path tests/engines/Cargo.toml` takes three minutes. Each chain starts nearly level, at rest,
//! and moves for ten seconds. It prints the widest gap of a joint and the largest change of the energy. The time of a step
//! for each link is the least of three runs.

use clebsch::{Clebsch, SiteStorage};
use nalgebra::{Matrix3, Matrix4, Rotation3, Vector3, Vector6};
use rapier3d_f64::prelude::*;
use std::time::Instant;

/// Links that hang from the origin, with frames at the centres of mass.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<3>; N], q: [SE<3>; N]| (0..N).map(|i| q[i] * F[i]),
    cost       = |h, F| (0..N).map(|i| {
        let turn = F[i].rotation() - I;
        ((turn * self.second_moments * turn.transpose()).trace() + self.mass * F[i].translation().norm_squared()) / (2 * h)
    }).sum(),
    potential  = |q| (0..N).map(|i| self.gravity * self.mass * q[i].translation().z).sum(),
    constraint = |q| [
        q[0].rotation() * self.near + q[0].translation() == Vector3::zeros(),
        (1..N).map(|i| q[i].rotation() * self.near + q[i].translation() == q[i - 1].rotation() * self.far + q[i - 1].translation()),
    ],
)]
struct Chain<const N: usize> {
    #[clebsch(diagonal)]
    second_moments: Matrix3<f64>,
    mass: f64,
    gravity: f64,
    near: Vector3<f64>,
    far: Vector3<f64>,
}

const INERTIA: [f64; 3] = [3.85e-3, 3.87e-3, 2.2e-4];
const MASS: f64 = 0.5;
const GRAVITY: f64 = 9.81;
const HALF: f64 = 0.15;
const TIME: f64 = 10.0;

/// Attitudes and places, nearly level.
fn places(n: usize) -> Vec<(Matrix3<f64>, Vector3<f64>)> {
    let mut joint = Vector3::zeros();
    let link = |i: usize| {
        let i = i as f64;
        let turn =
            *Rotation3::from_euler_angles(0.0, std::f64::consts::FRAC_PI_2 + 0.05 * (0.7 * i).sin(), 0.1 * i.cos())
                .matrix();
        let place = joint + turn * Vector3::z() * HALF;
        joint = place + turn * Vector3::z() * HALF;
        (turn, place)
    };
    (0..n).map(link).collect()
}

struct Report {
    gap: f64,
    energy: f64,
    nanoseconds: f64,
}

fn ours<const N: usize>(h: f64) -> Report {
    let inertia = Vector3::from(INERTIA);
    let second_moments = Matrix3::from_diagonal(&(-inertia).add_scalar(inertia.sum() / 2.0));
    let half = Vector3::z() * HALF;
    let chain = Chain::<N> { second_moments, mass: MASS, gravity: GRAVITY, near: -half, far: half };
    let placed = |(turn, place): (Matrix3<f64>, Vector3<f64>)| {
        let mut placed = turn.to_homogeneous();
        placed.fixed_view_mut::<3, 1>(0, 3).copy_from(&place);
        placed
    };
    let start: Vec<Matrix4<f64>> = places(N).into_iter().map(placed).collect();
    let stepper = chain.into_stepper(h).expect("regular");
    let room = vec![stepper.joint(); N];
    let sites = stepper.joined_sites(SiteStorage::of(start, vec![Vector6::zeros(); N]), room).expect("a chain");
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
                let before = if i > 0 { at(i - 1, half) } else { Vector3::zeros() };
                report.gap = report.gap.max((at(i, -half) - before).norm());
            }
            report.energy = report.energy.max((sites.energy().expect("sites") - energy).abs());
        }
        report.nanoseconds = report.nanoseconds.min(spent * 1e9 / steps as f64 / N as f64);
    }
    report
}

fn engine(n: usize, h: f64, reduced: bool) -> Report {
    let mut report = Report { gap: 0.0, energy: 0.0, nanoseconds: f64::INFINITY };
    for _ in 0..3 {
        let mut bodies = RigidBodySet::new();
        let (mut impulse, mut multibody) = (ImpulseJointSet::new(), MultibodyJointSet::new());
        let ground = bodies.insert(RigidBodyBuilder::fixed().build());
        let mut handles = Vec::new();
        for (turn, place) in places(n) {
            let turn = nalgebra::UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
            let pose = Pose::from_parts(
                Vector::new(place.x, place.y, place.z),
                Rotation::from_xyzw(turn.i, turn.j, turn.k, turn.w),
            );
            let mass =
                MassProperties::new(Vector::new(0., 0., 0.), MASS, Vector::new(INERTIA[0], INERTIA[1], INERTIA[2]));
            let mut body =
                RigidBodyBuilder::dynamic().pose(pose).additional_mass_properties(mass).can_sleep(false).build();
            body.enable_gyroscopic_forces(true);
            handles.push(bodies.insert(body));
        }
        for i in 0..n {
            let (before, anchor) = if i == 0 { (ground, 0.0) } else { (handles[i - 1], HALF) };
            let joint = SphericalJointBuilder::new()
                .local_anchor1(Vector::new(0., 0., anchor))
                .local_anchor2(Vector::new(0., 0., -HALF));
            if reduced {
                multibody.insert(before, handles[i], joint, true);
            } else {
                impulse.insert(before, handles[i], joint, true);
            }
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
        print("impulse joints", N, h, engine(N, h, false));
    }
    // these take a minute for more
    if N <= 10 {
        print("multibody joints", N, 1e-3, engine(N, 1e-3, true));
    }
}

fn main() {
    println!("{:>6}  {:<18} {:>8} {:>10} {:>10} {:>10}", "links", "", "h / s", "gap / m", "energy / J", "ns / link");
    compare::<2>();
    compare::<10>();
    compare::<30>();
}
