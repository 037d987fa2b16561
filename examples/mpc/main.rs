//! A quadrotor follows a track in gusts by a receding horizon. A hundred times a second it makes a plan over the next
//! half second from where it is, and flies the first step of it. One correction of the plan before is enough: Diehl,
//! Bock and Schlöder, *A real-time iteration scheme for nonlinear optimization in optimal feedback control* (2005).
//! Track and obstacle are references, given to the plan step by step. The least distance from the obstacle grows along
//! the plan by the reach of gusts. Source: Chisci, Rossiter and Zappa, *Systems with persistent disturbances: predictive
//! control with restricted constraints* (2001). The vehicle is that of the scene `quadrotor`.
//!
//! | file | its job |
//! |---|---|
//! | `declaration` | the quadrotor with its prices, as the macro is given it |
//! | `task` | track, obstacle, and the references of a plan |
//! | `flight` | flights with a plan at each tick, or at each fifth |
//! | `report` | their table and claims |
//! | `regulator` | the linear–quadratic regulator at hover, without derivatives of the macro |
//! | `correction` | one correction next to the converged plan |
//! | `figure` | drawn |

mod correction;
mod declaration;
mod figure;
mod flight;
#[path = "../quadrotor/place.rs"]
#[allow(dead_code, reason = "the scene `quadrotor` uses all of it")]
mod place;
mod regulator;
mod report;
mod task;
#[path = "../quadrotor/vehicle.rs"]
#[allow(dead_code, reason = "the scene `quadrotor` uses all of it")]
mod vehicle;

use clap::Parser;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, count, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use flight::{Flight, PILOTS};
use place::{position, tilt};
use regulator::Regulator;
use std::process::ExitCode;
use task::Task;

const SCENE: Scene = Scene {
    name: "mpc",
    step_size: "0.01",
    time_unit: "seconds",
    steps: "360",
    order: "2",
    order_note: "plans are made with steps of order 2",
    columns_note: "of the flight past the obstacle with ten corrections: position x1,x2,x3, track r1,r2,r3, obstacle o1,o2,o3 (m), how far it leans (rad), thrusts u1,u2,u3,u4 from there on (N)",
};

/// A quadrotor follows a track in gusts, planned anew a hundred times a second, past an obstacle that moves
#[derive(Parser, Debug)]
pub struct Flags {
    /// Steps of a plan
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true, default_value = "50")]
    horizon: u64,
    /// The largest velocity that a gust adds in a step, m/s
    #[arg(long, value_name = "V", value_parser = positive, allow_hyphen_values = true, default_value = "0.01")]
    gust: f64,
    /// Seed of the gusts
    #[arg(long, value_name = "SEED", default_value = "1")]
    seed: u64,
    /// The least distance from the obstacle, m
    #[arg(long, value_name = "D", value_parser = positive, allow_hyphen_values = true, default_value = "0.25")]
    clearance: f64,
    #[command(flatten)]
    run: Run,
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let task = Task::new(flags)?;
    let mut claims = Claims::new();
    let ahead = task.h * task.horizon as f64;
    say(format_args!("{} ticks of {} s, plans over {ahead} s in {} steps\n", task.steps, task.h, task.horizon));
    let flights = PILOTS.iter().map(|pilot| Flight::new(&task, pilot)).collect::<Result<Vec<_>, _>>()?;
    let lean = flights[0].path.iter().map(tilt).fold(0.0, f64::max);
    say(format_args!("the track makes it lean up to {:.1}°\n", lean.to_degrees()));
    let regulator = Regulator::new(&task)?;
    say(report::table(&task, &flights));
    say(report::comparison(&flights));
    report::claim(&task, &flights, &regulator, &mut claims);
    say(regulator.compare(&task, &mut claims)?);
    say(correction::compare(&task, &flights[0], &mut claims)?);
    let past = &flights[flight::PAST];
    write(flags, &task, past)?;
    figure::draw(flags, &task, &flights)?;
    Ok(claims)
}

/// The flight past the obstacle, as a file.
fn write(flags: &Flags, task: &Task, flight: &Flight) -> Result<(), Failure> {
    let columns = "x1 x2 x3 r1 r2 r3 o1 o2 o3 lean u1 u2 u3 u4";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    for (step, (place, thrusts)) in (0..).zip(flight.path.iter().zip(&flight.thrusts)) {
        let t = task.time(step);
        let points = [position(place), task.track(t), task.obstacle(t)];
        let numbers = points.iter().flat_map(by_rows).chain([tilt(place)]);
        csv.row(step as u64, t, numbers.chain(by_rows(thrusts)))?;
    }
    csv.finish()
}
