//! Paths in the plane, seen from above: equal aspect.

use super::canvas::{Area, Drawn};
use super::theme::{FRAME, GRID, INK, SOFT_INK, coloured, px, stroke, text, unit, write};
use plotters::prelude::Circle;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};

/// A part of the plane with its contents.
///
/// ```
/// use clebsch_plot::figure::{self, Arrow, ORANGE, Path, Plane};
///
/// let points: Vec<(f64, f64)> = (0..100).map(|i| f64::from(i) / 10.0).map(|t| (t * t.cos(), t * t.sin())).collect();
/// let paths = [Path { label: "spiral", points: &points, colour: None, width: 1.5 }];
/// let arrows = [Arrow { at: (0.0, 0.0), heading: 0.0, colour: ORANGE }];
/// let svg = figure::svg((500, 500), |area| Plane { unit: "m", paths: &paths, arrows: &arrows }.draw(area))?;
/// # assert!(svg.contains("x, y (m)"));
/// # Ok::<(), figure::Broken>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Plane<'a> {
    /// Unit of both coordinates.
    pub unit: &'a str,
    /// Paths, the first at the back.
    pub paths: &'a [Path<'a>],
    /// Points with a direction.
    pub arrows: &'a [Arrow],
}

/// A path in the plane.
///
/// ```
/// use clebsch_plot::figure::{BLUE, Path};
///
/// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
/// let path = Path { label: "square", points: &square, colour: Some(BLUE), width: 1.0 };
/// # assert_eq!(path.points.len(), 5);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Path<'a> {
    /// Its name, shown in its colour; empty for none.
    pub label: &'a str,
    /// (x, y) in the order of time.
    pub points: &'a [(f64, f64)],
    /// Its colour; [`along`](super::along) time where there is none.
    pub colour: Option<RGBColor>,
    /// Width of the line, pixels.
    pub width: f64,
}

/// A point with a direction.
///
/// ```
/// use clebsch_plot::figure::{Arrow, GREEN};
///
/// let north = Arrow { at: (2.0, 1.0), heading: std::f64::consts::FRAC_PI_2, colour: GREEN };
/// # assert_eq!(north.at.0, 2.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Arrow {
    /// (x, y)
    pub at: (f64, f64),
    /// From the x axis, rad.
    pub heading: f64,
    /// Its colour.
    pub colour: RGBColor,
}

/// Length of an arrow, pixels.
const ARROW: f64 = 17.0;

impl Plane<'_> {
    /// Draws into all of the area.
    pub fn draw(&self, area: &Area<'_>) -> Drawn {
        let points = self.paths.iter().flat_map(|path| path.points).copied();
        let Some(map) = Map::of(points.chain(self.arrows.iter().map(|arrow| arrow.at)), area) else { return Ok(()) };
        self.draw_grid(area, &map)?;
        for path in self.paths {
            path.draw(area, &map)?;
        }
        for arrow in self.arrows {
            let (at, (sin, cos)) = (map.project(arrow.at), arrow.heading.sin_cos());
            let place =
                |ahead: f64, left: f64| (at.0 + px(ahead * cos - left * sin), at.1 - px(ahead * sin + left * cos));
            let tip = place(ARROW, 0.0);
            stroke(area, vec![at, tip], arrow.colour, 1.6)?;
            stroke(area, vec![place(ARROW - 5.0, 3.5), tip, place(ARROW - 5.0, -3.5)], arrow.colour, 1.6)?;
            area.draw(&Circle::new(at, px(2.6), arrow.colour.filled()))?;
        }
        self.draw_labels(area, &map)
    }

    /// The names of the paths, one below the other at the right, the last path first.
    fn draw_labels(&self, area: &Area<'_>, map: &Map) -> Drawn {
        let (_, right, top, _) = map.frame;
        for (line, path) in self.paths.iter().rev().filter(|path| !path.label.is_empty()).enumerate() {
            let at = (right - px(6.0), top + px(8.0 + 16.0 * line as f64));
            write(area, path.label, at, text(12.5, path.colour.unwrap_or(INK), HPos::Right, VPos::Center))?;
        }
        Ok(())
    }

    /// Lines at round numbers, with their numbers at the left and below.
    fn draw_grid(&self, area: &Area<'_>, map: &Map) -> Drawn {
        let tick = map.tick();
        let digits = (-tick.log10().floor()).clamp(0.0, 12.0) as usize;
        let label = |index: i64| format!("{:.digits$}", index as f64 * tick);
        let soft = |horizontal, vertical| text(12.0, SOFT_INK, horizontal, vertical);
        let (left, right, top, bottom) = map.frame;
        for index in map.ticks(map.unproject((left, bottom)).0, map.unproject((right, top)).0) {
            let x = map.project((index as f64 * tick, 0.0)).0;
            stroke(area, vec![(x, top), (x, bottom)], GRID, 0.8)?;
            write(area, &label(index), (x, bottom + px(5.0)), soft(HPos::Center, VPos::Top))?;
        }
        for index in map.ticks(map.unproject((left, bottom)).1, map.unproject((right, top)).1) {
            let y = map.project((0.0, index as f64 * tick)).1;
            stroke(area, vec![(left, y), (right, y)], GRID, 0.8)?;
            write(area, &label(index), (left - px(5.0), y), soft(HPos::Right, VPos::Center))?;
        }
        stroke(area, vec![(left, top), (left, bottom), (right, bottom)], FRAME, 1.0)?;
        write(area, &format!("x, y ({})", self.unit), (right, bottom + px(22.0)), soft(HPos::Right, VPos::Top))
    }
}

