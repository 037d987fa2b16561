//! A cloud of free rigid bodies, all spun about their intermediate axis, each with a tilt of its own. Each turns over
//! in its own time, so the cloud loses its order. Each body conserves its energy and its momentum.
//!
//! All are stepped side by side, eight in the lanes of each register and on all cores. Each has the bits that it has
//! alone. Source of the exact motion: Landau and Lifshitz, *Mechanics*, §37.

mod euler;
mod figure;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, Ensemble, F64x8, Scalar};
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Run, Scene, count, moments_of_inertia, parse, positive};
use clebsch_examples::noise::Noise;
use clebsch_examples::progress::Progress;
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::{Matrix3, Vector3};
use std::process::ExitCode;
use watch::Watch;

/// A body that turns freely.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = moser_veselov,
)]
pub struct Rock<T: Scalar> {
    /// Principal moments of inertia, kg·m².
    pub moments: Vector3<T>,
}

const SCENE: Scene = Scene {
    name: "ensemble",
    step_size: "0.02",
    time_unit: "seconds",
    steps: "6000",
    order: "2",
    order_note: "it places the potential; free bodies have none, so 1 and 2 give the same step",
    columns_note: "mean, least and greatest pi2 of the cloud and the exact mean, as parts of the momentum",
};

/// A cloud of tumbling bodies, stepped side by side: each conserves energy and momentum, and has the bits that it has
/// alone
#[derive(Parser, Debug)]
struct Flags {
    /// Number of bodies
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true, default_value = "1000")]
    bodies: u64,
    /// Principal moments of inertia, kg m2
    #[arg(long, value_name = "A,B,C", value_parser = increasing, allow_hyphen_values = true)]
    #[arg(default_value = "1,2,2.5")]
    inertia: [f64; 3],
    /// Angular momentum of each body, kg m2/s
    #[arg(long, value_name = "L", value_parser = positive, allow_hyphen_values = true, default_value = "2")]
    spin: f64,
    /// Standard deviation of the tilt of the spin from the second axis, in each direction, degrees
    #[arg(long, value_name = "DEGREES", value_parser = positive, allow_hyphen_values = true, default_value = "2")]
    tilt: f64,
    /// Seed of the tilts
    #[arg(long, value_name = "SEED", default_value = "1")]
    seed: u64,
    #[command(flatten)]
    run: Run,
}

impl Flags {
    /// Body momenta at the start, near the second axis.
    fn momenta(&self) -> Vec<Vector3<f64>> {
        let mut noise = Noise::new(self.seed);
        let mut tilt = || noise.normal() * self.tilt.to_radians();
        (0..self.bodies).map(|_| Vector3::new(tilt(), 1.0, tilt()).normalize() * self.spin).collect()
    }
}

/// Moments of inertia; the second is the intermediate one.
fn increasing(text: &str) -> Result<[f64; 3], String> {
    let [a, b, c] = moments_of_inertia(text)?;
    if a < b && b < c {
        Ok([a, b, c])
    } else {
        Err("the second moment has to lie between the others: a < b < c".to_owned())
    }
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

/// The cloud with steps of this size.
fn cloud(flags: &Flags, step_size: f64, momenta: &[Vector3<f64>]) -> Result<Ensemble<Rock<F64x8>>, Failure> {
    let rock = Rock { moments: Vector3::from(flags.inertia).map(F64x8::splat) };
    let starts = momenta.iter().map(|&momentum| (Matrix3::identity(), momentum));
    rock.into_stepper(F64x8::splat(step_size))?.ensemble(starts).map_err(|failure| Failure::Start(failure.error))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let Run { step_size, steps, .. } = flags.run;
    let momenta = flags.momenta();
    let mut rocks = cloud(flags, step_size, &momenta)?;
    let mut halved = cloud(flags, step_size / 2.0, &momenta)?;

    let mut csv = Csv::create(&flags.run, &["mean", "least", "greatest", "exact"])?;
    let mut watch = Watch::new(flags, &momenta, &rocks)?;
    let mut progress = Progress::of(steps, "steps");
    for step in 0..=steps {
        if step > 0 {
            rocks.par_advance(1);
        }
        if let Some(failure) = rocks.failures().next() {
            return Err(Failure::Step { step: failure.step + 1, error: failure.error });
        }
        let is_written = flags.run.csv.is_some() && step.is_multiple_of(flags.run.every);
        if is_written || watch.looks_at(step) {
            let seen = watch.observe(step, &rocks);
            csv.row(step, flags.run.time(step), seen)?;
        }
        progress.reached(step);
    }
    halved.par_advance(2 * steps);

    let bodies = flags.bodies;
    say(format_args!("{bodies} free rigid bodies over {} s: {steps} steps of {step_size} s\n", flags.run.duration()));
    say(&watch.table);
    csv.finish()?;
    figure::draw(flags, &watch)?;

    let mut claims = Claims::new();
    watch.claim(&rocks, &halved, &mut claims)?;
    Ok(claims)
}
