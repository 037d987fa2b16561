//! The curves of the four-bar loop, and errors of both linkages against time.

use crate::linkages::FourBar;
use crate::watch::{Law, Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, INK, ORANGE, Panel, Path, Plane, RGBColor, Series};
use clebsch_examples::scene::Failure;

/// Bars drawn in the figure.
const DRAWN: usize = 12;

/// Left the loop with the path of the middle of its coupler; right heights and errors.
pub fn draw<P: Law<24>>(
    flags: &Flags,
    bars: &FourBar,
    pendulum: &Watch<'_, 24, P>,
    four_bar: &Watch<'_, 6, FourBar>,
    heights: &[(f64, [f64; 2])],
) -> Result<(), Failure> {
    let corners = |sample: &Sample<6>| bars.corners(&sample.motion).map(|corner| (corner.x, corner.y));
    let middle = |[_, a, b, _]: [(f64, f64); 4]| ((a.0 + b.0) / 2.0, (a.1 + b.1) / 2.0);
    let coupler: Vec<(f64, f64)> = four_bar.samples.iter().map(|sample| middle(corners(sample))).collect();
    let interval = four_bar.samples.len().div_ceil(DRAWN).max(1);
    let loops: Vec<[(f64, f64); 4]> = four_bar.samples.iter().step_by(interval).map(corners).collect();
    let grey = RGBColor(196, 202, 212);
    let bars = loops.iter().map(|points| Path { label: "", points, colour: Some(grey), width: 1.4 });
    let first = loops.first().map(|points| Path { label: "at the start", points, colour: Some(INK), width: 2.4 });
    let path = Path { label: "middle of the coupler", points: &coupler, colour: Some(ORANGE), width: 1.8 };
    let paths: Vec<Path<'_>> = bars.chain(first).chain([path]).collect();
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let left = figure::caption(&left, "Four-bar loop")?;
        Plane { unit: "m", paths: &paths, arrows: &[] }.draw(&left)?;
        let (first, rest) = figure::rows(&right, 175.0);
        let (second, third) = figure::rows(&rest, 175.0);
        let height = |i: usize| heights.iter().map(|(time, both)| (*time, both[i])).collect();
        let series = vec![
            Series { label: "upper", colour: BLUE, points: height(0) },
            Series { label: "lower", colour: GREEN, points: height(1) },
        ];
        Panel { title: "Double pendulum: heights of the centres", unit: "m", x_label: "", series }.draw(&first)?;
        let energies = vec![
            Series { label: "pendulum", colour: BLUE, points: curve(pendulum, |sample| sample.energy) },
            Series { label: "four-bar", colour: ORANGE, points: curve(four_bar, |sample| sample.energy) },
        ];
        Panel { title: "Errors of the energies", unit: "J", x_label: "", series: energies }.draw(&second)?;
        let offs = vec![
            Series { label: "pendulum", colour: BLUE, points: curve(pendulum, |sample| sample.off) },
            Series { label: "four-bar", colour: ORANGE, points: curve(four_bar, |sample| sample.off) },
        ];
        let title = "Distance from the other integrator";
        Panel { title, unit: "rad", x_label: "time (s)", series: offs }.draw(&third)
    })
}

fn curve<const N: usize, L: Law<N>>(watch: &Watch<'_, N, L>, value: fn(&Sample<N>) -> f64) -> Vec<(f64, f64)> {
    watch.samples.iter().map(|sample| (sample.time, value(sample))).collect()
}
