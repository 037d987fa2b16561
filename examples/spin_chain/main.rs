//! A ring of spins with exchange in a field: rotors on N spheres, each moved by its own rotation, tied to their neighbours.
//!
//! The declaration has N as a const generic. One loop steps eight spins in an array or a hundred thousand in vectors,
//! and the code is the same. Spins here have inertia, q̈ as well as q: Hamiltonian rotors. Their order parameter waves
//! travel with the speed √J of an antiferromagnet or a sigma model.
//!
//! Source: Haldane, *Nonlinear field theory of large-spin Heisenberg antiferromagnets*, Physical Review Letters 50 (1983), for the field that long rings tend to.

mod figure;
mod rotors;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, Power, SiteError, SiteStorage, Sites};
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Order, Run, Scene, finite, parse};
use clebsch_examples::progress::Progress;
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::process::ExitCode;
use watch::Watch;

/// A ring of N spins.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential = |q| (0..N).map(|i| -self.exchange * q[i].dot(&q[(i + 1) % N]) - self.field.dot(&q[i])).sum(),
)]
pub struct SpinChain<const N: usize> {
    /// Exchange energy, 1/s².
    pub exchange: f64,
    /// Field, 1/s².
    pub field: Vector3<f64>,
}

/// The same ring in steps of first order.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential = |q| (0..N).map(|i| -self.exchange * q[i].dot(&q[(i + 1) % N]) - self.field.dot(&q[i])).sum(),
    order     = 1,
)]
pub struct FirstOrderChain<const N: usize> {
    /// Exchange energy, 1/s².
    pub exchange: f64,
    /// Field, 1/s².
    pub field: Vector3<f64>,
}

/// A ring of either order.
pub trait Spins<const N: usize>:
    Power<N, Site: Clebsch<Configuration = Vector3<f64>, Momentum = Vector3<f64>>>
    + Clebsch<Scalar = f64, Configuration = [Vector3<f64>; N], Momentum = [Vector3<f64>; N], Time = ()>
    + Clone
{
    /// With this exchange energy and field.
    fn new(exchange: f64, field: Vector3<f64>) -> Self;
}

impl<const N: usize> Spins<N> for SpinChain<N> {
    fn new(exchange: f64, field: Vector3<f64>) -> Self {
        Self { exchange, field }
    }
}

impl<const N: usize> Spins<N> for FirstOrderChain<N> {
    fn new(exchange: f64, field: Vector3<f64>) -> Self {
        Self { exchange, field }
    }
}

const SCENE: Scene = Scene {
    name: "spin_chain",
    step_size: "0.02",
    time_unit: "seconds",
    steps: "2000",
    order: "2",
    order_note: "1: drift and kick, 2: half of the kick at each end",
    columns_note: "mean of the spins q1, q2, q3 and of their momenta N1, N2, N3, the energy of a spin",
};

/// A ring of spins in a field: their common conserved quantities, and a picture of the field in time
#[derive(Parser, Debug)]
struct Flags {
    /// Number of spins: 8, 64, 1000, 10000 or 100000
    #[arg(long, value_name = "N", default_value = "64")]
    sites: usize,
    /// Exchange energy of two neighbours, 1/s2
    #[arg(long, value_name = "J", value_parser = finite, allow_hyphen_values = true, default_value = "1")]
    exchange: f64,
    /// Field along the third axis, 1/s2
    #[arg(long, value_name = "B", value_parser = finite, allow_hyphen_values = true, default_value = "0.2")]
    field: f64,
    /// Turns of the spiral around the ring at the start
    #[arg(long, value_name = "K", default_value = "2")]
    turns: u32,
    /// Tilt of the spiral to the field, a different one at each site, degrees
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_hyphen_values = true, default_value = "20")]
    tilt: f64,
    #[command(flatten)]
    run: Run,
}

impl Flags {
    fn ring<S: Spins<N>, const N: usize>(&self) -> S {
        S::new(self.exchange, Vector3::new(0.0, 0.0, self.field))
    }

    /// A spiral, tilted in a wave of its own, and turning about the field as the tilt says.
    fn start(&self, sites: usize) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        let spin = |i: usize| {
            let around = TAU * f64::from(self.turns) * i as f64 / sites as f64;
            let height = (self.tilt.to_radians() * (TAU * i as f64 / sites as f64).cos()).sin();
            let across = (1.0 - height * height).sqrt();
            Vector3::new(across * around.cos(), across * around.sin(), height)
        };
        let q: Vec<Vector3<f64>> = (0..sites).map(spin).collect();
        let mu = q.iter().map(|q| q.cross(&Vector3::z().cross(q)) * 0.3).collect();
        (q, mu)
    }
}

/// The spins of a ring in vectors.
pub type Ring<S, const N: usize> = Sites<S, Vec<Vector3<f64>>, Vec<Vector3<f64>>, N>;

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(match flags.sites {
        8 => in_order::<8>(&flags),
        64 => in_order::<64>(&flags),
        1000 => in_order::<1000>(&flags),
        10_000 => in_order::<10_000>(&flags),
        100_000 => in_order::<100_000>(&flags),
        other => Err(Failure::Flags(format!(
            "--sites: {other} is none of the rings that are compiled here: 8, 64, 1000, 10000 or 100000"
        ))),
    })
}

fn failed(step: u64) -> impl Fn(SiteError) -> Failure {
    move |failure| Failure::Step { step, error: failure.error }
}

fn in_order<const N: usize>(flags: &Flags) -> Result<Claims, Failure> {
    match flags.run.order {
        Order::First => run::<FirstOrderChain<N>, FirstOrderChain<8>, N>(flags),
        Order::Second => run::<SpinChain<N>, SpinChain<8>, N>(flags),
    }
}

/// A ring at its start, with steps of this size.
fn ring<S: Spins<N>, const N: usize>(flags: &Flags, step_size: f64) -> Result<Ring<S, N>, Failure> {
    let (q, mu) = flags.start(N);
    let ring: S = flags.ring();
    let stepper = ring.into_stepper(step_size)?;
    stepper.sites(SiteStorage::of(q, mu)).map_err(|failure| Failure::Start(failure.error))
}

/// A ring of N, and of eight.
fn run<S: Spins<N>, Eight: Spins<8>, const N: usize>(flags: &Flags) -> Result<Claims, Failure> {
    let Run { step_size, steps, .. } = flags.run;
    let mut spins: Ring<S, N> = ring(flags, step_size)?;
    let mut halved: Ring<S, N> = ring(flags, step_size / 2.0)?;
    let mut csv = Csv::create(&flags.run, &["q1", "q2", "q3", "N1", "N2", "N3", "energy"])?;
    let mut watch = Watch::new(&flags.run, flags.field);
    let mut progress = Progress::new(steps);
    for step in 0..=steps {
        if step > 0 {
            spins.step().map_err(failed(step))?;
            halved.advance(2).map_err(failed(step))?;
        }
        let is_written = flags.run.csv.is_some() && step.is_multiple_of(flags.run.every);
        if is_written || watch.looks_at(step) {
            csv.row(step, flags.run.time(step), watch.observe(step, &spins, &halved).map_err(failed(step))?)?;
        }
        progress.reached(step);
    }
    say(format_args!("a ring of {N} spins over {} s: {steps} steps of {step_size} s\n", flags.run.duration()));
    say(&watch.table);
    csv.finish()?;
    figure::draw(flags, N, &watch)?;
    let mut claims = Claims::new();
    watch.claim(flags, N, &mut claims);
    rotors::claim::<Eight>(flags, &mut claims)?;
    Ok(claims)
}
