//! Conserved quantities over 10⁶ steps, or as many as `CLEBSCH_STEPS` says, with the growth of round-off: add `-- --nocapture`
//! for the table.
//!
//! A momentum that every step keeps exactly is lost to rounding alone: 2⁻⁵³ a step, of random sign. So its drift grows like
//! √steps, or like steps where roundings have a bias. Fitted is the slope of log drift over log steps, 0.4 to 0.7 in these runs;
//! at 1 there would be a bias. Drifts are bounded by 4 · 2⁻⁵³ · steps: linear growth of a few roundings a step.

use clebsch::{Clebsch, State, Stepper};
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::neumann::Neumann;
use clebsch_tests::fixtures::rigid_body4::RigidBody4;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::oracle::motion::slope;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::{components, skew};
use nalgebra::{Matrix3, Matrix4, SMatrix, Vector3, Vector6};

fn steps() -> usize {
    std::env::var("CLEBSCH_STEPS").ok().and_then(|text| text.parse().ok()).unwrap_or(1_000_000)
}

/// The results of a run: the largest drift of each quantity in each of the windows (0, n/2^k].
struct Drifts {
    names: Vec<&'static str>,
    windows: Vec<(usize, Vec<f64>)>,
}

/// Runs and watches quantities that should keep their initial values, as deviations relative to their scale.
fn watch<S: Clebsch<Scalar = f64>, const K: usize>(
    stepper: &Stepper<S>,
    (q, mu): (S::Configuration, S::Momentum),
    names: [&'static str; K],
    deviations: impl Fn(&State<S>) -> [f64; K],
) -> Drifts {
    let total = steps();
    let mut largest = [0.0_f64; K];
    let mut windows = Vec::new();
    let mut state = stepper.state(q, mu).expect("a state");
    for step in 1..=total {
        state = stepper.step(&state).expect("a solvable step");
        for (max, deviation) in largest.iter_mut().zip(deviations(&state)) {
            // NaN counts
            *max = if deviation.abs() <= *max { *max } else { deviation.abs() };
        }
        // ten windows, from 1/512 of the run to all of it
        if (0..10).any(|k| step == total >> k) {
            windows.push((step, largest.to_vec()));
        }
    }
    Drifts { names: names.to_vec(), windows }
}

impl Drifts {
    fn of(&self, quantity: usize) -> (f64, f64) {
        let points: Vec<(f64, f64)> = self
            .windows
            .iter()
            .map(|(step, largest)| ((*step as f64).log2(), largest[quantity].max(f64::EPSILON / 2.0).log2()))
            .collect();
        (self.windows.last().map_or(f64::NAN, |(_, largest)| largest[quantity]), slope(&points))
    }

    /// Each quantity stays to round-off.
    fn assert_round_off(&self, system: &str) {
        for (quantity, name) in self.names.iter().enumerate() {
            let (drift, slope) = self.of(quantity);
            println!("{system}: {name}: {drift:.1e} after {} steps, like steps^{slope:.2}", steps());
            assert!(drift <= 2.0 * f64::EPSILON * steps() as f64, "{system}: {name} drifts by {drift:.1e}");
            assert!(slope < 1.0, "{system}: {name} drifts like steps^{slope:.2}");
        }
    }
}

/// The largest entry of RᵀR − I.
fn orthogonality<const N: usize>(r: &SMatrix<f64, N, N>) -> f64 {
    (r.transpose() * r - SMatrix::identity()).amax()
}

/// Free body: Rπ in space, |π|², the energy (exactly, for SO(3)) and RᵀR.
#[test]
fn free_body_keeps_its_spatial_momentum_and_energy() {
    let mut random = Random::new(61);
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 1.6, 2.2));
    let stepper = FreeRigidBody { inertia }.stepper(0.05).expect("a body");
    let (r, pi) = (random.attitude::<3>(), Vector3::new(0.3, 1.5, -0.4));
    let (spatial, energy) = (r * pi, 0.5 * pi.dot(&(inertia.try_inverse().expect("a regular tensor") * pi)));
    let names = ["spatial momentum", "energy", "orthogonality"];
    let drifts = watch(&stepper, (r, pi), names, |state| {
        let spatial_drift = (state.configuration() * state.momentum() - spatial).amax() / pi.norm();
        [spatial_drift, stepper.energy(state) / energy - 1.0, orthogonality(state.configuration())]
    });
    drifts.assert_round_off("free body");
}

