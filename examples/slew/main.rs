//! A spacecraft turned from one attitude to another in a given time: which motion costs least?
//!
//! Two answers. In the first the cost is the action, and nothing acts on the way. The source of the momentum at the
//! start and at the end is not a part of the problem. In the second it starts and ends at rest, torques turn it, and
//! the cost is their square. The bound of each torque is a plain assumption, and `--torque` takes another. Orbit and
//! gradient of gravity are left out. The inertia is that of the International Space Station or of Envisat; sources are
//! in `body`. Geodesics of rotation groups and their conjugate points: Arnold, *Mathematical Methods of Classical
//! Mechanics* (1989), appendix 2; Milnor, *Morse Theory* (1963), §15. Fixed endpoints of a free body by discrete
//! Clebsch optimal control: Nordkvist, Crouch and Bloch, *Discrete Clebsch Optimal Control*. Torques: Pontryagin and
//! others, *The Mathematical Theory of Optimal Processes* (1962), chapter 1.

mod attitude;
mod body;
mod least_action;
mod least_effort;

use body::{Body, Craft};
use clap::{Parser, ValueEnum};
use clebsch_examples::claims::Claims;
use clebsch_examples::flags::{Run, Scene, finite, finite_list, parse, positive};
use clebsch_examples::scene::{Failure, conclude};
use least_action::Discretization;
use nalgebra::Matrix3;
use std::process::ExitCode;

const SCENE: Scene = Scene {
    name: "slew",
    step_size: "10",
    time_unit: "seconds",
    steps: "180",
    order: "2",
    order_note: "no potential kicks this body, so both are the same steps",
    columns_note: "attitude R11..R33 (body to space), angular momentum pi1,pi2,pi3 (body frame, kg m2/s), angular velocity omega1,omega2,omega3 (body frame, rad/s); with --least effort also the torques u1,u2,u3 from there on (body frame, N m)",
};

/// The quantity that is least.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Least {
    /// ∫ ½ Ω·JΩ dt; nothing acts on the way
    Action,
    /// ∫ ½ |u|² dt of the torques u; from rest to rest
    Effort,
}

/// A spacecraft turned from one attitude to another at least action, or by bounded torques at least effort: fixed endpoints, checked by shooting
#[derive(Parser, Debug)]
pub struct Flags {
    /// The spacecraft
    #[arg(long, value_enum, default_value = "station")]
    body: Craft,
    /// Another inertia tensor about the centre of mass, body frame, kg m2
    #[arg(long, value_name = "XX,YY,ZZ,XY,XZ,YZ", value_parser = finite_list::<6>, allow_hyphen_values = true)]
    #[arg(conflicts_with = "body")]
    inertia: Option<[f64; 6]>,
    /// Attitude at the start: axis, and angle in degrees
    #[arg(long, value_name = "X,Y,Z,ANGLE", value_parser = attitude::parse, allow_hyphen_values = true)]
    #[arg(default_value = "0,0,1,0")]
    from: Matrix3<f64>,
    /// Attitude at the end: axis, and angle in degrees
    #[arg(long, value_name = "X,Y,Z,ANGLE", value_parser = attitude::parse, allow_hyphen_values = true)]
    #[arg(default_value = "0.48,0.6,0.64,135")]
    to: Matrix3<f64>,
    /// Duration, seconds, in place of a step size
    #[arg(long, value_name = "T", value_parser = positive, allow_hyphen_values = true, conflicts_with = "step_size")]
    time: Option<f64>,
    /// The quantity that is least: the action of a free motion, or the effort of bounded torques from rest to rest
    #[arg(long, value_enum, default_value = "action")]
    least: Least,
    /// The largest torque about each axis of the body, N m [default: 80 % of the need of the smoothest turn about the
    /// fixed axis]
    #[arg(long, value_name = "U", value_parser = positive, allow_hyphen_values = true)]
    torque: Option<f64>,
    /// Flown: by which part of it the inertia is larger than planned
    #[arg(long, value_name = "PART", value_parser = finite, allow_hyphen_values = true, default_value = "0.02")]
    heavier: f64,
    /// Flown: by which angle the attitude at the start is not as planned, degrees
    #[arg(long, value_name = "ANGLE", value_parser = finite, allow_hyphen_values = true, default_value = "2")]
    tilted: f64,
    /// How velocities are made of group elements, for the least action
    #[arg(long, value_enum, default_value = "moser-veselov")]
    discretization: Discretization,
    #[command(flatten)]
    run: Run,
}

fn main() -> ExitCode {
    let mut flags: Flags = parse(&SCENE);
    if let Some(time) = flags.time {
        flags.run.step_size = time / flags.run.steps as f64;
    }
    conclude(run(&flags))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let body = Body::new(flags)?;
    match flags.least {
        Least::Action => least_action::run(flags, body),
        Least::Effort => least_effort::run(flags, body),
    }
}
