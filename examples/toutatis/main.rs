//! Asteroid 4179 Toutatis tumbles freely: its two periods from one integration, against those by radar and a flyby.
//!
//! Inertia and spin: Takahashi, Busch and Scheeres, *Spin state and moment of inertia characterization of 4179 Toutatis* (2013).
//! Periods: Zhao, Ji and others, *Orientation and rotational parameters of asteroid 4179 Toutatis: new insights from Chang'e-2's
//! close flyby* (2015).

mod closed_form;
mod comparison;
mod figure;
mod periods;
mod watch;

use clap::Parser;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, finite_list, moments_of_inertia, parse};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use comparison::Comparison;
use nalgebra::{Matrix3, Vector3};
use std::process::ExitCode;
use watch::Watch;

/// A rigid body that nothing acts on, in its principal axes.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    discretization = moser_veselov,
)]
pub struct TumblingBody {
    /// Principal moments of inertia, over that of the long axis.
    pub moments: Vector3<f64>,
}

const SCENE: Scene = Scene {
    name: "toutatis",
    step_size: "0.002",
    time_unit: "days",
    steps: "100000",
    order: "2",
    order_note: "it places the potential; a free body has none, so 1 and 2 give the same step",
    columns_note: "attitude R11..R33 (body to space), momentum pi1,pi2,pi3 (body frame, inertia unit times rad/day)",
};

/// Asteroid 4179 Toutatis tumbling freely, on real data: its period of rotation and its mean period of precession,
/// against published values
#[derive(Parser, Debug)]
struct Flags {
    /// Principal moments of inertia about the body axes, in any one unit
    #[arg(long, value_name = "A,B,C", value_parser = moments_of_inertia, allow_hyphen_values = true)]
    #[arg(default_value = "3.0836,3.235,1")]
    inertia: [f64; 3],
    /// Angular velocity at the start, body frame, degrees per day
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "14.51,33.529,-98.709")]
    spin: [f64; 3],
    #[command(flatten)]
    run: Run,
}

impl Flags {
    /// Whether this is Toutatis.
    fn is_toutatis(&self) -> bool {
        self.inertia == [3.0836, 3.235, 1.0] && self.spin == [14.51, 33.529, -98.709]
    }
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let moments = Vector3::from(flags.inertia);
    let momentum = moments.component_mul(&Vector3::from(flags.spin).map(f64::to_radians));
    let stepper = TumblingBody { moments }.into_stepper(flags.run.step_size)?;
    let start = stepper.state(Matrix3::identity(), momentum)?;

    let columns = ["R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33", "pi1", "pi2", "pi3"];
    let mut csv = Csv::create(&flags.run, &columns)?;
    let mut watch = Watch::new(&flags.run, &moments, &momentum);
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let (attitude, momentum) = (state.configuration(), state.momentum());
        csv.row(step, time, by_rows(attitude).chain(by_rows(&momentum)))?;
        watch.observe(step, time, attitude, &momentum, stepper.energy(state), stepper.system().orbit_defect(attitude));
        Ok(())
    })?;

    let Run { step_size, steps, .. } = flags.run;
    say(format_args!("free rotation over {} days: {steps} steps of {step_size} days\n", flags.run.duration()));
    say(&watch.table);
    let comparison = Comparison::new(flags, &watch, &moments, &momentum);
    say(comparison.table());
    csv.finish()?;
    figure::draw(flags, &watch, &comparison)?;

    let mut claims = Claims::new();
    watch.claim(&flags.run, &mut claims);
    comparison.claim(&mut claims);
    Ok(claims)
}
