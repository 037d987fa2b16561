//! The derived formulas are the explicit ones, written by hand, on random elements: Legendre transforms, momentum maps, Ad*, kicks.
//!
//! Both sides are sums of a few dozen products of numbers of size one to ten (h = 0.1 divides them), so they agree to 1e-13.

use clebsch::{Clebsch, Error};
use clebsch_tests::fixtures::first_order_top::FirstOrderTop;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::midpoint_top::MidpointTop;
use clebsch_tests::fixtures::neumann::Neumann;
use clebsch_tests::fixtures::paper_pendulum::PaperPendulum;
use clebsch_tests::fixtures::planar_pendulum::PlanarPendulum;
use clebsch_tests::fixtures::rigid_body4::RigidBody4;
use clebsch_tests::fixtures::sided_pair::SidedPair;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::fixtures::two_pendulums::TwoPendulums;
use clebsch_tests::oracle::body::{gravity_torque, mass_matrix};
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::{components, hat, skew, vee};
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix4, SMatrix, SVector, Vector3, Vector4, Vector6};

const H: f64 = 0.1;
const NEAR: f64 = 1e-13;
const SAMPLES: usize = 200;

fn heavy_top(random: &mut Random) -> HeavyTop {
    HeavyTop { mass_matrix: random.inertia(), weight: random.between(0.5, 2.0), center: random.vector() }
}

/// h π^ = F𝒥 − 𝒥Fᵀ before the step and 𝒥F − Fᵀ𝒥 after it, each with half of the torque mgl Γ × χ.
#[test]
fn legendre_transforms_of_the_heavy_top() {
    let mut random = Random::new(1);
    for _ in 0..SAMPLES {
        let top = heavy_top(&mut random);
        let (r, f) = (random.attitude::<3>(), random.attitude::<3>());
        let torque = |r| gravity_torque(top.weight, &top.center, r);
        let before = vee(&(f * top.mass_matrix - top.mass_matrix * f.transpose())) / H - torque(&r) * (H / 2.0);
        let after = vee(&(top.mass_matrix * f - f.transpose() * top.mass_matrix)) / H + torque(&(r * f)) * (H / 2.0);
        assert_near(&top.legendre(H, 0.0, &r, &f), &before, NEAR, "F⁻ℓd");
        assert_near(&top.legendre_next(H, 0.0, &r, &f), &after, NEAR, "F⁺ℓd");
    }
}

/// The papers' step: ℓd = K − hV(Φ_F q) has no kick at its start and all of it at its end.
#[test]
fn legendre_transforms_of_first_order() {
    let mut random = Random::new(2);
    for _ in 0..SAMPLES {
        let HeavyTop { mass_matrix, weight, center } = heavy_top(&mut random);
        let top = FirstOrderTop { mass_matrix, weight, center };
        let (r, f) = (random.attitude::<3>(), random.attitude::<3>());
        let before = vee(&(f * mass_matrix - mass_matrix * f.transpose())) / H;
        let after = f.transpose() * before + gravity_torque(weight, &center, &(r * f)) * H;
        assert_near(&top.legendre(H, 0.0, &r, &f), &before, NEAR, "F⁻ℓd");
        assert_near(&top.legendre_next(H, 0.0, &r, &f), &after, NEAR, "F⁺ℓd");
    }
}

/// For N = 4: hM = F J_d − J_d Fᵀ and hM⁺ = J_d F − Fᵀ J_d = h FᵀMF.
#[test]
fn legendre_transforms_on_so4() {
    let mut random = Random::new(3);
    for _ in 0..SAMPLES {
        let body = RigidBody4 { j_d: random.inertia() };
        let (r, f) = (random.attitude::<4>(), random.attitude::<4>());
        let m = (f * body.j_d - body.j_d * f.transpose()) / H;
        let before: Vector6<f64> = components(&m);
        let after: Vector6<f64> = components(&(f.transpose() * m * f));
        assert_near(&body.legendre(H, 0.0, &r, &f), &before, NEAR, "F⁻ℓd");
        assert_near(&body.legendre_next(H, 0.0, &r, &f), &after, NEAR, "F⁺ℓd");
        assert_near(&RigidBody4::momentum_matrix(&before), &m, NEAR, "M");
    }
}

