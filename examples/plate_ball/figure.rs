//! The tracks of the point of contact, and their curvature against the position across λ.

use crate::plan::{Moment, Plan};
use crate::way::{SHOWN, Way};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, Arrow, BLUE, Drawn, GREEN, INK, ORANGE, PURPLE, Panel, Path, Plane};
use clebsch_examples::figure::{Globe, Pointer, RGBColor, Series, Track, View};
use clebsch_examples::scene::Failure;

/// Colours of the ways.
const COLOURS: [RGBColor; SHOWN] = [BLUE, ORANGE, GREEN, PURPLE];
/// Names of the ways.
const NAMES: [&str; SHOWN] = ["way 1", "way 2", "way 3", "way 4"];

/// Left the tracks on the table; right the way of contact on the ball, and the curvature.
pub fn draw(flags: &Flags, ways: &[Way]) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (left, right) = figure::columns(area, 500.0);
        let title = format!("Tracks of a ball that rolls for {} s", flags.run.duration());
        plane(&figure::caption(&left, &title)?, ways)?;
        let (above, below) = figure::rows(&right, 300.0);
        globe(&figure::caption(&above, "The points of the ball that touch the table")?, ways)?;
        bending(ways).draw(&below)
    })
}

fn plane(area: &Area<'_>, ways: &[Way]) -> Drawn {
    let points = |way: &Way| way.plans[0].path.iter().map(|moment| (moment.position.x, moment.position.y)).collect();
    let tracks: Vec<Vec<_>> = ways.iter().map(points).collect();
    let widths = [2.4, 1.5, 1.0, 1.0];
    let path = |(k, points): (usize, _)| Path { label: NAMES[k], points, colour: Some(COLOURS[k]), width: widths[k] };
    let mut paths: Vec<_> = tracks.iter().map(Vec::as_slice).enumerate().map(path).collect();
    paths.reverse();
    let arrow = |(way, colour): (&Way, RGBColor)| {
        let first = way.plans[0].path[0];
        Arrow { at: (first.position.x, first.position.y), heading: first.input.y.atan2(first.input.x), colour }
    };
    let arrows: Vec<_> = ways.iter().zip(COLOURS).map(arrow).collect();
    Plane { unit: "m", paths: &paths, arrows: &arrows }.draw(area)
}

/// −Rᵀe₃: the lowest point, as the ball sees it.
fn globe(area: &Area<'_>, ways: &[Way]) -> Drawn {
    let lowest = |plan: &Plan| -> Vec<[f64; 3]> {
        plan.path.iter().map(|moment| (-moment.attitude.row(2).transpose()).into()).collect()
    };
    let lines: Vec<_> = ways.iter().map(|way| lowest(&way.plans[0])).collect();
    let widths = [2.4, 1.5, 1.0, 1.0];
    let tracks = lines.iter().zip(COLOURS).zip(widths);
    let mut tracks: Vec<_> =
        tracks.map(|((points, colour), width)| Track { points, colour: Some(colour), width }).collect();
    tracks.reverse();
    let last = lines[0].last().copied().unwrap_or_default();
    let pointers = [
        Pointer { label: "first", direction: [0.0, 0.0, -1.0], colour: INK },
        Pointer { label: "last", direction: last, colour: RGBColor(190, 44, 52) },
    ];
    Globe { view: View { azimuth: 40.0, elevation: -30.0 }, pointers: &pointers, tracks: &tracks }.draw(area)
}

/// By how much the tracks turn at their vertices, against the position across λ: points on straight lines.
fn bending(ways: &[Way]) -> Panel<'static> {
    let curve = |(way, (label, colour)): (&Way, (&'static str, RGBColor))| {
        let plan = &way.plans[0];
        let direction = plan.path[0].costate.normalize();
        let vertex = |pair: &[Moment]| {
            let (before, after) = (pair[0].input, pair[1].input);
            let angle = before.perp(&after).atan2(before.dot(&after));
            let length = (before.norm() + after.norm()) / 2.0 * plan.h;
            (pair[1].position.perp(&direction), angle / length)
        };
        Series { label, colour, points: plan.path[..plan.steps()].windows(2).map(vertex).collect() }
    };
    let series = ways.iter().zip(NAMES.into_iter().zip(COLOURS)).map(curve).collect();
    Panel { title: "Curvature of the tracks", unit: "1/m", x_label: "position across λ (m)", series }
}
