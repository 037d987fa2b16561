//! Error against time, a line for each setting, the front ringed.

use crate::measure::{Front, Point, by_setting};
use clebsch_examples::figure::{self, BLUE, Curve, Decades, GREEN, INK, ORANGE, PURPLE, RED, RGBColor, TEAL};
use clebsch_examples::scene::Failure;
use std::path::Path;

/// Draws the points of a scene to a folder, or to the default place.
pub fn draw(folder: Option<&Path>, scene: &str, title: &str, points: &[Point]) -> Result<(), Failure> {
    let name = format!("work_precision_{scene}");
    let path = folder.map(|folder| folder.join(&name).with_extension("svg"));
    let labels: Vec<String> = by_setting(points).map(label).collect();
    let curves = by_setting(points).zip(&labels).map(|(points, label)| curve(points, label));
    let chart = Decades {
        title: &format!("Work and precision: {title}"),
        x_label: "largest error at the samples",
        y_label: "time of computing for one unit of time / ns",
        curves: &curves.collect::<Vec<_>>(),
    };
    figure::draw_to(path.as_deref(), &name, (1000, 640), |area| chart.draw(area))
}

/// A name for those that are on a front, and for classical ones.
fn label(points: &[Point]) -> String {
    let shown = points.iter().any(|point| point.front != Front::Behind || !point.is_geometric());
    if shown { points[0].name.to_string() } else { String::new() }
}

fn curve<'a>(points: &[Point], label: &'a str) -> Curve<'a> {
    let name = points[0].name;
    let colour: RGBColor = match (points[0].is_geometric(), name.order) {
        (false, 4) => PURPLE,
        (false, _) => INK,
        (true, 1) => RGBColor(150, 156, 166),
        (true, 2) => BLUE,
        (true, 4) => GREEN,
        (true, 6) => ORANGE,
        (true, 8) => RED,
        (true, _) => TEAL,
    };
    let ringed = points.iter().map(|point| point.front != Front::Behind).collect();
    let width = if points[0].is_geometric() { 1.0 } else { 2.0 };
    Curve { label, colour, width, points: points.iter().map(|point| (point.error, point.time)).collect(), ringed }
}