/// hM = ½(F − Fᵀ) in the paper's normalisation, whose components are 2N; unchanged in the drift.
#[test]
fn legendre_transforms_of_the_sphere() {
    let mut random = Random::new(4);
    for _ in 0..SAMPLES {
        let (q, f) = (random.unit::<3>(), random.attitude::<3>());
        let paper = PaperPendulum { gravity: random.between(1.0, 10.0) };
        let n = vee(&((f - f.transpose()) / 2.0)) / H;
        let kick = -(f * q).cross(&Vector3::z()) * (2.0 * paper.gravity * H);
        assert_near(&paper.legendre(H, 0.0, &q, &f), &(n * 2.0), NEAR, "F⁻ℓd");
        assert_near(&paper.legendre_next(H, 0.0, &q, &f), &(n * 2.0 + kick), NEAR, "F⁺ℓd");
        assert_near(&PaperPendulum::momentum_matrix(&(n * 2.0)), &hat(&n), NEAR, "M = N^");

        let mass = random.between(0.5, 2.0);
        let pendulum = SphericalPendulum { mass, length: 1.5, gravity: 2.0 };
        let half = |q: Vector3<f64>| -q.cross(&Vector3::z()) * (mass * 1.5 * 2.0 * H / 2.0);
        let momentum = n * (mass * 1.5 * 1.5);
        assert_near(&pendulum.legendre(H, 0.0, &q, &f), &(momentum - half(q)), NEAR, "F⁻ℓd with mass and length");
        assert_near(
            &pendulum.legendre_next(H, 0.0, &q, &f),
            &(momentum + half(f * q)),
            NEAR,
            "F⁺ℓd with mass and length",
        );
    }
}

/// On S³: M = wqᵀ − qwᵀ with w = q̇, so that components are x_i p_j − x_j p_i, and kicks are tangential accelerations.
#[test]
fn momenta_and_kicks_of_neumann() {
    let mut random = Random::new(5);
    for _ in 0..SAMPLES {
        let problem = Neumann { stiffness: random.inertia() };
        let (q, f, p): (_, _, Vector4<f64>) = (random.unit::<4>(), random.attitude::<4>(), random.vector());
        let expected: Vector6<f64> = components(&((p * q.transpose() - q * p.transpose()) / 2.0));
        assert_near(&problem.momentum_map(&q, &p), &expected, NEAR, "J = P(pqᵀ)");
        assert!((expected[0] - (q[0] * p[1] - q[1] * p[0])).abs() < NEAR, "the component (12) is x₁p₂ − x₂p₁");
        let gradient = |q: Vector4<f64>| -> Vector6<f64> {
            let g = problem.stiffness * q;
            components(&((g * q.transpose() - q * g.transpose()) / 2.0))
        };
        let drift: Vector6<f64> = components(&((f - f.transpose()) / (4.0 * H)));
        let before = drift + gradient(q) * (H / 2.0);
        let after = drift - gradient(f * q) * (H / 2.0);
        assert_near(&problem.legendre(H, 0.0, &q, &f), &before, NEAR, "F⁻ℓd");
        assert_near(&problem.legendre_next(H, 0.0, &q, &f), &after, NEAR, "F⁺ℓd");
    }
}

/// On translations and on a circle: m a/h and I sin θ/h, with the forces of the potential.
#[test]
fn legendre_transforms_of_commutative_groups() {
    let mut random = Random::new(6);
    for _ in 0..SAMPLES {
        let bodies = TwoBodies { mass: [random.between(0.5, 2.0), random.between(0.5, 2.0)], gravitation: 1.5 };
        let x = [random.vector::<3>(), random.vector::<3>() + Vector3::new(3.0, 0.0, 0.0)];
        let a = [random.vector::<3>() * 0.3, random.vector::<3>() * 0.3];
        let force = |x: [Vector3<f64>; 2]| {
            let between = x[1] - x[0];
            let pull = between * (1.5 * bodies.mass[0] * bodies.mass[1] / between.norm().powi(3));
            stack(&pull, &-pull)
        };
        let momentum = stack(&(a[0] * (bodies.mass[0] / H)), &(a[1] * (bodies.mass[1] / H)));
        let next = bodies.act(&a, &x);
        assert_near(&bodies.legendre(H, 0.0, &x, &a), &(momentum - force(x) * (H / 2.0)), NEAR, "m a/h − h/2 f");
        assert_near(
            &bodies.legendre_next(H, 0.0, &x, &a),
            &(momentum + force(next) * (H / 2.0)),
            NEAR,
            "m a/h + h/2 f⁺",
        );

        let (length, mass) = (random.between(0.5, 2.0), random.between(0.5, 2.0));
        let (q, f) = (random.unit::<2>(), random.attitude::<2>());
        // V = m g l y, so the momentum changes by −m g l x
        let torque = |q: &SVector<f64, 2>| -mass * 9.80665 * length * q.x * H / 2.0;
        let drift = mass * length * length * f[(1, 0)] / H;
        let expected = [drift - torque(&q), drift + torque(&(f * q))];
        let pendulum = PlanarPendulum(length, mass);
        let found = [pendulum.legendre(H, 0.0, &q, &f)[0], pendulum.legendre_next(H, 0.0, &q, &f)[0]];
        // components reach 40, and 1e-13 is relative to them
        assert_near(&SVector::from(found), &SVector::from(expected), 40.0 * NEAR, "I sin θ/h");
    }
}

