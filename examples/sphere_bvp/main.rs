//! Points of spheres joined by extremals: great circles between any two of them, and the throw of a pendulum's bob that
//! arrives in time.
//!
//! Great circles: Nordkvist, Crouch and Bloch, *Discrete Clebsch Optimal Control*, example B, for the step. Indices of geodesics: Milnor,
//! *Morse Theory* (1963), §15.

mod arrival;
mod figure;
mod great_circle;
mod polygon;
mod throw;
mod windings;

use clap::Parser;
use clebsch::{Clebsch, Declared, Differentiated, Error};
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, finite, finite_list, parse};
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::{Vector3, Vector4};
use std::process::ExitCode;
use throw::{Throw, Way};

/// A free point on S², the chord of SO(3) as its cost.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    scalar = f64,
    emit   = [boundary],
)]
pub struct Sphere2;

/// A free point on S³, the chord of SO(4) as its cost: three of six motions fix a point.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<4>, q: Unit<Vector4>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    scalar = f64,
    emit   = [boundary],
)]
pub struct Sphere3;

/// A spherical pendulum of unit mass and length.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z,
    emit      = [boundary],
    method FirstOrder = (order = 1),
)]
pub struct SphericalPendulum {
    /// g, m/s².
    pub gravity: f64,
}

/// Drift, then kick.
pub struct FirstOrder;

const SCENE: Scene = Scene {
    name: "sphere_bvp",
    step_size: "0.01",
    time_unit: "seconds",
    steps: "60",
    order: "2",
    order_note: "1 drifts, then kicks; 2 kicks by half at both ends; a free point has no kicks",
    columns_note: "position q1,q2,q3 of the bob thrown the short way, angular momentum N1,N2,N3 (per unit mass; before the kick of the step that follows)",
};

/// Extremals between two points of a sphere: great circles with any number of steps, and throws of a pendulum's bob
#[derive(Parser, Debug)]
struct Flags {
    /// Gravity, m/s², downwards along the third axis
    #[arg(long, value_name = "G", value_parser = finite, allow_hyphen_values = true, default_value = "9.81")]
    gravity: f64,
    /// Where the bob is thrown, a unit vector
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "0,0.6,-0.8")]
    from: [f64; 3],
    /// Where it arrives, a unit vector that is not opposite to the first
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "0.8,0,0.6")]
    to: [f64; 3],
    #[command(flatten)]
    run: Run,
}

impl Flags {
    /// Both ends of the throw.
    fn ends(&self) -> (Vector3<f64>, Vector3<f64>) {
        (self.from.into(), self.to.into())
    }
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(match flags.run.order {
        Order::First => run::<FirstOrder>(&flags),
        Order::Second => run::<Declared>(&flags),
    })
}

fn run<M: Differentiated<SphericalPendulum, 3>>(flags: &Flags) -> Result<Claims, Failure> {
    let (from, to) = flags.ends();
    if from == to {
        return Err(Failure::Flags("--from and --to: two different points are needed".to_owned()));
    }
    let mut claims = Claims::new();
    let duration = flags.run.duration();
    say(format_args!("extremals between points of spheres in {duration} s\n"));
    let ends = (Vector4::repeat(0.5), Vector4::new(0.1, -0.7, 0.5, -0.5));
    polygon::inscribe(Sphere2, (from, to), duration, &mut claims)?;
    polygon::inscribe(Sphere3, ends, duration, &mut claims)?;
    windings::follow(Sphere2, (from, to), duration, &mut claims)?;
    windings::follow(Sphere3, ends, duration, &mut claims)?;

    let short = Throw::find::<M>(Way::Short, flags)?;
    let long = match Throw::find::<M>(Way::Long, flags) {
        Err(Failure::Start(Error::NoExtremal { .. })) => None,
        found => Some(found?),
    };
    say(format_args!("throws with g = {} m/s²: {} steps, order {}\n", flags.gravity, flags.run.steps, M::ORDER));
    say(throw::table(std::iter::once(&short).chain(&long)));
    short.claim(flags, &mut claims);
    throw::compare(&short, long.as_ref(), flags, &mut claims);
    write(&short, flags)?;
    figure::draw(flags, &short, long.as_ref())?;
    Ok(claims)
}

/// The trajectory of a throw as a file.
fn write(throw: &Throw, flags: &Flags) -> Result<(), Failure> {
    let mut csv = Csv::create(&flags.run, &["q1", "q2", "q3", "N1", "N2", "N3"])?;
    for (step, (q, n)) in (0..).zip(&throw.path) {
        csv.row(step, flags.run.time(step), by_rows(q).chain(by_rows(n)))?;
    }
    csv.finish()
}
