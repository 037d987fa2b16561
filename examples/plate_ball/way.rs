//! Ways to roll the ball to the goal: plans from many guesses, each next to the continuous extremal.

use crate::Problem;
use crate::plan::{Moment, Plan};
use crate::rolling::{Costate, Motion, Shot};
use clebsch::Error;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::Order;
use clebsch_examples::round_off::worst_case;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::Vector2;
use std::f64::consts::TAU;

/// Directions in which guesses set out.
const DIRECTIONS: u32 = 8;
/// Turns that they make, with the speed in radii per duration.
const CIRCLES: [(f64, f64); 4] = [(1.0, 4.0), (-1.0, 4.0), (0.5, 6.0), (-0.5, 6.0)];
/// Prices that differ by less, relative, are those of the same way or of its mirror image.
const SAME: f64 = 1e-7;
/// The tolerance of conditions of first order where extremals form a family, relative.
const FAMILY: f64 = 1e-6;
/// Ways that are looked at more closely.
pub const SHOWN: usize = 4;

/// A way to the goal.
#[derive(Clone, Debug)]
pub struct Way {
    /// With h, h/2 and h/4.
    pub plans: [Plan; 3],
    /// The continuous one; `None` where there is none near: too long a step.
    pub shot: Option<Shot>,
    /// The number of guesses that lead here.
    guesses: usize,
    /// From the first of them.
    iterations: u32,
}

/// The least ways that guesses lead to, the least first.
///
/// # Errors
/// Where no guess leads anywhere.
pub fn find(problem: &Problem, steps: u64) -> Result<Vec<Way>, Failure> {
    let mut found: Vec<(Plan, usize)> = Vec::new();
    let mut failure = None;
    for (turns, radii) in CIRCLES {
        for direction in 0..DIRECTIONS {
            let from = TAU * f64::from(direction) / f64::from(DIRECTIONS);
            let speed = radii * problem.radius / problem.duration;
            let circle = |part: f64| {
                let (sin, cos) = (from + TAU * turns * part).sin_cos();
                Vector2::new(cos, sin) * speed
            };
            match problem.solve(steps, circle) {
                Ok(plan) => match found.iter_mut().find(|(known, _)| (known.price / plan.price - 1.0).abs() < SAME) {
                    Some((_, guesses)) => *guesses += 1,
                    None => found.push((plan, 1)),
                },
                Err(error) => failure = Some(error),
            }
        }
    }
    found.sort_by(|a, b| a.0.price.total_cmp(&b.0.price));
    found.truncate(SHOWN);
    if let (true, Some(error)) = (found.is_empty(), failure) {
        return Err(Failure::Start(error));
    }
    Ok(found.into_iter().map(|(plan, guesses)| Way::new(problem, &plan, guesses)).collect::<Result<_, _>>()?)
}

/// Largest distances of a plan from the continuous extremal.
#[derive(Clone, Copy, Debug)]
struct Off {
    /// Of positions in radii, and of attitudes.
    place: f64,
    /// Of the price, relative.
    price: f64,
}

impl Way {
    /// Once more from its inputs, and with more steps.
    fn new(problem: &Problem, found: &Plan, guesses: usize) -> Result<Self, Error> {
        let steps = found.steps() as u64;
        let coarse = problem.solve(steps, |part| found.input(part))?;
        let middle = problem.solve(2 * steps, |part| coarse.input(part))?;
        let fine = problem.solve(4 * steps, |part| middle.input(part))?;
        let first = fine.path[0];
        let (r, unit) = (problem.radius, problem.radius / problem.duration);
        let (l, m) = (first.costate / unit, first.momentum / (r * unit));
        let shot = Shot::aim(problem, &Costate::from([l.x, l.y, m.x, m.y, m.z]));
        Ok(Self { plans: [coarse, middle, fine], shot, guesses, iterations: found.iterations })
    }

