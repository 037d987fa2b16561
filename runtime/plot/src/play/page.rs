//! The text of a page.

use super::Part;
use std::fmt::Write;

/// The page, with the names of its parts between `§`.
const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The radius of the picture in units of a vector.
const UNITS: f64 = 10_000.0;

/// The duration in units of a time.
const TICKS: f64 = 1e6;

/// The page with its motion.
pub(super) fn write(title: &str, time_unit: &str, times: &[f64], parts: &[Part], sphere: Option<f64>) -> String {
    let mut page = String::new();
    for (index, piece) in PAGE.split('§').enumerate() {
        match piece {
            _ if index % 2 == 0 => page.push_str(piece),
            "title" => page.push_str(&escaped(title)),
            "style" => page.push_str(STYLE),
            "script" => page.push_str(SCRIPT),
            _ => push_motion(&mut page, time_unit, times, parts, sphere),
        }
    }
    page
}

/// Text between tags.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// The motion as JSON that no tag ends.
fn push_motion(page: &mut String, time_unit: &str, times: &[f64], parts: &[Part], sphere: Option<f64>) {
    let view = View::of(parts, sphere);
    let first = times.first().copied().unwrap_or(0.0);
    let last = times.last().copied().unwrap_or(first);
    // writing to a text does not fail
    let _ = write!(page, r#"{{"count":{},"start":{first:?},"end":{last:?},"unit":"#, times.len());
    push_text(page, time_unit);
    if !is_even(times) {
        page.push_str(",\"times\":");
        let half = last / 2.0 - first / 2.0;
        let ticks = times.iter().map(|time| (time / 2.0 - first / 2.0) / half * TICKS);
        push_changes(page, ticks);
    }
    if let Some(radius) = sphere {
        let [x, y, z] = view.place([0.0; 3]).map(|x| (x * UNITS).round());
        let _ = write!(page, ",\"sphere\":[{x},{y},{z},{}]", (view.length(radius) * UNITS).round());
    }
    page.push_str(",\"parts\":[");
    for (index, part) in parts.iter().enumerate() {
        page.push_str(if index == 0 { "{\"kind\":\"" } else { ",\n{\"kind\":\"" });
        page.push_str(part.kind.name());
        page.push_str("\",\"name\":");
        push_text(page, &part.name);
        page.push_str(",\"data\":[");
        let count = part.vectors.first().map_or(0, Vec::len);
        for channel in 0..3 * count {
            let (k, i) = (channel / 3, channel % 3);
            if channel > 0 {
                page.push(',');
            }
            let number = |vectors: &Vec<[f64; 3]>| {
                let vector = if part.kind.is_place(k) { view.place(vectors[k]) } else { view.vector(vectors[k]) };
                vector[i] * UNITS
            };
            push_changes(page, part.vectors.iter().map(number));
        }
        page.push_str("]}");
    }
    page.push_str("]}");
}

/// Integers: the first one, then the changes from each to the next. A number that stays is there once.
fn push_changes(page: &mut String, numbers: impl Iterator<Item = f64>) {
    let mut last = 0;
    let changes: Vec<i64> = numbers
        .map(|number| {
            // only numbers beyond all measure are outside, and 0 stands for none
            let number = number.clamp(-1e9, 1e9).round() as i64;
            let change = number - last;
            last = number;
            change
        })
        .collect();
    let stays = changes.iter().skip(1).all(|change| *change == 0);
    let shown = if stays { &changes[..changes.len().min(1)] } else { &changes };
    page.push('[');
    for (index, change) in shown.iter().enumerate() {
        let _ = if index == 0 { write!(page, "{change}") } else { write!(page, ",{change}") };
    }
    page.push(']');
}

/// A text in JSON without a letter that HTML reads.
fn push_text(page: &mut String, text: &str) {
    page.push('"');
    for letter in text.chars() {
        match letter {
            '"' | '\\' => page.extend(['\\', letter]),
            '<' | '>' | '&' | '\u{2028}' | '\u{2029}' | '\0'..'\x20' => {
                let _ = write!(page, "\\u{:04x}", u32::from(letter));
            }
            _ => page.push(letter),
        }
    }
    page.push('"');
}

/// Whether the times have the same distances, as far as a page shows.
fn is_even(times: &[f64]) -> bool {
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return true };
    let whole = last / 2.0 - first / 2.0;
    let count = (times.len() - 1) as f64;
    let is_near = |(index, time): (usize, &f64)| {
        (time / 2.0 - first / 2.0 - whole * (index as f64 / count)).abs() <= whole.abs() / TICKS
    };
    whole == 0.0 || times.iter().enumerate().all(is_near)
}

/// A ball about everything that is drawn. Sums of the largest numbers overflow, so lengths are counted in the largest of them.
struct View {
    unit: f64,
    middle: [f64; 3],
    radius: f64,
}

impl View {
    fn of(parts: &[Part], sphere: Option<f64>) -> Self {
        let points: Vec<[f64; 3]> =
            parts.iter().flat_map(|part| part.vectors.iter().flat_map(|vectors| part.reach(vectors))).collect();
        let numbers = points.iter().flatten().copied().chain(sphere);
        let unit = numbers.fold(0.0, |largest: f64, number| largest.max(number.abs()));
        let unit = if unit > 0.0 { unit } else { 1.0 };
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        let of_sphere = sphere.iter().flat_map(|radius| [[*radius; 3], [-radius; 3]]);
        for point in points.iter().copied().chain(of_sphere) {
            for i in 0..3 {
                low[i] = low[i].min(point[i] / unit);
                high[i] = high[i].max(point[i] / unit);
            }
        }
        let middle = [0, 1, 2].map(|i| (low[i] + high[i]) / 2.0);
        let distance = |point: [f64; 3]| {
            let squares = [0, 1, 2].map(|i| (point[i] / unit - middle[i]).powi(2));
            squares.iter().sum::<f64>().sqrt()
        };
        let of_sphere = sphere.map(|radius| distance([0.0; 3]) + radius / unit);
        let radius = points.iter().map(|point| distance(*point)).chain(of_sphere).fold(0.0, f64::max);
        Self { unit, middle, radius: if radius > 0.0 { radius } else { 1.0 } }
    }

    fn place(&self, point: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| (point[i] / self.unit - self.middle[i]) / self.radius)
    }

    fn vector(&self, vector: [f64; 3]) -> [f64; 3] {
        vector.map(|x| self.length(x))
    }

    fn length(&self, length: f64) -> f64 {
        length / self.unit / self.radius
    }
}
