//! Flights in numbers, and their claims.

use super::flight::{CONVERGED, Flight, ONE, PAST};
use super::regulator::Regulator;
use super::task::Task;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::table::Table;

/// Of a number that has a spread.
struct Spread {
    median: f64,
    /// Greater than 95 of 100.
    high: f64,
    most: f64,
}

impl Spread {
    fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let at = |percent: usize| values.get(values.len() * percent / 100).or(values.last()).copied().unwrap_or(0.0);
        Self { median: at(50), high: at(95), most: at(100) }
    }
}

/// The root of the mean square, once the start has settled.
fn rms(task: &Task, values: &[f64]) -> f64 {
    let values = &values[task.steps / 8..];
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// All flights.
pub fn table(task: &Task, flights: &[Flight]) -> Table<8> {
    let headings =
        ["plans", "off the track / mm", "most", "obstacle / m", "thrusts / N", "linearisations", "95 %", "most"];
    let mut table = Table::new(headings);
    for flight in flights {
        let (off, (low, high)) = (flight.off(task), flight.span());
        let millimetres = |value: f64| format!("{:.1}", 1e3 * value);
        let clear = flight.clear(task).into_iter().fold(f64::INFINITY, f64::min);
        let work = Spread::of(flight.work.iter().map(|work| f64::from(*work)));
        table.row([
            flight.pilot.name.to_owned(),
            millimetres(rms(task, &off)),
            millimetres(largest(off[task.steps / 8..].iter().copied())),
            format!("{clear:.4}"),
            format!("{low:.3} to {high:.3}"),
            work.median.to_string(),
            work.high.to_string(),
            work.most.to_string(),
        ]);
    }
    table
}

/// One correction next to converged plans.
pub fn comparison(flights: &[Flight]) -> Table<4> {
    let mut table = Table::new(["one correction from converged plans", "median", "95 %", "most"]);
    let (one, converged) = (&flights[ONE], &flights[CONVERGED]);
    let names = ["thrusts at the same place, of that at hover", "paths, m"];
    for (name, apart) in names.into_iter().zip([one.apart.clone(), one.from(converged)]) {
        let Spread { median, high, most } = Spread::of(apart);
        let [median, high, most] = [median, high, most].map(|value| format!("{value:.2e}"));
        table.row([name.to_owned(), median, high, most]);
    }
    table
}

/// Claims of all flights.
pub fn claim(task: &Task, flights: &[Flight], regulator: &Regulator, claims: &mut Claims) {
    let [still, one, converged, fifth, corrected, ..] = flights else { return };
    let rms = |values: &[f64]| rms(task, values);
    let spans = flights.iter().map(Flight::span);
    let excess = spans.map(|(low, high)| (-low).max(high - task.system.top)).fold(f64::NEG_INFINITY, f64::max);
    claims.at_most("bounds of thrusts are kept", excess, 0.0, "N, beyond a bound");
    let failed: usize = flights.iter().map(|flight| flight.failed).sum();
    claims.at_most("all plans are usable", failed as f64, 0.0, "searches that failed");
    let most = one.work.iter().copied().max().unwrap_or(0);
    claims.at_most("the work of a tick is bounded", f64::from(most), 3.0, "linearisations of one correction");
    let apart = largest(one.apart.iter().copied());
    let reason = "of the thrust at hover, from the converged plan at the same place";
    claims.at_most("one correction gives the same thrusts", apart, 0.01, reason);
    let allowed = 0.01 * rms(&one.off(task));
    let reason = "m, from the flight by converged plans: a hundredth of the deviation";
    claims.at_most("and the same path", largest(one.from(converged)), allowed, reason);
    claims.at_most("in still air it is on the track", rms(&still.off(task)), 1e-3, "m, root mean square");
    let moved = rms(&one.from(still)) / (regulator.reach * task.gust / 3.0);
    let name = "gusts move it as far as the regulator lets them";
    if task.steps >= 300 {
        claims.within(name, moved, 0.5..=1.5, 3, "of the distance by Lyapunov's sum at hover");
    } else {
        claims.skip(name, "too short a flight for a mean");
    }
    let (without, with) = (rms(&fifth.from(one)), rms(&corrected.from(one)));
    let reason = "m, from plans at each tick: half of the distance without";
    claims.at_most("feedback stands in for plans", with, without / 2.0, reason);
    let past = &flights[PAST];
    claims.at_most("plans leave room for gusts", past.lack, 1e-9, "m, lacking in the first half of a plan");
    let nearest = |flight: &Flight| flight.clear(task).into_iter().fold(f64::INFINITY, f64::min);
    let reason = "m, lacking in flight: ten corrections";
    claims.at_most("so it stays clear of the obstacle", task.clearance - nearest(past), 0.0, reason);
    let name = "the obstacle is in the way";
    if nearest(one) < task.clearance {
        claims.holds(name, true, "of the flight that does not know of it");
    } else {
        claims.skip(name, "the flight ends before, or the distance is small");
    }
}
