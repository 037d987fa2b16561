//! Kick and drift: three steps of a pendulum in its phase space.

use crate::Pictures;
use clebsch::Clebsch;
use clebsch_examples::figure::{BLUE, GREEN, ORANGE, Panel, RGBColor, Series};
use clebsch_examples::scene::Failure;
use nalgebra::Vector1;

/// A pendulum of length one and mass one, by its angle.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, angle: Vector1| angle + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |angle| -self.gravity * angle.x.cos(),
)]
pub struct Pendulum {
    /// g, m/s².
    pub gravity: f64,
}

/// Long, so that one sees its three motions.
const STEP: f64 = 0.8;
const PALE: RGBColor = RGBColor(196, 203, 213);

pub fn kick_and_drift(pictures: &Pictures) -> Result<(), Failure> {
    let stepper = Pendulum { gravity: 1.0 }.stepper(STEP)?;
    let start = stepper.state(Vector1::new(-1.1), Vector1::new(0.7))?;
    let mut series = Vec::new();
    for energy in [-0.7, -0.3, 0.1, 0.5, 0.9] {
        series.push(Series { label: "", colour: PALE, points: level(energy) });
    }
    let mut state = start;
    for step in 0..3 {
        let next = stepper.step(&state)?;
        let half_kick = |angle: f64| -STEP / 2.0 * angle.sin();
        let (from, to) = (state.configuration().x, next.configuration().x);
        let (before, after) = (state.momentum().x, next.momentum().x);
        let drifting = before + half_kick(from);
        let label = |label| if step == 0 { label } else { "" };
        let kick = |angle, from, to| vec![(angle, from), (angle, to)];
        series.push(Series { label: label("half kick"), colour: ORANGE, points: kick(from, before, drifting) });
        series.push(Series { label: label("drift"), colour: BLUE, points: vec![(from, drifting), (to, drifting)] });
        series.push(Series { label: label("half kick"), colour: GREEN, points: kick(to, drifting, after) });
        state = next;
    }
    let panel = Panel { title: "Three steps of 0.8 s of a pendulum", unit: "momentum", x_label: "angle (rad)", series };
    pictures.draw("kick-and-drift", |area| panel.draw(area))
}

/// The momentum against the angle on a level of the energy ½p² − cos(angle), for swings to both sides.
fn level(energy: f64) -> Vec<(f64, f64)> {
    let widest = (-energy).acos();
    let upper = (0..=60).map(|i| -widest * (f64::from(i) * std::f64::consts::PI / 60.0).cos());
    let half: Vec<_> = upper.map(|angle| (angle, (2.0 * (energy + angle.cos())).max(0.0).sqrt())).collect();
    let back = half.iter().rev().map(|&(angle, momentum)| (angle, -momentum));
    half.iter().copied().chain(back).collect()
}
