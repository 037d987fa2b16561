//! Curves over powers of ten in both directions.

use super::canvas::{Area, Drawn};
use super::theme::{FRAME, GRID, INK, SOFT_INK, px, stroke, text, unit, write};
use plotters::prelude::Circle;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};
use std::ops::RangeInclusive;

/// Room at the left, the top, the right (for names) and the bottom, pixels.
const MARGINS: [f64; 4] = [74.0, 34.0, 190.0, 52.0];

/// One curve; points that are not above zero are left out.
///
/// ```
/// use clebsch_plot::figure::{BLUE, Curve};
///
/// let points: Vec<(f64, f64)> = [1.0, 10.0, 100.0_f64].map(|x| (x, x.sqrt())).to_vec();
/// let root = Curve { label: "√x", colour: BLUE, width: 1.2, points, ringed: vec![false, false, true] };
/// # assert_eq!(root.points[2].1, 10.0);
/// ```
#[derive(Clone, Debug)]
pub struct Curve<'a> {
    /// Its name, at the right in its colour; empty for none.
    pub label: &'a str,
    /// Its colour.
    pub colour: RGBColor,
    /// Width of the line, pixels.
    pub width: f64,
    /// (x, y)
    pub points: Vec<(f64, f64)>,
    /// Which of the points have a ring about them.
    pub ringed: Vec<bool>,
}

/// A chart with logarithmic axes; x grows to the right.
///
/// ```
/// use clebsch_plot::figure::{self, Curve, Decades, ORANGE};
///
/// let points = [1e-3, 1e-2, 1e-1].map(|h| (h, h * h)).to_vec();
/// let curves = [Curve { label: "order 2", colour: ORANGE, width: 1.5, points, ringed: Vec::new() }];
/// let chart = Decades { title: "Errors", x_label: "step size (s)", y_label: "error", curves: &curves };
/// let svg = figure::svg((800, 500), |area| chart.draw(area))?;
/// assert!(svg.contains("1e-6") && svg.contains("order 2"));
/// # Ok::<(), figure::Broken>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Decades<'a> {
    /// The title of the plot.
    pub title: &'a str,
    /// Name and unit of x.
    pub x_label: &'a str,
    /// Name and unit of y.
    pub y_label: &'a str,
    /// Curves, the first at the back.
    pub curves: &'a [Curve<'a>],
}

impl Decades<'_> {
    /// Draws into all of the area.
    pub fn draw(&self, area: &Area<'_>) -> Drawn {
        let points = || self.curves.iter().flat_map(|curve| curve.visible());
        let frame =
            Frame::new(area, powers(points().map(|(_, point)| point.0)), powers(points().map(|(_, point)| point.1)));
        self.draw_axes(area, &frame)?;
        for curve in self.curves {
            curve.draw(area, &frame)?;
        }
        self.draw_names(area, &frame)
    }

    fn draw_axes(&self, area: &Area<'_>, frame: &Frame) -> Drawn {
        let Frame { x, y, .. } = frame;
        let (across, down) = (stride(x), stride(y));
        for power in x.clone().step_by(across) {
            let [top, bottom] = [*y.end(), *y.start()].map(|y| frame.place(f64::from(power), f64::from(y)));
            stroke(area, vec![top, bottom], GRID, 0.8)?;
            let at = (bottom.0, bottom.1 + px(14.0));
            write(area, &format!("1e{power}"), at, text(12.0, SOFT_INK, HPos::Center, VPos::Center))?;
        }
        for power in y.clone().step_by(down) {
            let [left, right] = [*x.start(), *x.end()].map(|x| frame.place(f64::from(x), f64::from(power)));
            stroke(area, vec![left, right], GRID, 0.8)?;
            let at = (left.0 - px(8.0), left.1);
            write(area, &format!("1e{power}"), at, text(12.0, SOFT_INK, HPos::Right, VPos::Center))?;
        }
        let corner = |x: i32, y: i32| frame.place(f64::from(x), f64::from(y));
        let (left, right, low, high) = (*x.start(), *x.end(), *y.start(), *y.end());
        let corners = vec![corner(left, high), corner(left, low), corner(right, low)];
        stroke(area, corners, FRAME, 1.0)?;
        let (start, end) = (corner(left, high), corner(right, low));
        write(area, self.title, (px(10.0), px(14.0)), text(15.0, INK, HPos::Left, VPos::Center))?;
        let unit = (end.0, px(14.0));
        write(area, &format!("y: {}", self.y_label), unit, text(13.0, SOFT_INK, HPos::Right, VPos::Center))?;
        let below = ((start.0 + end.0) / 2, end.1 + px(36.0));
        write(area, self.x_label, below, text(13.0, SOFT_INK, HPos::Center, VPos::Center))
    }

    fn draw_names(&self, area: &Area<'_>, frame: &Frame) -> Drawn {
        let left = frame.place(f64::from(*frame.x.end()), 0.0).0 + px(12.0);
        let named = self.curves.iter().filter(|curve| !curve.label.is_empty());
        for (line, curve) in named.enumerate() {
            let at = (left, px(44.0 + 18.0 * line as f64));
            write(area, curve.label, at, text(12.5, curve.colour, HPos::Left, VPos::Center))?;
        }
        Ok(())
    }
}

