//! The path on the table, and by how much it leaves the closed form.

use crate::watch::{Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, ORANGE, Panel, Path, Plane, RGBColor, Series};
use clebsch_examples::scene::Failure;
use nalgebra::Vector2;

/// Left the path; right the distance from the centre less the radius, and the place against that of the closed form.
pub fn draw(flags: &Flags, watch: &Watch) -> Result<(), Failure> {
    let exact = watch.exact;
    let points = |place: &dyn Fn(&Sample) -> Vector2<f64>| -> Vec<(f64, f64)> {
        watch.samples.iter().map(|sample| (place(sample).x, place(sample).y)).collect()
    };
    let (path, centre) = (points(&|sample| sample.x), points(&|sample| exact.centre(sample.time)));
    let paths = [
        Path { label: "path of the centre", points: &centre, colour: Some(ORANGE), width: 1.6 },
        Path { label: "", points: &path, colour: None, width: 1.8 },
    ];
    figure::draw(&flags.run, SCENE.name, (1000, 500), |area| {
        let (left, right) = figure::columns(area, 480.0);
        let kind = if flags.hollow { "Hollow" } else { "Solid" };
        let title = format!("{kind} ball on a table that turns at {} rad/s, tilted {}°", flags.table, flags.tilt);
        let left = figure::caption(&left, &title)?;
        Plane { unit: "m", paths: &paths, arrows: &[] }.draw(&left)?;
        figure::colour_bar(&left, "0 s", &format!("{} s", flags.run.duration()))?;
        let (first, second) = figure::rows(&right, 235.0);
        let off = |sample: &Sample| (sample.x - exact.centre(sample.time)).norm() - exact.radius;
        curve(watch, "Distance from the centre, less the radius", "", GREEN, off).draw(&first)?;
        let late = |sample: &Sample| (sample.x - exact.place(sample.time)).norm();
        curve(watch, "Distance from the closed form", "time (s)", BLUE, late).draw(&second)
    })
}

fn curve<'a>(
    watch: &Watch,
    title: &'a str,
    x_label: &'a str,
    colour: RGBColor,
    value: impl Fn(&Sample) -> f64,
) -> Panel<'a> {
    let points = watch.samples.iter().map(|sample| (sample.time, value(sample))).collect();
    Panel { title, unit: "m", x_label, series: vec![Series { label: "", colour, points }] }
}
