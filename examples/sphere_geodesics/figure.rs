//! The coordinates along the great circle, and how far round-off leads away from it.

use crate::watch::{Growth, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, INK, ORANGE, Panel, Series, along};
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;

/// Above the coordinates over the first turns; below the defects against the number of steps, both logarithmic.
pub fn draw<const D: usize>(flags: &Flags, watch: &Watch<D>) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 600), |area| {
        let title = format!("A geodesic of S{}: {:.4} rad a step", D - 1, watch.circle.angle);
        let (above, below) = figure::rows(&figure::caption(area, &title)?, 260.0);
        coordinates(watch).draw(&above)?;
        growth(watch).draw(&below)
    })
}

fn coordinates<const D: usize>(watch: &Watch<D>) -> Panel<'static> {
    let series = (0..D).map(|i| {
        let points = watch.path.iter().map(|(time, q)| (*time, q[i])).collect();
        Series { label: "", colour: along(i as f64 / (D - 1) as f64), points }
    });
    let title = "Coordinates q₁ (dark) to the last (light): all of them turn with one frequency";
    Panel { title, unit: "", x_label: "time (s)", series: series.collect() }
}

fn growth<const D: usize>(watch: &Watch<D>) -> Panel<'static> {
    let curve = |label, colour, value: fn(&Growth) -> f64| {
        // an error of zero has no logarithm: a gap
        let points = watch.growth.iter().map(|growth| ((growth.step as f64).log10(), value(growth).log10())).collect();
        Series { label, colour, points }
    };
    let series = vec![
        curve("worst case", INK, |growth| round_off::worst_case(growth.step, 1.0)),
        curve("from the circle", BLUE, |growth| growth.distance),
        curve("from its plane", GREEN, |growth| growth.outside),
        curve("||q|² − 1|", ORANGE, |growth| growth.off_sphere),
    ];
    Panel {
        title: "Round-off, log₁₀ of the largest so far", unit: "", x_label: "log₁₀ of the number of steps", series
    }
}
