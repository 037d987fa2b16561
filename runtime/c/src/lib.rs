//! Steppers of `clebsch` for programs in C: functions over plain structs, without allocation, and the header that declares them.
//!
//! [`export!`] names a struct with `#[derive(Clebsch)]`, its name in C, and its fields:
//!
//! ```
//! use clebsch::Clebsch;
//! use nalgebra::{Matrix3, Vector3};
//!
//! #[derive(Clebsch, Clone, Debug)]
//! #[clebsch(
//!     action    = |F: SO<3>, R: SO<3>| R * F,
//!     cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
//!     potential = |R| self.weight * (R * self.center).z,
//! )]
//! pub struct HeavyTop {
//!     pub mass_matrix: Matrix3<f64>,
//!     pub weight: f64,
//!     pub center: Vector3<f64>,
//! }
//!
//! clebsch_c::export!(heavy_top: HeavyTop { mass_matrix: Matrix3<f64>, weight: f64, center: Vector3<f64> });
//!
//! // a program of one line prints the header
//! fn main() {
//!     print!("{}", heavy_top::HEADER);
//! #   let header = heavy_top::HEADER.to_string();
//! #   assert!(header.contains("double mass_matrix[3][3];"));
//! #   assert!(header.contains("int32_t heavy_top_step(const heavy_top_stepper *stepper, heavy_top_state *state);"));
//! }
//! ```
//!
//! The functions of C are those of a [`Stepper`](clebsch::Stepper): `heavy_top_make`, `heavy_top_start`, `heavy_top_step`,
//! `heavy_top_step_with`, `heavy_top_advance`, `heavy_top_kick`, `heavy_top_read`, `heavy_top_energy` and `heavy_top_explain`.
//! Each takes pointers to memory of the caller and returns a [`Status`]. Nothing allocates, and after an error the state is unchanged.
//!
//! A state in C is the struct `heavy_top_numbers`: arrays with the names and the order of
//! [`Stepper::table`](clebsch::Stepper::table). `heavy_top_stepper` and `heavy_top_state` are bytes that only the functions read.
//! Their size is that of the target that the header was made for. `make` and `start` check it.
//!
//! The exported names are the only unsafe code: `#[unsafe(export_name)]`, because two functions of one name would clash. Bodies have none.
#![no_std]

mod header;
mod interface;
mod numbers;
mod status;

pub use header::Header;
pub use interface::{advance, energy, explain, kick, make, read, start, step, step_with, width};
pub use numbers::Real;
pub use status::{Message, Status};
#[doc(hidden)]
pub use {clebsch, core};

