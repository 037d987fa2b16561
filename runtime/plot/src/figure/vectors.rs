//! A sheet of unit vectors: colours and arrows are directions about the third axis.

use super::canvas::{Area, Broken, Drawn};
use super::cells::{Cells, direction};
use super::theme::INK;
use nalgebra::Vector3;
use plotters::prelude::PathElement;
use plotters::style::{Color, RGBColor};
use std::f64::consts::FRAC_PI_2;

/// Arrows in each direction.
const ARROWS: usize = 21;
/// Cells in each direction, at most.
const CELLS: usize = 64;

/// Unit vectors on a square grid. The paper is e3, black is −e3.
///
/// ```
/// use clebsch_plot::figure::{self, Vectors};
/// use nalgebra::Vector3;
///
/// let at = |i: u8, j: u8| Vector3::new(f64::from(i) - 4.5, f64::from(j) - 4.5, 3.0).normalize();
/// let vectors: Vec<Vector3<f64>> = (0..10).flat_map(|i| (0..10).map(move |j| at(i, j))).collect();
/// let sheet = Vectors { side: 1.0, count: 10, vectors: &vectors };
/// let svg = figure::svg((400, 400), |area| sheet.draw(area))?;
/// # assert!(svg.contains("<polyline"));
/// # Ok::<(), figure::Broken>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Vectors<'a> {
    /// The side of the square.
    pub side: f64,
    /// Vectors along a side.
    pub count: usize,
    /// The vectors, those of the second direction next to each other.
    pub vectors: &'a [Vector3<f64>],
}

impl Vectors<'_> {
    /// Draws into all of the area. Vectors that are not there are e3.
    pub fn draw(&self, area: &Area<'_>) -> Drawn {
        let n = self.count;
        let vector = |i: usize, j: usize| {
            let place = i.checked_mul(n).and_then(|start| start.checked_add(j));
            place.and_then(|place| self.vectors.get(place)).copied().unwrap_or_else(Vector3::z)
        };
        let some: Vec<usize> = (0..n).step_by(n.div_ceil(CELLS).max(1)).collect();
        let columns: Vec<Vec<_>> =
            some.iter().map(|i| some.iter().map(|j| colour(&vector(*i, *j))).collect()).collect();
        let ends = (0.0, self.side);
        let cells = Cells { x_label: "", y_label: "", x: ends, y: ends, columns: &columns };
        let frame = cells.draw(area)?;
        let pace = 1.0 / ARROWS as f64;
        for index in 0..ARROWS * ARROWS {
            let place = [index / ARROWS, index % ARROWS].map(|i| (i as f64 + 0.5) * pace);
            let [i, j] = place.map(|share| (share * n as f64) as usize);
            arrow(area, |x, y| frame.at((place[0] + x * pace, place[1] + y * pace)), &vector(i, j))?;
        }
        Ok(())
    }
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
