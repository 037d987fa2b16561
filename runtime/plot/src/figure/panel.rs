//! Curves against time, or against another number.

use super::canvas::{Area, Drawn};
use super::theme::{FRAME, GRID, INK, SOFT_INK, px, text, write};
use plotters::chart::ChartBuilder;
use plotters::prelude::PathElement;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};
use std::ops::Range;

/// One curve.
///
/// ```
/// use clebsch_plot::figure::{PURPLE, Series};
///
/// let points = vec![(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0), (3.0, 4.0)];
/// let series = Series { label: "with a gap", colour: PURPLE, points };
/// # assert_eq!(series.points.len(), 4);
/// ```
///
/// Where `y` is not finite the curve has a gap.
#[derive(Clone, Debug)]
pub struct Series<'a> {
    /// Its name, shown in its colour where there is more than one; empty for none.
    pub label: &'a str,
    /// Its colour.
    pub colour: RGBColor,
    /// (x, y)
    pub points: Vec<(f64, f64)>,
}

/// A chart with a title, labelled axes and curves.
///
/// ```
/// use clebsch_plot::figure::{self, GREEN, Panel, Series};
///
/// let points = (0..50).map(|i| (f64::from(i), 1e-15 * f64::from(i % 7))).collect();
/// let series = vec![Series { label: "", colour: GREEN, points }];
/// let panel = Panel { title: "Change of the energy", unit: "J", x_label: "time (s)", series };
/// let svg = figure::svg((600, 200), |area| panel.draw(area))?;
/// assert!(svg.contains("(10⁻¹⁵ J)"));
/// # Ok::<(), figure::Broken>(())
/// ```
#[derive(Clone, Debug)]
pub struct Panel<'a> {
    /// The title of the plot.
    pub title: &'a str,
    /// The unit of y, empty for none.
    pub unit: &'a str,
    /// Name and unit of x; empty where the panel below shows it.
    pub x_label: &'a str,
    /// Curves.
    pub series: Vec<Series<'a>>,
}

impl Panel<'_> {
    /// Draws into all of the area.
    pub fn draw(&self, area: &Area<'_>) -> Drawn {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let scale = Scale::of(points().map(|point| point.1));
        let x = spread(points().map(|point| point.0), 0.0);
        let y = spread(points().map(|point| point.1 * scale.factor), 0.06);
        let (head, body) = area.split_vertically(px(22.0));
        self.draw_head(&head, &scale)?;

        let bottom = if self.x_label.is_empty() { px(10.0) } else { px(38.0) };
        let mut chart = ChartBuilder::on(&body)
            .margin_right(px(18.0))
            .set_label_area_size(plotters::chart::LabelAreaPosition::Left, px(64.0))
            .set_label_area_size(plotters::chart::LabelAreaPosition::Bottom, bottom)
            .build_cartesian_2d(x.clone(), y.clone())?;
        let (x_digits, y_digits) = (digits(&x), digits(&y));
        let mut mesh = chart.configure_mesh();
        mesh.x_labels(if self.x_label.is_empty() { 0 } else { 7 })
            .y_labels(5)
            .x_label_formatter(&|value| plain(*value, x_digits))
            .y_label_formatter(&|value| plain(*value, y_digits))
            .x_desc(self.x_label)
            .axis_desc_style(text(13.0, SOFT_INK, HPos::Left, VPos::Top))
            .label_style(text(12.0, SOFT_INK, HPos::Left, VPos::Top))
            .axis_style(FRAME.stroke_width(px(1.0).unsigned_abs()))
            .bold_line_style(GRID.stroke_width(px(0.8).unsigned_abs()))
            .light_line_style(GRID.mix(0.0))
            .set_all_tick_mark_size(px(4.0))
            .draw()?;
        for series in &self.series {
            for piece in series.points.split(|point| !point.1.is_finite()).filter(|piece| piece.len() > 1) {
                let points: Vec<_> = piece.iter().map(|&(x, y)| (x, y * scale.factor)).collect();
                chart
                    .plotting_area()
                    .draw(&PathElement::new(points, series.colour.stroke_width(px(1.1).unsigned_abs())))?;
            }
        }
        Ok(())
    }

    /// The title with unit and power of ten, then the names of the curves from the right.
    fn draw_head(&self, head: &Area<'_>, scale: &Scale) -> Drawn {
        let unit = match (scale.power.as_str(), self.unit) {
            ("", "") => String::new(),
            (power, "") => format!("  ({power})"),
            ("", unit) => format!("  ({unit})"),
            (power, unit) => format!("  ({power} {unit})"),
        };
        write(head, &format!("{}{unit}", self.title), (px(64.0), px(12.0)), text(13.5, INK, HPos::Left, VPos::Center))?;
        let mut right = head.dim_in_pixel().0 as i32 - px(18.0);
        for series in self.series.iter().rev().filter(|series| !series.label.is_empty()) {
            write(head, series.label, (right, px(12.0)), text(12.5, series.colour, HPos::Right, VPos::Center))?;
            right -= px(12.0 + 7.0 * series.label.chars().count() as f64);
        }
        Ok(())
    }
}

/// A power of ten taken out of the labels of an axis.
struct Scale {
    factor: f64,
    power: String,
}

impl Scale {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let largest = values.filter(|value| value.is_finite()).fold(0.0, |a: f64, b| a.max(b.abs()));
        if largest == 0.0 || (1e-2..1e4).contains(&largest) {
            return Self { factor: 1.0, power: String::new() };
        }
        let exponent = largest.log10().floor().max(-300.0) as i32;
        Self { factor: 10_f64.powi(-exponent), power: format!("10{}", superscript(exponent)) }
    }
}

fn superscript(number: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    };
    number.to_string().chars().map(raised).collect()
}

/// The range of the values, with a margin on both sides; not empty where all of them are equal.
fn spread(values: impl Iterator<Item = f64>, margin: f64) -> Range<f64> {
    // differences of these are finite
    const FARTHEST: f64 = 4e307;
    let finite = values.filter(|value| value.is_finite()).map(|value| value.clamp(-FARTHEST, FARTHEST));
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)));
    match high - low {
        width if width > 1e-12 * high.abs().max(low.abs()) => low - margin * width..high + margin * width,
        _ if low.is_finite() => low - low.abs().max(1.0)..high + high.abs().max(1.0),
        _ => 0.0..1.0,
    }
}

/// Decimals that tell the ticks of a range apart.
fn digits(range: &Range<f64>) -> usize {
    let tick = (range.end - range.start) / 6.0;
    (-(tick.log10().floor())).clamp(0.0, 12.0) as usize
}

/// A tick without the sign of −0.
fn plain(value: f64, digits: usize) -> String {
    let label = format!("{value:.digits$}");
    if label.trim_matches(['-', '0', '.']).is_empty() { label.trim_start_matches('-').to_owned() } else { label }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_any_data_are_finite() {
        assert_eq!(spread([].into_iter(), 0.1), 0.0..1.0);
        assert_eq!(spread([3.0, f64::NAN, 3.0].into_iter(), 0.1), 0.0..6.0);
        assert_eq!(spread([0.0, 1.0].into_iter(), 0.5), -0.5..1.5);
        assert_eq!(Scale::of([2.5e-15].into_iter()).power, "10⁻¹⁵");
        assert_eq!(plain(-0.0, 2), "0.00");
        assert_eq!(digits(&(0.0..0.3)), 2);
    }
}
