//! The flying rod at many times with its energy and momenta, and rods at rest.

use crate::flight::{Flight, Sample};
use crate::statics::Shapes;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, ORANGE, Panel, Path, Plane, RGBColor, Series, along};
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;

/// Above the flight, below the curves.
pub fn draw(flags: &Flags, flight: &Flight) -> Result<(), Failure> {
    let line = |sample: &Sample| sample.places.iter().map(|place| (place.x, place.y)).collect();
    let rods: Vec<Vec<(f64, f64)>> = flight.samples.iter().step_by(flight.interval).map(line).collect();
    let tip = |last: bool| -> Vec<(f64, f64)> {
        let place = |sample: &Sample| if last { sample.places.last() } else { sample.places.first() }.copied();
        flight.samples.iter().filter_map(place).map(|place| (place.x, place.y)).collect()
    };
    let (lower, upper) = (tip(false), tip(true));
    let grey = RGBColor(176, 184, 196);
    let count = rods.len().saturating_sub(1).max(1) as f64;
    let ends =
        [("", &lower), ("", &upper)].map(|(label, points)| Path { label, points, colour: Some(grey), width: 1.0 });
    let rods = (rods.iter().enumerate()).map(|(i, points)| Path {
        label: "",
        points,
        colour: Some(along(i as f64 / count)),
        width: 3.0,
    });
    let paths: Vec<Path<'_>> = ends.into_iter().chain(rods).collect();
    let between = flight.samples.get(flight.interval).map_or(0.0, |sample| sample.time);
    figure::draw(&flags.run, SCENE.name, (1000, 900), |area| {
        let (above, below) = figure::rows(area, 560.0);
        let title = format!("The flying rod, every {between:.1} s, and the paths of its ends");
        let above = figure::caption(&above, &title)?;
        Plane { unit: "m", paths: &paths, arrows: &[] }.draw(&above)?;
        let end = flight.samples.last().map_or(1.0, |sample| sample.time);
        figure::colour_bar(&above, "0 s", &format!("{end:.0} s"))?;
        let (first, second) = figure::columns(&below, 500.0);
        let curve =
            |value: fn(&Sample) -> f64| flight.samples.iter().map(|sample| (sample.time, value(sample))).collect();
        let energy = vec![Series { label: "", colour: GREEN, points: curve(|sample| sample.energy) }];
        Panel { title: "Energy", unit: "J", x_label: "time (s)", series: energy }.draw(&first)?;
        let momenta = vec![
            Series { label: "momentum p1", colour: BLUE, points: curve(|sample| sample.momenta[0].x) },
            Series { label: "angular L3", colour: ORANGE, points: curve(|sample| sample.momenta[1].z) },
        ];
        Panel { title: "Momenta", unit: "SI", x_label: "time (s)", series: momenta }.draw(&second)
    })
}

/// From space to the picture.
type View = fn(&Vector3<f64>) -> (f64, f64);

/// Rods at rest for growing loads.
pub fn draw_shapes(flags: &Flags, shapes: &Shapes) -> Result<(), Failure> {
    let views: [View; 3] = [
        |place| (place.z, -place.y),
        |place| (place.z, place.y),
        // x runs away from the eye
        |place| (place.z + 0.5 * place.x, place.y + 0.3 * place.x),
    ];
    let titles = [
        "A moment, up to 2πEI/L",
        "A force across, up to 10 EI/L²",
        "The 45° bend of Bathe and Bolourchi, seen from the side and from above",
    ];
    let lines: Vec<Vec<Vec<(f64, f64)>>> = (shapes.all.iter().zip(views))
        .map(|(lines, view)| lines.iter().map(|line| line.iter().map(view).collect()).collect())
        .collect();
    figure::draw(&flags.run, SCENE.name, (1000, 860), |area| {
        let (above, below) = figure::rows(area, 400.0);
        let (left, right) = figure::columns(&above, 500.0);
        for ((area, title), lines) in [left, right, below].iter().zip(titles).zip(&lines) {
            let count = lines.len().saturating_sub(1).max(1) as f64;
            let path = |(i, points)| Path { label: "", points, colour: Some(along(i as f64 / count)), width: 2.6 };
            let paths: Vec<Path<'_>> = lines.iter().map(Vec::as_slice).enumerate().map(path).collect();
            Plane { unit: "m", paths: &paths, arrows: &[] }.draw(&figure::caption(area, title)?)?;
        }
        Ok(())
    })
}
