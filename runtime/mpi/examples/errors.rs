//! Wrong input gives the same error on all ranks, and no rank waits for ever.
//!
//! `mpirun -n 4 target/release/examples/errors`

mod fields;

use clebsch::{Domain, Field, Grid};
use clebsch_mpi::{Error, slab};
use fields::{WaveMap, spin};
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Root};
use nalgebra::Vector3;

/// All ranks have the error of rank 0, and it says this.
fn told(world: &SimpleCommunicator, error: Option<Error>, part: &str) -> Result<(), String> {
    let text = error.map_or_else(|| "no error".to_owned(), |error| error.to_string());
    let mut first = [0_u8; 400];
    first.iter_mut().zip(text.bytes()).for_each(|(place, byte)| *place = byte);
    let own = first;
    world.process_at_rank(0).broadcast_into(&mut first[..]);
    if world.rank() == 0 {
        println!("{text}");
    }
    if own != first || !text.contains(part) {
        return Err(format!("rank {} of {} has `{text}`, and not `{part}` as all others", world.rank(), world.size()));
    }
    Ok(())
}

/// Steps a field until it fails: on all ranks with the error of one process, and again when it is stepped on.
fn as_alone(
    world: &SimpleCommunicator,
    field: &Domain<WaveMap, Grid<f64, 2>>,
    h: f64,
    start: impl Fn(usize) -> (Vector3<f64>, Vector3<f64>),
) -> Result<(), Box<dyn std::error::Error>> {
    let (ranks, [rows, columns]) = (world.size() as usize, field.lattice().sizes());
    let (q, mu): (Vec<_>, Vec<_>) = (0..rows * columns).map(&start).unzip();
    let alone = field.clone().stepper(h)?;
    let mut expected = alone.state(q, mu)?;
    let error = alone.advance(&mut expected, 1000).err().ok_or("a step that fails")?;
    let site = error.site.ok_or("a site")?;
    let rank = (0..ranks).find(|rank| rows * (rank + 1) / ranks > site / columns).unwrap_or_default();
    let expected = format!("site {site}, on rank {rank}: {}", error.error);
    let stepper = slab(world, field)?.stepper(h)?;
    let mut state = stepper.state(|[i, j]| start(columns * i + j))?;
    for _ in 0..2 {
        told(world, stepper.advance(&mut state, 1000).err(), &expected)?;
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let universe = mpi::initialize().ok_or("MPI has been initialised before")?;
    let world = universe.world();
    let (rank, ranks) = (world.rank() as usize, world.size() as usize);
    let last = ranks - 1;
    let sheet = WaveMap.grid([12, 4]).spacing([0.5, 0.5]).periodic();

    told(&world, slab(&world, &WaveMap.grid([0, 4])).err(), "0 sites in direction 0")?;
    told(&world, slab(&world, &WaveMap.grid([12, 0])).err(), "0 sites in direction 1")?;
    told(&world, slab(&world, &WaveMap.grid([12, 4]).spacing([0.5, 0.0])).err(), "the spacing in direction 1 is 0")?;
    told(&world, slab(&world, &sheet)?.stepper(0.0).err(), "the step size is 0")?;
    if ranks > 1 {
        let few = WaveMap.grid([ranks - 1, 4]);
        told(&world, slab(&world, &few).err(), &format!("{ranks} ranks share a grid of {} rows", ranks - 1))?;
        let other = WaveMap.grid([12, if rank == last { 5 } else { 4 }]);
        let differs = format!("rank {last} has 5 as the size of a direction, and rank 0 has 4");
        told(&world, slab(&world, &other).err(), &differs)?;
        let other = if rank == last { sheet.clone().free() } else { sheet.clone() };
        told(&world, slab(&world, &other).err(), "the sides of a direction")?;
        let other = slab(&world, &sheet)?.stepper(if rank == last { 0.2 } else { 0.1 });
        told(&world, other.err(), "0.2 as the step size, and rank 0 has 0.1")?;
    }

    let stepper = slab(&world, &sheet)?.stepper(0.1)?;
    let number = |[i, j]: [usize; 2]| 4 * i + j;
    let unknown =
        stepper.state(|place| if number(place) == 45 { (Vector3::x() * f64::NAN, Vector3::zeros()) } else { spin(3) });
    told(&world, unknown.err(), &format!("site 45, on rank {last}: the configuration is not finite"))?;
    if ranks > 1 {
        let mut state = stepper.state(|place| spin(number(place)))?;
        let error = stepper.advance(&mut state, if rank == last { 4 } else { 3 }).err();
        told(&world, error, "4 as the number of steps, and rank 0 has 3")?;
        stepper.advance(&mut state, 3)?;
    }

    let mut other = slab(&world, &WaveMap.grid([12 * ranks, 4]))?.stepper(0.1)?.state(|_| spin(3))?;
    if ranks > 1 {
        told(&world, stepper.advance(&mut other, 1).err(), "where there are")?;
        told(&world, stepper.energy(&other).err(), "where there are")?;
        told(&world, stepper.gather(&other).err(), "where there are")?;
        // the last rank resumes a state of another time, and one of another motion
        let mut states = Vec::new();
        for (first, steps) in [(0, 1), (0, 2), (7, 1)] {
            let mut state = stepper.state(|place| spin(number(place) + first))?;
            stepper.advance(&mut state, steps)?;
            states.push(postcard::to_allocvec(state.field())?);
        }
        for (wrong, part) in [(1, "2 as the number of steps, and rank 0 has 1"), (2, "let each rank resume the state")]
        {
            let bytes = if rank == last { &states[wrong] } else { &states[0] };
            told(&world, stepper.resume(postcard::from_bytes(bytes)?).err(), part)?;
        }
    }

    // the same error as in one process: above the stable step a wave grows, until a step is too long for a site
    let tilted = |site: usize| {
        let tilt: f64 = if site == 33 { 0.01 } else { 0.0 };
        (Vector3::new(tilt.sin(), 0.0, tilt.cos()), Vector3::zeros())
    };
    as_alone(&world, &sheet, 0.4, tilted)?;
    // and far away from other ranks, which hear of it before anything has moved there
    let thrown = |site: usize| (Vector3::z(), Vector3::x() * if site == 4 * 113 + 2 { 11.0 } else { 0.0 });
    as_alone(&world, &WaveMap.grid([120, 4]).spacing([0.5, 0.5]), 0.1, thrown)?;
    if world.rank() == 0 {
        println!("errors{:46} ranks: {ranks}, the same on all of them", "");
    }
    Ok(())
}
