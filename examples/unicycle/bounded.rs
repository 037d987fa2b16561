//! The same parking without reverse gear, and with a largest turning rate.

use crate::declaration::{Car, Forward, Free};
use crate::place::coordinates;
use crate::plan::{Plan, Problem};
use crate::steps::Steps;
use clebsch::Error;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, Vector2};
use std::f64::consts::{PI, TAU};

/// The limits of the inputs, in the order in which the bounds are declared.
const BOUNDS: [&str; 3] = ["turns right at most", "turns left at most", "stands still"];

/// The tolerance of a barrier for inputs and places, relative.
const BARRIER: f64 = 1e-8;

/// A plan that keeps the bounds.
#[derive(Clone, Debug)]
pub struct Bounded {
    problem: Problem,
    /// With h.
    pub plan: Plan,
    /// Without bounds, from the inputs of the plan.
    free: Plan,
}

impl Bounded {
    /// Solves the problem within bounds from a turn in place, a drive straight ahead and another turn; `None` where bounds leave no way.
    ///
    /// # Errors
    /// The other errors of the solver.
    pub fn new(problem: Problem, goal: &Matrix3<f64>, top_turn: f64, steps: u64) -> Result<Option<Self>, Error> {
        let problem = Problem { car: Car { top_turn, ..problem.car }, ..problem };
        let guess = turn_drive_turn(goal, top_turn, problem.duration);
        let plan = match problem.solve::<Forward, 3>(steps, guess) {
            Err(Error::Infeasible { .. } | Error::TargetMissed { .. } | Error::Uncontrollable { .. }) => {
                return Ok(None);
            }
            plan => plan?,
        };
        let free = problem.solve::<Free, 0>(steps, |t| plan.input(t))?;
        Ok(Some(Self { problem, plan, free }))
    }

    /// The steps one after the other, those with the same active bounds in one row.
    pub fn phases(&self) -> Table<4> {
        let mut table = Table::new(["from / s", "to / s", "turned / °", "bounds that are active"]);
        let plan = &self.plan;
        let mut start = 0;
        for run in plan.active.chunk_by(|a, b| a == b) {
            let end = start + run.len();
            let turned: f64 = plan.path[start..end].iter().map(|moment| moment.input.x * plan.h).sum();
            let names = BOUNDS.iter().zip(&run[0]).filter_map(|(name, active)| active.then_some(*name));
            let names = names.collect::<Vec<_>>().join(", ");
            table.row([
                format!("{:.3}", start as f64 * plan.h),
                format!("{:.3}", end as f64 * plan.h),
                format!("{:.2}", turned.to_degrees()),
                if names.is_empty() { "none".to_owned() } else { names },
            ]);
            start = end;
        }
        table
    }

    /// The bounds are satisfied, and the conditions of first order hold where they are active and where they are not.
    pub fn claim(&self, claims: &mut Claims) {
        let (plan, car, steps) = (&self.plan, &self.problem.car, self.plan.steps() as u64);
        claims.round_off("bounds: the plan arrives", plan.gap, steps, 1.0);
        let beyond = |input: &Vector2<f64>| (input.x.abs() / car.top_turn - 1.0).max(-input.y);
        let beyond = largest(plan.path.iter().map(|moment| beyond(&moment.input).clamp(0.0, f64::INFINITY)));
        claims.at_most("bounds: the inputs keep them", beyond, BARRIER, "the largest excess, relative and in m/s");
        let (least, most) = (Vector2::new(-car.top_turn, 0.0), Vector2::new(car.top_turn, f64::INFINITY));
        let equations = Steps { h: plan.h, turn_price: car.turn_price, least, most };
        let name = "bounds: shooting with the steps' clamped equations gives the plan";
        match equations.off(plan) {
            Some((off, growth)) => {
                let reason = format!("what the last barrier leaves; errors at the start grow {growth:.0} times");
                claims.at_most(name, off, BARRIER, &reason);
            }
            None => claims.skip(name, "the inputs of a step are not found by sweeps: too long a step"),
        }
        claims.at_most(
            "bounds: they cost something",
            self.free.price,
            plan.price * (1.0 + 1e-12),
            "m²/s, without them",
        );
        claims.holds("bounds: it is a minimum", plan.index == 0, &format!("index {}", plan.index));
    }
}

/// Inputs that lead to the goal without reverse gear.
fn turn_drive_turn(goal: &Matrix3<f64>, top_turn: f64, duration: f64) -> impl Fn(f64) -> Vector2<f64> {
    let way = coordinates(goal);
    let distance = way.x.hypot(way.y);
    let first = if distance > 0.0 { way.y.atan2(way.x) } else { 0.0 };
    let second = (way.z - first + PI).rem_euclid(TAU) - PI;
    let angle = first.abs() + second.abs();
    // half of the time, or half of the remaining time at the largest rate
    let least = angle / top_turn;
    let turning = if least < duration / 2.0 { duration / 2.0 } else { (least + duration) / 2.0 };
    let (rate, speed) = (angle / turning, distance / (duration - turning));
    move |t| match t {
        _ if t * rate < first.abs() => Vector2::new(rate * first.signum(), 0.0),
        _ if (duration - t) * rate < second.abs() => Vector2::new(rate * second.signum(), 0.0),
        _ => Vector2::new(0.0, speed),
    }
}
