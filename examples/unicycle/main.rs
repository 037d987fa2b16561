//! A unicycle that turns and drives at least price: geodesics of the sub-Riemannian plane of motions. Then the effect
//! of bounds, of a free end and of a free time.
//!
//! Closed form: Moiseev and Sachkov (2010), as in `geodesic`. The number of steps and their length are those of `--steps` and `--step-size`;
//! nothing is a kick.

mod bounded;
mod conjugate;
mod declaration;
mod figure;
mod geodesic;
mod place;
mod plan;
mod shooting;
mod steps;
mod study;
mod time;

use bounded::Bounded;
use clap::Parser;
use clebsch::Target;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, finite_list, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use declaration::Car;
use geodesic::Geodesic;
use nalgebra::{Matrix3, Vector2, Vector3};
use plan::{Plan, Problem};
use std::process::ExitCode;
use study::Study;
use time::FreeTime;

const SCENE: Scene = Scene {
    name: "unicycle",
    step_size: "0.02",
    time_unit: "seconds",
    steps: "50",
    order: "2",
    order_note: "nothing kicks a unicycle, so both are the same steps",
    columns_note: "position x,y (m), heading theta (rad), turning rate omega (rad/s) and speed v (m/s) of the step that follows, costate ltheta (m2/s), lx,ly (m/s; body frame) of the parking",
};

/// A unicycle from one place to another at the least of 1/2 the integral of C omega^2 + v^2: against a closed form
#[derive(Parser, Debug)]
pub struct Flags {
    /// Price of turning against driving, m2
    #[arg(long, value_name = "C", value_parser = positive, allow_hyphen_values = true, default_value = "1")]
    turn_price: f64,
    /// Costate at the start of the geodesic: C omega in m2/s, v in m/s, and the push to the left, m/s
    #[arg(long, value_name = "THETA,X,Y", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "1.5,1.2,2.4")]
    costate: [f64; 3],
    /// Where to park, from the origin: metres and degrees
    #[arg(long, value_name = "X,Y,DEGREES", value_parser = place::parse, allow_hyphen_values = true)]
    #[arg(default_value = "0,1,0")]
    goal: Matrix3<f64>,
    /// Price of missing the goal by d where the end is free: P d^2/2, P in 1/s
    #[arg(long, value_name = "P", value_parser = positive, allow_hyphen_values = true, default_value = "20")]
    miss_price: f64,
    /// Bound on the turning rate of the unicycle without reverse gear, rad/s
    #[arg(long, value_name = "RATE", value_parser = positive, allow_hyphen_values = true, default_value = "3.5")]
    top_turn: f64,
    /// Price of a second where the time is free, m2/s2
    #[arg(long, value_name = "W", value_parser = positive, allow_hyphen_values = true, default_value = "2")]
    time_price: f64,
    #[command(flatten)]
    run: Run,
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(run(&flags))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let (duration, car) = (flags.run.duration(), Car::new(flags.turn_price, f64::INFINITY));
    if flags.goal == Matrix3::identity() {
        return Err(Failure::Flags("--goal: a place other than the origin is needed".to_owned()));
    }
    let mut claims = Claims::new();
    let problem = |car, target| Problem { car, target, duration };
    let given = Geodesic::new(flags.turn_price, &flags.costate.into())
        .ok_or_else(|| Failure::Flags("--costate: numbers of this size overflow".to_owned()))?;
    let end = given.at(duration).place;
    let rest = |_: f64| Vector2::zeros();
    let goal = Vector2::new(flags.goal[(0, 2)], flags.goal[(1, 2)]);
    let steps = flags.run.steps;
    let geodesic = Study::new("geodesic", problem(car, Target::Place(end)), steps, |t| given.at(t).input)?;
    let parking = Study::new("parking", problem(car, Target::Place(flags.goal)), steps, rest)?;
    let missing = Car { miss_price: flags.miss_price, goal, ..car };
    let free_end = Study::new("free end", problem(missing, Target::Free), steps, |t| parking.plans[0].input(t))?;
    let mut table = study::table();
    for study in [&geodesic, &parking, &free_end] {
        study.rows(&mut table);
        study.claim(&mut claims);
    }
    say(table);
    geodesic.claim_costate(&given, &mut claims);
    let free_time = FreeTime::new(problem(car, Target::Place(flags.goal)), &parking, flags.time_price)?;
    say(free_time.table());
    free_time.claim(&mut claims);
    let bounded = Bounded::new(problem(car, Target::Place(flags.goal)), &flags.goal, flags.top_turn, steps)?;
    say(format_args!("parking without reverse gear, turning at no more than {} rad/s", flags.top_turn));
    match &bounded {
        Some(bounded) => {
            say(bounded.phases());
            bounded.claim(&mut claims);
        }
        None => claims.skip("bounds: the plan arrives", "they leave no way in so short a time"),
    }
    write(&parking.plans[0], flags)?;
    figure::draw(flags, [&geodesic, &parking, &free_end], bounded.as_ref().map(|bounded| &bounded.plan))?;
    Ok(claims)
}

/// The parking, as a file.
fn write(plan: &Plan, flags: &Flags) -> Result<(), Failure> {
    let mut csv = Csv::create(&flags.run, &["x", "y", "theta", "omega", "v", "ltheta", "lx", "ly"])?;
    for (step, moment) in (0..).zip(&plan.path) {
        let place: Vector3<f64> = place::coordinates(&moment.place);
        let values = by_rows(&place).chain(by_rows(&moment.input)).chain(by_rows(&moment.costate)).collect::<Vec<_>>();
        csv.row(step, flags.run.time(step), values)?;
    }
    csv.finish()
}
