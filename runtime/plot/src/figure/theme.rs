//! Colours, type and layout, the same in all figures.

use super::canvas::{Area, Drawn, FINENESS};
use plotters::prelude::{DrawingAreaErrorKind, IntoFont, PathElement, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoTextStyle, RGBColor, TextStyle};
use std::io;

/// Text.
pub const INK: RGBColor = RGBColor(38, 44, 56);
/// Curves.
pub const BLUE: RGBColor = RGBColor(31, 92, 168);
/// Curves.
pub const ORANGE: RGBColor = RGBColor(214, 106, 22);
/// Curves.
pub const GREEN: RGBColor = RGBColor(45, 134, 72);
/// Curves.
pub const RED: RGBColor = RGBColor(190, 44, 52);
/// Curves.
pub const TEAL: RGBColor = RGBColor(0, 128, 138);
/// Curves.
pub const PURPLE: RGBColor = RGBColor(118, 78, 160);

pub(super) const PAPER: RGBColor = RGBColor(255, 255, 255);
pub(super) const SOFT_INK: RGBColor = RGBColor(92, 100, 114);
pub(super) const FRAME: RGBColor = RGBColor(176, 184, 196);
pub(super) const GRID: RGBColor = RGBColor(228, 232, 238);

/// The path of time, from early to late.
const GRADIENT: [RGBColor; 4] =
    [RGBColor(48, 44, 122), RGBColor(28, 116, 168), RGBColor(38, 160, 134), RGBColor(236, 152, 46)];

const FONT: &str = "Helvetica, Arial, sans-serif";

/// Pixels as units of the drawing.
pub(super) fn px(pixels: f64) -> i32 {
    unit(pixels * f64::from(FINENESS))
}

/// The unit of the drawing next to a number, for numbers far outside and for those that are none, too.
pub(super) fn unit(number: f64) -> i32 {
    const FARTHEST: f64 = 1e8;
    number.clamp(-FARTHEST, FARTHEST).round() as i32
}

/// Text of a height in pixels, anchored at a point.
pub(super) fn text(height: f64, colour: RGBColor, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    let font = (FONT, px(height)).into_font();
    TextStyle { font, color: colour.to_backend_color(), pos: Pos::new(horizontal, vertical) }
}

/// The colour at a fraction of the path of time.
pub fn along(fraction: f64) -> RGBColor {
    let last = GRADIENT.len() - 1;
    let place = fraction.clamp(0.0, 1.0) * last as f64;
    let index = (place as usize).min(last - 1);
    blend(GRADIENT[index], GRADIENT[index + 1], place - index as f64)
}

/// Pieces of one colour in a path that is coloured by time.
pub const PIECES: usize = 60;

/// At most [`PIECES`] pieces of a path, each with one point of the next, so that they meet.
pub fn pieces<T>(points: &[T]) -> impl Iterator<Item = &[T]> {
    let length = points.len().div_ceil(PIECES).max(1);
    (0..points.len()).step_by(length).map(move |start| &points[start..(start + length + 1).min(points.len())])
}

/// A path in the pieces that it is drawn in, each with its colour: one piece where the path has a colour, else [`along`] time.
pub(super) fn coloured<T>(points: &[T], colour: Option<RGBColor>) -> Vec<(RGBColor, &[T])> {
    if let Some(colour) = colour {
        return vec![(colour, points)];
    }
    let fraction = |index: usize| index as f64 / (PIECES - 1) as f64;
    pieces(points).enumerate().map(|(index, piece)| (along(fraction(index)), piece)).collect()
}

/// A mixture with the share `share` of `to`, and otherwise `from`.
pub(super) fn blend(from: RGBColor, to: RGBColor, share: f64) -> RGBColor {
    let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * share).round() as u8;
    RGBColor(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

/// A line of text at the top of an area; returns the area below.
pub fn caption<'a>(area: &Area<'a>, line: &str) -> Result<Area<'a>, DrawingAreaErrorKind<io::Error>> {
    let (head, body) = area.split_vertically(px(26.0));
    write(&head, line, (px(10.0), px(14.0)), text(15.0, INK, HPos::Left, VPos::Center))?;
    Ok(body)
}

/// Splits into columns, the first `pixels` wide.
pub fn columns<'a>(area: &Area<'a>, pixels: f64) -> (Area<'a>, Area<'a>) {
    area.split_horizontally(px(pixels))
}

/// Splits into rows, the first `pixels` high.
pub fn rows<'a>(area: &Area<'a>, pixels: f64) -> (Area<'a>, Area<'a>) {
    area.split_vertically(px(pixels))
}

/// Names in their colours, one below the other, at the upper left of an area.
pub fn legend<'a>(area: &Area<'_>, names: impl Iterator<Item = (&'a str, RGBColor)>) -> Drawn {
    for (line, (name, colour)) in names.enumerate() {
        let at = (px(12.0), px(12.0 + 18.0 * line as f64));
        write(area, name, at, text(12.5, colour, HPos::Left, VPos::Center))?;
    }
    Ok(())
}

/// The scale of [`along`], with the texts at its ends, at the bottom of an area.
pub fn colour_bar(area: &Area<'_>, from: &str, to: &str) -> Drawn {
    const CELLS: i32 = 48;
    let (width, height) = area.dim_in_pixel();
    let (middle, y) = (width as i32 / 2, height as i32 - px(18.0));
    let cell = px(160.0) / CELLS;
    let left = middle - cell * CELLS / 2;
    for index in 0..CELLS {
        let corners = [(left + index * cell, y - px(4.0)), (left + (index + 1) * cell + px(0.3), y + px(4.0))];
        area.draw(&Rectangle::new(corners, along(f64::from(index) / f64::from(CELLS - 1)).filled()))?;
    }
    let right = left + CELLS * cell + px(8.0);
    write(area, from, (left - px(8.0), y), text(12.0, SOFT_INK, HPos::Right, VPos::Center))?;
    write(area, to, (right, y), text(12.0, SOFT_INK, HPos::Left, VPos::Center))
}

/// A line through points in units of the drawing.
pub(super) fn stroke(area: &Area<'_>, points: Vec<(i32, i32)>, colour: RGBColor, width: f64) -> Drawn {
    area.draw(&PathElement::new(points, colour.stroke_width(px(width).unsigned_abs())))
}

/// Text of one line.
pub(super) fn write(area: &Area<'_>, line: &str, at: (i32, i32), style: TextStyle<'static>) -> Drawn {
    area.draw(&Text::new(line.to_owned(), at, style.into_text_style(area)))
}
