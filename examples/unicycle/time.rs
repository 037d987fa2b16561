//! The same parking in a time of one's own choice, which has a price.
//!
//! Paths do not depend on the time, so a path of the length d in the metric costs d²/(2T) + wT. The least is d√(2w), at
//! T = d/√(2w).

use crate::declaration::{Car, Free};
use crate::plan::{Plan, Problem};
use crate::study::Study;
use clebsch::Error;
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::Order;
use clebsch_examples::table::Table;

/// The golden ratio less 1.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Sections of an interval: the price is flat to rounding once the interval is a ten millionth of its first length.
const SECTIONS: usize = 34;

/// Plans whose time was found, and its exact value.
#[derive(Clone, Debug)]
pub struct FreeTime {
    /// With N, 2N and 4N steps.
    plans: [Plan; 3],
    /// By searching among plans of given times, with N steps, s.
    searched: f64,
    /// T and the price of the closed form.
    exact: Option<(f64, f64)>,
}

impl FreeTime {
    /// Solves the problem of `parking` with the price `time_price` of a second.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn new(problem: Problem, parking: &Study, time_price: f64) -> Result<Self, Error> {
        let problem = Problem { car: Car { time_price, ..problem.car }, ..problem };
        let [coarse, middle, fine] = &parking.plans;
        let find = |known: &Plan| problem.solve_free_time::<Free, 0>(known.steps() as u64, |t| known.input(t));
        let plans = [find(coarse)?, find(middle)?, find(fine)?];
        let searched = search(&problem, &plans[0])?;
        let exact = parking.geodesic.map(|geodesic| {
            let distance = geodesic.speed_squared().sqrt() * problem.duration;
            (distance / (2.0 * time_price).sqrt(), distance * (2.0 * time_price).sqrt())
        });
        Ok(Self { plans, searched, exact })
    }

    /// The results.
    pub fn table(&self) -> Table<6> {
        let mut table =
            Table::new(["free time: steps", "time / s", "off by", "price / (m²/s)", "off by", "iterations"]);
        for plan in &self.plans {
            let off = |value: f64, exact: Option<f64>| {
                exact.map_or("-".to_owned(), |exact| format!("{:.2e}", value / exact - 1.0))
            };
            let time = plan.duration();
            table.row([
                plan.steps().to_string(),
                format!("{time:.9}"),
                off(time, self.exact.map(|exact| exact.0)),
                format!("{:.9}", plan.price),
                off(plan.price, self.exact.map(|exact| exact.1)),
                plan.iterations.to_string(),
            ]);
        }
        table
    }

    /// The time is that of the search, and of second order that of the closed form.
    pub fn claim(&self, claims: &mut Claims) {
        let off = (self.plans[0].duration() / self.searched - 1.0).abs();
        claims.at_most("free time: that of a golden section search", off, 1e-6, "relative; the price is flat there");
        let times = self.exact.map(|(time, _)| self.plans.each_ref().map(|plan| (plan.duration() / time - 1.0).abs()));
        let prices = self.exact.map(|(_, price)| self.plans.each_ref().map(|plan| (plan.price / price - 1.0).abs()));
        for (part, errors) in [("time", times), ("price", prices)] {
            let (name, steps) = (format!("free time: the order of the {part}"), self.plans[0].steps() as u64);
            match errors {
                Some(errors) => {
                    Convergence { errors, reference: 1e-13, steps }.claim(Order::Second, &name, claims);
                }
                None => claims.skip(&name, "no geodesic of the closed form is near: too long a step"),
            }
        }
    }
}

/// The time within 10 % of that of `near` at which plans of N steps cost least, by golden sections.
fn search(problem: &Problem, near: &Plan) -> Result<f64, Error> {
    let steps = near.steps() as u64;
    let duration = near.duration();
    let price = |time: f64| -> Result<f64, Error> {
        let problem = Problem { duration: time, ..*problem };
        let plan = problem.solve::<Free, 0>(steps, |t| near.input(t * duration / time) * (duration / time))?;
        Ok(plan.price)
    };
    let (mut low, mut high) = (0.9 * duration, 1.1 * duration);
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_left, mut at_right) = (price(left)?, price(right)?);
    for _ in 0..SECTIONS {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = price(left)?;
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = price(right)?;
        }
    }
    Ok((low + high) / 2.0)
}
