//! A tractor backs its trailer into a parking place at least effort: it drives ahead, turns, and pushes the trailer in.
//!
//! The wheels of both do not slip sideways, and the hitch is behind the axle of the tractor. The inputs are a thrust and a torque.
//! Both are bounded, and so is the angle of the hitch, so that the rig does not jackknife.
//!
//! The robot of Lamiraux, Sekhavat and Laumond, *Motion planning and control for Hilare pulling a trailer* (1999), has such a hitch.
//! Here both bodies have masses.
//!
//! | file | its job |
//! |---|---|
//! | `declaration` | the rig, as the macro is given it |
//! | `rig` | its numbers, poses, velocities and outlines |
//! | `plan` | plans, and the motion by their inputs |
//! | `reduced` | the same motion by equations without constraint |
//! | `census` | plans to goals all around |
//! | `figure` | drawn |

mod census;
mod declaration;
mod figure;
mod plan;
mod reduced;
mod rig;

use clap::Parser;
use clebsch::Error;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::convergence::Convergence;
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Order, Run, Scene, finite_list, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use plan::{GUESSES, Plan, Problem, apart};
use rig::{at_rest, fold, heading, position, rig, velocity};
use std::process::ExitCode;

/// Steps for each of the plan, where its motion is compared with other equations.
const FINER: u64 = 4;
/// Prices that differ by less, relative, are those of the same plan.
const ROUNDED: f64 = 1e-9;
/// The largest relative change of the price by shorter steps: one that changes more is that of another plan.
const SAME: f64 = 0.03;
/// How far a measured slope of the price may be from 2: contacts with a bound begin and end between steps.
const SLOPE: f64 = 0.2;
/// The tolerance of a barrier for inputs and places, relative.
const BARRIER: f64 = 1e-8;

const SCENE: Scene = Scene {
    name: "trailer",
    step_size: "0.1",
    time_unit: "seconds",
    steps: "160",
    order: "2",
    order_note: "steps with a constraint have order 2",
    columns_note: "position x,y (m) and heading (rad) of the tractor, then of the trailer xt,yt,headingt, angle fold between them (rad), speed v (m/s) and turning rate omega (rad/s) of the tractor, thrust (N) and torque (N m) of the step that follows",
};

/// A tractor backs its trailer into a parking place at least effort: bounded inputs, and no jackknifing
#[derive(Parser, Clone, Debug)]
pub struct Flags {
    /// Where the tractor parks from where it starts, m, and its heading there in degrees; the trailer stands behind
    #[arg(long, value_name = "X,Y,ANGLE", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "1,3,-90")]
    goal: [f64; 3],
    /// The largest angle between tractor and trailer, degrees
    #[arg(long, value_name = "ANGLE", value_parser = angle, allow_hyphen_values = true, default_value = "45")]
    fold: f64,
    /// The largest thrust, N
    #[arg(long, value_name = "F", value_parser = positive, allow_hyphen_values = true, default_value = "200")]
    thrust: f64,
    /// The largest torque, N m
    #[arg(long, value_name = "T", value_parser = positive, allow_hyphen_values = true, default_value = "100")]
    torque: f64,
    /// Also plan to so many goals all around
    #[arg(long, value_name = "N", default_value = "0")]
    goals: u64,
    #[command(flatten)]
    run: Run,
}

/// The angle of a hitch that may fold.
fn angle(text: &str) -> Result<f64, String> {
    let degrees = positive(text)?;
    if degrees <= 90.0 { Ok(degrees) } else { Err(format!("`{}` is more than 90", text.trim())) }
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let rig = rig(flags.thrust, flags.torque, flags.fold.to_radians());
    let [x, y, degrees] = flags.goal;
    let (start, goal) = (at_rest(&rig, [0.0, 0.0], 0.0, 0.0), at_rest(&rig, [x, y], degrees.to_radians(), 0.0));
    if apart(&rig, &start, &goal) < 1e-6 {
        return Err(Failure::Flags("--goal: a place other than the start is needed".to_owned()));
    }
    let problem = Problem { rig, start, goal, h: flags.run.step_size, steps: flags.run.steps };
    let plans = GUESSES.map(|guess| problem.solve(guess));
    let table = table(&problem, &plans);
    let plan = least(plans)?;
    say(format_args!(
        "from x, y = 0, 0 m and 0° to {x}, {y} m and {degrees}° in {} s, {} steps\n",
        flags.run.duration(),
        flags.run.steps
    ));
    say(table);
    let mut claims = Claims::new();
    claim(&problem, &plan, &mut claims);
    claim_motion(&problem, &plan, &mut claims)?;
    claim_refined(&problem, &plan, &mut claims);
    census::claim(&problem, flags.goals, &mut claims);
    write(flags, &problem, &plan)?;
    figure::draw(flags, &problem, &plan)?;
    Ok(claims)
}

/// The cheapest of the plans that were found.
fn least(plans: [Result<Plan, Error>; 5]) -> Result<Plan, Error> {
    let cheaper = |a: Result<Plan, Error>, b: Result<Plan, Error>| match (&a, &b) {
        (Ok(first), Ok(second)) if second.price < first.price * (1.0 - ROUNDED) => b,
        (Err(_), Ok(_)) => b,
        _ => a,
    };
    let [first, others @ ..] = plans;
    others.into_iter().fold(first, cheaper)
}

