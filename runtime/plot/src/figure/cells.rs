//! A table of colours: a field over two directions, or over space and time.

use super::canvas::{Area, Drawn};
use super::theme::{
    BLUE, FRAME, GREEN, INK, ORANGE, PAPER, PURPLE, RED, SOFT_INK, TEAL, blend, px, stroke, text, unit, write,
};
use plotters::prelude::Rectangle;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};
use std::f64::consts::TAU;

/// Steps of a colour scale: neighbours of one colour are one rectangle.
const SHADES: f64 = 24.0;
/// From below zero over zero to above it.
const DIVERGING: [RGBColor; 5] = [
    RGBColor(24, 74, 150),
    RGBColor(128, 172, 214),
    RGBColor(248, 246, 242),
    RGBColor(234, 160, 104),
    RGBColor(172, 56, 22),
];
/// Around a circle.
const WHEEL: [RGBColor; 6] = [BLUE, PURPLE, RED, ORANGE, GREEN, TEAL];
/// Cells reach so far over their neighbours, pixels: no paper shows between them.
const OVERLAP: f64 = 0.4;

/// The colour of a number from −1 to 1.
pub fn diverging(number: f64) -> RGBColor {
    let last = DIVERGING.len() - 1;
    let fraction = (((number + 1.0) / 2.0).clamp(0.0, 1.0) * SHADES).round() / SHADES;
    let place = fraction * last as f64;
    let index = (place as usize).min(last - 1);
    blend(DIVERGING[index], DIVERGING[index + 1], place - index as f64)
}

/// The colour of a direction in the plane, from −π to π. `share` from 0 to 1 goes from the paper to it, and on to ink at 2.
pub fn direction(angle: f64, share: f64) -> RGBColor {
    let turn = ((angle / TAU).rem_euclid(1.0) * SHADES).round() / SHADES;
    let place = turn * WHEEL.len() as f64;
    let (index, part) = (place as usize, place.fract());
    let hue = blend(WHEEL[index % WHEEL.len()], WHEEL[(index + 1) % WHEEL.len()], part);
    let share = (share.clamp(0.0, 2.0) * SHADES / 2.0).round() * 2.0 / SHADES;
    if share <= 1.0 { blend(PAPER, hue, share) } else { blend(hue, INK, share - 1.0) }
}

/// Cells in columns from the left and rows from below.
///
/// ```
/// use clebsch_plot::figure::{self, Cells, diverging};
///
/// let wave = |i: i32, j: i32| diverging((f64::from(i) / 8.0).sin() * (f64::from(j) / 5.0).cos());
/// let columns: Vec<Vec<_>> = (0..50).map(|i| (0..40).map(|j| wave(i, j)).collect()).collect();
/// let cells = Cells { x_label: "place (m)", y_label: "time (s)", x: (0.0, 5.0), y: (0.0, 8.0), columns: &columns };
/// let svg = figure::svg((600, 400), |area| cells.draw(area).map(|_| ()))?;
/// # assert!(svg.contains("<rect"));
/// # Ok::<(), figure::Broken>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    /// Name of the direction to the right, empty for none.
    pub x_label: &'a str,
    /// Name of the direction upwards, empty for none.
    pub y_label: &'a str,
    /// The ends of the direction to the right.
    pub x: (f64, f64),
    /// The ends of the direction upwards.
    pub y: (f64, f64),
    /// Colours, column by column.
    pub columns: &'a [Vec<RGBColor>],
}

/// Where the cells of a table lie in the drawing: [`Cells::draw`] gives it, for lines over the cells.
///
/// ```
/// use clebsch_plot::figure::plotters::{prelude::PathElement, style::Color};
/// use clebsch_plot::figure::{self, Cells, INK, diverging};
///
/// let columns = [vec![diverging(-1.0); 2], vec![diverging(1.0); 2]];
/// let cells = Cells { x_label: "", y_label: "", x: (0.0, 1.0), y: (0.0, 1.0), columns: &columns };
/// let svg = figure::svg((300, 300), |area| {
///     let frame = cells.draw(area)?;
///     area.draw(&PathElement::new([frame.at((0.0, 0.0)), frame.at((1.0, 1.0))], INK.stroke_width(20)))
/// })?;
/// # assert!(svg.contains("<polyline"));
/// # Ok::<(), figure::Broken>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    left: i32,
    top: i32,
    size: (i32, i32),
}

