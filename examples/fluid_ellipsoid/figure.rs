//! The shape of the drop, its conserved quantities, and the spheroid that swirl turns back.

use crate::exact::Swirl;
use crate::watch::Watch;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Drawn, GREEN, Globe, INK, ORANGE, PURPLE, Panel, Pointer, RED};
use clebsch_examples::figure::{Series, Track, View};
use clebsch_examples::scene::Failure;

/// Left the direction of the longest axis; right the semi-axes, the changes of the momenta, and the swirling spheroid.
pub fn draw(flags: &Flags, watch: &Watch, swirl: &Swirl) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 600), |area| {
        let (left, right) = figure::columns(area, 470.0);
        globe(&figure::caption(&left, "A drop without gravity: its longest axis")?, flags, watch)?;
        let (first, rest) = figure::rows(&right, 190.0);
        let (second, third) = figure::rows(&rest, 180.0);
        semi_axes(watch).draw(&first)?;
        changes(watch).draw(&second)?;
        spheroid(swirl).draw(&third)
    })
}

/// An axis has no sign: it goes on from where it was.
fn path(watch: &Watch) -> Vec<[f64; 3]> {
    let mut path: Vec<[f64; 3]> = Vec::with_capacity(watch.samples.len());
    for sample in &watch.samples {
        let axis: [f64; 3] = sample.longest.into();
        let turned = path.last().is_some_and(|last| last.iter().zip(&axis).map(|(a, b)| a * b).sum::<f64>() < 0.0);
        path.push(if turned { axis.map(|entry| -entry) } else { axis });
    }
    path
}

fn globe(area: &Area<'_>, flags: &Flags, watch: &Watch) -> Drawn {
    let path = path(watch);
    let axis = |label, direction| Pointer { label, direction, colour: INK };
    let mut pointers = vec![axis("x", [1.0, 0.0, 0.0]), axis("y", [0.0, 1.0, 0.0]), axis("z", [0.0, 0.0, 1.0])];
    pointers.extend(path.last().map(|&direction| Pointer { label: "longest", direction, colour: PURPLE }));
    let azimuth = path.last().map_or(0.0, |axis| axis[1].atan2(axis[0]).to_degrees() - 40.0);
    let tracks = [Track { points: &path, colour: None, width: 1.6 }];
    Globe { view: View { azimuth, elevation: 25.0 }, pointers: &pointers, tracks: &tracks }.draw(area)?;
    figure::colour_bar(area, "0 s", &format!("{} s", flags.run.duration()))
}

fn semi_axes(watch: &Watch) -> Panel<'static> {
    let series = [("longest", BLUE), ("middle", GREEN), ("shortest", ORANGE)].into_iter().enumerate();
    let curve = |(index, (label, colour))| {
        let points = watch.samples.iter().map(|sample| (sample.time, sample.semi_axes[index])).collect();
        Series { label, colour, points }
    };
    Panel { title: "Semi-axes", unit: "radii", x_label: "", series: series.map(curve).collect() }
}

fn changes(watch: &Watch) -> Panel<'static> {
    let series = [("angular momentum", BLUE), ("circulation", RED)].into_iter().enumerate();
    let curve = |(index, (label, colour))| {
        let points = watch.samples.iter().map(|sample| (sample.time, sample.changes[index])).collect();
        Series { label, colour, points }
    };
    Panel { title: "Largest change", unit: "kg·m²/s", x_label: "time (s)", series: series.map(curve).collect() }
}

fn spheroid(swirl: &Swirl) -> Panel<'static> {
    let exact =
        swirl.exact.iter().flat_map(|&(time, radius)| [(time, radius), (time, radius * 1.04), (time, f64::NAN)]);
    Panel {
        title: "A swirling spheroid",
        unit: "radii",
        x_label: "time (s)",
        series: vec![
            Series { label: "quadrature", colour: ORANGE, points: exact.collect() },
            Series { label: "steps", colour: BLUE, points: swirl.radii.clone() },
        ],
    }
}