    fn off(&self, problem: &Problem, plan: &Plan) -> Option<Off> {
        let shot = self.shot?;
        let path = shot.path(problem, plan.steps() as u64);
        let distance = |(moment, motion): (&Moment, &Motion)| {
            let way = moment.position / problem.radius - motion.position;
            [way.norm(), (moment.attitude - motion.attitude).norm()]
        };
        let place = largest(plan.path.iter().zip(&path).flat_map(distance));
        let off = Off { place, price: (plan.price / shot.price - 1.0).abs() };
        Some(off)
    }

    fn claim(&self, problem: &Problem, number: usize, claims: &mut Claims) {
        let [plan, ..] = &self.plans;
        let steps = plan.steps() as u64;
        let name = |text: &str| format!("way {number}: {text}");
        let defects = plan.defects();
        claims.round_off(&name("the ball arrives"), plan.gap, steps, 1.0);
        claims.round_off(&name("it neither slips nor spins"), defects.slip, steps, 1.0);
        claims.round_off(&name("λ is constant"), defects.costate, steps, 1.0);
        claims.round_off(&name("m is constant in the ball"), defects.momentum, steps, 1.0);
        // of a family any is as good, so that it is found less well
        let is_isolated = self.shot.is_none_or(|shot| shot.is_isolated);
        let (rest, note) = if is_isolated { (0.0, "rounding") } else { (FAMILY, "one of a family") };
        let bound = worst_case(steps, 1.0).max(rest);
        claims.at_most(&name("m3 is an affine function of the position"), defects.elastica, bound, note);
        let text = name("shooting with the steps' equations gives the plan");
        match plan.off_shooting() {
            Some((off, growth)) => {
                let reason = format!("{note}; errors at the start grow {growth:.0} times");
                claims.at_most(&text, off, worst_case(steps, growth).max(rest * growth), &reason);
            }
            None => claims.skip(&text, "the input of a step is not found by sweeps: too long a step"),
        }
        let bending = self.plans.each_ref().map(Plan::bending);
        let law = Convergence { errors: bending, reference: f64::EPSILON, steps };
        law.claim(Order::Second, &name("the order of the elastica's law"), claims);
        let order = |part: &str, value: fn(&Off) -> f64, claims: &mut Claims| {
            let name = name(&format!("the order of {part}"));
            let errors = self.plans.each_ref().map(|plan| self.off(problem, plan).as_ref().map_or(f64::NAN, value));
            match self.shot {
                Some(Shot { error: reference, .. }) => {
                    Convergence { errors, reference, steps }.claim(Order::Second, &name, claims);
                }
                None => claims.skip(&name, "no continuous extremal is near: too long a step"),
            }
        };
        if is_isolated {
            order("places", |off| off.place, claims);
        } else {
            claims.skip(&name("the order of places"), "one of a family, not the same for all steps");
        }
        order("the price", |off| off.price, claims);
    }
}

/// Each way on its own, and the least of them.
pub fn claim(problem: &Problem, ways: &[Way], claims: &mut Claims) {
    (1..).zip(ways).for_each(|(number, way)| way.claim(problem, number, claims));
    let least = &ways[0].plans[0];
    claims.holds("the least is a minimum", least.index == 0, &format!("index {}", least.index));
}

/// Ways side by side.
pub fn table(problem: &Problem, ways: &[Way]) -> Table<9> {
    let mut table = Table::new([
        "way",
        "price / (m²/s)",
        "of the least",
        "track / m",
        "index",
        "guesses",
        "iterations",
        "continuous",
        "off with h, h/2, h/4",
    ]);
    for (number, way) in (1..).zip(ways) {
        let [plan, ..] = &way.plans;
        let off = |plan: &Plan| way.off(problem, plan).map_or("-".to_owned(), |off| format!("{:.2e}", off.place));
        table.row([
            number.to_string(),
            format!("{:.9}", plan.price),
            format!("{:.4}", plan.price / ways[0].plans[0].price),
            format!("{:.4}", plan.length()),
            plan.index.to_string(),
            way.guesses.to_string(),
            way.iterations.to_string(),
            way.shot.map_or("-".to_owned(), |shot| format!("{:.9}", shot.price)),
            way.plans.each_ref().map(off).join(" "),
        ]);
    }
    table
}
