//! The spin as the momentum sees it, and the effect of rounding.

use crate::watch::{Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{
    self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, Panel, Pointer, Series, Track, View,
};
use clebsch_examples::scene::Failure;

/// Left the spin at rest, in axes that go with the momentum; right its part along the momentum, and the defects.
pub fn draw(flags: &Flags, watch: &Watch) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 520), |area| {
        let (left, right) = figure::columns(area, 470.0);
        globe(&figure::caption(&left, "The spin against the momentum p, in the rest frame")?, watch)?;
        let (above, below) = figure::rows(&right, 260.0);
        longitudinal(watch).draw(&above)?;
        defects(watch).draw(&below)
    })
}

fn globe(area: &Area<'_>, watch: &Watch) -> Drawn {
    let path: Vec<[f64; 3]> = watch.samples.iter().map(|sample| unit(sample.spin)).collect();
    let axis = |label, direction| Pointer { label, direction, colour: INK };
    let pointers = [axis("p", [1.0, 0.0, 0.0]), axis("B", [0.0, 0.0, 1.0])];
    let tracks = [Track { points: &path, colour: None, width: 2.0 }];
    Globe { view: View { azimuth: 35.0, elevation: 25.0 }, pointers: &pointers, tracks: &tracks }.draw(area)?;
    let end = watch.samples.last().map_or(0.0, |sample| sample.laboratory);
    figure::colour_bar(area, "0 µs", &format!("{end:.3} µs"))
}

fn longitudinal(watch: &Watch) -> Panel<'static> {
    let curve = |label, colour, part: usize| {
        let points = watch.samples.iter().map(|sample| (sample.laboratory, sample.spin[part])).collect();
        Series { label, colour, points }
    };
    let series = vec![curve("along p", BLUE, 0), curve("across p", ORANGE, 1), curve("third", GREEN, 2)];
    Panel { title: "Spin at rest", unit: "", x_label: "time of the laboratory (µs)", series }
}

fn defects(watch: &Watch) -> Panel<'static> {
    let curve = |label, colour, value: fn(&Sample) -> f64| {
        let points = watch.samples.iter().map(|sample| (sample.time, value(sample))).collect();
        Series { label, colour, points }
    };
    let series = vec![
        curve("q η qᵀ − η", BLUE, |sample| sample.defects[0]),
        curve("field of the laboratory", ORANGE, |sample| sample.defects[1]),
    ];
    Panel { title: "Defects over |q|²", unit: "", x_label: "proper time (ns)", series }
}

/// The direction of a vector whose length is one but for rounding.
fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 { vector.map(|x| x / length) } else { vector }
}
