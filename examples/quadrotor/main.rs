//! A quadrotor flies from hovering at one place to hovering at another in less than a second, at least effort. The
//! effort is ½ ∫ Σ (u/u₀ − 1)² dt of the thrusts u of its rotors, with u₀ the thrust at hover. No rotor pushes
//! downwards or more than it can: it has to lean, to stand nearly on its edge, and to catch itself. Six degrees of
//! freedom, four inputs: Lee, Leok and McClamroch, *Geometric tracking control of a quadrotor UAV on SE(3)* (2010). The
//! vehicle is the Crazyflie 2.0; sources are in `vehicle`. Drag, wake and the delay of the motors are left out.
//!
//! | file | its job |
//! |---|---|
//! | `declaration` | the quadrotor, as the macro is given it |
//! | `vehicle`, `place`, `problem` | numbers, poses, the task |
//! | `plan` | plans of the steps |
//! | `conditions` | their first-order conditions by differences of complete flights |
//! | `pontryagin`, `refinement` | plans of the continuous problem, next to those of the steps |
//! | `flight` | plans flown in a gust and with another mass, with feedback and without |
//! | `figure` | drawn |

mod conditions;
mod declaration;
mod figure;
mod flight;
mod place;
mod plan;
mod pontryagin;
mod problem;
mod refinement;
mod vehicle;

use clap::Parser;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, finite, finite_list, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use conditions::Conditions;
use declaration::Thrusts;
use flight::Pair;
use place::{attitude, position, spin, tilt, velocity};
use plan::Plan;
use problem::Problem;
use refinement::Refinement;
use std::process::ExitCode;

const SCENE: Scene = Scene {
    name: "quadrotor",
    step_size: "0.005",
    time_unit: "seconds",
    steps: "160",
    order: "2",
    order_note: "plans are made with steps of order 2",
    columns_note: "attitude R11..R33 (body to space), position x1,x2,x3 (m), velocity v1,v2,v3 (space, m/s), angular momentum pi1,pi2,pi3 (body frame, N m s), thrusts u1,u2,u3,u4 from there on (N)",
};

/// A quadrotor from hovering to hovering at least effort: bounded thrusts, checked by shooting, flown in a gust
#[derive(Parser, Debug)]
pub struct Flags {
    /// Where it is to hover, from where it starts, m
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true, default_value = "1.5,0.5,0.5")]
    to: [f64; 3],
    /// By how much it is to be turned about the vertical there, degrees
    #[arg(long, value_name = "ANGLE", value_parser = finite, allow_hyphen_values = true, default_value = "90")]
    yaw: f64,
    /// Mass, kg
    #[arg(long, value_name = "M", value_parser = positive, allow_hyphen_values = true, default_value = vehicle::MASS)]
    mass: f64,
    /// The largest thrust of a rotor, N
    #[arg(long, value_name = "U", value_parser = positive, allow_hyphen_values = true, default_value = vehicle::TOP)]
    thrust: f64,
    /// Flown: the velocity that a gust leaves after a quarter of the flight, m/s
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true, default_value = "0,0.2,0")]
    gust: [f64; 3],
    /// Flown: by which part the mass is larger than planned
    #[arg(long, value_name = "PART", value_parser = finite, allow_hyphen_values = true, default_value = "0.02")]
    heavier: f64,
    #[command(flatten)]
    run: Run,
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    if flags.run.order == Order::First {
        return Err(Failure::Flags("--order 1: plans are made with steps of order 2".to_owned()));
    }
    let problem = Problem::new(flags)?;
    let plan = Plan::solve(&problem, 1)?;
    let mut claims = Claims::new();
    say(format_args!("{:.3} m in {} s, {} steps\n", problem.distance, problem.duration, problem.steps));
    say(table(&plan));
    claim(&problem, &plan, &mut claims)?;
    let refinement = Refinement::new(&problem, &plan)?;
    say(&refinement);
    refinement.claim(&plan, &mut claims);
    let pairs = Pair::all(&problem, &plan, flags)?;
    say(flight::table(&pairs));
    flight::claim(&pairs, &mut claims);
    write(flags, &problem, &plan)?;
    figure::draw(flags, &problem, &plan, &pairs)?;
    Ok(claims)
}

fn table(plan: &Plan) -> Table<6> {
    let mut table =
        Table::new(["effort / s", "leans / °", "thrusts from / N", "to / N", "held back", "linearisations"]);
    let lean = plan.places().map(|place| tilt(&place)).fold(0.0, f64::max);
    let (low, high) = plan.thrusts();
    let (low, high) = (format!("{:.5}", low.max(0.0)), format!("{high:.5}"));
    let (held, work) = (plan.held_back().to_string(), plan.iterations.to_string());
    table.row([format!("{:.6}", plan.effort), format!("{:.2}", lean.to_degrees()), low, high, held, work]);
    table
}

/// The properties of the steps themselves.
fn claim(problem: &Problem, plan: &Plan, claims: &mut Claims) -> Result<(), Failure> {
    let (hover, top) = (problem.vehicle.hover(), problem.vehicle.top);
    claims.round_off("it arrives and hovers", plan.gap, problem.steps, 1.0);
    claims.holds("it is a minimum", plan.index == 0, &format!("index {}", plan.index));
    let (low, high) = plan.thrusts();
    claims.at_most("bounds are kept", (-low).max(high - top), 4.0 * f64::EPSILON * top, "N, beyond a bound");
    claims.holds("no multiplier is negative", plan.least_multiplier() >= 0.0, "of all bounds and steps");
    let reason = "s/N, 10⁻⁹ of h over the thrust at hover: slacks of active bounds have few digits";
    claims.at_most("first-order conditions", plan.residual, 1e-9 * plan.h / hover, reason);
    let ([across, about], [linear, angular]) = plan.symmetry();
    claims.round_off("the costate of the position stays", across, problem.steps, linear);
    claims.round_off("that of turning about the vertical stays", about, problem.steps, angular);
    let found = Conditions::new(problem, plan)?;
    let reason = "of the largest slope: differences of whole flights";
    claims.at_most("first-order conditions, without derivatives", found.residual, 1e-6, reason);
    claims.at_most("multipliers, without derivatives", found.multipliers, 1e-6, "of the largest");
    claims.at_most("none of these is negative", found.negative, 1e-6, "of the largest");
    Ok(())
}

/// The plan, as a file.
fn write(flags: &Flags, problem: &Problem, plan: &Plan) -> Result<(), Failure> {
    let columns = "R11 R12 R13 R21 R22 R23 R31 R32 R33 x1 x2 x3 v1 v2 v3 pi1 pi2 pi3 u1 u2 u3 u4";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    let hover = Thrusts::repeat(problem.vehicle.hover());
    let thrusts = plan.stages.iter().map(|stage| *stage.input()).chain([hover]);
    for (step, (place, thrusts)) in (0..).zip(plan.places().zip(thrusts)) {
        let (attitude, velocity) = (attitude(&place), velocity(&place, problem.vehicle.mass));
        let moving = [position(&place), velocity, spin(&place)];
        let numbers = by_rows(&attitude).chain(moving.iter().flat_map(|part| part.iter().copied()));
        csv.row(step, flags.run.time(step), numbers.chain(by_rows(&thrusts)))?;
    }
    csv.finish()
}