impl Path<'_> {
    fn draw(&self, area: &Area<'_>, map: &Map) -> Drawn {
        for (colour, piece) in coloured(self.points, self.colour) {
            stroke(area, piece.iter().map(|point| map.project(*point)).collect(), colour, self.width)?;
        }
        Ok(())
    }
}

/// From the plane to the page.
struct Map {
    /// Left, right, top and bottom, units of the drawing.
    frame: (i32, i32, i32, i32),
    middle: (f64, f64),
    /// Units of the drawing in a unit of the plane.
    scale: f64,
}

impl Map {
    /// All points, with a margin; `None` where there are none.
    fn of(points: impl Iterator<Item = (f64, f64)>, area: &Area<'_>) -> Option<Self> {
        let (width, height) = area.dim_in_pixel();
        let frame = (px(58.0), width as i32 - px(16.0), px(12.0), height as i32 - px(46.0));
        let limits = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
        let empty = (f64::INFINITY, f64::NEG_INFINITY);
        let (x, y) = points
            .filter(|point| point.0.is_finite() && point.1.is_finite())
            .fold((empty, empty), |(x, y), point| (limits(x, point.0), limits(y, point.1)));
        let room = (f64::from(frame.1 - frame.0), f64::from(frame.3 - frame.2));
        let reach = ((x.1 - x.0) / room.0).max((y.1 - y.0) / room.1) * 1.2;
        let scale = if reach > 1e-290 { 1.0 / reach } else { room.0 / 2.0 };
        (x.0 <= x.1).then_some(Self { frame, middle: ((x.0 + x.1) / 2.0, (y.0 + y.1) / 2.0), scale })
    }

    /// The middle of the frame.
    fn centre(&self) -> (f64, f64) {
        let (left, right, top, bottom) = self.frame;
        (f64::from(left + right) / 2.0, f64::from(top + bottom) / 2.0)
    }

    fn project(&self, (x, y): (f64, f64)) -> (i32, i32) {
        let centre = self.centre();
        let across = centre.0 + (x - self.middle.0) * self.scale;
        let down = centre.1 - (y - self.middle.1) * self.scale;
        (unit(across), unit(down))
    }

    fn unproject(&self, (across, down): (i32, i32)) -> (f64, f64) {
        let centre = self.centre();
        let x = self.middle.0 + (f64::from(across) - centre.0) / self.scale;
        (x, self.middle.1 - (f64::from(down) - centre.1) / self.scale)
    }

    /// A round length of some 70 pixels.
    fn tick(&self) -> f64 {
        let length = f64::from(px(70.0)) / self.scale;
        let power = 10_f64.powf(length.log10().floor());
        [1.0, 2.0, 5.0, 10.0].map(|round| round * power).into_iter().find(|tick| *tick >= length).unwrap_or(length)
    }

    /// The numbers of the ticks between two values.
    fn ticks(&self, from: f64, to: f64) -> std::ops::RangeInclusive<i64> {
        let tick = self.tick();
        (from / tick).ceil() as i64..=(to / tick).floor() as i64
    }
}
