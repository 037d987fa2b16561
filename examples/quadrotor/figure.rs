//! The flight from the side, thrusts and their bounds, and how far flights are from the plan.

use super::flight::{Flight, Pair};
use super::place::{attitude, position, tilt};
use super::plan::Plan;
use super::problem::Problem;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, INK, ORANGE, PURPLE, Panel, RED, RGBColor, Series};
use clebsch_examples::scene::Failure;

/// Rotors, and their colours.
const ROTORS: [(&str, RGBColor); 4] = [("u₁", BLUE), ("u₂", ORANGE), ("u₃", GREEN), ("u₄", PURPLE)];
/// Half the width of the drawn vehicle, m.
const WIDTH: f64 = 0.06;
/// Vehicles that are drawn.
const SHOWN: usize = 20;

/// Left the flight from the side, and how far it leans; right thrusts, and distances of flights from the plan.
pub fn draw(flags: &Flags, problem: &Problem, plan: &Plan, pairs: &[Pair; 3]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (left, right) = figure::columns(area, 500.0);
        let (above, below) = figure::rows(&left, 330.0);
        side(plan).draw(&above)?;
        lean(flags, plan).draw(&below)?;
        let (above, below) = figure::rows(&right, 280.0);
        thrusts(flags, problem, plan).draw(&above)?;
        flights(flags, pairs).draw(&below)
    })
}

fn side(plan: &Plan) -> Panel<'static> {
    let path = plan.places().map(|place| (position(&place).x, position(&place).z)).collect();
    let every = plan.stages.len().div_ceil(SHOWN).max(1);
    let vehicles = plan.places().step_by(every).flat_map(|place| {
        let (at, axes) = (position(&place), attitude(&place));
        let rim = |side: f64| (at.x + side * WIDTH * axes[(0, 0)], at.z + side * WIDTH * axes[(2, 0)]);
        let up = (at.x + WIDTH * axes[(0, 2)], at.z + WIDTH * axes[(2, 2)]);
        [rim(-1.0), rim(1.0), (0.0, f64::NAN), (at.x, at.z), up, (0.0, f64::NAN)]
    });
    let vehicles = Series { label: "", colour: INK, points: vehicles.collect() };
    let path = Series { label: "", colour: BLUE, points: path };
    Panel { title: "From the side: first axis and thrust", unit: "m", x_label: "x (m)", series: vec![path, vehicles] }
}

fn lean(flags: &Flags, plan: &Plan) -> Panel<'static> {
    let points = (0..).zip(plan.places()).map(|(step, place)| (flags.run.time(step), tilt(&place).to_degrees()));
    let series = vec![Series { label: "", colour: PURPLE, points: points.collect() }];
    Panel { title: "Leans from the vertical", unit: "degrees", x_label: "time (s)", series }
}

fn thrusts(flags: &Flags, problem: &Problem, plan: &Plan) -> Panel<'static> {
    let curve = |rotor: usize| {
        let stairs = (0..).zip(&plan.stages);
        let stairs =
            stairs.flat_map(|(step, stage)| [step, step + 1].map(|end| (flags.run.time(end), stage.input()[rotor])));
        Series { label: ROTORS[rotor].0, colour: ROTORS[rotor].1, points: stairs.collect() }
    };
    let bound =
        |value: f64| Series { label: "", colour: RED, points: vec![(0.0, value), (flags.run.duration(), value)] };
    let series = (0..4).map(curve).chain([bound(0.0), bound(problem.vehicle.top)]).collect();
    Panel { title: "Thrusts of least effort", unit: "N", x_label: "", series }
}

fn flights(flags: &Flags, [_, gust, heavier]: &[Pair; 3]) -> Panel<'static> {
    let curve = |label, colour, flight: &Flight| {
        let points = (0..).zip(&flight.off).map(|(step, &off)| (flags.run.time(step), off));
        Series { label, colour, points: points.collect() }
    };
    let series = vec![
        curve("gust", ORANGE, &gust.open),
        curve("corrected", RED, &gust.closed),
        curve("heavier", GREEN, &heavier.open),
        curve("corrected", BLUE, &heavier.closed),
    ];
    Panel { title: "Flown: off by", unit: "m", x_label: "time (s)", series }
}
