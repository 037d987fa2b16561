//! The field at four times: colours and arrows are directions about the third axis.

use crate::watch::Watch;
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, Area, BLUE, Broken, Cells, Drawn, INK, Panel, RGBColor, Series, direction};
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;
use plotters::prelude::PathElement;
use plotters::style::Color;
use std::f64::consts::FRAC_PI_2;

/// Arrows in each direction.
const ARROWS: usize = 21;
/// Cells in each direction, at most.
const CELLS: usize = 64;

/// Four pictures, and the energy below.
pub fn draw(flags: &Flags, watch: &Watch) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 1120), |area| {
        let title = "Unit vectors on a sheet: arrows show q1 and q2; the paper is q = e3, colours are directions, black is q = -e3";
        let mut area = figure::caption(area, title)?;
        for pair in watch.pictures.chunks(2).take(2) {
            let (row, below) = figure::rows(&area, 455.0);
            let (left, right) = figure::columns(&row, 500.0);
            for (picture, place) in pair.iter().zip([left, right]) {
                sheet(flags, picture, &place)?;
            }
            area = below;
        }
        let series = vec![Series { label: "", colour: BLUE, points: watch.energies.clone() }];
        Panel { title: "Change of the energy over the energy", unit: "", x_label: "time (s)", series }.draw(&area)
    })
}

fn sheet(flags: &Flags, (time, q): &(f64, Vec<Vector3<f64>>), area: &Area<'_>) -> Drawn {
    let n = flags.sites;
    let (area, _) = figure::columns(area, 470.0);
    let area = figure::caption(&area, &format!("{time:.2} s"))?;
    let some: Vec<usize> = (0..n).step_by(n.div_ceil(CELLS)).collect();
    let columns: Vec<Vec<_>> = some.iter().map(|i| some.iter().map(|j| colour(&q[i * n + j])).collect()).collect();
    let side = flags.length;
    let cells = Cells { x_label: "", y_label: "", x: (0.0, side), y: (0.0, side), columns: &columns };
    let frame = cells.draw(&area)?;
    let pace = 1.0 / ARROWS as f64;
    for index in 0..ARROWS * ARROWS {
        let place = [index / ARROWS, index % ARROWS].map(|i| (i as f64 + 0.5) * pace);
        let [i, j] = place.map(|share| (share * n as f64) as usize);
        arrow(&area, |x, y| frame.at((place[0] + x * pace, place[1] + y * pace)), &q[i * n + j])?;
    }
    Ok(())
}

/// Tilts of a few degrees show, too.
fn colour(q: &Vector3<f64>) -> RGBColor {
    let tilt = q.xy().norm().atan2(q.z) / FRAC_PI_2;
    direction(q.y.atan2(q.x), if tilt < 1.0 { tilt.powf(0.6) } else { tilt })
}

/// An arrow along the first two components, in units of the distance of arrows.
fn arrow(area: &Area<'_>, at: impl Fn(f64, f64) -> (i32, i32), q: &Vector3<f64>) -> Result<(), Broken> {
    const LENGTH: f64 = 0.45;
    const SHORTEST: f64 = 0.1;
    if q.x.hypot(q.y) < SHORTEST {
        return Ok(());
    }
    let place =
        |along: f64, across: f64| at(LENGTH * (along * q.x - across * q.y), LENGTH * (along * q.y + across * q.x));
    for line in [vec![place(-1.0, 0.0), place(1.0, 0.0)], vec![place(0.5, 0.3), place(1.0, 0.0), place(0.5, -0.3)]] {
        area.draw(&PathElement::new(line, INK.stroke_width(7)))?;
    }
    Ok(())
}
