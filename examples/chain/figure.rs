//! The chain at some times with the path of its tip; speed, tension and energy against time.

use crate::watch::{Sample, Watch};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, INK, ORANGE, Panel, Path, Plane, RGBColor, Series};
use clebsch_examples::scene::Failure;

/// Chains drawn in the figure.
const DRAWN: usize = 16;

/// Left the chain, seen from the side; right three curves.
pub fn draw<const N: usize>(flags: &Flags, watch: &Watch<N>) -> Result<(), Failure> {
    let chain = |sample: &Sample| sample.look.joints.iter().map(|at| (at.x, at.y)).collect();
    let interval = watch.samples.len().div_ceil(DRAWN).max(1);
    let between = watch.samples.get(interval).map_or(0.0, |sample| sample.time);
    let chains: Vec<Vec<(f64, f64)>> = watch.samples.iter().step_by(interval).map(chain).collect();
    let tip: Vec<(f64, f64)> =
        watch.samples.iter().map(|sample| sample.look.joints[N]).map(|at| (at.x, at.y)).collect();
    let grey = RGBColor(196, 202, 212);
    let some = chains.iter().map(|points| Path { label: "", points, colour: Some(grey), width: 1.4 });
    let first = chains.first().map(|points| Path { label: "at the start", points, colour: Some(INK), width: 2.4 });
    let path = Path { label: "path of the tip", points: &tip, colour: Some(ORANGE), width: 1.4 };
    let paths: Vec<Path<'_>> = some.chain([path]).chain(first).collect();
    figure::draw(&flags.run, SCENE.name, (1000, 560), |area| {
        let (left, right) = figure::columns(area, 470.0);
        let left = figure::caption(&left, &format!("A chain of {N} links, every {between:.2} s"))?;
        Plane { unit: "m", paths: &paths, arrows: &[] }.draw(&left)?;
        let (first, rest) = figure::rows(&right, 175.0);
        let (second, third) = figure::rows(&rest, 175.0);
        let panel = |title, unit, x_label, colour, value: fn(&Sample) -> f64| Panel {
            title,
            unit,
            x_label,
            series: vec![Series {
                label: "",
                colour,
                points: watch.samples.iter().map(|sample| (sample.time, value(sample))).collect(),
            }],
        };
        panel("Speed of the tip", "m/s", "", ORANGE, |sample| sample.look.speed).draw(&first)?;
        panel("Tension of the first joint", "N", "", BLUE, |sample| sample.force.norm()).draw(&second)?;
        panel("Energy", "J", "time (s)", GREEN, |sample| sample.energy).draw(&third)
    })
}