fn stack(a: &Vector3<f64>, b: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z)
}

/// J(q, p) is 2(qᵀp)^∨ for a right action on matrices, q × p on the sphere, and p for translations.
#[test]
fn momentum_maps() {
    let mut random = Random::new(7);
    for _ in 0..SAMPLES {
        let (r, p) = (random.attitude::<3>(), random.matrix::<3, 3>());
        assert_near(&heavy_top(&mut random).momentum_map(&r, &p), &(vee(&(r.transpose() * p)) * 2.0), NEAR, "qF");
        let (q, p) = (random.unit::<3>(), random.vector::<3>());
        assert_near(&PaperPendulum { gravity: 1.0 }.momentum_map(&q, &p), &q.cross(&p), NEAR, "Fq");
        let found = SidedPair.momentum_map(&(r, q), &(random.matrix::<3, 3>() * 0.0, p));
        assert_near(&found, &stack(&Vector3::zeros(), &q.cross(&p)), NEAR, "one factor on each side");
        let bodies = TwoBodies { mass: [1.0, 2.0], gravitation: 1.0 };
        let (a, b) = (random.vector::<3>(), random.vector::<3>());
        assert_near(&bodies.momentum_map(&[q, p], &[a, b]), &stack(&a, &b), NEAR, "x + a");
        let (x, y) = (random.unit::<4>(), random.matrix::<4, 4>());
        let (r, body) = (random.attitude::<4>(), RigidBody4 { j_d: Matrix4::identity() });
        let expected: Vector6<f64> = components(&(r.transpose() * y));
        assert_near(&body.momentum_map(&r, &y), &expected, NEAR, "qF on SO(4)");
        assert!((x.norm() - 1.0).abs() < NEAR);
    }
}

/// Ad*_F is Fᵀμ on SO(3), FᵀMF on SO(N), and nothing for translations.
#[test]
fn coadjoint_actions() {
    let mut random = Random::new(8);
    for _ in 0..SAMPLES {
        let (f, mu) = (random.attitude::<3>(), random.vector::<3>());
        assert_near(&heavy_top(&mut random).coadjoint(&f, &mu), &(f.transpose() * mu), NEAR, "SO(3)");
        let (f, mu) = (random.attitude::<4>(), random.vector::<6>());
        let m: SMatrix<f64, 4, 4> = skew(&mu) / 2.0;
        let expected: Vector6<f64> = components(&(f.transpose() * m * f));
        assert_near(&RigidBody4 { j_d: Matrix4::identity() }.coadjoint(&f, &mu), &expected, NEAR, "SO(4)");
        let (f, g) = (random.attitude::<3>(), random.attitude::<3>());
        let both = stack(&(f.transpose() * mu.fixed_rows::<3>(0)), &(g.transpose() * mu.fixed_rows::<3>(3)));
        assert_near(&SidedPair.coadjoint(&(f, g), &mu), &both, NEAR, "a product, on both sides alike");
        let bodies = TwoBodies { mass: [1.0, 2.0], gravitation: 1.0 };
        assert_near(&bodies.coadjoint(&[random.vector(), random.vector()], &mu), &mu, 0.0, "translations");
    }
}

