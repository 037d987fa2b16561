//! Where the first axis of the body points on the way, how far it has turned, and how fast.

use super::problem::Problem;
use super::ways::Way;
use crate::attitude::turn;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, PURPLE, Panel, Pointer, RGBColor};
use clebsch_examples::figure::{Series, Track, View};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector3};

/// Colours of the ways.
const COLOURS: [RGBColor; 4] = [BLUE, ORANGE, GREEN, PURPLE];

/// Left the paths of the first axis in space; right the angle from the start for all ways, and the angular velocity of the least.
pub fn draw(flags: &Flags, problem: &Problem, ways: &[Way], least: &Way) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let title = format!("Slews in {} s, the first axis of the body", problem.duration);
        globe(&figure::caption(&left, &title)?, problem, ways)?;
        let (above, below) = figure::rows(&right, 270.0);
        angles(flags, problem, ways).draw(&above)?;
        spin(flags, problem, least).draw(&below)
    })
}

fn globe(area: &Area<'_>, problem: &Problem, ways: &[Way]) -> Drawn {
    let axis = |attitude: &Matrix3<f64>| <[f64; 3]>::from(attitude.column(0).into_owned());
    let points = |way: &Way| way.slew.path.iter().map(|(attitude, _)| axis(attitude)).collect::<Vec<_>>();
    let paths: Vec<_> = ways.iter().map(points).collect();
    let widths = [2.4, 1.4, 0.9, 0.9];
    let tracks = paths.iter().zip(COLOURS).zip(widths);
    let mut tracks: Vec<_> =
        tracks.map(|((points, colour), width)| Track { points, colour: Some(colour), width }).collect();
    tracks.reverse();
    let pointers = [
        Pointer { label: "from", direction: axis(&problem.from), colour: INK },
        Pointer { label: "to", direction: axis(&problem.to), colour: RGBColor(190, 44, 52) },
    ];
    Globe { view: View { azimuth: 40.0, elevation: 20.0 }, pointers: &pointers, tracks: &tracks }.draw(area)
}

fn angles(flags: &Flags, problem: &Problem, ways: &[Way]) -> Panel<'static> {
    let curve = |(way, colour): (&Way, RGBColor)| {
        let angle = |attitude: &Matrix3<f64>| turn(&problem.from, attitude).norm().to_degrees();
        let points = (0..).zip(&way.slew.path).map(|(step, (attitude, _))| (flags.run.time(step), angle(attitude)));
        Series { label: way.name, colour, points: points.collect() }
    };
    let series = ways.iter().zip(COLOURS).map(curve).collect();
    Panel { title: "Turned by", unit: "degrees", x_label: "", series }
}

fn spin(flags: &Flags, problem: &Problem, least: &Way) -> Panel<'static> {
    let curve = |label, colour, entry: fn(&Vector3<f64>) -> f64| {
        let value = |momentum: &Vector3<f64>| entry(&problem.body.spin(momentum)).to_degrees();
        let points = (0..).zip(&least.slew.path).map(|(step, (_, momentum))| (flags.run.time(step), value(momentum)));
        Series { label, colour, points: points.collect() }
    };
    let series = vec![
        curve("Ω₁", BLUE, |omega| omega.x),
        curve("Ω₂", ORANGE, |omega| omega.y),
        curve("Ω₃", GREEN, |omega| omega.z),
    ];
    Panel { title: "Angular velocity of the least", unit: "degrees/s", x_label: "time (s)", series }
}
