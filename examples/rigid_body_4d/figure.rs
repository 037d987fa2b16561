//! The body momentum on its two spheres, and the conserved quantities of the steps.

use crate::watch::Watch;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, Panel, Pointer, RED};
use clebsch_examples::figure::{Series, Track, View};
use clebsch_examples::scene::Failure;

/// Above the directions of the two halves of M, which are vectors of constant length; below the changes of the
/// conserved quantities.
pub fn draw(flags: &Flags, watch: &Watch) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 680), |area| {
        let (above, below) = figure::rows(area, 460.0);
        let (left, right) = figure::columns(&above, 500.0);
        globe(
            &figure::caption(&left, "Body momentum on SO(4): the self-dual half of M")?,
            0,
            ["M₁₂ + M₃₄", "M₁₃ − M₂₄", "M₁₄ + M₂₃"],
            flags,
            watch,
        )?;
        globe(
            &figure::caption(&right, "The anti-self-dual half of M")?,
            1,
            ["M₁₂ − M₃₄", "M₁₃ + M₂₄", "M₁₄ − M₂₃"],
            flags,
            watch,
        )?;
        changes(watch).draw(&below)
    })
}

fn globe(area: &Area<'_>, half: usize, axes: [&str; 3], flags: &Flags, watch: &Watch) -> Drawn {
    let path: Vec<[f64; 3]> = watch.samples.iter().map(|sample| sample.halves[half]).collect();
    let axis = |label, direction| Pointer { label, direction, colour: INK };
    let [first, second, third] = axes;
    let pointers = [axis(first, [1.0, 0.0, 0.0]), axis(second, [0.0, 1.0, 0.0]), axis(third, [0.0, 0.0, 1.0])];
    let tracks = [Track { points: &path, colour: None, width: 1.0 }];
    Globe { view: View { azimuth: 40.0, elevation: 25.0 }, pointers: &pointers, tracks: &tracks }.draw(area)?;
    figure::colour_bar(area, "0 s", &format!("{} s", flags.run.duration()))
}

fn changes(watch: &Watch) -> Panel<'static> {
    let series = [("spatial momentum", BLUE), ("energy", ORANGE), ("Manakov Σm²(d+d)", GREEN), ("Manakov Σm²dd", RED)];
    let curves = series.into_iter().enumerate().map(|(index, (label, colour))| {
        let points = watch.samples.iter().map(|sample| (sample.time, sample.changes[index])).collect();
        Series { label, colour, points }
    });
    Panel { title: "Relative change since the start", unit: "", x_label: "time (s)", series: curves.collect() }
}
