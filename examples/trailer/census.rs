//! Plans to goals all around: does the solver find all of them from a guess without inputs?

use super::plan::{NONE, Problem};
use super::rig::at_rest;
use clebsch_examples::claims::Claims;
use clebsch_examples::progress::Progress;
use clebsch_examples::scene::say;

/// The farthest goal in x and y, m.
const FARTHEST: f64 = 3.0;
/// The largest turn, rad.
const TURN: f64 = 2.0;
/// The largest angle between both bodies, as a part of the limit.
const FOLD: f64 = 0.6;
/// The root of x⁵ = x + 1: its negative powers fill the box evenly (Roberts, 2018, after Kronecker's sequences).
const ROOT: f64 = 1.167_303_978_261_418_7;

/// Plans to so many goals. All of them are found, and are minima.
pub fn claim(problem: &Problem, goals: u64, claims: &mut Claims) {
    if goals == 0 {
        return;
    }
    let limit = problem.rig.least_cosine.acos();
    let mut progress = Progress::of(goals, "goals");
    let mut iterations = Vec::new();
    let mut minima = 0_u64;
    for number in 1..=goals {
        let part = |index: i32| 2.0 * (number as f64 * ROOT.powi(-index)).fract() - 1.0;
        let at = [FARTHEST * part(1), FARTHEST * part(2)];
        let goal = at_rest(&problem.rig, at, TURN * part(3), FOLD * limit * part(4));
        if let Ok(plan) = (Problem { goal, ..problem.clone() }).solve(NONE) {
            iterations.push(plan.iterations);
            minima += u64::from(plan.is_minimum);
        }
        progress.reached(number);
    }
    iterations.sort_unstable();
    let found = iterations.len();
    let (median, most) = (iterations.get(found / 2).copied(), iterations.last().copied());
    say(format_args!(
        "goals all around: {found} of {goals} are planned, with {} linearisations in the median and {} at most\n",
        median.unwrap_or_default(),
        most.unwrap_or_default()
    ));
    claims.holds("goals all around are planned", found as u64 == goals, &format!("{found} of {goals}"));
    claims.holds("these are minima", minima == found as u64, &format!("{minima} of {found}"));
}
