//! Constraints: the path of Chaplygin's sleigh, and its turning rate against the closed form.

use crate::Pictures;
use clebsch::Clebsch;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::figure::{self, Arrow, BLUE, GREEN, ORANGE, Panel, Path, Plane, Series};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector3};

/// A sleigh on a blade that does not slip sideways. Its velocity is (ω, v_x, v_y) in the frame of the blade.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    lagrangian     = |xi| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + (xi.z + self.offset * xi.x).powi(2))) / 2,
    discretization = moser_veselov,
    constraint     = |xi| [xi.z == 0],
)]
pub struct Sleigh {
    /// Kilograms.
    pub mass: f64,
    /// Moment of inertia about the centre of mass, kg·m².
    pub inertia: f64,
    /// Centre of mass ahead of the blade, metres.
    pub offset: f64,
}

const STEP: f64 = 0.02;
const STEPS: usize = 400;

pub fn constraints(pictures: &Pictures, claims: &mut Claims) -> Result<(), Failure> {
    let sleigh = Sleigh { mass: 1.5, inertia: 0.4, offset: 0.6 };
    let about_blade = sleigh.inertia + sleigh.mass * sleigh.offset.powi(2);
    let (turning, speed) = (1.1, -0.8);
    let stepper = sleigh.stepper(STEP)?;
    let start = stepper.state_moving(Matrix3::identity(), Vector3::new(turning, speed, 0.0))?;

    // v = C tanh(aCt/β² + δ) and ω = C/β sech(aCt/β² + δ), with β² = (I + ma²)/m and C² = v² + β²ω²
    let beta = (about_blade / sleigh.mass).sqrt();
    let c = speed.hypot(beta * turning);
    let delta = (speed / c).atanh();
    let rate = |t: f64| c / beta / (sleigh.offset * c * t / (beta * beta) + delta).cosh();

    let (mut path, mut rates, mut arrows) = (Vec::new(), Vec::new(), Vec::new());
    for (k, state) in stepper.trajectory(start).take(STEPS + 1).enumerate() {
        let state = state?;
        let q = state.configuration();
        let at = (q[(0, 2)], q[(1, 2)]);
        path.push(at);
        rates.push((k as f64 * STEP, state.momentum().x / about_blade));
        if k % 50 == 0 {
            arrows.push(Arrow { at, heading: q[(1, 0)].atan2(q[(0, 0)]), colour: GREEN });
        }
    }
    let error = largest(rates.iter().map(|&(t, turns)| (turns - rate(t)).abs()));
    claims.at_most(
        "turning rate of the sleigh, against sech",
        error,
        2e-3,
        "second order: falls by four with half of the step",
    );
    let exact = rates.iter().map(|&(t, _)| (t, rate(t))).collect();
    let series = vec![
        Series { label: "closed form", colour: ORANGE, points: exact },
        Series { label: "steps of 0.02 s", colour: BLUE, points: rates },
    ];
    let paths = [Path { label: "", points: &path, colour: Some(BLUE), width: 2.0 }];
    pictures.draw("constraints", |area| {
        let (left, right) = figure::columns(area, 370.0);
        let left = figure::caption(&left, "Path of the blade, and its direction")?;
        Plane { unit: "m", paths: &paths, arrows: &arrows }.draw(&left)?;
        Panel { title: "Turning rate of the sleigh", unit: "rad/s", x_label: "time (s)", series }.draw(&right)
    })
}
