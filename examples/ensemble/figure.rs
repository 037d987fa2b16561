//! The spins of a few bodies, and the mean of all.

use crate::watch::{DRAWN, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, INK, ORANGE, PURPLE, Panel, RED, RGBColor, Series};
use clebsch_examples::scene::Failure;

/// The colours of the bodies, in turn.
const COLOURS: [RGBColor; 6] = [BLUE, ORANGE, GREEN, RED, PURPLE, INK];

/// Above the first bodies, below the mean with the exact one.
pub fn draw(flags: &Flags, watch: &Watch) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 600), |area| {
        let title = format!("{} free bodies spun about their intermediate axis", flags.bodies);
        let area = figure::caption(area, &title)?;
        let (above, below) = figure::rows(&area, 270.0);
        bodies(watch).draw(&above)?;
        mean(watch).draw(&below)
    })
}

fn bodies(watch: &Watch) -> Panel<'static> {
    let count = watch.samples.first().map_or(0, |sample| sample.drawn.len().min(DRAWN));
    let curve = |body: usize| {
        let points = watch.samples.iter().map(|sample| (sample.time, sample.drawn[body])).collect();
        Series { label: "", colour: COLOURS[body % COLOURS.len()], points }
    };
    Panel {
        title: "Spin π₂/|π| of the first bodies", unit: "", x_label: "", series: (0..count).map(curve).collect()
    }
}

fn mean(watch: &Watch) -> Panel<'static> {
    let points = |value: fn(&crate::watch::Sample) -> f64| {
        watch.samples.iter().map(|sample| (sample.time, value(sample))).collect()
    };
    let exact = Series { label: "exact", colour: ORANGE, points: points(|sample| sample.exact) };
    let steps = Series { label: "steps", colour: BLUE, points: points(|sample| sample.mean) };
    Panel { title: "Mean spin of all", unit: "", x_label: "time (s)", series: vec![exact, steps] }
}
