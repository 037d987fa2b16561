//! The path of the sleigh, both crossings, and the errors of both energies.

use crate::closed_form::Place;
use crate::watch::{Motion, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Arrow, BLUE, GREEN, ORANGE, Panel, Path, Plane, RGBColor, Series};
use clebsch_examples::scene::Failure;

/// Left the path with the directions of the blade; right curves against time.
pub fn draw(flags: &Flags, watch: &Watch, path: &[(f64, f64)], arrows: &[Arrow]) -> Result<(), Failure> {
    let paths = [Path { label: "", points: path, colour: Some(BLUE), width: 2.0 }];
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (left, right) = figure::columns(area, 400.0);
        let left = figure::caption(&left, "Path of the sleigh, and the direction of its blade")?;
        Plane { unit: "m", paths: &paths, arrows }.draw(&left)?;
        let (first, rest) = figure::rows(&right, 175.0);
        let (second, third) = figure::rows(&rest, 175.0);
        let [sleigh, body] = &watch.motions;
        crossing(sleigh, "Sleigh: speed and turning", ["v", "β ω"], "m/s").draw(&first)?;
        crossing(body, "Suslov's body: angular velocity", ["along", "across"], "√J").draw(&second)?;
        let energy = |label, motion: &Motion, colour| Series { label, colour, points: motion.energies.clone() };
        let series = vec![energy("sleigh", sleigh, GREEN), energy("Suslov", body, ORANGE)];
        Panel { title: "Errors of the energies, relative", unit: "", x_label: "time (s)", series }.draw(&third)
    })
}

fn crossing<'a>(motion: &Motion, title: &'a str, labels: [&'a str; 2], unit: &'a str) -> Panel<'a> {
    let series = |label, colour: RGBColor, part: fn(&Place) -> f64| {
        let points = motion.places.iter().map(|(time, place)| (*time, part(place))).collect();
        Series { label, colour, points }
    };
    let series = vec![series(labels[0], BLUE, |place| place.along), series(labels[1], GREEN, |place| place.across)];
    Panel { title, unit, x_label: "", series }
}
