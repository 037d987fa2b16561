//! The body momentum, and the conserved quantities of the steps.

use crate::watch::Watch;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, ORANGE, Panel, RED, Series, along};
use clebsch_examples::scene::Failure;

/// Above the ten entries of M at the beginning; below the changes of the conserved quantities over the run.
pub fn draw(flags: &Flags, watch: &Watch) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 620), |area| {
        let title = "A free rigid body on SO(5): the ten entries of its momentum in the body frame";
        let (above, below) = figure::rows(&figure::caption(area, title)?, 320.0);
        entries(watch).draw(&above)?;
        changes(watch).draw(&below)
    })
}

fn entries(watch: &Watch) -> Panel<'static> {
    let series = (0..10).map(|entry| {
        let points = watch.path.iter().map(|(time, entries)| (*time, entries[entry])).collect();
        Series { label: "", colour: along(entry as f64 / 9.0), points }
    });
    Panel {
        title: "M₁₂ (dark) to M₄₅ (light)", unit: "kg m²/s", x_label: "time (s)", series: series.collect()
    }
}

fn changes(watch: &Watch) -> Panel<'static> {
    let series = [("spatial momentum", BLUE), ("energy", ORANGE), ("Σ m²(d+d+d)", GREEN), ("Σ P²d", RED)];
    let curves = series.into_iter().enumerate().map(|(index, (label, colour))| {
        let points = watch.samples.iter().map(|sample| (sample.time, sample.changes[index])).collect();
        Series { label, colour, points }
    });
    Panel { title: "Relative change since the start", unit: "", x_label: "time (s)", series: curves.collect() }
}
