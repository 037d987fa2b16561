//! One correction next to the converged plan: a gust throws the quadrotor off a plan in the middle of its flight.
//!
//! One correction is Newton's step from the plan before. Its thrusts are off by the square of the gust.

use super::declaration::Thrusts;
use super::flight::{Flight, push};
use super::task::Task;
use clebsch::{Limits, Target};
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::Vector3;

/// The velocity that the largest gust leaves, m/s.
const GUST: Vector3<f64> = Vector3::new(0.02, -0.03, 0.02);
/// How far a measured order may be from 2.
const SLOPE: f64 = 0.1;

/// Gusts of three sizes at the middle of a flight.
///
/// # Errors
/// Those of a plan.
pub fn compare(task: &Task, flight: &Flight, claims: &mut Claims) -> Result<Table<3>, Failure> {
    let tick = task.steps / 2;
    let (steering, hover) = (task.steering(tick)?, task.system.hover);
    let place = flight.path[tick];
    let mut plan = vec![steering.stage(&place).with_input(Thrusts::repeat(hover)); task.horizon];
    steering.refer(&mut plan, |j, t| task.reference(j, t, false));
    let before = *steering.solve(&place, Target::Free, &mut plan)?.stages()[0].input();
    let mut table = Table::new(["gust / m/s", "thrusts change by", "one correction is off by"]);
    let mut errors = [0.0; 3];
    for (error, size) in errors.iter_mut().zip([1.0, 0.5, 0.25]) {
        let (mut place, gust) = (place, GUST * size);
        push(&mut place, &(gust * task.system.mass));
        let (mut one, mut all) = (plan.clone(), plan.clone());
        steering.solve_within(&place, Target::Free, Limits { sweeps: 1 }, &mut one)?;
        steering.solve(&place, Target::Free, &mut all)?;
        *error = (one[0].input() - all[0].input()).norm() / hover;
        let number = |value: f64| format!("{value:.3e}");
        table.row([format!("{:.4}", gust.norm()), number((all[0].input() - before).norm() / hover), number(*error)]);
    }
    let order = (errors[1] / errors[2]).log2();
    let reason = "order in the size of the gust: a step of Newton's method";
    claims.within("one correction is right to first order", order, 2.0 - SLOPE..=2.0 + SLOPE, 3, reason);
    Ok(table)
}
