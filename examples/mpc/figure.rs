//! The flights from above and from the side, deviations from the track, and distances from the obstacle.

use super::flight::{Flight, PAST};
use super::place::position;
use super::task::Task;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, INK, ORANGE, Panel, Path, Plane, RED, RGBColor, Series};
use clebsch_examples::scene::Failure;
use std::f64::consts::TAU;

/// Left the paths from above and from the side; right how far off flights are, and how far from the obstacle.
pub fn draw(flags: &Flags, task: &Task, flights: &[Flight]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (left, right) = figure::columns(area, 500.0);
        let (above, below) = figure::rows(&left, 350.0);
        let past = &flights[PAST];
        let flown: Vec<_> = past.path.iter().map(position).collect();
        let track: Vec<_> = (0..task.steps).map(|tick| task.track(task.time(tick))).collect();
        let [round, path] = [&track, &flown].map(|points| points.iter().map(|x| (x.x, x.y)).collect::<Vec<_>>());
        let sphere = sphere(task, past);
        let of = |label, points, colour, width| Path { label, points, colour: Some(colour), width };
        let paths = [
            of("track", &round[..], GREEN, 1.0),
            of("past the obstacle", &path, BLUE, 1.5),
            of("too near, when it is nearest", &sphere, RED, 1.2),
        ];
        Plane { unit: "m", paths: &paths, arrows: &[] }.draw(&above)?;
        let series = [("track", GREEN, &track), ("past the obstacle", BLUE, &flown)].map(|(label, colour, points)| {
            Series { label, colour, points: points.iter().map(|x| (x.x, x.z)).collect() }
        });
        let series = series.into();
        Panel { title: "From the side: z", unit: "m", x_label: "x (m)", series }.draw(&below)?;
        let (above, below) = figure::rows(&right, 270.0);
        gusts(task, flights).draw(&above)?;
        obstacle(task, flights).draw(&below)
    })
}

/// The part of the horizontal plane through the flight that is too near to the obstacle, when it is nearest.
fn sphere(task: &Task, flight: &Flight) -> Vec<(f64, f64)> {
    let clear = flight.clear(task);
    let nearest = (0..clear.len()).min_by(|a, b| clear[*a].total_cmp(&clear[*b])).unwrap_or(0);
    let middle = task.obstacle(task.time(nearest));
    let height = position(&flight.path[nearest]).z - middle.z;
    let radius = (task.clearance.powi(2) - height.powi(2)).max(0.0).sqrt();
    let angles = (0..=60).map(|part| TAU * f64::from(part) / 60.0);
    angles.map(|angle| (middle.x + radius * angle.cos(), middle.y + radius * angle.sin())).collect()
}

fn series(task: &Task, label: &'static str, colour: RGBColor, values: Vec<f64>) -> Series<'static> {
    Series { label, colour, points: (0..).map(|tick| task.time(tick)).zip(values).collect() }
}

fn gusts(task: &Task, flights: &[Flight]) -> Panel<'static> {
    let names = [("still air", GREEN), ("each tick", BLUE), ("", BLUE), ("each 5th", ORANGE), ("with gains", RED)];
    let shown = flights.iter().zip(names).filter(|(_, (label, _))| !label.is_empty());
    let series = shown.map(|(flight, (label, colour))| series(task, label, colour, flight.off(task))).collect();
    Panel { title: "Off the track", unit: "m", x_label: "", series }
}

/// While it is near.
fn obstacle(task: &Task, flights: &[Flight]) -> Panel<'static> {
    let past: Vec<_> =
        flights.iter().filter(|flight| flight.pilot.has_obstacle).map(|flight| flight.clear(task)).collect();
    let is_near = |tick: usize| past.iter().any(|clear| clear[tick] < 2.0 * task.clearance);
    let series = |label, colour, value: &dyn Fn(usize) -> f64| {
        let near = (0..task.steps).filter(|tick| is_near(*tick));
        Series { label, colour, points: near.map(|tick| (task.time(tick), value(tick))).collect() }
    };
    let mut all = vec![series("least", INK, &|_| task.clearance)];
    let names = [("one", ORANGE), ("three", GREEN), ("ten", BLUE)];
    all.extend(past.iter().zip(names).map(|(clear, (label, colour))| series(label, colour, &|tick| clear[tick])));
    Panel { title: "From the obstacle", unit: "m", x_label: "time (s)", series: all }
}
