//! Geodesics of S³, S⁷, S²⁰ and S¹⁰⁰, moved by SO(4) to SO(101) from the left. The step is explicit, and its points lie
//! on a great circle.
//!
//! Source: Nordkvist, Crouch and Bloch, *Discrete Clebsch Optimal Control*, example B.

mod figure;
mod great_circle;
mod watch;

use clap::{Parser, ValueEnum};
use clebsch::{Clebsch, Conserved, Conserves};
use clebsch_examples::claims::{self, Claims};
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, finite_numbers, parse};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use great_circle::GreatCircle;
use nalgebra::{SMatrix, SVector};
use std::process::ExitCode;
use watch::Watch;

/// A free point on S³, the chord of SO(4) as its cost.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<4>, q: Unit<Vector4>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    scalar = f64,
)]
pub struct Sphere3;

/// A free point on S⁷, the chord of SO(8) as its cost: 28 components of the momentum, and still no equation to solve.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<8>, q: Unit<SVector<f64, 8>>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
)]
pub struct Sphere7;

/// A free point on S²⁰, the chord of SO(21) as its cost: 210 components of the momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<21>, q: Unit<SVector<f64, 21>>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
)]
pub struct Sphere20;

/// A free point on S¹⁰⁰, the chord of SO(101) as its cost: 5050 components of the momentum, and steps that take 101 numbers of them.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<101>, q: Unit<SVector<f64, 101>>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
)]
pub struct Sphere100;

/// The same point on S³ with the logarithm of F as its velocity: its steps are those of the continuous geodesic.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<4>, q: Unit<Vector4>| F * q,
    lagrangian     = |xi| xi.norm_squared() / 2,
    discretization = exponential,
    scalar         = f64,
)]
pub struct ExactSphere3;

const SCENE: Scene = Scene {
    name: "sphere_geodesics",
    step_size: "0.1",
    time_unit: "seconds",
    steps: "100000",
    order: "2",
    order_note: "it places the potential; a free point has none, so 1 and 2 give the same step",
    columns_note: "position q1.. and velocity w1.. (1/s), N + 1 of each",
};

/// Geodesics of S3, S7, S20 and S100: an explicit step whose points lie on a great circle, compared with its closed
/// form
#[derive(Parser, Debug)]
struct Flags {
    /// Dimension of the sphere
    #[arg(long, value_name = "N", default_value = "7")]
    sphere: Sphere,
    /// How a step measures its length: the chord F - I, or the logarithm of F (on S3 only)
    #[arg(long, value_name = "NAME", default_value = "chord")]
    discretization: Discretization,
    /// Position at the start, a unit vector of N + 1 numbers [default: 0.5,0.5,0.5,0.5 and zeros; on S20 and S100 all equal]
    #[arg(long, value_name = "X,..", value_parser = coordinates, allow_hyphen_values = true)]
    position: Option<Coordinates>,
    /// Velocity at the start, N + 1 numbers, 1/s; its component along the position is left out [default:
    /// 0.3,-0.4,0.2,-0.1,0.5,-0.3,0.1,0.2, again and again]
    #[arg(long, value_name = "X,..", value_parser = coordinates, allow_hyphen_values = true)]
    velocity: Option<Coordinates>,
    #[command(flatten)]
    run: Run,
}

/// As many numbers as were given: a list that clap does not take for a flag that may be repeated.
#[derive(Clone, Debug)]
struct Coordinates(Vec<f64>);

