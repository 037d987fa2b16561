//! Times steps of waves of unit vectors on all ranks: `scaling ROWS COLUMNS STEPS`.
//!
//! Prints the ranks, the rows, the columns, and the milliseconds of a step: the median of five times of so many steps.

mod fields;

use clebsch::Field;
use fields::WaveMap;
use mpi::traits::{Communicator, CommunicatorCollectives};
use nalgebra::Vector3;
use std::time::Instant;

const TIMES: usize = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let universe = mpi::initialize().ok_or("MPI has been initialised before")?;
    let world = universe.world();
    let mut numbers = std::env::args().skip(1).map(|text| text.parse::<usize>());
    let mut next = || numbers.next().ok_or("scaling ROWS COLUMNS STEPS")?.map_err(|_| "scaling ROWS COLUMNS STEPS");
    let (rows, columns, steps) = (next()?, next()?, next()?);
    let sheet = WaveMap.grid([rows, columns]).spacing([0.1, 0.1]).periodic();
    let stepper = clebsch_mpi::slab(&world, &sheet)?.stepper(0.05)?;
    let tilt = |place: usize, size: usize| (core::f64::consts::TAU * place as f64 / size as f64).sin();
    let mut state = stepper.state(|[i, j]| {
        let angle = 0.3 * tilt(i, rows) * tilt(j, columns);
        (Vector3::new(angle.sin(), 0.0, angle.cos()), Vector3::zeros())
    })?;
    stepper.advance(&mut state, 2)?;
    let mut times = Vec::new();
    for _ in 0..TIMES {
        world.barrier();
        let start = Instant::now();
        stepper.advance(&mut state, steps as u64)?;
        world.barrier();
        times.push(start.elapsed().as_secs_f64() * 1e3 / steps as f64);
    }
    times.sort_by(f64::total_cmp);
    if world.rank() == 0 {
        println!("{} {rows} {columns} {:.4}", world.size(), times[TIMES / 2]);
    }
    Ok(())
}