fn table(problem: &Problem, plans: &[Result<Plan, Error>]) -> Table<8> {
    let headings = ["price / N² s", "way / m", "turns back", "thrust / N", "torque / N m", "hitch / °"];
    let [price, way, cusps, thrust, torque, hitch] = headings;
    let mut table = Table::new(["guess", price, way, cusps, thrust, torque, hitch, "linearisations"]);
    for (guess, plan) in GUESSES.iter().zip(plans) {
        let name = guess.name.to_owned();
        let Ok(plan) = plan else {
            table.row([&name, "-", "-", "-", "-", "-", "-", "-"].map(str::to_owned));
            continue;
        };
        let most = plan.most();
        table.row([
            name,
            format!("{:.3}", plan.price),
            format!("{:.3}", plan.way(&problem.rig)),
            plan.cusps(&problem.rig).to_string(),
            format!("{:.2}", most.x),
            format!("{:.2}", most.y),
            format!("{:.3}", plan.fold().to_degrees()),
            plan.iterations.to_string(),
        ]);
    }
    table
}

/// The properties of the plan itself.
fn claim(problem: &Problem, plan: &Plan, claims: &mut Claims) {
    let (rig, steps) = (&problem.rig, problem.steps);
    let momentum = largest(plan.places().map(|(_, momentum)| momentum.amax()));
    claims.round_off("it arrives and stands", plan.gap, steps, momentum);
    claims.holds("it is a minimum", plan.is_minimum, "no small change of the inputs costs less");
    let size = largest(plan.places().map(|(poses, _)| largest(poses.iter().map(|pose| position(pose).norm()))));
    claims.round_off("the hitch stays closed", plan.hitch_error(rig), steps, size);
    let speed = largest(plan.places().map(|place| velocity(rig, place, 0).norm()));
    claims.round_off("no wheel slips at the end of a step", plan.slip(rig), steps, speed);
    claims.round_off("no wheel slips within a step: it is an arc", plan.bend(), steps, size);
    let most = plan.most();
    let beyond = largest([most.x / rig.top_thrust - 1.0, most.y / rig.top_torque - 1.0].map(|part| part.max(0.0)));
    claims.at_most("thrust and torque are within their bounds", beyond, BARRIER, "the largest excess, relative");
    let beyond = largest([rig.least_cosine - plan.fold().cos()].map(|excess| excess.max(0.0)));
    claims.at_most("the hitch is within its bound", beyond, BARRIER, "the largest excess of the cosine");
}

/// The motion by the planned inputs, by the stepper and by equations without constraint.
fn claim_motion(problem: &Problem, plan: &Plan, claims: &mut Claims) -> Result<(), Failure> {
    let rig = &problem.rig;
    let driven = problem.driven(plan, 1)?;
    let off = largest(driven.iter().zip(plan.places()).map(|(a, b)| apart(rig, a, b)));
    claims.at_most("the stepper makes the same motion of the inputs", off, 1e-9, "m, rad, m/s and rad/s");
    let (exact, reference) = reduced::driven(problem, plan);
    // errors of backing up grow along the way, so the steps are shorter than those of the plan
    let error = |part: u64| Ok::<_, Failure>(reduced::off(rig, &exact, &problem.driven(plan, part)?));
    let errors = [error(FINER)?, error(2 * FINER)?, error(4 * FINER)?];
    let name = "shorter steps: the motion of two equations without constraint";
    Convergence { errors, reference, steps: FINER * problem.steps }.claim(Order::Second, name, claims);
    let back = problem.driven_back(plan)?;
    claims.at_most(
        "the inputs in reverse order lead back",
        apart(rig, &back, &problem.start),
        1e-9,
        "m, rad, m/s and rad/s",
    );
    Ok(())
}

/// The price of the same plan in shorter steps.
fn claim_refined(problem: &Problem, plan: &Plan, claims: &mut Claims) {
    let name = "the order of the price, by steps of h, h/2 and h/4";
    let finer = [2, 4].map(|part| problem.finer(part).solve(plan.guess));
    let [Ok(finer), Ok(finest)] = finer else {
        claims.skip(name, "no plan was found with shorter steps");
        return;
    };
    let [coarse, fine] = [plan.price - finer.price, finer.price - finest.price];
    if largest([coarse.abs(), fine.abs()]) > SAME * plan.price {
        claims.skip(name, "shorter steps lead to another plan");
        return;
    }
    let reason = format!("by its differences, {coarse:.2} and {fine:.2} N² s");
    claims.within(name, (coarse / fine).log2(), 2.0 - SLOPE..=2.0 + SLOPE, 3, &reason);
}

/// The plan, as a file.
fn write(flags: &Flags, problem: &Problem, plan: &Plan) -> Result<(), Failure> {
    let columns = "x y heading xt yt headingt fold v omega thrust torque";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    let last = plan.inputs().last().copied().unwrap_or_default();
    let inputs = plan.inputs().copied().chain([last]);
    for (step, (place, input)) in (0..).zip(plan.places().zip(inputs)) {
        let poses = place.0.iter().flat_map(|pose| [position(pose).x, position(pose).y, heading(pose)]);
        let moving = velocity(&problem.rig, place, 0);
        let numbers = [fold(&place.0), moving.y, moving.x, input.x, input.y];
        csv.row(step, flags.run.time(step), poses.chain(numbers))?;
    }
    csv.finish()
}
