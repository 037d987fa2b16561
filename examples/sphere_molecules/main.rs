//! Molecules on a sphere that attract and repel each other by the potential of Lennard-Jones: a sum over all pairs, N as a const generic.
//!
//! Source: Lee, Leok and McClamroch, *Lagrangian mechanics and variational integrators on two-spheres*, International
//! Journal for Numerical Methods in Engineering 79 (2009). Its example has 642 molecules on the unit sphere.

mod figure;
mod pair;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, Conserved, Conserves, Power, SiteError, SiteStorage, Sites};
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Order, Run, Scene, parse, positive};
use clebsch_examples::noise::Noise;
use clebsch_examples::progress::Progress;
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};
use std::process::ExitCode;
use watch::Watch;

/// N molecules of mass 1 on the unit sphere.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential = |q| (0..N).map(|i| (i + 1..N).map(|j| {
        let near = self.size.powi(2) / (q[i] - q[j]).norm_squared();
        4 * self.depth * (near.powi(6) - near.powi(3))
    }).sum()).sum(),
)]
pub struct Molecules<const N: usize> {
    /// The distance at which two neither attract nor repel each other, σ, as a part of the radius.
    pub size: f64,
    /// The depth of the potential, ε, 1/s².
    pub depth: f64,
}

/// The same molecules in steps of first order.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential = |q| (0..N).map(|i| (i + 1..N).map(|j| {
        let near = self.size.powi(2) / (q[i] - q[j]).norm_squared();
        4 * self.depth * (near.powi(6) - near.powi(3))
    }).sum()).sum(),
    order     = 1,
)]
pub struct FirstOrderMolecules<const N: usize> {
    /// The distance at which two neither attract nor repel each other, σ, as a part of the radius.
    pub size: f64,
    /// The depth of the potential, ε, 1/s².
    pub depth: f64,
}

/// Molecules in steps of either order.
pub trait Cloud<const N: usize>:
    Power<N, Site: Clebsch<Configuration = Vector3<f64>, Momentum = Vector3<f64>>>
    + Clebsch<Scalar = f64, Configuration = [Vector3<f64>; N], Momentum = [Vector3<f64>; N], Time = ()>
    + Conserves<Conserved = Conserved<f64, 3>>
    + Clone
{
    /// With the size σ and the depth ε.
    fn new(size: f64, depth: f64) -> Self;
}

impl<const N: usize> Cloud<N> for Molecules<N> {
    fn new(size: f64, depth: f64) -> Self {
        Self { size, depth }
    }
}

impl<const N: usize> Cloud<N> for FirstOrderMolecules<N> {
    fn new(size: f64, depth: f64) -> Self {
        Self { size, depth }
    }
}

const SCENE: Scene = Scene {
    name: "sphere_molecules",
    step_size: "0.005",
    time_unit: "seconds",
    steps: "4000",
    order: "2",
    order_note: "1: drift and kick, 2: half of the kick at each end",
    columns_note: "total angular momentum L1, L2, L3 (1/s), kinetic and potential energy of all molecules (1/s2)",
};

/// Molecules on a sphere that attract and repel each other: angular momentum and energy of all, and a pair next to its
/// closed form
#[derive(Parser, Debug)]
struct Flags {
    /// Number of molecules: 12, 64 or 642
    #[arg(long, value_name = "N", default_value = "64")]
    sites: usize,
    /// Depth of the potential of two molecules, 1/s2
    #[arg(long, value_name = "E", value_parser = positive, allow_hyphen_values = true, default_value = "0.02")]
    depth: f64,
    /// Standard deviation of each component of the velocities at the start, 1/s
    #[arg(long, value_name = "V", value_parser = positive, allow_hyphen_values = true, default_value = "0.1")]
    speed: f64,
    /// Seed of the velocities
    #[arg(long, value_name = "SEED", default_value = "1")]
    seed: u64,
    #[command(flatten)]
    run: Run,
}

impl Flags {
    /// A lattice by the golden angle, with random velocities.
    fn start(&self, sites: usize) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        let mut noise = Noise::new(self.seed);
        let golden = PI * (3.0 - 5.0_f64.sqrt());
        let place = |i: usize| {
            let (height, around) = (1.0 - (2.0 * i as f64 + 1.0) / sites as f64, golden * i as f64 % TAU);
            let across = (1.0 - height * height).sqrt();
            Vector3::new(across * around.cos(), across * around.sin(), height)
        };
        let q: Vec<Vector3<f64>> = (0..sites).map(place).collect();
        let mut velocity = || Vector3::new(noise.normal(), noise.normal(), noise.normal()) * self.speed;
        let mu = q.iter().map(|q| q.cross(&velocity())).collect();
        (q, mu)
    }
}

/// Molecules in vectors.
pub type Many<S, const N: usize> = Sites<S, Vec<Vector3<f64>>, Vec<Vector3<f64>>, N>;

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(match flags.sites {
        12 => in_order::<12>(&flags),
        64 => in_order::<64>(&flags),
        642 => in_order::<642>(&flags),
        other => {
            Err(Failure::Flags(format!("--sites: {other} is none of the clouds that are compiled here: 12, 64 or 642")))
        }
    })
}

fn failed(step: u64) -> impl Fn(SiteError) -> Failure {
    move |failure| Failure::Step { step, error: failure.error }
}

fn in_order<const N: usize>(flags: &Flags) -> Result<Claims, Failure> {
    match flags.run.order {
        Order::First => run::<FirstOrderMolecules<N>, N>(flags),
        Order::Second => run::<Molecules<N>, N>(flags),
    }
}

/// Molecules at their start, of a size at which neighbours on the lattice rest, with steps of this length.
fn cloud<S: Cloud<N>, const N: usize>(flags: &Flags, step_size: f64) -> Result<Many<S, N>, Failure> {
    let (q, mu) = flags.start(N);
    let stepper = S::new(2.75 / (N as f64).sqrt(), flags.depth).into_stepper(step_size)?;
    stepper.sites(SiteStorage::of(q, mu)).map_err(|failure| Failure::Start(failure.error))
}

fn run<S: Cloud<N>, const N: usize>(flags: &Flags) -> Result<Claims, Failure> {
    let Run { step_size, steps, .. } = flags.run;
    let mut molecules: Many<S, N> = cloud(flags, step_size)?;
    let mut halved: Many<S, N> = cloud(flags, step_size / 2.0)?;
    let mut csv = Csv::create(&flags.run, &["L1", "L2", "L3", "kinetic", "potential"])?;
    let mut watch = Watch::new(&flags.run);
    let mut progress = Progress::new(steps);
    for step in 0..=steps {
        if step > 0 {
            molecules.step().map_err(failed(step))?;
            halved.advance(2).map_err(failed(step))?;
        }
        let is_written = flags.run.csv.is_some() && step.is_multiple_of(flags.run.every);
        if is_written || watch.looks_at(step) {
            let seen = watch.observe(step, &molecules, &halved).map_err(failed(step))?;
            csv.row(step, flags.run.time(step), seen)?;
        }
        progress.reached(step);
    }
    say(format_args!("{N} molecules over {} s: {steps} steps of {step_size} s\n", flags.run.duration()));
    say(&watch.table);
    csv.finish()?;
    figure::draw(flags, N, &watch)?;
    let mut claims = Claims::new();
    watch.claim(N, &mut claims);
    pair::claim(flags, &mut claims)?;
    Ok(claims)
}
