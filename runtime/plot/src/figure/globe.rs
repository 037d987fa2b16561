//! A path on the unit sphere, seen from far away: equal aspect, the far side paler than the near one.

use super::canvas::{Area, Drawn};
use super::theme::{FRAME, GRID, INK, PAPER, blend, coloured, px, stroke, text, unit, write};
use plotters::prelude::Circle;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};
use std::f64::consts::{PI, TAU};

/// From where one looks, degrees.
///
/// ```
/// use clebsch_plot::figure::View;
///
/// let from_above = View { azimuth: 0.0, elevation: 90.0 };
/// # assert_eq!(from_above.elevation, 90.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Turned about the third axis, from the first.
    pub azimuth: f64,
    /// Above the plane of the first two axes.
    pub elevation: f64,
}

/// An axis: drawn from the sphere outwards, with its name at the tip.
///
/// ```
/// use clebsch_plot::figure::{INK, Pointer};
///
/// let up = Pointer { label: "up", direction: [0.0, 0.0, 1.0], colour: INK };
/// # assert_eq!(up.label, "up");
/// ```
#[derive(Clone, Debug)]
pub struct Pointer<'a> {
    /// Its name.
    pub label: &'a str,
    /// Its unit vector.
    pub direction: [f64; 3],
    /// Its colour.
    pub colour: RGBColor,
}

/// The sphere and the curves on it.
///
/// ```
/// use clebsch_plot::figure::{self, Globe, Track, View};
///
/// let circle: Vec<[f64; 3]> = (0..=90).map(|i| f64::from(4 * i).to_radians()).map(|a| [a.cos(), a.sin(), 0.0]).collect();
/// let tracks = [Track { points: &circle, colour: Some(figure::RED), width: 2.0 }];
/// let globe = Globe { view: View { azimuth: 30.0, elevation: 25.0 }, pointers: &[], tracks: &tracks };
/// let svg = figure::svg((400, 400), |area| globe.draw(area))?;
/// # assert!(svg.contains("<circle"));
/// # Ok::<(), figure::Broken>(())
/// ```
#[derive(Clone, Debug)]
pub struct Globe<'a> {
    /// From where one looks.
    pub view: View,
    /// Axes.
    pub pointers: &'a [Pointer<'a>],
    /// Paths, the first at the back.
    pub tracks: &'a [Track<'a>],
}

/// A path on the sphere.
///
/// ```
/// use clebsch_plot::figure::Track;
///
/// let quarter: Vec<[f64; 3]> = (0..=90).map(|i| f64::from(i).to_radians()).map(|a| [a.cos(), 0.0, a.sin()]).collect();
/// let track = Track { points: &quarter, colour: None, width: 1.5 }; // coloured by time
/// # assert_eq!(track.points.len(), 91);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Track<'a> {
    /// Unit vectors in the order of time.
    pub points: &'a [[f64; 3]],
    /// Its colour; [`along`](super::along) time where there is none.
    pub colour: Option<RGBColor>,
    /// Width of the line, pixels.
    pub width: f64,
}

/// How far pointers reach, in radii.
const REACH: f64 = 1.22;

impl Globe<'_> {
    /// Draws into all of the area.
    pub fn draw(&self, area: &Area<'_>) -> Drawn {
        let (width, height) = area.dim_in_pixel();
        let eye = Eye::new(self.view, f64::from(width), f64::from(height));
        area.draw(&Circle::new(eye.middle(), eye.radius as i32, RGBColor(250, 251, 253).filled()))?;
        self.draw_side(area, &eye, Side::Far)?;
        self.draw_side(area, &eye, Side::Near)?;
        area.draw(&Circle::new(eye.middle(), eye.radius as i32, FRAME.stroke_width(px(1.2).unsigned_abs())))
    }

    fn draw_side(&self, area: &Area<'_>, eye: &Eye, side: Side) -> Drawn {
        let grid = side.tint(GRID, 0.55);
        for line in graticule() {
            for piece in eye.visible(&line, side) {
                stroke(area, eye.project_all(&line[piece]), grid, 1.0)?;
            }
        }
        if side == Side::Far {
            self.draw_pointers(area, eye, side)?;
        }
        for track in self.tracks {
            track.draw_side(area, eye, side)?;
        }
        if side == Side::Near { self.draw_pointers(area, eye, side) } else { Ok(()) }
    }

    fn draw_pointers(&self, area: &Area<'_>, eye: &Eye, side: Side) -> Drawn {
        for pointer in self.pointers.iter().filter(|pointer| eye.side(&pointer.direction) == side) {
            let foot = eye.project(&pointer.direction);
            let tip = eye.project(&pointer.direction.map(|x| x * REACH));
            let colour = side.tint(pointer.colour, 0.3);
            stroke(area, vec![foot, tip], colour, 1.8)?;
            area.draw(&Circle::new(foot, px(2.6), colour.filled()))?;
            // The name goes on from the tip, away from the sphere.
            let (across, down) = (tip.0 - foot.0, tip.1 - foot.1);
            let (name, horizontal) = match across {
                _ if across.abs() < px(4.0) => ((tip.0, tip.1 + down.signum() * px(12.0)), HPos::Center),
                1.. => ((tip.0 + px(5.0), tip.1), HPos::Left),
                _ => ((tip.0 - px(5.0), tip.1), HPos::Right),
            };
            write(area, pointer.label, name, text(14.0, blend(colour, INK, 0.3), horizontal, VPos::Center))?;
        }
        Ok(())
    }
}

