//! The body momentum, and the conserved quantities of the steps.

use crate::SCENE;
use crate::start::planes;
use crate::watch::{Sample, Watch};
use clebsch_examples::claims::largest;
use clebsch_examples::figure::{self, BLUE, GREEN, ORANGE, Panel, RED, Series, along};
use clebsch_examples::flags::Run;
use clebsch_examples::scene::Failure;

/// Above the entries of M at the beginning; below the changes of the conserved quantities over the run.
pub fn draw<const N: usize>(run: &Run, watch: &Watch<N>) -> Result<(), Failure> {
    figure::draw(run, SCENE.name, (1000, 620), |area| {
        let entries = planes(N).count();
        let title = format!("A free rigid body on SO({N}): the {entries} entries of its momentum in the body frame");
        let (above, below) = figure::rows(&figure::caption(area, &title)?, 320.0);
        momentum(watch).draw(&above)?;
        changes(watch).draw(&below)
    })
}

fn momentum<const N: usize>(watch: &Watch<N>) -> Panel<'static> {
    let last = planes(N).count() - 1;
    let series = planes(N).enumerate().map(|(index, plane)| {
        let points = watch.path.iter().map(|(time, m)| (*time, m[plane])).collect();
        Series { label: "", colour: along(index as f64 / last as f64), points }
    });
    let title = "From M₁₂ (dark) to the last entry above the diagonal (light)";
    Panel { title, unit: "kg m²/s", x_label: "time (s)", series: series.collect() }
}

fn changes<const N: usize>(watch: &Watch<N>) -> Panel<'static> {
    let curve = |label, colour, value: fn(&Sample) -> f64| {
        let points = watch.samples.iter().map(|sample| (sample.time, value(sample))).collect();
        Series { label, colour, points }
    };
    let series = vec![
        curve("spatial momentum", BLUE, |sample| sample.changes[0]),
        curve("energy", ORANGE, |sample| sample.changes[1].abs()),
        curve("integrals quadratic in M", GREEN, |sample| sample.integrals[0]),
        curve("all others", RED, |sample| largest(sample.integrals[1..].iter().copied())),
    ];
    Panel { title: "Change since the start over its scale", unit: "", x_label: "time (s)", series }
}
