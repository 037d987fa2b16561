//! Integrators that keep the structure of a mechanical system, derived at compile time from its declaration.
//!
//! A rigid body turning freely, from its inertia tensor:
//!
//! ```
//! use clebsch::Clebsch;
//! use nalgebra::{Matrix3, Vector3};
//!
//! #[derive(Clebsch, Clone, Debug)]
//! #[clebsch(
//!     action         = |F: SO<3>, R: SO<3>| R * F,
//!     lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
//!     discretization = moser_veselov,
//! )]
//! pub struct RigidBody {
//!     /// Inertia tensor about the centre of mass, body frame, kg·m².
//!     #[clebsch(symmetric)]
//!     pub inertia: Matrix3<f64>,
//! }
//!
//! let body = RigidBody { inertia: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)) };
//! let stepper = body.stepper(0.01)?;
//! let start = stepper.state(Matrix3::identity(), Vector3::new(0.1, 2.0, 0.1))?;
//! for state in stepper.trajectory(start).take(1000) {
//!     let state = state?;
//!     println!("{} {}", state.configuration(), state.momentum());
//! }
//! # Ok::<(), clebsch::Error>(())
//! ```
//!
//! The attitude stays a rotation. The spatial momentum `R * π` and the energy are constant to round-off, for any number
//! of steps. The step is the exact motion of a discrete mechanical system, not an approximation that drifts.
//!
//! # What is where
//!
//! | to | see |
//! |---|---|
//! | write a declaration | the derive macro [`Clebsch`](derive@Clebsch): every key, value, group, field attribute and function |
//! | read the formulas of a declaration | the trait [`Clebsch`](trait@Clebsch), one method for each derived formula |
//! | integrate | [`Stepper`] is a system with its step size; it steps a [`State`], and [`Trajectory`] iterates |
//! | step one system in several ways | [`Clebsch::stepper_by`] and [`Method`]; [`Stepper::state_of`] takes a state over from one to another |
//! | step a state in place | the trait [`Drive`], one set of words for all that has a state of its own |
//! | step a large state in place, on the heap if you like | [`Stepper::integrator`]; [`Integrator`], in a `Box` |
//! | hit a body, or correct its place | [`Stepper::kick`], [`Stepper::with_configuration`] |
//! | make a step of another size | [`Stepper::step_for`], [`Stepper::with_step_size`] |
//! | have states at times of your own | [`Trajectory::at`], [`Trajectory::every`]; [`Timed`] |
//! | find when a function of the state crosses zero, and go on, stop or kick | [`Trajectory::events`]; [`Crossing`], [`Event`] |
//! | have the numbers of a state with their names | [`Stepper::table`]; [`Table`], [`Column`] |
//! | write states to a file, as CSV or for NumPy | the module `record`, with the feature of this name |
//! | watch and cancel a long run | [`Drive::advance_watched`]; [`Stepper::advance_or_stop`] and [`Stopped`] |
//! | choose the step size for an error | [`Stepper::suggest_step_size`] |
//! | know the quantities that no step changes | [`Stepper::conserved`], which exists where conserved momenta were found; [`Conserved`] |
//! | step the momentum without its configuration | `emit = [momentum]`: a [`Clebsch::Configuration`] of `()` |
//! | read steps of `order = 1` to second order | [`Stepper::synchronized`], started by [`Stepper::staggered_state`] |
//! | follow a potential in time | [`Stepper::state_at`] and [`State::time`], which exist where the time matters |
//! | work on the cotangent bundle | [`CotangentState`] and [`Stepper::step_symmetric`] |
//! | differentiate a step | [`Stepper::step_tangent`] and [`Stepper::step_sensitivity`], with `emit = [tangent]`; [`Tangent`] |
//! | know the basis of a momentum | [`group`]: matrices, basis, pairing and signs |
//! | handle failures | [`Error`]: each kind with its numbers and the change that helps |
//! | go from here to there in a given time | [`Stepper::boundary`], with `emit = [boundary]`; [`Extremal`] |
//! | give each step an input of its forces | [`Stepper::step_with`], [`Trajectory::forced_by`] |
//! | choose the inputs at the least price, within bounds | [`Controlled::control`], with `controls`, `dynamics` or `effort`; [`Control::solve`], [`Optimum`] and its [`Stage`]s |
//! | estimate a motion from measurements, and its covariance | [`Control::with_prior`], [`Control::slide`], [`Prior`] |
//! | choose them anew at each step, in bounded time | [`Control::solve_within`], [`Control::shift`] |
//! | solve an implicit equation of one's own | [`implicit`] |
//! | integrate in another number type | [`Scalar`], and [`Space`] for collections of scalars; [`Real`] for a scalar that has an order |
//! | step many bodies at once | [many bodies](crate#many-bodies), on lanes and on all cores |
//! | step N equal sites that are tied to each other | a const generic N: an array of sites is a system, [`Stepper::sites`] or [`Stepper::joined_sites`] steps them in [`SiteStorage`]; the macro derives [`Power`] |
//! | step a field, the same site at each place of a grid or a mesh | the key `space`; [`Field::grid`] gives a [`Domain`], whose [`FieldStepper`] steps a [`FieldState`] |
//! | step some rows of a field, the others elsewhere | [`Domain::slab`] gives a [`Slab`]; [`FieldStepper::advance_exchanging`] |
//! | choose a stable step of a field | [`Domain::stable_step`] and [`FieldStepper::suggest_step_size`] |
//! | step a stiff field along a line with long implicit steps | `emit = [midpoint]`; [`MidpointSite`], `Domain::midpoint` |
//! | step the elements of edges in place of configurations | `emit = [connection]`; [`ConnectedField`], `Domain::connection` |
//! | find where a field without a cost rests | [`Domain::relax`]; [`Relaxation`] and [`Relaxed`], `Multigrid` on grids |
//!
//! # Features
//!
//! All but `roots` are off by default. Only `std` changes results that exist without it.
//!
//! | feature | gives |
//! |---|---|
//! | `roots` (default) | square roots by the processor's instruction, the same bits as those of `libm`; needs the standard library. `default-features = false` is `no_std` |
//! | `std` | elementary functions of the standard library in place of `libm`: those of the platform, [see below](crate#the-same-bits-everywhere) |
//! | `lanes` | `F64x4`, `F64x8` and `F32x8`: several bodies side by side in vector registers, `no_std` and without heap |
//! | `alloc` | on the heap: `Ensemble`, many bodies; `Mesh`, `Multigrid`, and sites of a field with parameters of their own |
//! | `rayon` | `Ensemble::par_advance` and `FieldStepper::par_advance`, on all cores; needs the standard library |
//! | `num-dual` | the numbers of that crate as scalars, which carry derivatives; needs the standard library |
//! | `double-double` | `DoubleDouble`: 31 digits for reference runs |
//! | `generated` | the dial `emit = [generated]`: the constant `GENERATED`, the generated code as text |
//! | `record` | the module `record`: tables of states in files, CSV and NumPy; needs the standard library. The crate `clebsch-plot` draws such tables, without the feature |
//! | `serde` | states that are written and read back; `Stepper::resume` and `FieldStepper::resume` go on bit for bit, if the format keeps all digits (`serde_json` with `float_roundtrip`) |
//!
//! # Where dials end
//!
//! Every dial has an end, such as h|ω| = 1 for `discretization = moser_veselov`. Beyond it a step is [`Error::Unsolvable`], which gives the longest
//! one, or energies grow. `docs/book/src/evidence/extremes.md` of the repository has the table of all dials, measured.
//!
//! The work of a step is bounded. Newton's method takes at most 12 linearisations; with `solver = fixed_point` at most
//! 32 residuals come before them. If these do not decide, at most [`implicit::LINEARIZATIONS`] more follow along the
//! path from the identity. The last point of this path may take four more. With `order = 16` a step takes at most 64
//! sweeps.
//!
//! # Many bodies
//!
//! A declaration over `T: Scalar` runs on lanes: with `F64x8` for `T` a [`State`] holds eight bodies, and a step makes
//! the step of each. Lanes are independent. Each has, bit for bit, the result that it would have alone. It does not
//! matter how many iterations the others need, or whether they fail. [`Stepper::step`] asks for all lanes to succeed,
//! [`Stepper::step_each`] steps those that can be, and [`Stepper::failure`] says why another cannot. Parameters and
//! step sizes are lanes too, so that each body can have its own.
//!
//! `Ensemble` does this for any number of bodies. Build for the instruction set of the machine, by
//! `RUSTFLAGS="-C target-cpu=native"`. Otherwise the registers are those of the oldest processor of the architecture,
//! and lanes gain little.
//!
//! # What holds everywhere
//!
//! * Momenta are components in a documented basis; those of a right action (`R * F`) are in the body frame.
//! * A step changes nothing but its result: after an [`Error`] the state that was passed in is still good.
//! * Nothing allocates and no input makes it panic.
//! * Every number in an `Ok` is finite. A number that is not finite, and an overflow, is an error that names the
//!   quantity. Formulas without a [`Result`] are evaluated as they stand: [`Stepper::energy`], [`Stepper::legendre`],
//!   [`Stepper::momentum_map`], [`Stepper::synchronized`] and the methods of the trait [`Clebsch`]. They return NaN for
//!   NaN, and infinity or NaN after an overflow.
//!
//! # The same bits everywhere
//!
//! Without the feature `std` (the default) a run uses only additions, multiplications, divisions and square roots of
//! IEEE 754 of the platform. Elementary functions are those of `libm`. So it has the same bits on every processor and
//! operating system, in debug and in release builds, in lanes and alone. `runtime/tests/platforms.rs` pins them, on
//! x86-64, aarch64, i686 and the big-endian s390x.
//!
//! With `std`, sines, exponentials, logarithms, powers and the like are those of the platform's mathematical library.
//! They differ in their last place between platforms, and between releases of one. So does every step whose declaration
//! or discretization uses such functions. Steps without them, such as those of tops by a cost with (F − I), stay the
//! same.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(clippy::needless_range_loop, reason = "indices show an algorithm and, below constant bounds, cost no checks")]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(any(feature = "roots", feature = "record", test))]
extern crate std;