fn coordinates(text: &str) -> Result<Coordinates, String> {
    finite_numbers(text).map(Coordinates)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Sphere {
    #[value(name = "3")]
    Three,
    #[value(name = "7")]
    Seven,
    #[value(name = "20")]
    Twenty,
    #[value(name = "100")]
    Hundred,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Discretization {
    Chord,
    Exponential,
}

impl Discretization {
    /// The angle of a step at the speed |w|.
    fn angle(self, h: f64, speed: f64) -> f64 {
        match self {
            Self::Chord => (h * speed).asin(),
            Self::Exponential => h * speed,
        }
    }
}

/// Coordinate i of the position at the start: all of them equal on the large spheres.
fn first_position(dimensions: usize, i: usize) -> f64 {
    match dimensions {
        ..=8 if i < 4 => 0.5,
        ..=8 => 0.0,
        _ => (dimensions as f64).sqrt().recip(),
    }
}

/// Coordinate i of the velocity at the start, 1/s.
fn first_velocity(i: usize) -> f64 {
    [0.3, -0.4, 0.2, -0.1, 0.5, -0.3, 0.1, 0.2][i % 8]
}

/// The default numbers, unless others were given.
fn numbers<const D: usize>(
    given: Option<&Coordinates>,
    default: impl Fn(usize) -> f64,
    flag: &str,
) -> Result<SVector<f64, D>, Failure> {
    let Some(Coordinates(numbers)) = given else { return Ok(SVector::from_fn(|i, _| default(i))) };
    if numbers.len() == D {
        return Ok(SVector::from_column_slice(numbers));
    }
    let (dimension, found) = (D - 1, numbers.len());
    Err(Failure::Flags(format!("{flag}: a point of S{dimension} has {D} coordinates, {found} were given")))
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(match (flags.sphere, flags.discretization) {
        (Sphere::Three, Discretization::Chord) => run(Sphere3, &flags),
        (Sphere::Three, Discretization::Exponential) => run(ExactSphere3, &flags),
        (Sphere::Seven, Discretization::Chord) => run(Sphere7, &flags),
        (Sphere::Twenty, Discretization::Chord) => run(Sphere20, &flags),
        (Sphere::Hundred, Discretization::Chord) => run(Sphere100, &flags),
        (_, Discretization::Exponential) => {
            Err(Failure::Flags("--discretization exponential: declared here for S3 only, add --sphere 3".to_owned()))
        }
    })
}

fn run<S, const D: usize, const K: usize>(point: S, flags: &Flags) -> Result<Claims, Failure>
where
    S: Conserves<Scalar = f64, Configuration = SVector<f64, D>, Conserved = Conserved<f64, K>>,
    S::MomentumMatrix: Into<SMatrix<f64, D, D>>,
{
    let position = numbers::<D>(flags.position.as_ref(), |i| first_position(D, i), "--position")?;
    let velocity = numbers::<D>(flags.velocity.as_ref(), first_velocity, "--velocity")?;
    let stepper = point.into_stepper(flags.run.step_size)?;
    // J(q, w) forgets the component of w along q: the momentum is then in the annihilator of the rotations that fix q.
    let start = stepper.state(position, stepper.momentum_map(&position, &velocity))?;
    let circle = GreatCircle::new(position, velocity, |speed| flags.discretization.angle(flags.run.step_size, speed));

    let mut csv = Csv::create(&flags.run, &columns(D).iter().map(String::as_str).collect::<Vec<_>>())?;
    let mut watch = Watch::new(&flags.run, circle);
    let momenta = stepper.conserved(&start);
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let q = state.configuration();
        // the matrix has D² numbers, which only the file is worth
        if flags.run.csv.is_some() {
            let matrix: SMatrix<f64, D, D> = stepper.momentum_matrix(&state.momentum()).into();
            // M = ½ (w qᵀ − q wᵀ) as a matrix of the trace pairing
            csv.row(step, time, by_rows(q).chain(by_rows(&(matrix * q * 2.0))))?;
        }
        let now = stepper.conserved(state);
        let moved = largest(now.values().iter().zip(momenta.values()).map(|(now, before)| now - before));
        watch.observe(step, time, q, moved, stepper.system().orbit_defect(q));
        Ok(())
    })?;

    let Run { step_size, steps, .. } = flags.run;
    let (sphere, angle) = (D - 1, watch.circle.angle);
    say(format_args!("geodesic of S{sphere}: {steps} steps of {step_size} s, {angle:.6} rad each\n"));
    say(&watch.table);
    if let Some(exponent) = watch.exponent() {
        say(format_args!(
            "over the last hundredfold of steps the distance from the circle grew like k^{exponent:.2}\n"
        ));
    }
    csv.finish()?;
    figure::draw(flags, &watch)?;

    let mut claims = Claims::new();
    watch.claim(&mut claims, flags.discretization, S::DERIVATION, largest(momenta.values().iter().copied()));
    Ok(claims)
}

/// The largest size of these numbers, NaN if one of them is.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    claims::largest(numbers.map(f64::abs))
}

/// The columns of the CSV file.
fn columns(coordinates: usize) -> Vec<String> {
    ["q", "w"].into_iter().flat_map(|letter| (1..=coordinates).map(move |i| format!("{letter}{i}"))).collect()
}
