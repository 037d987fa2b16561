//! Torques and their bounds, momentum, and how far flights are from the plan.

use super::flight::{Flight, Sortie};
use super::plan::Plan;
use super::problem::Problem;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, PURPLE, Panel, Pointer, RED};
use clebsch_examples::figure::{RGBColor, Series, Track, View};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Rotation3};

/// Axes of the body, and their colours.
const AXES: [(&str, RGBColor); 3] = [("u₁", BLUE), ("u₂", ORANGE), ("u₃", GREEN)];

/// Left the paths of the first axis in space; right torques, and angles of flights to the plan.
pub fn draw(flags: &Flags, problem: &Problem, plan: &Plan, free: &Plan, sorties: &[Sortie; 2]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 640), |area| {
        let (left, right) = figure::columns(area, 440.0);
        let title = format!("From rest to rest in {} s, the first axis of the body", problem.duration);
        globe(&figure::caption(&left, &title)?, problem, plan)?;
        let (above, below) = figure::rows(&right, 215.0);
        let (middle, below) = figure::rows(&below, 205.0);
        torques(flags, plan, Some(problem.top), "Torques of least effort").draw(&above)?;
        torques(flags, free, None, "without bounds").draw(&middle)?;
        flights(flags, sorties).draw(&below)
    })
}

fn globe(area: &Area<'_>, problem: &Problem, plan: &Plan) -> Drawn {
    let axis = |attitude: &Matrix3<f64>| <[f64; 3]>::from(attitude.column(0).into_owned());
    let planned: Vec<_> = plan.places().map(|place| axis(&place.0)).collect();
    let steady = |part: u32| axis(&(problem.from * Rotation3::new(problem.turn * f64::from(part) / 100.0).matrix()));
    let steady: Vec<_> = (0..=100).map(steady).collect();
    let pointers = [
        Pointer { label: "from", direction: axis(&problem.from), colour: INK },
        Pointer { label: "to", direction: axis(&problem.to), colour: RED },
    ];
    let tracks = [
        Track { points: &steady, colour: Some(PURPLE), width: 1.0 },
        Track { points: &planned, colour: Some(BLUE), width: 2.4 },
    ];
    Globe { view: View { azimuth: 40.0, elevation: 20.0 }, pointers: &pointers, tracks: &tracks }.draw(area)
}

fn torques(flags: &Flags, plan: &Plan, top: Option<f64>, title: &'static str) -> Panel<'static> {
    let curve = |axis: usize| {
        let stairs = (0..)
            .zip(&plan.stages)
            .flat_map(|(step, stage)| [step, step + 1].map(|end| (flags.run.time(end), stage.input()[axis])));
        Series { label: AXES[axis].0, colour: AXES[axis].1, points: stairs.collect() }
    };
    let bound =
        |value: f64| Series { label: "", colour: RED, points: vec![(0.0, value), (flags.run.duration(), value)] };
    let series = (0..3).map(curve).chain(top.into_iter().flat_map(|top| [bound(top), bound(-top)])).collect();
    Panel { title, unit: "N m", x_label: "", series }
}

fn flights(flags: &Flags, sorties: &[Sortie; 2]) -> Panel<'static> {
    let curve = |label, colour, flight: &Flight| {
        let points = (0..).zip(&flight.off).map(|(step, off)| (flags.run.time(step), off.to_degrees()));
        Series { label, colour, points: points.collect() }
    };
    let [_, start] = sorties[0].surprised();
    let [inertia, _] = sorties[1].surprised();
    let series = vec![
        curve("start", ORANGE, &start.open),
        curve("corrected", RED, &start.closed),
        curve("inertia", GREEN, &inertia.open),
        curve("corrected", BLUE, &inertia.closed),
    ];
    Panel { title: "Flown: off by", unit: "degrees", x_label: "time (s)", series }
}