// first, as its page shows methods in the order of modules
mod stepper;

#[doc(hidden)]
pub mod __private;
mod boundary;
mod cofactors;
mod collocation;
mod columns;
mod conserved;
mod constraint;
mod control;
mod controlled;
mod definite;
#[cfg(feature = "double-double")]
mod double_double;
mod drive;
#[cfg(feature = "num-dual")]
mod dual;
mod element;
mod energy;
mod error;
mod exponential;
mod field;
mod fields;
mod free_rotation;
mod free_rotation_4d;
pub mod group;
pub mod implicit;
mod joints;
#[cfg(feature = "lanes")]
mod lanes;
mod linear;
mod logarithm;
mod matrices;
mod method;
mod newton;
mod opaque;
mod orbit;
mod orientation;
mod parameters;
mod parts;
mod power;
#[cfg(feature = "record")]
pub mod record;
mod root;
mod rotation;
mod rotation_4d;
#[cfg(test)]
mod runner;
#[cfg(feature = "serde")]
mod saved;
mod scalar;
mod scheme;
mod schur;
mod space;
mod sphere;
mod state;
mod steered;
mod stumpff;
mod sums;
mod sylvester;
mod system;
mod table;
mod tangent;
mod time;
mod trajectory;
mod variational;

pub use boundary::{Boundary, Extremal, Guess, Node, States, Way};
pub use clebsch_macros::Clebsch;
pub use columns::{Column, Columns, Form, Names};
pub use conserved::{Conserved, Conserves};
pub use constraint::{Constrained, Reacting};
pub use control::{
    Control, Ended, Estimator, Known, Limits, Optimum, Prior, Referenced, Referring, Stage, Start, Target,
};
pub use controlled::{Arrival, BoundsExpansion, Controlled, EndpointExpansion, Expansion, TargetExpansion};
#[cfg(feature = "double-double")]
pub use double_double::DoubleDouble;
#[cfg(feature = "alloc")]
pub use drive::{Bodies, Ensemble, Failure};
pub use drive::{Drive, Integrator, NoJoints, SiteError, SiteStorage, Sites};
pub use error::Error;
#[cfg(feature = "serde")]
pub use field::SavedField;
pub use field::{
    Alike, ConnectedField, Domain, Field, FieldSite, FieldState, FieldStepper, Grid, Lattice, MidpointSite,
    MovingField, Population, Relaxation, Relaxed, Side, Sides, Slab, StaticField,
};
#[cfg(feature = "alloc")]
pub use field::{
    CellComplex, ConnectionState, ConnectionStepper, Mesh, MidpointState, MidpointStepper, Multigrid, Various,
};
#[cfg(feature = "lanes")]
pub use lanes::{F32x8, F32x8Mask, F64x4, F64x4Mask, F64x8, F64x8Mask};
pub use method::{Declared, Method};
pub use nalgebra;
#[cfg(feature = "num-dual")]
pub use num_dual;
pub use power::Power;
#[cfg(feature = "serde")]
pub use saved::SavedState;
pub use scalar::{Mask, Real, Scalar};
pub use space::Space;
pub use state::{Body, CotangentState, State, Stopped};
pub use stepper::Stepper;
pub use system::Clebsch;
pub use table::{Quantities, Row, Sample, Table};
pub use tangent::{Sensitivity, Tangent, Variation};
pub use time::{Clock, Time};
pub use trajectory::{Crossing, Event, Events, Inputs, InputsBy, Multiples, NoInputs, Timed, Trajectory, WithTimes};
pub use variational::{Carried, Differentiated, Edge, Ends, Momenta, Sensitive, Variational};
