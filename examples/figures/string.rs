//! Fields: sites and edges in space and time, and the pulse of a string against d'Alembert's solution.

use crate::Pictures;
use clebsch::{Clebsch, Field};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::figure::{self, BLUE, GREEN, ORANGE, PURPLE, Panel, Path, Plane, RGBColor, Series};
use clebsch_examples::scene::Failure;
use nalgebra::Vector1;

/// A point of a string of unit density and unit tension, by its height.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<1>, u: Vector1| u + a,
    lagrangian = |v| v.norm_squared() / 2,
    space      = |dx, u, next| (next - u).norm_squared() / (2 * dx.powi(2)),
    scalar     = f64,
)]
pub struct Strand;

/// Metres.
const LENGTH: f64 = 10.0;
const SITES: usize = 100;
/// Seconds.
const STEP: f64 = 0.05;
const PALE: RGBColor = RGBColor(196, 203, 213);

pub fn fields(pictures: &Pictures, claims: &mut Claims) -> Result<(), Failure> {
    let dx = LENGTH / SITES as f64;
    let stepper = Strand.grid([SITES]).spacing([dx]).periodic().stepper(STEP)?;
    let place = |i: usize| i as f64 * dx - LENGTH / 2.0;
    let pulse = |x: f64| (-4.0 * x * x).exp();
    let start: Vec<_> = (0..SITES).map(|i| Vector1::new(pulse(place(i)))).collect();
    let mut state = stepper.state(start, vec![Vector1::zeros(); SITES])?;
    let (mut series, mut errors) = (Vec::new(), Vec::new());
    for (time, label, colour) in [(0.0, "at the start", ORANGE), (1.5, "after 1.5 s", GREEN), (3.0, "after 3 s", BLUE)]
    {
        let steps = (time / STEP) as u64 - state.steps();
        stepper.advance(&mut state, steps).map_err(Failure::step(1))?;
        // half of the pulse goes either way
        let exact = |x: f64| (pulse(x - time) + pulse(x + time)) / 2.0;
        let points: Vec<_> = state.configuration().iter().enumerate().map(|(i, u)| (place(i), u.x)).collect();
        errors.extend(points.iter().map(|&(x, u)| (u - exact(x)).abs()));
        series.push(Series { label, colour, points });
    }
    claims.at_most(
        "height of the string, against d'Alembert",
        largest(errors),
        2e-2,
        "second order: falls by four with half of the spacing and of the step",
    );

    // sites across, times upward: the edges of the middle site, and its step
    let line = |from: (f64, f64), to: (f64, f64)| [from, to];
    let along: Vec<_> = (0..4).map(|k| line((0.0, f64::from(k)), (4.0, f64::from(k)))).collect();
    let across: Vec<_> = (0..5).map(|i| line((f64::from(i), 0.0), (f64::from(i), 3.0))).collect();
    let [before, after, step] =
        [line((1.0, 1.0), (2.0, 1.0)), line((2.0, 1.0), (3.0, 1.0)), line((2.0, 1.0), (2.0, 2.0))];
    let pale = |points| Path { label: "", points, colour: Some(PALE), width: 1.0 };
    let bold = |label, points, colour| Path { label, points, colour: Some(colour), width: 3.5 };
    let mut paths: Vec<Path<'_>> = along.iter().chain(&across).map(|points| pale(points)).collect();
    paths.extend([bold("edge in", &before, ORANGE), bold("edge out", &after, PURPLE), bold("step", &step, BLUE)]);
    pictures.draw("fields", |area| {
        let (left, right) = figure::columns(area, 330.0);
        let left = figure::caption(&left, "Sites across, times upward")?;
        Plane { unit: "sites, steps", paths: &paths, arrows: &[] }.draw(&left)?;
        Panel { title: "Pulse of a string", unit: "m", x_label: "place (m)", series }.draw(&right)
    })
}
