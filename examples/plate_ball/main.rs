//! A ball rolled between a table and a plate that moves: it comes back to where it was, and shows another side.
//!
//! Jurdjevic, *The geometry of the plate-ball problem* (1993): of all such ways, those of least ½∫|u|²dt let the point
//! of contact run along an elastica. Here u is the velocity of the centre. Radius r, no slipping, no spinning about the
//! vertical.

mod attitude;
mod census;
mod figure;
mod plan;
mod rolling;
mod steps;
mod way;

use clap::Parser;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, finite_list, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::{Matrix3, Vector2};
use plan::Plan;
use std::process::ExitCode;

/// A ball that rolls on a table: u is the velocity of its centre.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |(a, W): (Translation<2>, SO<3>), (x, R): (Vector2, SO<3>)| (x + a, W * R),
    controls       = |u: Vector2| (u, vector![-u.y / self.radius, u.x / self.radius, 0]),
    cost           = |h, u| h * u.norm_squared() / 2,
    discretization = exponential,
)]
pub struct Ball {
    /// Radius, m.
    pub radius: f64,
}

const SCENE: Scene = Scene {
    name: "plate_ball",
    step_size: "0.05",
    time_unit: "seconds",
    steps: "100",
    order: "2",
    order_note: "nothing kicks a rolling ball, so both are the same steps",
    columns_note: "position x,y (m), attitude R11..R33 (ball to space), velocity u1,u2 (m/s) of the step that follows, costate m1,m2,m3 of the attitude (m2/s)",
};

/// A ball rolled from one place and attitude to another at the least of 1/2 the integral of |u|^2: its track is an elastica
#[derive(Parser, Debug)]
pub struct Flags {
    /// Radius of the ball, m
    #[arg(long, value_name = "R", value_parser = positive, allow_hyphen_values = true, default_value = "0.1")]
    radius: f64,
    /// Where the ball ends, from where it starts, m
    #[arg(long, value_name = "X,Y", value_parser = finite_list::<2>, allow_hyphen_values = true)]
    #[arg(default_value = "0,0")]
    goal: [f64; 2],
    /// The rotation there: axis, and angle in degrees
    #[arg(long, value_name = "X,Y,Z,ANGLE", value_parser = attitude::parse, allow_hyphen_values = true)]
    #[arg(default_value = "0.48,0.6,0.64,90")]
    turn: Matrix3<f64>,
    #[command(flatten)]
    run: Run,
}

/// The task.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    /// r, m.
    radius: f64,
    /// T, s.
    duration: f64,
    /// (x, R)
    start: (Vector2<f64>, Matrix3<f64>),
    /// (x, R)
    goal: (Vector2<f64>, Matrix3<f64>),
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(run(&flags))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let problem = Problem {
        radius: flags.radius,
        duration: flags.run.duration(),
        start: (Vector2::zeros(), Matrix3::identity()),
        goal: (flags.goal.into(), flags.turn),
    };
    if problem.start == problem.goal {
        return Err(Failure::Flags("--goal, --turn: another place or another attitude is needed".to_owned()));
    }
    let mut claims = Claims::new();
    let ways = way::find(&problem, flags.run.steps)?;
    say(way::table(&problem, &ways));
    way::claim(&problem, &ways, &mut claims);
    census::claim(&ways, &census::take(&problem, &ways), &mut claims);
    write(&ways[0].plans[0], flags)?;
    figure::draw(flags, &ways)?;
    Ok(claims)
}

/// The least, as a file.
fn write(plan: &Plan, flags: &Flags) -> Result<(), Failure> {
    let columns = "x y R11 R12 R13 R21 R22 R23 R31 R32 R33 u1 u2 m1 m2 m3";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    for (step, moment) in (0..).zip(&plan.path) {
        let place = by_rows(&moment.position).chain(by_rows(&moment.attitude));
        csv.row(step, flags.run.time(step), place.chain(by_rows(&moment.input)).chain(by_rows(&moment.momentum)))?;
    }
    csv.finish()
}
