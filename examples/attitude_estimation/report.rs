//! Estimates in numbers, and their claims.

use crate::orbit::Orbit;
use crate::{Estimate, Flags, Start, filter, window};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;

/// Errors of the start: a name, degrees, degrees per hour, and the standard deviations of both that the estimators are told.
type Wrong = (&'static str, [[f64; 3]; 2], [f64; 2]);

/// Errors of several sizes; the last ones are those of the source.
pub const STARTS: [Wrong; 4] = [
    ("1° off", [[1.0, 1.0, 1.0], [0.1, 0.1, 0.1]], [1.0, 0.2]),
    ("30° off", [[30.0, 30.0, 30.0], [0.1, 0.1, 0.1]], [50.0, 0.2]),
    ("175° off", [[-50.0, 50.0, 160.0], [0.1, 0.1, 0.1]], [50.0, 0.2]),
    ("175° off, and 24°/h", [[-50.0, 50.0, 160.0], [20.0, 10.0, -10.0]], [50.0, 20.0]),
];

/// The case in which the bias is wrong too.
pub const WRONG_BIAS: usize = 3;
/// Errors that count as known, degrees.
const KNOWN: f64 = 0.1;
const NEARLY: f64 = 1.0;

/// Estimates from one start.
pub struct Case {
    pub name: &'static str,
    pub window: Vec<Estimate>,
    pub filter: Vec<Estimate>,
    /// The linearisations of each estimate.
    work: Vec<u32>,
}

impl Case {
    pub fn new(flags: &Flags, orbit: &Orbit, &(name, errors, spread): &Wrong) -> Result<Self, Failure> {
        let start = Start::new(&orbit.places[0], errors, spread);
        let (window, work) = window::estimates(orbit, &start, (flags.window as usize, flags.stride as usize))?;
        let filter = filter::filter(orbit, &start);
        Ok(Self { name, window, filter, work })
    }
}

/// The time from which on the error stays below so many degrees, h.
fn known_from(orbit: &Orbit, estimates: &[Estimate], degrees: f64) -> Option<f64> {
    let last = estimates.iter().rposition(|estimate| estimate.off(orbit) >= degrees);
    let first = estimates.get(last.map_or(0, |last| last + 1))?;
    Some(first.k as f64 * orbit.h / 3600.0)
}

/// The estimates of the last third.
fn late<'a>(orbit: &Orbit, estimates: &'a [Estimate]) -> impl Iterator<Item = &'a Estimate> {
    let from = orbit.gyro.len() * 2 / 3;
    estimates.iter().filter(move |estimate| estimate.k > from)
}

/// The root of the mean square of the error in the last third, degrees.
fn rms(orbit: &Orbit, estimates: &[Estimate]) -> f64 {
    let (sum, count) =
        late(orbit, estimates).fold((0.0, 0.0), |(sum, count), x| (sum + x.off(orbit).powi(2), count + 1.0));
    (sum / count).sqrt()
}

/// The mean of δ·Λδ of the last third, by its degrees of freedom.
fn spread(orbit: &Orbit, estimates: &[Estimate]) -> f64 {
    let square = |estimate: &Estimate| {
        let error = estimate.error(orbit);
        estimate.information.map_or(f64::NAN, |information| error.dot(&(information * error)))
    };
    let (sum, count) = late(orbit, estimates).fold((0.0, 0.0), |(sum, count), x| (sum + square(x), count + 1.0));
    sum / count / 6.0
}

pub fn table(orbit: &Orbit, cases: &[Case]) -> Table<6> {
    let mut table =
        Table::new(["at the start", "below 1° from", "below 0.1° from", "last third", "δ·Λδ/6", "linearisations"]);
    let hours = |time: Option<f64>| time.map_or("never".to_owned(), |time| format!("{time:.2} h"));
    for case in cases {
        let mean = case.work.iter().sum::<u32>() as f64 / case.work.len() as f64;
        let rows = [("window", &case.window, format!("{mean:.1}")), ("filter", &case.filter, String::new())];
        for (name, estimates, work) in rows {
            table.row([
                format!("{}, {name}", case.name),
                hours(known_from(orbit, estimates, NEARLY)),
                hours(known_from(orbit, estimates, KNOWN)),
                format!("{:.4}°", rms(orbit, estimates)),
                format!("{:.2}", spread(orbit, estimates)),
                work,
            ]);
        }
    }
    table
}

pub fn claim(flags: &Flags, orbit: &Orbit, cases: &[Case], claims: &mut Claims) {
    let most = cases.iter().flat_map(|case| &case.work).copied().max().unwrap_or(0);
    claims.at_most("estimates take few linearisations", f64::from(most), 60.0, "linearisations of one estimate");
    let long = [
        "the window is as exact as the filter",
        "its errors have the covariance that it says",
        "wrong starts are forgotten",
        "also with a wrong bias",
        "the filter is slower then",
    ];
    if flags.run.duration() < 18_000.0 || flags.window < 60 {
        long.iter().for_each(|name| claims.skip(name, "less than five hours, or a window below 60 steps"));
        return;
    }
    let [next, near, far, biased] = cases else { return };
    let parts = rms(orbit, &next.window) / rms(orbit, &next.filter);
    claims.within(long[0], parts, 0.8..=1.2, 3, "of the error of the filter in the last third, from 1°");
    let spreads = cases.iter().map(|case| spread(orbit, &case.window));
    let reason = "δ·Λδ by its six degrees of freedom, the largest of all cases";
    claims.within(long[1], largest(spreads), 0.3..=2.5, 2, reason);
    let known = [near, far].map(|case| known_from(orbit, &case.window, NEARLY).unwrap_or(f64::INFINITY));
    claims.at_most(long[2], largest(known), 0.1, "h until the attitude is known to 1°, for good");
    let window = known_from(orbit, &biased.window, KNOWN).unwrap_or(f64::INFINITY);
    claims.at_most(long[3], window, 1.0, "h until the attitude is known to 0.1°, for good");
    let filter = known_from(orbit, &biased.filter, KNOWN).unwrap_or(f64::INFINITY);
    claims.at_most(long[4], window / filter, 0.5, "of the time that the filter takes, 0 if it never gets there");
}
