//! The scenes at fixed parameters: free body (P1), heavy top (P2), spherical pendulum (P3, P3g), free body in four dimensions (P4).

use crate::counted::{self, Counted, Work, work};
use crate::engine::{self, Gyroscopic};
use crate::hand::{Body, Pendulum};
use crate::hand4::Body4;
use crate::runge_kutta::{RungeKutta, Swinging, Turning, Turning4};
use crate::timing::interleaved;
use crate::trial::{Drift, Trial, by_hand, derived};
use clebsch::Clebsch;
use clebsch_tests::fixtures::compensated_top::CompensatedTop;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::principal_body::PrincipalBody;
use clebsch_tests::fixtures::rigid_body4::RigidBody4;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use nalgebra::{Matrix3, Matrix4, Rotation3, SVector, Vector3, Vector4};

/// The results of one contestant at one problem.
pub struct Result {
    /// The name of the problem.
    pub problem: &'static str,
    /// The contestant.
    pub peer: &'static str,
    /// How it was run.
    pub setting: &'static str,
    /// Step size, s.
    pub h: f64,
    /// Time of a step.
    pub time: crate::timing::Time,
    /// Largest deviations of energy and constraint.
    pub drift: Drift,
    /// Where it is known.
    pub work: Option<Work>,
}

/// All problems at all their step sizes.
pub fn all() -> Vec<Result> {
    let mut results = Vec::new();
    results.extend([0.01, 0.1].into_iter().flat_map(free_body));
    results.extend(heavy_top(0.01));
    results.extend([("P3", 1.0), ("P3g", 9.81)].into_iter().flat_map(|(name, gravity)| pendulum(name, gravity, 0.01)));
    results.extend([0.01, 0.1].into_iter().flat_map(four_dimensions));
    results
}

/// Steps with sums that keep their rests.
pub struct Compensated;

/// The free body of P1 by the default discretization, the Cayley map, and with compensated sums.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    method Compensated = (discretization = moser_veselov, summation = compensated),
)]
pub struct FreeBody {
    /// Principal moments of inertia, kg·m².
    pub moments: Vector3<f64>,
}

/// The heavy top of P2 by the default discretization.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    potential  = |R| self.weight * (R * self.center).z,
)]
pub struct DefaultTop {
    /// Principal moments of inertia, kg·m².
    pub moments: Vector3<f64>,
    /// m·g, N.
    pub weight: f64,
    /// m.
    pub center: Vector3<f64>,
}

/// The free body of P1 after a million steps.
pub fn ends() -> [engine::End; 3] {
    engine::ends(INERTIA, MOMENTUM)
}

/// The free body of P1: it turns about its middle axis, nearly.
const INERTIA: [f64; 3] = [1.0, 2.0, 3.0];
const MOMENTUM: [f64; 3] = [0.3, 2.0, 0.6];

fn free_body(h: f64) -> Vec<Result> {
    let (inertia, momentum) = (INERTIA, MOMENTUM);
    let stepper = PrincipalBody { moments: inertia.into() }.into_stepper(h).expect("a body");
    let start = stepper.state(Matrix3::identity(), momentum.into()).expect("a state");
    let compensated = FreeBody { moments: inertia.into() }.into_stepper_by::<Compensated>(h).expect("a body");
    let compensated_start = compensated.state(Matrix3::identity(), momentum.into()).expect("a state");
    let default = FreeBody { moments: inertia.into() }.into_stepper(h).expect("a body");
    let default_start = default.state(Matrix3::identity(), momentum.into()).expect("a state");
    let unit = [1.0, 0.0, 0.0, 0.0];
    let hand = Body::new(h, inertia, [0.0; 3], unit, momentum);
    let motion = Turning { inertia, moment: [0.0; 3] };
    let [m1, m2, m3] = momentum;
    let rk4 = RungeKutta::new(h, motion, [1.0, 0.0, 0.0, 0.0, m1, m2, m3]);
    let work = {
        let stepper = counted::PrincipalBody { moments: three(inertia) }.into_stepper(Counted(h)).expect("a body");
        let state = |m| stepper.state(Matrix3::identity().map(Counted), three(m)).expect("a state");
        work(&stepper, state(momentum), 1000)
    };
    let engine = Gyroscopic::new(h, inertia, momentum);
    let trials = vec![
        derived(&stepper, start, 1.0),
        by_hand("rust_hand_newton", hand),
        by_hand("rust_rk4", rk4),
        by_hand("rust_gyroscopic", engine),
        derived(&compensated, compensated_start, 1.0).named("clebsch_compensated"),
        derived(&default, default_start, 1.0).named("clebsch_default"),
    ];
    results("P1", h, 100, trials, work)
}

