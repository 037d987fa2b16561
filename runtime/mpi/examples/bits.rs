//! Compares fields on all ranks with the same in one process, every bit: configurations, momenta, energies and conserved momenta.
//!
//! `mpirun -n 4 target/release/examples/bits`

mod fields;

use clebsch::{
    Clebsch, Conserved, Conserves, Domain, Field, Grid, MovingField, Population, Real, SavedField, Side, Sides, Space,
};
use fields::{Beads, Crystal, Rod, Strand, WaveMap, spin};
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Equivalence, Root};
use nalgebra::{Matrix4, Rotation3, Vector1, Vector2, Vector3, Vector4, Vector6};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::error::Error;

/// The steps before the states are saved and read back, and those after it.
const STEPS: [u64; 2] = [23, 20];

/// Whether all numbers have the same bits. Those of `f32` are compared as `f64`, which has a place for each of them.
fn are_same<T: Real, V: Space<T>>(a: &[V], b: &[V]) -> bool {
    let differ = |a: T, b: T| if a.to_f64().to_bits() == b.to_f64().to_bits() { T::zero() } else { T::one() };
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.zip_map(b, differ).sum() == T::zero())
}

type Q<S> = <S as Clebsch>::Configuration;
type Mu<S> = <S as Clebsch>::Momentum;

/// Steps a field on all ranks and on rank 0 alone.
fn compare<S, T, P, const D: usize, const K: usize>(
    world: &SimpleCommunicator,
    name: &str,
    field: &Domain<S, Grid<T, D>, P>,
    h: T,
    start: impl Fn(usize) -> (Q<S>, Mu<S>),
) -> Result<(), Box<dyn Error>>
where
    S: Field<D> + MovingField + Clebsch<Scalar = T> + Conserves<Conserved = Conserved<T, K>> + Clone,
    T: Real + Equivalence,
    Q<S>: Serialize + DeserializeOwned,
    Mu<S>: Serialize + DeserializeOwned,
    S::Time: Serialize + DeserializeOwned,
    P: Population,
{
    let grid = *field.lattice();
    let stepper = clebsch_mpi::slab(world, field)?.stepper(h)?;
    let mut state = stepper.state(|place| start(grid.index(place).unwrap_or_default()))?;
    stepper.advance(&mut state, STEPS[0])?;
    // each rank saves its own, and goes on from it
    let bytes = postcard::to_allocvec(state.field())?;
    let saved: SavedField<Vec<Q<S>>, Vec<Mu<S>>, S::Time> = postcard::from_bytes(&bytes)?;
    let mut state = stepper.resume(saved)?;
    stepper.advance(&mut state, STEPS[1])?;
    let (energy, momenta) = (stepper.energy(&state)?, stepper.conserved(&state)?);
    let all = stepper.gather(&state)?;
    let sizes = grid.sizes().map(|size| size.to_string()).join(" × ");
    let mut is_same = true;
    if let Some((q, mu)) = all {
        let alone = field.clone().stepper(h)?;
        let (first, momentum): (Vec<_>, Vec<_>) = (0..grid.sites()).map(start).unzip();
        let mut expected = alone.state(first.clone(), momentum)?;
        alone.advance(&mut expected, STEPS[0])?;
        alone.advance(&mut expected, STEPS[1])?;
        let parts = [
            ("configurations", are_same(&q, expected.configuration())),
            ("momenta", are_same(&mu, expected.momentum())),
            ("the energy", are_same(&[energy], &[alone.energy(&expected)?])),
            ("conserved momenta", are_same(momenta.values(), alone.conserved(&expected)?.values())),
            ("sites that have moved", !are_same(&q, &first)),
        ];
        for (part, _) in parts.iter().filter(|(_, is_same)| !is_same) {
            println!("{name}, {sizes} sites, {} ranks: {part} are not those of one process", world.size());
            is_same = false;
        }
        if is_same {
            println!("{name:28} {sizes:>12} sites, ranks: {}, bit for bit", world.size());
        }
    }
    // all ranks know it
    world.process_at_rank(0).broadcast_into(&mut is_same);
    if is_same { Ok(()) } else { Err("the bits differ".into()) }
}

fn main() -> Result<(), Box<dyn Error>> {
    let universe = mpi::initialize().ok_or("MPI has been initialised before")?;
    let world = universe.world();
    let (open, hanging) = (Sides::Open(Side::Free, Side::Free), Sides::Open(Side::Fixed, Side::Free));

    let sheet = WaveMap.grid([37, 16]).spacing([0.1, 0.12]);
    compare(&world, "waves on S², periodic", &sheet.clone().periodic(), 0.05, spin)?;
    compare(&world, "waves on S², fixed", &sheet.fixed(), 0.05, spin)?;

    let rod = Rod {
        section: Vector4::new(3e-4, 2e-4, 1e-4, 0.1),
        stiffness: Vector6::new(0.5, 0.6, 0.4, 40.0, 50.0, 80.0),
        reference: Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
    };
    let section = |i: usize| {
        let push = Vector6::new(1e-5, 0.0, 2e-5, 0.01 * (0.3 * i as f64).sin(), 0.0, 0.002);
        (Matrix4::new_translation(&Vector3::new(0.0, 0.0, 0.1 * i as f64)), push)
    };
    compare(&world, "a rod, free", &rod.grid([41]).spacing([0.1]), 0.002, section)?;

    let beads = Beads { mass: 0.7, spring: 0.4 };
    let sheet = beads.grid([23, 9]).spacing([0.8, 0.9]).sides([hanging, Sides::Periodic]);
    let own = |[i, j]: [usize; 2]| Beads { mass: 1.0 + 0.1 * i as f64, spring: 0.3 + 0.01 * (i + 2 * j) as f64 };
    let bead = |site: usize| {
        let x = site as f64;
        (Vector2::new((1.7 * x).sin(), (2.3 * x).cos()), Vector2::new((0.9 * x).cos() * 0.3, 0.1))
    };
    compare(&world, "beads, various, order 4", &sheet.various(own), 0.05, bead)?;

    let block = Crystal.grid([9, 4, 5]).sides([Sides::Periodic, open, hanging]);
    let turn = |site: usize| {
        let x = site as f64;
        let axis = Vector3::new(x.sin(), 0.5 * x.cos(), 0.3);
        (Rotation3::new(axis).into_inner(), Vector3::new(0.1, (0.6 * x).sin() * 0.2, -0.1))
    };
    compare(&world, "rotations in three directions", &block, 0.05, turn)?;

    let height = |site: usize| (Vector1::new((1.7 * site as f32).sin()), Vector1::new(0.1));
    compare(&world, "a string in f32, order 8", &Strand.grid([50]).fixed(), 0.1, height)
}
