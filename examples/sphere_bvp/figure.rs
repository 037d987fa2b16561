//! The throws on the sphere, and their heights.

use crate::throw::Throw;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, Panel, Pointer, RGBColor};
use clebsch_examples::figure::{Series, Track, View};
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;

/// Left both paths on the sphere; right height and speed against time.
pub fn draw(flags: &Flags, short: &Throw, long: Option<&Throw>) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 520), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let title = format!("Throws of a bob that arrive after {} s", flags.run.duration());
        globe(&figure::caption(&left, &title)?, flags, short, long)?;
        let (above, below) = figure::rows(&right, 250.0);
        panel(flags, [Some(short), long], "Height q₃", "", |q, _| q.z).draw(&above)?;
        panel(flags, [Some(short), long], "Speed |N|", "time (s)", |_, n| n.norm()).draw(&below)
    })
}

fn globe(area: &Area<'_>, flags: &Flags, short: &Throw, long: Option<&Throw>) -> Drawn {
    let points = |throw: &Throw| -> Vec<[f64; 3]> { throw.path.iter().map(|(q, _)| (*q).into()).collect() };
    let (short, long) = (points(short), long.map_or(Vec::new(), points));
    let tracks = [
        Track { points: &long, colour: Some(ORANGE), width: 1.4 },
        Track { points: &short, colour: Some(BLUE), width: 2.2 },
    ];
    let pointer = |label, direction, colour: RGBColor| Pointer { label, direction, colour };
    let pointers = [
        pointer("from", flags.from, INK),
        pointer("to", flags.to, GREEN),
        pointer("up", [0.0, 0.0, 1.0], RGBColor(160, 168, 180)),
    ];
    Globe { view: View { azimuth: 40.0, elevation: 14.0 }, pointers: &pointers, tracks: &tracks }.draw(area)
}

fn panel<'a>(
    flags: &Flags,
    throws: [Option<&Throw>; 2],
    title: &'a str,
    x_label: &'a str,
    value: fn(&Vector3<f64>, &Vector3<f64>) -> f64,
) -> Panel<'a> {
    let curve = |throw: &Throw, colour| {
        let points = (0..).zip(&throw.path).map(|(step, (q, n))| (flags.run.time(step), value(q, n)));
        Series { label: throw.name, colour, points: points.collect() }
    };
    let series =
        throws.into_iter().zip([BLUE, ORANGE]).filter_map(|(throw, colour)| Some(curve(throw?, colour))).collect();
    Panel { title, unit: "", x_label, series }
}
