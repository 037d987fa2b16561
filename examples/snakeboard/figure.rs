//! The path of the drive, the turn and the way sideways.

use crate::watch::{Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Arrow, BLUE, GREEN, ORANGE, Panel, Path, Plane, RGBColor, Series};
use clebsch_examples::scene::Failure;

/// The path of the drive with the direction of the board, and below curves of all gaits against time.
pub fn draw(flags: &Flags, watches: &[Watch; 3]) -> Result<(), Failure> {
    let [drive, rotate, park] = watches;
    let path: Vec<(f64, f64)> = drive.samples.iter().map(|sample| sample.at).collect();
    let arrow = |sample: &Sample| Arrow { at: sample.at, heading: sample.heading, colour: GREEN };
    let arrows: Vec<Arrow> = drive.samples.iter().step_by(25).map(arrow).collect();
    let paths = [Path { label: "", points: &path, colour: Some(BLUE), width: 1.8 }];
    figure::draw(&flags.run, SCENE.name, (900, 700), |area| {
        let (first, rest) = figure::rows(area, 235.0);
        let first = figure::caption(&first, "Drive: path of the board, and its direction")?;
        Plane { unit: "m", paths: &paths, arrows: &arrows }.draw(&first)?;
        let (second, rest) = figure::rows(&rest, 145.0);
        let (third, fourth) = figure::rows(&rest, 145.0);
        let momentum = |sample: &Sample| sample.momentum;
        curve(drive, ["Drive: momentum along the wheels", "kg·m²/s", ""], BLUE, momentum).draw(&second)?;
        let heading = |sample: &Sample| sample.heading.to_degrees();
        curve(rotate, ["Rotate: heading", "°", ""], GREEN, heading).draw(&third)?;
        curve(park, ["Park: sideways", "m", "time (s)"], ORANGE, |sample| sample.at.1).draw(&fourth)
    })
}

fn curve<'a>(
    watch: &Watch,
    [title, unit, x_label]: [&'a str; 3],
    colour: RGBColor,
    value: fn(&Sample) -> f64,
) -> Panel<'a> {
    let points = watch.samples.iter().map(|sample| (sample.time, value(sample))).collect();
    Panel { title, unit, x_label, series: vec![Series { label: "", colour, points }] }
}