fn heavy_top(h: f64) -> Vec<Result> {
    let (inertia, center) = ([1.0, 1.5, 2.0], [0.0, 0.0, 1.0]);
    let (tilt, momentum) = (0.5_f64, [0.1, 0.3, 10.0]);
    let mass_matrix = Matrix3::from_diagonal(&Vector3::new(1.25, 0.75, 0.25));
    let stepper = HeavyTop { mass_matrix, weight: 1.0, center: center.into() }.into_stepper(h).expect("a top");
    let attitude = *Rotation3::from_axis_angle(&Vector3::x_axis(), tilt).matrix();
    let start = stepper.state(attitude, momentum.into()).expect("a state");
    let (cos, sin) = ((tilt / 2.0).cos(), (tilt / 2.0).sin());
    let hand = Body::new(h, inertia, center, [cos, sin, 0.0, 0.0], momentum);
    let [m1, m2, m3] = momentum;
    let rk4 = RungeKutta::new(h, Turning { inertia, moment: center }, [cos, sin, 0.0, 0.0, m1, m2, m3]);
    let work = {
        let (mass_matrix, center) = (mass_matrix.map(Counted), three(center));
        let top = counted::HeavyTop { mass_matrix, weight: Counted(1.0), center };
        let stepper = top.into_stepper(Counted(h)).expect("a top");
        let state = |r: Matrix3<f64>, m| stepper.state(r.map(Counted), three(m)).expect("a state");
        work(&stepper, state(attitude, momentum), 1000)
    };
    let compensated =
        CompensatedTop { mass_matrix, weight: 1.0, center: center.into() }.into_stepper(h).expect("a top");
    let compensated_start = compensated.state(attitude, momentum.into()).expect("a state");
    let default = DefaultTop { moments: inertia.into(), weight: 1.0, center: center.into() }.into_stepper(h);
    let default = default.expect("a top");
    let default_start = default.state(attitude, momentum.into()).expect("a state");
    let trials = vec![
        derived(&stepper, start, 1.0),
        by_hand("rust_hand_newton", hand),
        by_hand("rust_rk4", rk4),
        derived(&compensated, compensated_start, 1.0).named("clebsch_compensated"),
        derived(&default, default_start, 1.0).named("clebsch_default"),
    ];
    results("P2", h, 50, trials, work)
}

fn pendulum(name: &'static str, gravity: f64, h: f64) -> Vec<Result> {
    let (position, momentum) = ([0.0, 1.0, 0.0], [1.0, 0.0, 0.5]);
    let stepper = SphericalPendulum { mass: 1.0, length: 1.0, gravity }.into_stepper(h).expect("a pendulum");
    let start = stepper.state(position.into(), momentum.into()).expect("a state");
    let hand = Pendulum::new(h, gravity, position, momentum);
    let rk4 = RungeKutta::new(h, Swinging { gravity }, [0.0, 1.0, 0.0, 1.0, 0.0, 0.5]);
    let work = {
        let [mass, length, gravity] = [1.0, 1.0, gravity].map(Counted);
        let stepper =
            counted::SphericalPendulum { mass, length, gravity }.into_stepper(Counted(h)).expect("a pendulum");
        let state = |q, m| stepper.state(three(q), three(m)).expect("a state");
        work(&stepper, state(position, momentum), 1000)
    };
    let trials = vec![derived(&stepper, start, 1.0), by_hand("rust_hand_map", hand), by_hand("rust_rk4", rk4)];
    results(name, h, 100, trials, work)
}

fn four_dimensions(h: f64) -> Vec<Result> {
    let (j_d, momentum) = ([1.0, 1.5, 2.0, 2.5], [0.3, -0.5, 0.2, 0.6, -0.1, 0.5]);
    let diagonal = Matrix4::from_diagonal(&Vector4::from(j_d));
    let stepper = RigidBody4 { j_d: diagonal }.into_stepper(h).expect("a body");
    // Components of the basis Eji − Eij are −2 times the entries of M.
    let components = SVector::<f64, 6>::from(momentum) * -2.0;
    let start = stepper.state(Matrix4::identity(), components).expect("a state");
    let hand = Body4::new(h, j_d, momentum);
    let mut y = [0.0; 22];
    (0..4).for_each(|i| y[5 * i] = 1.0);
    y[16..].copy_from_slice(&momentum);
    let rk4 = RungeKutta::new(h, Turning4 { j_d }, y);
    let work = {
        let stepper = counted::RigidBody4 { j_d: diagonal.map(Counted) }.into_stepper(Counted(h)).expect("a body");
        let state =
            |m: SVector<f64, 6>| stepper.state(Matrix4::identity().map(Counted), m.map(Counted)).expect("a state");
        work(&stepper, state(components), 1000)
    };
    // The pairing tr(MᵀΩ) counts each plane twice.
    let trials = vec![derived(&stepper, start, 0.5), by_hand("rust_hand_fixed_point", hand), by_hand("rust_rk4", rk4)];
    results("P4", h, 100, trials, work)
}

fn three(entries: [f64; 3]) -> Vector3<Counted> {
    Vector3::from(entries.map(Counted))
}

/// The first trial is the derived step, the second the same scheme by hand.
fn results(problem: &'static str, h: f64, duration: u64, trials: Vec<Trial<'_>>, work: Work) -> Vec<Result> {
    let steps = (1.0 / h).round() as u64; // in a unit of time
    let ends: Vec<_> = trials.iter().map(|trial| (trial.drift)(steps, duration)).collect();
    let apart = ends[0].1.iter().zip(&ends[1].1).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-7, "{problem}: the derived step and the one by hand part by {apart:e}");
    let (names, runs): (Vec<_>, Vec<_>) = trials.into_iter().map(|trial| (trial.name, trial.run)).unzip();
    let times = interleaved(&runs);
    let rows = names.into_iter().zip(times).zip(ends).enumerate();
    rows.map(|(index, ((peer, time), (drift, _)))| Result {
        problem,
        peer,
        setting: if index == 0 { "derive, rustc -O3" } else { "rustc -O3" },
        h,
        time,
        drift,
        work: (index == 0).then_some(work),
    })
    .collect()
}
