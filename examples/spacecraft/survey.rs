//! The six ways in which the principal axes can point, each tilted a little and followed.

use crate::Spacecraft;
use crate::body::{Body, Orientation};
use crate::equations::Equations;
use crate::libration::{Linear, Mode, Tilt};
use crate::orbit::Circle;
use clebsch::{Clebsch, Method};
use clebsch_examples::claims::Claims;
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Each of yaw, roll and pitch at the start, radians.
const TILT: f64 = 1e-8;
/// An unstable orientation is followed until its tilt has grown by this factor.
const GROWTH: f64 = 1e4;
/// A stable one over this many orbits.
const ORBITS: f64 = 20.0;
/// A case takes at most this many steps.
const LONGEST: f64 = 1e5;
/// Growth below this, in units of n, is not told from none.
const LEAST_GROWTH: f64 = 0.05;

/// One orientation and the outcome of a tilt.
pub struct Case {
    /// Moments about radius, direction of flight and normal, by their rank from 0.
    pub places: [usize; 3],
    /// Of the linear theory.
    pub linear: Linear,
    mode: Mode,
    /// How fast the growing part grew, in units of n.
    pub growth: f64,
    /// The largest tilt over the first.
    largest: f64,
    /// The bound by Lagrange's integral; none where it is indefinite.
    bound: Option<f64>,
    /// h·2n, with 2n the largest of the entries of the linear system.
    angle: f64,
    order: Order,
}

/// Follows all six.
pub fn follow<M: Method<Spacecraft>>(body: &Body, radius: f64, run: &Run) -> Result<Vec<Case>, Failure> {
    let circle = Circle::new(body, radius, run)?;
    Orientation::ALL.iter().map(|&places| case::<M>(body, &Orientation::new(body, places), &circle, run)).collect()
}

fn case<M: Method<Spacecraft>>(
    body: &Body,
    orientation: &Orientation,
    circle: &Circle,
    run: &Run,
) -> Result<Case, Failure> {
    let (equations, linear) = (Equations::new(body), Linear::new(orientation));
    let (n, mode) = (circle.mean_motion, linear.fastest());
    let is_unstable = mode.root.re > LEAST_GROWTH;
    let duration = if is_unstable { GROWTH.ln() / (mode.root.re * n) } else { ORBITS * TAU / n };
    let steps = (duration / run.step_size).ceil().clamp(1.0, LONGEST) as u64;

    let stepper = Spacecraft::from(body).into_stepper_by::<M>(run.step_size)?;
    let (pose, momentum) = circle.start(body, orientation, &Vector3::repeat(TILT));
    let mut state = stepper.state(pose, momentum)?;
    let first = Tilt::new(&equations, orientation, circle, &pose, &momentum);
    let (mut tilt, mut largest) = (first, first.angles.norm());
    for step in 1..=steps {
        state = stepper.step(&state).map_err(|error| Failure::Step { step, error })?;
        tilt = Tilt::new(&equations, orientation, circle, state.configuration(), &state.momentum());
        largest = largest.max(tilt.angles.norm());
    }
    let grown = |tilt: &Tilt| linear.growing_part(&mode, tilt, n);
    let growth = if is_unstable { (grown(&tilt) / grown(&first)).ln() / (n * run.time(steps)) } else { 0.0 };
    Ok(Case {
        places: orientation.places,
        linear,
        mode,
        growth,
        largest: largest / first.angles.norm(),
        bound: bound(orientation, &first.angles),
        angle: 2.0 * n * run.step_size,
        order: run.order,
    })
}

/// Lagrange's integral is ½ Σ J α̇² + ½ n² (κ_y ψ² + κ_r ρ² + κ_p θ²) with κ = (pitch − roll), 4(pitch − yaw), 3(roll −
/// yaw). From rest, no angle exceeds √(Σ κα²/κ_min).
fn bound(orientation: &Orientation, angles: &Vector3<f64>) -> Option<f64> {
    let [yaw, roll, pitch] = orientation.moments.into();
    let stiffness = Vector3::new(pitch - roll, 4.0 * (pitch - yaw), 3.0 * (roll - yaw));
    let sum = stiffness.dot(&angles.component_mul(angles));
    (stiffness.min() > 0.0).then(|| (sum / stiffness.min()).sqrt() / angles.norm())
}

/// The cases as a table.
pub fn table(cases: &[Case]) -> Table<6> {
    let mut table = Table::new([
        "axis to the planet, along, normal",
        "k_roll",
        "k_yaw",
        "growth, theory / n",
        "growth, steps / n",
        "fastest",
    ]);
    for case in cases {
        let fastest = if case.mode.is_pitch { "pitch" } else { "roll and yaw" };
        table.row([
            name(case.places),
            format!("{:.4}", case.linear.roll),
            format!("{:.4}", case.linear.yaw),
            format!("{:.6}", case.theory()),
            format!("{:.6}", case.growth),
            if case.theory() > 0.0 { fastest.to_owned() } else { "-".to_owned() },
        ]);
    }
    table
}

fn name(places: [usize; 3]) -> String {
    places.map(|place| ["longest", "middle", "shortest"][place]).join(", ")
}

impl Case {
    /// Growth by the linear theory, in units of n; zero where there is none.
    pub fn theory(&self) -> f64 {
        if self.mode.root.re > LEAST_GROWTH { self.mode.root.re } else { 0.0 }
    }

    /// Unstable orientations leave at the rate of the linear theory, Lagrange's stays within its integral.
    ///
    /// At order 1 the momenta are half a kick ahead, and the growing part is measured wrongly by hΩ at start and end.
    pub fn claim(&self, claims: &mut Claims) {
        let name = name(self.places);
        let half_kick = if self.order == Order::First { self.angle } else { 0.0 };
        if self.theory() > 0.0 {
            // The entries of the system are relative to its root as 2n to the growth; where roots are close, once more.
            let condition = (2.0 / self.theory()).powi(2);
            let error = (self.growth / self.theory() - 1.0).abs();
            let bound = condition * (self.angle.powi(2) / 4.0 + 2.0 * half_kick / GROWTH.ln()) + TILT * GROWTH;
            let reason = "growth rate, relative error; (hΩ)² and condition";
            claims.at_most(&format!("{name}: unstable"), error, bound, reason);
        } else if let Some(bound) = self.bound {
            let bound = bound * (1.0 + self.angle.powi(2) + half_kick);
            let reason = "largest tilt over the first; Lagrange's integral";
            claims.at_most(&format!("{name}: stable"), self.largest, bound, reason);
        } else {
            let reason =
                "neither a growing root nor Lagrange's integral decides (DeBra and Delp's region, or equal moments)";
            claims.skip(&name, reason);
        }
    }
}