impl Curve<'_> {
    /// Points with a logarithm, with their numbers.
    fn visible(&self) -> impl Iterator<Item = (usize, (f64, f64))> + '_ {
        let points = self.points.iter().copied().enumerate();
        points.filter(|(_, (x, y))| *x > 0.0 && *y > 0.0 && x.is_finite() && y.is_finite())
    }

    fn draw(&self, area: &Area<'_>, frame: &Frame) -> Drawn {
        let places: Vec<_> = self.visible().map(|(index, (x, y))| (index, frame.place(x.log10(), y.log10()))).collect();
        stroke(area, places.iter().map(|(_, place)| *place).collect(), self.colour, self.width)?;
        for (index, place) in places {
            area.draw(&Circle::new(place, px(1.8), self.colour.filled()))?;
            if self.ringed.get(index) == Some(&true) {
                area.draw(&Circle::new(place, px(5.0), self.colour.stroke_width(px(1.2).unsigned_abs())))?;
            }
        }
        Ok(())
    }
}

/// Where powers of ten lie in the drawing.
struct Frame {
    x: RangeInclusive<i32>,
    y: RangeInclusive<i32>,
    /// Left, top, right and bottom.
    sides: [f64; 4],
}

impl Frame {
    fn new(area: &Area<'_>, x: RangeInclusive<i32>, y: RangeInclusive<i32>) -> Self {
        let (width, height) = area.dim_in_pixel();
        let [left, top, right, bottom] = MARGINS.map(|margin| f64::from(px(margin)));
        Self { x, y, sides: [left, top, f64::from(width) - right, f64::from(height) - bottom] }
    }

    fn place(&self, x: f64, y: f64) -> (i32, i32) {
        let [left, top, right, bottom] = self.sides;
        let share = |value: f64, range: &RangeInclusive<i32>| {
            (value - f64::from(*range.start())) / f64::from(range.end() - range.start())
        };
        let across = left + share(x, &self.x) * (right - left);
        let down = bottom - share(y, &self.y) * (bottom - top);
        (unit(across), unit(down))
    }
}

/// How many powers of ten lie between two lines of the grid.
fn stride(powers: &RangeInclusive<i32>) -> usize {
    const LINES: i32 = 24;
    usize::try_from((powers.end() - powers.start()) / LINES + 1).unwrap_or(1)
}

/// The powers of ten about some values, at least one apart.
fn powers(values: impl Iterator<Item = f64>) -> RangeInclusive<i32> {
    let logarithms = values.map(f64::log10);
    let (low, high) = logarithms.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return 0..=1;
    }
    let (low, high) = (low.floor() as i32, high.ceil() as i32);
    low..=high.max(low + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_any_data_have_a_length() {
        assert_eq!(powers([].into_iter()), 0..=1);
        assert_eq!(powers([1.0].into_iter()), 0..=1);
        assert_eq!(powers([2e-7, 30.0].into_iter()), -7..=2);
    }
}