/// The momentum before the step determines F: `inverse_legendre` solves the equation that `legendre` evaluates.
#[test]
fn inverse_legendre_inverts_legendre() {
    let mut random = Random::new(9);
    for _ in 0..SAMPLES {
        let top = heavy_top(&mut random);
        let (r, f) = (random.attitude::<3>(), random.rotation::<3>(0.5));
        let stepper = top.stepper(H).expect("a regular top");
        let found = stepper.inverse_legendre(&r, &stepper.legendre(&r, &f)).expect("a solvable step");
        assert_near(&found, &f, NEAR, "SO(3), right");
        let mu = random.vector::<3>() * 2.0;
        let f = stepper.inverse_legendre(&r, &mu).expect("a solvable step");
        assert_near(&stepper.legendre(&r, &f), &mu, NEAR, "the residual on SO(3)");

        let stepper = RigidBody4 { j_d: random.inertia() }.stepper(H).expect("a regular body");
        let (r, f) = (random.attitude::<4>(), random.rotation::<4>(0.5));
        let found = stepper.inverse_legendre(&r, &stepper.legendre(&r, &f)).expect("a solvable step");
        assert_near(&found, &f, NEAR, "SO(4), right");

        let pendulums = TwoPendulums { mass: [1.0, 2.0], gravity: 3.0, coupling: random.vector() };
        let stepper = pendulums.stepper(H).expect("regular pendulums");
        let q: (Vector3<f64>, Vector3<f64>) = (random.unit(), random.unit());
        let (a, b) = (q.0.cross(&random.vector::<3>()), q.1.cross(&random.vector::<3>()));
        let mu = stack(&a, &b);
        let f = stepper.inverse_legendre(&q, &mu).expect("a solvable step");
        assert_near(&stepper.legendre(&q, &f), &mu, NEAR, "SO(3) × SO(3), left");
        let found = stepper.inverse_legendre(&q, &stepper.legendre(&q, &f)).expect("a solvable step");
        assert_near(&found.0, &f.0, NEAR, "SO(3) × SO(3), left");
        assert_near(&found.1, &f.1, NEAR, "SO(3) × SO(3), left");
        // a part that turns q about itself belongs to no motion of q
        let outside = stepper.inverse_legendre(&q, &(mu + stack(&(q.0 * 0.3), &Vector3::zeros())));
        assert!(matches!(outside, Err(Error::OutsideMomentumSpace { .. })), "{outside:?}");
    }
}

/// The inertia tensor and ½tr(J)I − J belong to each other; kinetic energy and Hessian are those of a rigid body.
#[test]
fn kinetic_energy_is_that_of_the_body() {
    let mut random = Random::new(10);
    for _ in 0..SAMPLES {
        let top = heavy_top(&mut random);
        let inertia = clebsch_tests::oracle::body::inertia(&top.mass_matrix);
        assert_near(&mass_matrix(&inertia), &top.mass_matrix, NEAR, "𝒥");
        let omega = random.vector::<3>();
        let (pi, energy) = (inertia * omega, omega.dot(&(inertia * omega)) / 2.0);
        let constants = top.step_constants(H).expect("a regular top");
        let r = random.attitude::<3>();
        assert!((top.kinetic_energy(&constants, 0.0, &r, &pi) - energy).abs() < NEAR);
        assert!((top.potential(0.0, &r) - top.weight * (r * top.center).z).abs() < NEAR);
    }
}

/// A rounded F determines N to ε‖∂²ℓd/∂F²‖, as its documentation says. A unit in the last place of F moves N by as much, so no formula
/// gives more digits.
#[test]
fn legendre_transforms_are_known_to_rounding_over_h() {
    let mut random = Random::new(12);
    for h in [1e-1, 1e-3, 1e-5, 1e-7] {
        let mut most = 0.0_f64;
        for _ in 0..SAMPLES {
            let HeavyTop { mass_matrix, weight, center } = heavy_top(&mut random);
            let coupled = MidpointTop { mass_matrix, weight, stiffness: 0.7, center }.stepper(h).expect("a top");
            let top = HeavyTop { mass_matrix, weight, center }.stepper(h).expect("a top");
            let (r, mu) = (random.attitude::<3>(), random.vector::<3>());
            let bound = 16.0 * f64::EPSILON * (1.0 + mass_matrix.amax() / h);
            let f = top.inverse_legendre(&r, &mu).expect("a solvable step");
            assert_near(&top.legendre(&r, &f), &mu, bound, "a separable cost");
            let mut next = f;
            next[(0, 0)] += f64::EPSILON;
            most = most.max((top.legendre(&r, &next) - top.legendre(&r, &f)).amax());
            let f = coupled.inverse_legendre(&r, &mu).expect("a solvable step");
            assert_near(&coupled.legendre(&r, &f), &mu, bound, "a coupled cost");
        }
        assert!(most > 0.01 * f64::EPSILON / h, "{h}: {most:e}");
    }
}
