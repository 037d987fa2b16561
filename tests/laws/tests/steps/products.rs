//! Products of groups, translations and the circle.

use clebsch::Clebsch;
use clebsch_tests::fixtures::flying_body::FlyingBody;
use clebsch_tests::fixtures::planar_pendulum::PlanarPendulum;
use clebsch_tests::fixtures::sided_pair::SidedPair;
use clebsch_tests::fixtures::spin_pair::SpinPair;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::fixtures::two_pendulums::TwoPendulums;
use clebsch_tests::oracle::near::{assert_near, distance};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::{body, sphere};
use nalgebra::{Matrix3, Vector2, Vector3, Vector6};

use crate::{last, repeat};

fn diagonal(x: f64, y: f64, z: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(x, y, z))
}

/// Factors couple through the potential only: one hand-written step for each, with the other's position in the kick.
#[test]
fn coupled_spheres() {
    let mut random = Random::new(15);
    let (mass, gravity, coupling): ([f64; 2], f64, Vector3<f64>) = ([1.0, 1.5], 2.0, random.vector());
    let stepper = TwoPendulums { mass, gravity, coupling }.stepper(0.02).expect("pendulums");
    let forces = |q: [Vector3<f64>; 2]| {
        [0, 1].map(|i| (Vector3::z() * gravity * mass[i] + coupling.component_mul(&q[1 - i])) / mass[i])
    };
    pair(&mut random, mass, forces, 0.02, |q, mu| {
        let (q, mu) = last(&stepper, (q[0], q[1]), mu);
        ([q.0, q.1], mu)
    });

    let anisotropy = [random.inertia::<3>(), random.inertia::<3>()];
    let exchange = [[0.3, -0.5], [0.7, 0.2]];
    let stepper = SpinPair { inertia: mass, anisotropy, exchange }.stepper(0.02).expect("spins");
    let forces = |q: [Vector3<f64>; 2]| {
        // each pair (i, j) has the energy exchange[i][j] q[i]·q[1 − j]
        [0, 1].map(|i| {
            let own = q[i] * (2.0 * exchange[i][1 - i]);
            let other = q[1 - i] * (exchange[i][i] + exchange[1 - i][1 - i]);
            (anisotropy[i] * q[i] + own + other) / mass[i]
        })
    };
    pair(&mut random, mass, forces, 0.02, |q, mu| last(&stepper, q, mu));
}

/// Two points on S² by hand, against the derived stepper from the same start.
fn pair(
    random: &mut Random,
    inertia: [f64; 2],
    forces: impl Fn([Vector3<f64>; 2]) -> [Vector3<f64>; 2],
    h: f64,
    derived: impl Fn([Vector3<f64>; 2], Vector6<f64>) -> ([Vector3<f64>; 2], Vector6<f64>),
) {
    let q = [random.unit::<3>(), random.unit::<3>()];
    let w = q.map(|q| q.cross(&random.vector::<3>()));
    let momentum = |q: [Vector3<f64>; 2], w: [Vector3<f64>; 2]| {
        let n = [0, 1].map(|i| q[i].cross(&w[i]) * inertia[i]);
        Vector6::new(n[0].x, n[0].y, n[0].z, n[1].x, n[1].y, n[1].z)
    };
    let found = derived(q, momentum(q, w));
    let expected = repeat((q, w), |(q, w)| {
        let kick = |q: [Vector3<f64>; 2], w: [Vector3<f64>; 2]| {
            let force = forces(q);
            [0, 1].map(|i| sphere::kick(h / 2.0, &force[i], (q[i], w[i])).1)
        };
        let w = kick(q, w);
        let moved = [0, 1].map(|i| sphere::drift(h, (q[i], w[i])));
        let (q, w) = (moved.map(|point| point.0), moved.map(|point| point.1));
        (q, kick(q, w))
    });
    println!("pair: {:.1e} {:.1e}", distance(&found.0[0], &expected.0[0]), distance(&found.0[1], &expected.0[1]));
    assert_near(&found.0[0], &expected.0[0], 1e-11, "the first point");
    assert_near(&found.0[1], &expected.0[1], 1e-11, "the second point");
    assert_near(&found.1, &momentum(expected.0, expected.1), 1e-11, "the momenta");
}