impl Track<'_> {
    fn draw_side(&self, area: &Area<'_>, eye: &Eye, side: Side) -> Drawn {
        for (colour, piece) in coloured(self.points, self.colour) {
            for visible in eye.visible(piece, side) {
                stroke(area, eye.project_all(&piece[visible]), side.tint(colour, 0.68), self.width)?;
            }
        }
        Ok(())
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    Near,
    Far,
}

impl Side {
    /// The far side is paler, by the share `pallor` of paper.
    fn tint(self, colour: RGBColor, pallor: f64) -> RGBColor {
        if self == Side::Near { colour } else { blend(colour, PAPER, pallor) }
    }
}

/// The orthographic projection.
struct Eye {
    right: [f64; 3],
    up: [f64; 3],
    towards: [f64; 3],
    centre: (f64, f64),
    radius: f64,
}

impl Eye {
    fn new(view: View, width: f64, height: f64) -> Self {
        let (sin_a, cos_a) = view.azimuth.to_radians().sin_cos();
        let (sin_e, cos_e) = view.elevation.to_radians().sin_cos();
        Self {
            right: [-sin_a, cos_a, 0.0],
            up: [-sin_e * cos_a, -sin_e * sin_a, cos_e],
            towards: [cos_e * cos_a, cos_e * sin_a, sin_e],
            centre: (width / 2.0, height / 2.0),
            radius: width.min(height) / 2.0 / (REACH + 0.08),
        }
    }

    fn middle(&self) -> (i32, i32) {
        (self.centre.0 as i32, self.centre.1 as i32)
    }

    fn project(&self, point: &[f64; 3]) -> (i32, i32) {
        let (x, y) = (dot(&self.right, point), dot(&self.up, point));
        (unit(self.centre.0 + self.radius * x), unit(self.centre.1 - self.radius * y))
    }

    fn project_all(&self, points: &[[f64; 3]]) -> Vec<(i32, i32)> {
        points.iter().map(|point| self.project(point)).collect()
    }

    fn side(&self, point: &[f64; 3]) -> Side {
        if dot(&self.towards, point) >= 0.0 { Side::Near } else { Side::Far }
    }

    /// The stretches of a line on one side, each with one point beyond, so that the two sides meet.
    fn visible(&self, line: &[[f64; 3]], side: Side) -> Vec<std::ops::Range<usize>> {
        let mut stretches = Vec::new();
        let mut start = None;
        for (index, point) in line.iter().enumerate() {
            match (self.side(point) == side, start) {
                (true, None) => start = Some(index.saturating_sub(1)),
                (false, Some(first)) => {
                    stretches.push(first..index);
                    start = None;
                }
                _ => {}
            }
        }
        stretches.extend(start.map(|first| first..line.len()));
        stretches
    }
}

/// Circles of latitude and of longitude about the third axis, 30° apart.
fn graticule() -> Vec<Vec<[f64; 3]>> {
    let parallels = (-2..=2)
        .map(|i| f64::from(i) * PI / 6.0)
        .map(|latitude: f64| (0..=48).map(|j| point(latitude, f64::from(j) * TAU / 48.0)).collect::<Vec<_>>());
    let meridians = (0..12)
        .map(|i| f64::from(i) * TAU / 12.0)
        .map(|longitude| (-15..=15).map(|j| point(f64::from(j) * PI / 30.0, longitude)).collect::<Vec<_>>());
    parallels.chain(meridians).collect()
}

fn point(latitude: f64, longitude: f64) -> [f64; 3] {
    [latitude.cos() * longitude.cos(), latitude.cos() * longitude.sin(), latitude.sin()]
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