/// Heavy top: the momentum about the vertical, and a band of the energy that does not widen.
#[test]
fn heavy_top_keeps_its_vertical_momentum_and_its_energy_band() {
    let mut random = Random::new(62);
    let top = HeavyTop {
        mass_matrix: Matrix3::from_diagonal(&Vector3::new(0.6, 0.6, 0.4)),
        weight: 1.0,
        center: Vector3::new(0.1, 0.0, 0.9),
    };
    let stepper = top.stepper(0.02).expect("a top");
    let (r, pi) = (random.attitude::<3>(), Vector3::new(0.2, -0.3, 2.0));
    let vertical = (r * pi).z;
    let drifts = watch(&stepper, (r, pi), ["vertical momentum", "orthogonality"], |state| {
        let momentum = (state.configuration() * state.momentum()).z;
        [(momentum - vertical) / pi.norm(), orthogonality(state.configuration())]
    });
    drifts.assert_round_off("heavy top");
    assert_band("heavy top", &stepper, (r, pi), 5e-5);
}

/// Spherical pendulum: N_z, N ⊥ q, |q| = 1, and the band of the energy.
#[test]
fn spherical_pendulum_keeps_its_vertical_momentum_and_stays_on_the_sphere() {
    let stepper = SphericalPendulum { mass: 1.0, length: 1.0, gravity: 9.81 }.stepper(0.01).expect("a pendulum");
    let (q, n) = (Vector3::y(), Vector3::new(1.0, 0.0, 0.5));
    let names = ["vertical momentum", "N·q", "|q| − 1"];
    let drifts = watch(&stepper, (q, n), names, |state| {
        let (at, momentum) = (state.configuration(), state.momentum());
        // |N| reaches 3.4 at the lowest point
        [(momentum.z - n.z) / 3.4, momentum.dot(at) / 3.4, at.norm() - 1.0]
    });
    drifts.assert_round_off("spherical pendulum");
    assert_band("spherical pendulum", &stepper, (q, n), 7e-3);
}

/// Without gravity every step turns by the same angle. A cosine that is rounded once and multiplies q would change |q|
/// in every step by as much, here by 10⁻¹¹ in all. The increment of q is rounded far below its last place.
#[test]
fn a_geodesic_of_the_sphere_keeps_its_length() {
    let stepper = SphericalPendulum { mass: 1.0, length: 1.0, gravity: 0.0 }.stepper(0.01).expect("a pendulum");
    let mut state = stepper.state(Vector3::y(), Vector3::new(0.7, 0.0, 0.9)).expect("a state");
    for _ in 0..100_000 {
        state = stepper.step(&state).expect("a solvable step");
    }
    assert!((state.configuration().norm_squared() - 1.0).abs() < 1e-12);
}

/// SO(4): R M Rᵀ in space, and RᵀR.
#[test]
fn four_dimensional_body_keeps_its_spatial_momentum() {
    let mut random = Random::new(63);
    let j_d = Matrix4::from_diagonal(&nalgebra::Vector4::new(0.3, 0.5, 0.7, 0.9));
    let stepper = RigidBody4 { j_d }.stepper(0.05).expect("a body");
    let (r, mu): (_, Vector6<f64>) = (random.attitude::<4>(), random.vector());
    let spatial = r * skew::<4, 6>(&mu) * r.transpose();
    let drifts = watch(&stepper, (r, mu), ["spatial momentum", "orthogonality"], |state| {
        let (r, m) = (state.configuration(), skew::<4, 6>(&state.momentum()));
        [(r * m * r.transpose() - spatial).amax(), orthogonality(r)]
    });
    drifts.assert_round_off("body in four dimensions");
}

