//! The points as tables, as lines of a file, and as advice.

use crate::measure::{Front, Point, at_error, by_setting};
use crate::setting::Dial;
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::Table;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// The error at which settings are compared in the first table.
const COMPARED: f64 = 1e-6;
/// The errors for which there is advice.
const WISHED: [f64; 4] = [1e-3, COMPARED, 1e-9, 1e-12];
/// The classical method that times are compared with.
const PEER: &str = "RK4";

/// Every setting at one error.
pub fn settings(points: &[Point], least: f64) -> Table<8> {
    let peer = by_setting(points).find(|points| points[0].name.method == PEER);
    let peer_time = peer.and_then(|points| at_error(points, COMPARED)).map_or(f64::NAN, |(time, _)| time);
    let mut table = Table::new([
        "at an error of 1e-6",
        "h / s",
        "ns per s",
        "over RK4",
        "slope",
        "energy error",
        "momenta moved",
        "off the group by",
    ]);
    for setting in by_setting(points) {
        let Some((time, h)) = at_error(setting, COMPARED) else { continue };
        let at = setting.iter().find(|point| point.error <= COMPARED).unwrap_or(&setting[0]);
        table.row([
            setting[0].name.to_string(),
            format!("{h:.2e}"),
            format!("{time:.2e}"),
            if peer_time.is_nan() { "-".to_owned() } else { format!("{:.2}", time / peer_time) },
            slope(setting, least).map_or("-".to_owned(), |slope| format!("{slope:.2}")),
            format!("{:.0e}", at.energy[0].max(at.energy[1])),
            format!("{:.0e}", at.momenta),
            format!("{:.0e}", at.constraint),
        ]);
    }
    table
}

/// Points, those on a front alone or all.
pub fn points(points: &[Point], all: bool) -> Table<8> {
    let mut table = Table::new([
        if all { "all points" } else { "the fronts" },
        "h / s",
        "error",
        "ns per s",
        "energy error",
        "momenta moved",
        "off the group by",
        "front",
    ]);
    for point in points.iter().filter(|point| all || point.front != Front::Behind) {
        table.row([
            point.name.to_string(),
            format!("{:.2e}", point.h),
            format!("{:.1e}", point.error),
            format!("{:.2e}", point.time),
            format!("{:.0e}", point.energy[0].max(point.energy[1])),
            format!("{:.0e}", point.momenta),
            format!("{:.0e}", point.constraint),
            mark(point.front).to_owned(),
        ]);
    }
    table
}

fn mark(front: Front) -> &'static str {
    match front {
        Front::Behind => "",
        Front::Geometric => "geometric",
        Front::All => "all",
    }
}

/// Errors between which a power of h shows: below, rounding is near; above, the next powers are.
pub const WINDOW: [f64; 2] = [6e-11, 1e-2];
/// Ratio of the step sizes that an order is measured over: a halving, and a rounding. In longer steps the next powers are seen where V is small.
const SPAN: f64 = 2.1;

/// The measured order: between the shortest steps whose error is in [`WINDOW`] and those that are, if they can, twice as long.
/// Errors below `least` do not count.
///
/// At order 1 it is that of the energy error. Its steps are those of order 2 seen from other momenta, by half a kick.
/// So over long times the phase is wrong by h² t, and h shows only in bounded errors.
pub fn slope(points: &[Point], least: f64) -> Option<f64> {
    let first_order = points.first()?.name.order == 1;
    let error = |point: &Point| if first_order { point.energy[0].max(point.energy[1]) } else { point.error };
    let [low, high] = [WINDOW[0].max(least), WINDOW[1]];
    let inside: Vec<&Point> = points.iter().filter(|point| (low..high).contains(&error(point))).collect();
    let last = inside.last()?;
    let first = inside.iter().find(|point| point.h < SPAN * last.h)?;
    let fixed = matches!(first.dial, Dial::Steps(_)) && first.h > last.h;
    fixed.then(|| (error(first) / error(last)).ln() / (first.h / last.h).ln())
}

/// The advice for an error, one line for each.
pub fn advice(title: &str, duration: f64, points: &[Point]) -> Vec<String> {
    WISHED.iter().filter_map(|error| advise(title, duration, points, *error)).collect()
}

fn advise(title: &str, duration: f64, points: &[Point], error: f64) -> Option<String> {
    let places = by_setting(points).filter_map(|points| Some((points[0], at_error(points, error)?)));
    let mut places: Vec<(Point, (f64, f64))> = places.collect();
    places.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
    let (best, (time, h)) = *places.iter().find(|(point, _)| point.is_geometric())?;
    let mut line =
        format!("{title}, {error:.0e} over {duration} s: {}, h = {h:.2e}, {time:.0} ns per second", best.name);
    for (classical, (needed, _)) in places.iter().filter(|(point, _)| !point.is_geometric()) {
        line += &format!("; {} needs {needed:.0}, {}", classical.name, compared(needed / time));
    }
    Some(line)
}

fn compared(ratio: f64) -> String {
    if ratio < 1.0 { format!("{:.1} times less", 1.0 / ratio) } else { format!("{ratio:.1} times more") }
}

/// One line a point, after one of names.
pub struct Csv<'a> {
    path: &'a Path,
    writer: BufWriter<File>,
}

impl<'a> Csv<'a> {
    /// Opens the file.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn create(path: &'a Path) -> Result<Self, Failure> {
        let mut csv = Self { path, writer: BufWriter::new(File::create(path).map_err(Failure::file(path))?) };
        csv.line(format_args!("{COLUMNS}"))?;
        Ok(csv)
    }

    /// Writes the points of a scene.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn points(&mut self, scene: &str, points: &[Point]) -> Result<(), Failure> {
        for point in points {
            let Point { name, h, steps, error, time, energy: [first, second], momenta, constraint, front, .. } = point;
            let tolerance = match (point.dial, name.tolerance) {
                (Dial::Tolerance(tolerance), _) => tolerance.to_string(),
                (_, Some(tolerance)) => format!("{tolerance:e}"),
                _ => String::new(),
            };
            self.line(format_args!(
                "{scene},{},{},{h:e},{tolerance},{steps},{error:e},{time:e},{first:e},{second:e},{momenta:e},{constraint:e},{}",
                name.method,
                name.order,
                mark(*front)
            ))?;
        }
        Ok(())
    }

    /// Writes the buffered lines and says where the file is.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn finish(mut self) -> Result<(), Failure> {
        self.writer.flush().map_err(Failure::file(self.path))?;
        say(format_args!("points      {}", self.path.display()));
        Ok(())
    }

    fn line(&mut self, line: std::fmt::Arguments<'_>) -> Result<(), Failure> {
        writeln!(self.writer, "{line}").map_err(Failure::file(self.path))
    }
}

const COLUMNS: &str = "scene,method,order,h,tolerance,steps,error,ns_per_second,energy_error_first_half,energy_error_second_half,momenta_moved,off_the_group,front";
