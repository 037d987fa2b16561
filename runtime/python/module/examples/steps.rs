//! The time of steps of a heavy top in Rust, which `bench.py` compares with those in Python.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};
use std::time::Instant;

/// A rigid body turning about a fixed pivot in uniform gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
)]
struct HeavyTop {
    mass_matrix: Matrix3<f64>,
    weight: f64,
    center: Vector3<f64>,
}

const STEPS: usize = 100_000;

/// The least time of five runs, in nanoseconds for each step.
fn print_least(name: &str, run: impl Fn() -> Result<f64, clebsch::Error>) -> Result<(), clebsch::Error> {
    let mut least = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        std::hint::black_box(run()?);
        least = least.min(start.elapsed().as_secs_f64() / STEPS as f64);
    }
    println!("{name}: {:.0} ns a step", 1e9 * least);
    Ok(())
}

fn main() -> Result<(), clebsch::Error> {
    let mass_matrix = Matrix3::from_diagonal(&Vector3::new(0.25, 0.25, 1.0));
    let stepper = HeavyTop { mass_matrix, weight: 1.0, center: Vector3::z() }.into_stepper(0.01)?;
    let start = stepper.state(Matrix3::identity(), Vector3::new(0.1, 0.0, 3.2))?;
    print_least("Rust, advance", || Ok(stepper.advance(&start, STEPS)?.momentum().x))?;
    print_least("Rust, run with rows", || {
        let table = stepper.table().energy().conserved();
        let mut numbers = Vec::new();
        for sample in stepper.trajectory(start).every(0.01).with_times().take(STEPS) {
            let (time, state) = sample?;
            numbers.extend(table.row(time, &state));
        }
        Ok(numbers.iter().sum())
    })
}
