//! The paper's two figures in one: the path, and the conserved quantities.

use crate::watch::{Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, Panel, Pointer, RGBColor};
use clebsch_examples::figure::{Series, Track, View};
use clebsch_examples::scene::Failure;

/// Left the path on the sphere; right N·q, the vertical momentum and the energy against time.
pub fn draw(flags: &Flags, watch: &Watch) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 540), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let title = format!("Spherical pendulum, order {}, steps of {} s", flags.run.order, flags.run.step_size);
        globe(&figure::caption(&left, &title)?, flags, watch)?;
        let (first, rest) = figure::rows(&right, 165.0);
        let (second, third) = figure::rows(&rest, 165.0);
        curve(watch, "N·q: zero in exact arithmetic", "", ORANGE, |sample| sample.n.dot(&sample.q)).draw(&first)?;
        curve(watch, "Vertical momentum N₃", "", GREEN, |sample| sample.n.z).draw(&second)?;
        curve(watch, "Energy |N|² + 2 g q₃", "time (s)", BLUE, Sample::papers_energy).draw(&third)
    })
}

fn globe(area: &Area<'_>, flags: &Flags, watch: &Watch) -> Drawn {
    let path: Vec<[f64; 3]> = watch.samples.iter().map(|sample| sample.q.into()).collect();
    let axis = |label, direction| Pointer { label, direction, colour: INK };
    let pointers = [axis("q₁", [1.0, 0.0, 0.0]), axis("q₂", [0.0, 1.0, 0.0]), axis("q₃", [0.0, 0.0, 1.0])];
    let tracks = [Track { points: &path, colour: None, width: 1.0 }];
    Globe { view: View { azimuth: 35.0, elevation: 18.0 }, pointers: &pointers, tracks: &tracks }.draw(area)?;
    figure::colour_bar(area, "0 s", &format!("{} s", flags.run.duration()))
}

fn curve<'a>(
    watch: &Watch,
    title: &'a str,
    x_label: &'a str,
    colour: RGBColor,
    value: fn(&Sample) -> f64,
) -> Panel<'a> {
    let points = watch.samples.iter().map(|sample| (sample.time, value(sample))).collect();
    Panel { title, unit: "", x_label, series: vec![Series { label: "", colour, points }] }
}
