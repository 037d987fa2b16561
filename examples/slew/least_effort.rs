//! Bounded torques turn the spacecraft from rest to rest at least effort, ∫ ½ |u|² dt.
//!
//! The discrete plan is compared with the continuous one, by Pontryagin's conditions and shooting, and with turns about
//! the fixed axis. It is also compared with flights in which the body or the start is not as planned.
//!
//! | file | its job |
//! |---|---|
//! | `declaration` | the body with torques, as the macro is given it |
//! | `problem` | attitudes, body, duration, bounds |
//! | `plan` | plans of the steps, and their books of momentum and energy |
//! | `pontryagin` | plans of the continuous problem, by shooting |
//! | `refinement` | both side by side |
//! | `eigenaxis` | turns about the fixed axis |
//! | `flight` | plans flown, with feedback and without |
//! | `figure` | drawn |

mod declaration;
mod eigenaxis;
mod figure;
mod flight;
mod plan;
mod pontryagin;
mod problem;
mod refinement;

use crate::Flags;
use crate::body::Body;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::Table;
use eigenaxis::Eigenaxis;
use flight::Sortie;
use nalgebra::Vector3;
use plan::Plan;
use problem::Problem;
use refinement::Refinement;

/// How many times wider the bounds of the plan are that none of them holds back.
const WIDE: f64 = 4.0;

/// Plans, shoots, compares, flies, claims, writes and draws.
///
/// # Errors
/// The errors of the solver, and files that cannot be written.
pub fn run(flags: &Flags, body: Body) -> Result<Claims, Failure> {
    let problem = Problem::new(flags, body)?;
    let wide = Problem { top: WIDE * problem.top, ..problem.clone() };
    let (plan, free) = (Plan::solve(&problem, 1)?, Plan::solve(&wide, 1)?);
    let mut claims = Claims::new();
    let (degrees, Problem { steps, duration, top, .. }) = (problem.turn.norm().to_degrees(), &problem);
    say(format_args!(
        "a turn by {degrees:.3}° from rest to rest: {duration} s in {steps} steps, torques up to {top:.4} N m\n"
    ));
    let eigenaxis = Eigenaxis::new(&problem);
    say(table(&plan, &free, &eigenaxis));
    claim(&problem, &plan, &mut claims);
    compare(&problem, [&plan, &free], &eigenaxis, &mut claims);
    let refinement = Refinement::new(&problem, &plan)?;
    say(&refinement);
    refinement.claim(&plan, &mut claims);
    let sorties = [Sortie::new("bounded", &problem, &plan, flags)?, Sortie::new("unbounded", &wide, &free, flags)?];
    say(flight::table(&sorties));
    flight::claim(&sorties, &mut claims);
    write(flags, &problem, &plan)?;
    figure::draw(flags, &problem, &plan, &free, &sorties)?;
    Ok(claims)
}

fn table(plan: &Plan, free: &Plan, eigenaxis: &Eigenaxis) -> Table<5> {
    let mut table = Table::new(["", "effort / N² m² s", "largest torque / N m", "held back", "linearisations"]);
    let number = |value: f64| format!("{value:.6e}");
    for (name, plan) in [("plan", plan), ("plan without bounds", free)] {
        let (held, work) = (plan.held_back().to_string(), plan.iterations.to_string());
        table.row([name.to_owned(), number(plan.effort), number(plan.largest_torque()), held, work]);
    }
    let torque = number(eigenaxis.largest_torque);
    table.row(["fixed axis, smooth".to_owned(), number(eigenaxis.smooth), torque, String::new(), String::new()]);
    let blank = || String::new();
    table.row(["fixed axis, no less than".to_owned(), number(eigenaxis.least), blank(), blank(), blank()]);
    table
}

/// The price of bounds, and the saving by an axis that is free to move.
fn compare(problem: &Problem, [plan, free]: [&Plan; 2], eigenaxis: &Eigenaxis, claims: &mut Claims) {
    claims.at_most("bounds make it no cheaper", free.effort, plan.effort * (1.0 + 1e-9), "N² m² s, with bounds");
    let smooth = eigenaxis.smooth * (1.0 + 10.0 / (problem.steps as f64).powi(2));
    let reason = "N² m² s, of the smooth turn about the fixed axis, unbounded too";
    claims.at_most("unbounded it costs no more than about the fixed axis", free.effort, smooth, reason);
    let name = "bounded it costs less than any turn about the fixed axis";
    if plan.effort < eigenaxis.least {
        claims.at_most(name, plan.effort, eigenaxis.least, "N² m² s, no less about the fixed axis, bounded or not");
    } else {
        claims.skip(name, "bounds are tight, or the axis is nearly principal");
    }
}

/// The properties of the steps themselves, to rounding.
fn claim(problem: &Problem, plan: &Plan, claims: &mut Claims) {
    let (angle, momentum) = problem::apart(&plan.end, &problem.goal());
    let (moves, costate) = plan.costate_moves();
    let (book, largest) = plan.momentum_book();
    claims.round_off("it arrives: angle, rad", angle, problem.steps, 1.0);
    claims.round_off("and rests: momentum, N m s", momentum, problem.steps, largest);
    claims.holds("it is a minimum", plan.index == 0, &format!("index {}", plan.index));
    let reason = "N m, beyond the bound";
    claims.at_most("bounds are kept", plan.largest_torque() - problem.top, 4.0 * f64::EPSILON * problem.top, reason);
    claims.holds("no multiplier is negative", plan.least_multiplier() >= 0.0, "of all bounds and steps");
    let reason = "N m s, 10⁻⁹ of the bound times h: slacks of active bounds have few digits";
    claims.at_most("first-order conditions", plan.residual, 1e-9 * problem.top * plan.h, reason);
    claims.round_off("the costate of the attitude stays, seen in space", moves, problem.steps, costate);
    claims.round_off("the momentum in space is what torques gave", book, problem.steps, largest);
}

/// The plan, as a file.
fn write(flags: &Flags, problem: &Problem, plan: &Plan) -> Result<(), Failure> {
    let columns = "R11 R12 R13 R21 R22 R23 R31 R32 R33 pi1 pi2 pi3 omega1 omega2 omega3 u1 u2 u3";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    let torques = plan.stages.iter().map(|stage| *stage.input()).chain([Vector3::zeros()]);
    for (step, ((attitude, momentum), torque)) in (0..).zip(plan.places().zip(torques)) {
        let omega = problem.body.spin(&momentum);
        let state = by_rows(&attitude).chain(by_rows(&momentum)).chain(by_rows(&omega)).chain(by_rows(&torque));
        csv.row(step, flags.run.time(step), state)?;
    }
    csv.finish()
}
