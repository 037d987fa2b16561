//! Integrators that keep the structure of a mechanical system, derived at compile time from its declaration.
#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[cfg(any(feature = "std", test))]
extern crate std;

#[doc(hidden)]
pub mod __private;
mod error;
pub mod group;
pub mod implicit;
mod linear;
mod orbit;
mod parameters;
mod scalar;
mod space;
mod state;
mod stepper;
mod system;
mod trajectory;

pub use clebsch_macros::Clebsch;
pub use error::Error;
pub use nalgebra;
pub use scalar::Scalar;
pub use space::Space;
pub use state::{CotangentState, State};
pub use stepper::Stepper;
pub use system::Clebsch;
pub use trajectory::Trajectory;
