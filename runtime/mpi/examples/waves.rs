//! Waves of unit vectors on a sheet that ranks share: `mpirun -n 4 target/release/examples/waves`.

use clebsch::{Clebsch, Field};
use mpi::traits::Communicator;
use nalgebra::Vector3;

/// Waves of unit vectors in two directions of space.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = [
        |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
        |dy, q, next| (next - q).norm_squared() / (2 * dy.powi(2)),
    ],
)]
struct WaveMap;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let universe = mpi::initialize().ok_or("MPI has been initialised before")?;
    let world = universe.world();
    let sheet = WaveMap.grid([1024, 256]).spacing([0.1, 0.1]).periodic();

    let stepper = clebsch_mpi::slab(&world, &sheet)?.stepper(0.02)?;
    let mut state = stepper.state(|[i, j]| {
        let tilt = 0.3 * (i as f64 * 0.05).sin() * (j as f64 * 0.1).cos();
        (Vector3::new(tilt.sin(), 0.0, tilt.cos()), Vector3::zeros())
    })?;
    let before = stepper.energy(&state)?; // all ranks have it
    stepper.advance(&mut state, 100)?;
    let after = stepper.energy(&state)?;
    println!("rank {} of {} has the rows {:?}", world.rank(), world.size(), stepper.slab().rows());
    // rank 0 alone has all sites
    if let Some((q, _)) = stepper.gather(&state)? {
        println!("{} sites, the energy has changed by {:.1e} of it", q.len(), (after - before) / before);
    }
    Ok(())
}