#[test]
fn planar_pendulum_and_two_bodies() {
    let (length, mass, h) = (0.8, 1.2, 0.01);
    let stepper = PlanarPendulum(length, mass).stepper(h).expect("a pendulum");
    let inertia = mass * length * length;
    let found = last(&stepper, Vector2::x(), [0.5].into());
    // the angle from the x axis: V = m g l sin α
    let (angle, momentum) = repeat((0.0_f64, 0.5), |(angle, momentum)| {
        let torque = |angle: f64| -mass * 9.80665 * length * angle.cos();
        let momentum = momentum + h / 2.0 * torque(angle);
        let angle = angle + (h * momentum / inertia).asin();
        (angle, momentum + h / 2.0 * torque(angle))
    });
    assert_near(&found.0, &Vector2::new(angle.cos(), angle.sin()), 1e-11, "the direction");
    assert!((found.1[0] - momentum).abs() < 1e-11, "{} {momentum}", found.1[0]);

    let (mass, gravitation) = ([3.0, 0.5], 1.1);
    let stepper = TwoBodies { mass, gravitation }.stepper(h).expect("bodies");
    let x = [Vector3::zeros(), Vector3::new(2.0, 0.0, 0.3)];
    let v = [Vector3::new(0.0, -0.2, 0.0), Vector3::new(0.1, 1.1, 0.0)];
    let stack = |a: Vector3<f64>, b: Vector3<f64>| Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z);
    let found = last(&stepper, x, stack(v[0] * mass[0], v[1] * mass[1]));
    let accelerations = |x: [Vector3<f64>; 2]| {
        let between = x[1] - x[0];
        let pull = between * (gravitation / between.norm().powi(3));
        [pull * mass[1], -pull * mass[0]]
    };
    let (x, v) = repeat((x, v), |(x, v)| {
        let a = accelerations(x);
        let v = [0, 1].map(|i| v[i] + a[i] * (h / 2.0));
        let x = [0, 1].map(|i| x[i] + v[i] * h);
        let a = accelerations(x);
        (x, [0, 1].map(|i| v[i] + a[i] * (h / 2.0)))
    });
    println!("Kepler: {:.1e}", distance(&found.0[1], &x[1]));
    assert_near(&found.0[0], &x[0], 1e-11, "the first body");
    assert_near(&found.0[1], &x[1], 1e-11, "the second body");
    assert_near(&found.1, &stack(v[0] * mass[0], v[1] * mass[1]), 1e-11, "the momenta");
}

/// A product of groups on both sides: a turning body and a point on the sphere do not know of each other.
#[test]
fn one_factor_on_each_side() {
    let mut random = Random::new(16);
    let (r, q, pi) = (random.attitude(), random.unit::<3>(), random.vector::<3>());
    let w = q.cross(&random.vector::<3>());
    let n = q.cross(&w);
    let stepper = SidedPair.stepper(0.05).expect("a pair");
    let found = last(&stepper, (r, q), Vector6::new(pi.x, pi.y, pi.z, n.x, n.y, n.z));
    // |F − I|²/(4h) is the body with 𝒥 = ½I, whose inertia tensor is I
    let body = repeat((r, pi), |state| body::strang(&diagonal(1.0, 1.0, 1.0), |_| Vector3::zeros(), 0.05, state));
    let point = repeat((q, w), |state| sphere::drift(0.05, state));
    assert_near(&found.0.0, &body.0, 1e-12, "the body");
    assert_near(&found.0.1, &point.0, 1e-12, "the point");
}

/// Translations and rotations together, in single precision: f32 is right to 1e-4 to 1e-3 over a thousand steps.
#[test]
fn flying_body_in_single_precision() {
    let (mass, stiffness, h) = (1.5, 2.0, 0.02);
    let (mass_matrix, hook) = (diagonal(0.5, 0.75, 1.0), Vector3::new(0.25, 0.5, -0.125));
    let body = FlyingBody {
        mass: mass as f32,
        mass_matrix: mass_matrix.cast::<f32>(),
        hook: hook.cast::<f32>(),
        stiffness: stiffness as f32,
    };
    let stepper = body.stepper(h as f32).expect("a regular body");
    let (x, r, p, pi) = (Vector3::new(1.0, 0.0, 0.5), Matrix3::identity(), Vector3::y(), Vector3::new(0.5, -0.25, 1.0));
    let mu = Vector6::new(p.x, p.y, p.z, pi.x, pi.y, pi.z);
    let ((found_x, found_r), _) = last(&stepper, (x.cast::<f32>(), r.cast::<f32>()), mu.cast::<f32>());
    let inertia = body::inertia(&mass_matrix);
    let kick = |x: Vector3<f64>, r: Matrix3<f64>, p: Vector3<f64>, pi: Vector3<f64>| {
        let pull = -(x + r * hook) * stiffness;
        (p + pull * (h / 2.0), pi + hook.cross(&(r.transpose() * pull)) * (h / 2.0))
    };
    let (x, r, _, _) = repeat((x, r, p, pi), |(x, r, p, pi)| {
        let (p, pi) = kick(x, r, p, pi);
        let f = body::drift(&inertia, h, &pi);
        let (x, r, pi) = (x + p * (h / mass), r * f, f.transpose() * pi);
        let (p, pi) = kick(x, r, p, pi);
        (x, r, p, pi)
    });
    let distances = (distance(&found_x.cast::<f64>(), &x), distance(&found_r.cast::<f64>(), &r));
    println!("f32: {:.1e} {:.1e}", distances.0, distances.1);
    assert!(distances.0 < 1e-3 && distances.1 < 1e-3, "{distances:?}");
}