/// Exports the stepper of a system to C, in a module with the given name: `export!(name: System { field: Type, … })`.
///
/// All fields of the struct are listed with their types: numbers, vectors, matrices, and arrays of these, in the scalar of the
/// system, `f64` or `f32`. The module has the functions, and the constant `HEADER`, which prints the header.
///
/// `export!(name: System, by Method { field: Type, … })` exports the steppers of a named method of the declaration.
/// Each method has a name of its own in C, so that a program may use several.
///
/// A crate that forbids unsafe code cannot export names: write `deny` in place of `forbid`.
#[macro_export]
macro_rules! export {
    ($(#[$attribute:meta])* $name:ident: $system:ty { $($fields:tt)* }) => {
        $crate::export!(@ $(#[$attribute])* $name: $system, $crate::clebsch::Declared { $($fields)* });
    };
    ($(#[$attribute:meta])* $name:ident: $system:ty, by $method:ty { $($fields:tt)* }) => {
        $crate::export!(@ $(#[$attribute])* $name: $system, $method { $($fields)* });
    };
    (@ $(#[$attribute:meta])* $name:ident: $system:ty, $method:ty { $($field:ident: $type:ty),* $(,)? }) => {
        $(#[$attribute])*
        #[allow(unsafe_code, reason = "exported names")]
        #[allow(improper_ctypes_definitions, reason = "steppers and states are bytes to C")]
        #[allow(unused_imports, reason = "types of fields may be in scope here")]
        pub mod $name {
            use super::*;
            use $crate::clebsch::{Clebsch, Columns, Space};
            use $crate::core::mem::MaybeUninit;
            use $crate::core::option::Option::{self, Some};
            use $crate::core::{concat, primitive, stringify};
            use $crate::{Header, Message, Status};

            type System = $system;
            type Steps = $crate::clebsch::Stepper<System, $method>;
            type Stated = $crate::clebsch::State<System, $method>;
            type Scalar = <System as Clebsch>::Scalar;
            type Parameters = [Scalar; PARAMETERS];
            type Numbers = [Scalar; $crate::width::<System>()];
            type Input = [Scalar; <<System as Clebsch>::Input as Columns<Scalar>>::FORM.width()];
            type Impulse = [Scalar; <<System as Clebsch>::Momentum as Columns<Scalar>>::FORM.width()];

            const PARAMETERS: primitive::usize = 0 $(+ <$type as Columns<Scalar>>::FORM.width())*;

            /// The header that declares these functions in C.
            pub const HEADER: Header = Header::new::<System, $method>(
                stringify!($name),
                &[$((stringify!($field), <$type as Columns<Scalar>>::FORM)),*],
            );

            /// The system with these parameters.
            fn system(parameters: &Parameters) -> Option<System> {
                let mut numbers = parameters.iter().copied();
                let _ = &mut numbers;
                Some(System { $($field: <$type as Space<Scalar>>::from_columns(&mut numbers)?),* })
            }

            /// A stepper with these parameters.
            #[unsafe(export_name = concat!(stringify!($name), "_make"))]
            pub extern "C" fn make(
                stepper: Option<&mut MaybeUninit<Steps>>,
                size: primitive::usize,
                parameters: Option<&Parameters>,
                step_size: Scalar,
            ) -> Status {
                $crate::make(stepper, size, parameters.and_then(system), step_size)
            }

            /// A state with these numbers.
            #[unsafe(export_name = concat!(stringify!($name), "_start"))]
            pub extern "C" fn start(
                stepper: Option<&Steps>,
                state: Option<&mut MaybeUninit<Stated>>,
                size: primitive::usize,
                numbers: Option<&Numbers>,
            ) -> Status {
                $crate::start(stepper, state, size, numbers.map(|numbers| &numbers[..]))
            }

            /// One step, in place.
            #[unsafe(export_name = concat!(stringify!($name), "_step"))]
            pub extern "C" fn step(stepper: Option<&Steps>, state: Option<&mut Stated>) -> Status {
                $crate::step(stepper, state)
            }

            /// One step with an input of the forces, in place.
            #[unsafe(export_name = concat!(stringify!($name), "_step_with"))]
            pub extern "C" fn step_with(
                stepper: Option<&Steps>,
                state: Option<&mut Stated>,
                input: Option<&Input>,
            ) -> Status {
                $crate::step_with(stepper, state, input.map(|input| &input[..]))
            }

            /// So many steps, in place.
            #[unsafe(export_name = concat!(stringify!($name), "_advance"))]
            pub extern "C" fn advance(
                stepper: Option<&Steps>,
                state: Option<&mut Stated>,
                steps: primitive::usize,
            ) -> Status {
                $crate::advance(stepper, state, steps)
            }

            /// An impulse, added to the momentum in place.
            #[unsafe(export_name = concat!(stringify!($name), "_kick"))]
            pub extern "C" fn kick(
                stepper: Option<&Steps>,
                state: Option<&mut Stated>,
                impulse: Option<&Impulse>,
            ) -> Status {
                $crate::kick(stepper, state, impulse.map(|impulse| &impulse[..]))
            }

            /// The numbers of a state.
            #[unsafe(export_name = concat!(stringify!($name), "_read"))]
            pub extern "C" fn read(state: Option<&Stated>, numbers: Option<&mut Numbers>) -> Status {
                $crate::read(state, numbers.map(|numbers| &mut numbers[..]))
            }

            /// The energy of a state.
            #[unsafe(export_name = concat!(stringify!($name), "_energy"))]
            pub extern "C" fn energy(
                stepper: Option<&Steps>,
                state: Option<&Stated>,
                energy: Option<&mut Scalar>,
            ) -> Status {
                $crate::energy(stepper, state, energy)
            }

            /// The first error of a stepper with these parameters, of a state of these numbers, and of a step with this input, in words.
            #[unsafe(export_name = concat!(stringify!($name), "_explain"))]
            pub extern "C" fn explain(
                parameters: Option<&Parameters>,
                step_size: Scalar,
                numbers: Option<&Numbers>,
                input: Option<&Input>,
                message: Option<&mut Message>,
            ) -> Status {
                let numbers = numbers.map(|numbers| &numbers[..]);
                $crate::explain::<System, $method>(parameters.and_then(system), step_size, numbers, input.map(|input| &input[..]), message)
            }
        }
    };
}
