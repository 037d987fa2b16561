//! Fields of `clebsch` on many machines, by MPI.
//!
//! The grid is cut into slabs of rows, one for each rank. A row is all sites with one place in the first direction.
//! Each rank has its own rows, and those of its neighbours on which forces depend: `Field::REACH` of them on each side.
//! After each move of the sites neighbours exchange these rows. So a step is the same arithmetic as in one process, and has its bits.
//!
//! ```no_run
//! use clebsch::{Clebsch, Field};
//! use mpi::traits::Communicator;
//! use nalgebra::Vector3;
//!
//! /// Waves of unit vectors in two directions of space.
//! #[derive(Clebsch, Clone, Debug)]
//! #[clebsch(
//!     action = |F: SO<3>, q: Unit<Vector3>| F * q,
//!     cost   = |h, F| (F - I).norm_squared() / (4 * h),
//!     space  = [
//!         |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
//!         |dy, q, next| (next - q).norm_squared() / (2 * dy.powi(2)),
//!     ],
//! )]
//! struct WaveMap;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let universe = mpi::initialize().ok_or("MPI has been initialised before")?;
//! let world = universe.world();
//! let sheet = WaveMap.grid([4096, 1024]).spacing([0.1, 0.1]).periodic();
//!
//! let stepper = clebsch_mpi::slab(&world, &sheet)?.stepper(0.05)?;
//! let tilt = |[i, j]: [usize; 2]| 0.3 * (i as f64 * 0.01).sin() * (j as f64 * 0.02).cos();
//! let mut state = stepper.state(|place| {
//!     let tilt = tilt(place);
//!     (Vector3::new(tilt.sin(), 0.0, tilt.cos()), Vector3::zeros())
//! })?;
//! stepper.advance(&mut state, 1000)?;
//! let energy = stepper.energy(&state)?; // all ranks have it
//! if let Some((q, momenta)) = stepper.gather(&state)? {
//!     println!("{energy} J, {} sites", q.len()); // rank 0 alone
//! }
//! # Ok(())
//! # }
//! ```
//!
//! * All ranks call the functions of this crate, in the same order. Errors are the same on all of them.
//! * MPI itself ends the program where a message fails, as it does by default.
//! * Drop the steppers before the `Universe`: declare it first.
//! * `runtime/mpi/check` compares 1, 2 and 4 ranks with one process, bit for bit, and prints their scaling.

#![forbid(unsafe_code)]

mod error;
mod numbers;
mod part;
mod ranks;
mod stepper;

pub use clebsch;
pub use error::Error;
pub use mpi;
pub use part::{Part, slab};
pub use stepper::{Gathered, PartState, PartStepper};