impl Frame {
    /// The point at shares of the way to the right and upwards.
    pub fn at(&self, (x, y): (f64, f64)) -> (i32, i32) {
        let along = |share: f64, length: i32| unit(share * f64::from(length));
        (self.left + along(x, self.size.0), self.top + self.size.1 - along(y, self.size.1))
    }
}

impl Cells<'_> {
    /// Draws into all of the area, with round numbers at the axes that have a name.
    pub fn draw(&self, area: &Area<'_>) -> Result<Frame, super::canvas::Broken> {
        let (width, height) = area.dim_in_pixel();
        let left = if self.y_label.is_empty() { px(10.0) } else { px(58.0) };
        let below = if self.x_label.is_empty() { px(10.0) } else { px(44.0) };
        let top = px(8.0);
        let size = (width as i32 - left - px(14.0), height as i32 - below - top);
        let frame = Frame { left, top, size };
        self.fill(area, &frame)?;
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
        stroke(area, corners.map(|corner| frame.at(corner)).to_vec(), FRAME, 1.0)?;
        self.label(area, &frame)?;
        Ok(frame)
    }

    fn fill(&self, area: &Area<'_>, frame: &Frame) -> Drawn {
        let (count, over) = (self.columns.len().max(1) as f64, px(OVERLAP));
        for (i, column) in self.columns.iter().enumerate() {
            let rows = column.len().max(1) as f64;
            let mut start = 0;
            for run in column.chunk_by(|a, b| a == b) {
                let end = start + run.len();
                let first = frame.at((i as f64 / count, start as f64 / rows));
                let last = frame.at(((i + 1) as f64 / count, end as f64 / rows));
                area.draw(&Rectangle::new([(first.0, last.1), (last.0 + over, first.1 + over)], run[0].filled()))?;
                start = end;
            }
        }
        Ok(())
    }

    fn label(&self, area: &Area<'_>, frame: &Frame) -> Drawn {
        let soft = |horizontal, vertical| text(12.0, SOFT_INK, horizontal, vertical);
        if !self.x_label.is_empty() {
            for (number, share) in ticks(self.x) {
                let at = frame.at((share, 0.0));
                stroke(area, vec![at, (at.0, at.1 + px(4.0))], FRAME, 1.0)?;
                write(area, &number, (at.0, at.1 + px(6.0)), soft(HPos::Center, VPos::Top))?;
            }
            let middle = frame.at((0.5, 0.0));
            write(area, self.x_label, (middle.0, middle.1 + px(24.0)), soft(HPos::Center, VPos::Top))?;
        }
        if !self.y_label.is_empty() {
            for (number, share) in ticks(self.y) {
                let at = frame.at((0.0, share));
                stroke(area, vec![at, (at.0 - px(4.0), at.1)], FRAME, 1.0)?;
                write(area, &number, (at.0 - px(6.0), at.1), soft(HPos::Right, VPos::Center))?;
            }
            let corner = frame.at((0.0, 1.0));
            write(area, self.y_label, (px(4.0), corner.1 + px(4.0)), soft(HPos::Left, VPos::Center))?;
        }
        Ok(())
    }
}

/// Some five round numbers between two, and their shares of the way.
fn ticks((from, to): (f64, f64)) -> Vec<(String, f64)> {
    let length = to - from;
    if !(length.is_finite() && length > 1e-290) {
        return Vec::new();
    }
    let power = 10_f64.powf((length / 5.0).log10().floor());
    let tick = [1.0, 2.0, 5.0, 10.0].map(|round| round * power).into_iter().find(|tick| *tick >= length / 5.0);
    let tick = tick.unwrap_or(length);
    let digits = (-tick.log10().floor()).clamp(0.0, 12.0) as usize;
    let numbers = (from / tick).ceil() as i64..=(to / tick).floor() as i64;
    numbers
        .map(|index| index as f64 * tick)
        .map(|value| (format!("{value:.digits$}"), (value - from) / length))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_diverge_from_zero_and_ticks_are_round() {
        assert_eq!(diverging(0.0), DIVERGING[2]);
        assert_eq!((diverging(-2.0), diverging(1.0)), (DIVERGING[0], DIVERGING[4]));
        assert_eq!((direction(1.0, 0.0), direction(0.0, 1.0), direction(-2.0, 2.0)), (PAPER, BLUE, INK));
        let numbers: Vec<String> = ticks((0.0, 8.0)).into_iter().map(|(number, _)| number).collect();
        assert_eq!(numbers, ["0", "2", "4", "6", "8"]);
        assert!(ticks((1.0, 1.0)).is_empty() && ticks((0.0, f64::NAN)).is_empty());
    }
}