/// A point on S³: |q| = 1, the momentum in g_q^⊥ without any projection, and the band of the energy.
#[test]
fn neumann_stays_on_its_orbit() {
    let mut random = Random::new(64);
    let stiffness = random.inertia::<4>();
    let stepper = Neumann { stiffness }.stepper(0.05).expect("a sphere");
    let q = random.unit::<4>();
    let w = random.vector::<4>();
    let mu: Vector6<f64> = components(&((w * q.transpose() - q * w.transpose()) / 2.0));
    let drifts = watch(&stepper, (q, mu), ["|q| − 1", "isotropy"], |state| {
        let m = skew::<4, 6>(&state.momentum());
        // the matrix wqᵀ − qwᵀ with w = mq, which M is for momenta of motions
        let w = m * state.configuration();
        let rebuilt = w * state.configuration().transpose() - state.configuration() * w.transpose();
        [state.configuration().norm() - 1.0, (m - rebuilt).amax()]
    });
    drifts.assert_round_off("Neumann");
    assert_band("Neumann", &stepper, (q, mu), 2e-4);
}

/// Two bodies: linear and angular momentum.
#[test]
fn two_bodies_keep_linear_and_angular_momentum() {
    let stepper = TwoBodies { mass: [3.0, 0.5], gravitation: 1.1 }.stepper(0.01).expect("bodies");
    let x = [Vector3::zeros(), Vector3::new(1.5, 0.0, 0.3)];
    // at rest in total, so that positions stay small
    let mu = Vector6::new(0.0, -0.6, 0.1, 0.0, 0.6, -0.1);
    let parts = |mu: &Vector6<f64>| (Vector3::new(mu[0], mu[1], mu[2]), Vector3::new(mu[3], mu[4], mu[5]));
    let angular = |x: &[Vector3<f64>; 2], mu: &Vector6<f64>| x[0].cross(&parts(mu).0) + x[1].cross(&parts(mu).1);
    let start = angular(&x, &mu);
    let drifts = watch(&stepper, (x, mu), ["linear momentum", "angular momentum"], |state| {
        let mu = state.momentum();
        let linear = parts(&mu).0 + parts(&mu).1;
        [linear.amax(), (angular(state.configuration(), &mu) - start).amax()]
    });
    drifts.assert_round_off("two bodies");
    assert_band("two bodies", &stepper, (x, mu), 1e-4);
}

/// The energy oscillates in a band that is as wide over the full run as over its first tenth: no secular drift.
///
/// The band is of the size (hω)² for the fastest rate ω of the problem; for the pendulum an independent 60-digit run has [1.2422, 1.2500].
fn assert_band<S: Clebsch<Scalar = f64>>(
    name: &str,
    stepper: &Stepper<S>,
    (q, mu): (S::Configuration, S::Momentum),
    width: f64,
) {
    let start = stepper.state(q, mu).expect("a state");
    let first = stepper.energy(&start);
    let scale = first.abs().max(stepper.kinetic_energy(&start));
    let (mut early, mut late) = (0.0_f64, 0.0_f64);
    for (k, state) in stepper.trajectory(start).take(steps()).enumerate() {
        let deviation = (stepper.energy(&state.expect("a solvable step")) - first).abs() / scale;
        if k < steps() / 10 {
            early = early.max(deviation);
        } else {
            late = late.max(deviation);
        }
    }
    println!("{name}: energy within {early:.2e} over the first tenth, {late:.2e} after it");
    assert!(late < 1.05 * early, "{name}: the energy drifts, {early:.2e} then {late:.2e}");
    assert!(early > 0.0 && early < width, "{name}: a band of {early:.2e}, {width:.0e} expected at most");
}
