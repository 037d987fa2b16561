//! Plots of motions that [`clebsch`] integrates, as SVG, and pages that play them: each in about three lines.
//!
//! Names and units are those of the declaration and of its table.
//!
//! | to see | call |
//! |---|---|
//! | the path of an axis or of a bob on its sphere | [`sphere`] |
//! | configuration, momentum, energy and values of your own in time | [`quantities`] |
//! | how far energy and conserved momenta move, next to the law of rounding | [`drift`] |
//! | the price of accuracy of the methods of a declaration | [`work_precision`] |
//! | the motion itself: a page that plays bodies, points and frames, to turn and to stop | [`Motion`] |
//! | pictures of your own, from the same parts | [`figure`](mod@figure) |
//!
//! ```
//! use clebsch::Clebsch;
//! use nalgebra::{Matrix3, Vector3};
//!
//! /// A rigid body turning about a fixed pivot in uniform gravity.
//! #[derive(Clebsch, Clone, Debug)]
//! #[clebsch(
//!     action     = |F: SO<3>, R: SO<3>| R * F,
//!     lagrangian = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
//!     potential  = |R| self.weight * R[(2, 2)],
//! )]
//! struct Top {
//!     /// Principal moments of inertia, kg·m².
//!     moments: Vector3<f64>,
//!     /// Weight times the distance from the pivot to the centre of mass, N·m.
//!     weight: f64,
//! }
//!
//! let stepper = Top { moments: Vector3::new(1.0, 1.0, 0.5), weight: 1.0 }.into_stepper(0.01)?;
//! let start = stepper.state(Matrix3::identity(), Vector3::new(0.3, 0.0, 2.0))?;
//! let states = stepper.trajectory(start).every(0.05).with_times().take(1000);
//! # let folder = std::env::temp_dir().join(format!("clebsch-plot-{}", std::process::id()));
//! # let file = |name: &str| folder.join(name);
//!
//! clebsch_plot::sphere(states.clone(), |(_, state)| state.configuration().column(2).into_owned())?.save(file("axis.svg"))?;
//! clebsch_plot::quantities(stepper.table().energy().units(&[("t", "s")]), states.clone())?.save(file("top.svg"))?;
//! clebsch_plot::drift(stepper.table().energy().conserved(), states)?.save(file("drift.svg"))?;
//! # std::fs::remove_dir_all(folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Nothing here panics: a number that is not finite, a step that failed and an empty motion are each a [`PlotError`].

mod drift;
mod error;
pub mod figure;
mod picture;
mod play;
mod point;
mod quantities;
mod rows;
mod sphere;
#[cfg(test)]
mod tests;
mod thin;
mod work_precision;

pub use drift::{Drift, drift};
pub use error::PlotError;
pub use play::{Motion, Pose, Shape};
pub use point::Point;
pub use quantities::{Quantities, quantities};
pub use sphere::{Sphere, sphere};
pub use work_precision::{Study, WorkPrecision, work_precision};
