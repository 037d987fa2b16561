//! The library of a declaration as an extension module of Python.
//!
//! The Python package `clebsch` writes a crate for each declaration: its text, and one line of [`library!`]. This crate is what
//! all of them share. It is compiled once, and so are the classes of Python: [`Engine`] hides the types of a system.

mod classes;
mod engine;
mod ensemble;
mod failure;
mod layout;
mod library;
mod run;

pub use engine::{Driven, Engine, Momenta, Point};
pub use failure::Failure;
pub use layout::{Layout, Quantity};
pub use library::{Library, Of, WithConserved, WithoutConserved, engine, fill, parameters};
pub use run::Watch;
#[doc(hidden)]
pub use {clebsch, nalgebra, pyo3};

/// What a declaration finds without a `use` of its own.
pub mod prelude {
    pub use clebsch::{Clebsch, Real, Scalar, Space};
    pub use nalgebra::*;
}

/// Makes the module of Python of a system: `library!(System<f64, 8>, System { field: Type, … }, [Method, …], { type T = f64; const N: usize = 8; });`.
///
/// The last part says what the parameters of the struct are, for the types of its fields. Fields are the parameters: numbers, vectors, matrices, and arrays of these, in the scalar of the system, `f64` or `f32`.
#[macro_export]
macro_rules! library {
    ($system:ty, $name:ident { $($field:ident: $type:ty),* $(,)? }, [$($method:ident),*], { $($generic:item)* }) => {
        #[allow(unused_imports, reason = "types of fields and methods; one of the traits is not needed")]
        mod of_python {
            use super::*;
            use $crate::clebsch::{Clebsch as _, Columns as _, Space as _};
            use $crate::pyo3::prelude::*;
            use $crate::{WithConserved as _, WithoutConserved as _};

            type OwnSystem = $system;
            type OwnScalar = <OwnSystem as $crate::clebsch::Clebsch>::Scalar;

            $($generic)*

            struct Declared;

            impl $crate::Library for Declared {
                fn layout(&self) -> $crate::Layout {
                    let parameters = [
                        $((::core::stringify!($field), <$type as $crate::clebsch::Columns<OwnScalar>>::FORM)),*
                    ];
                    let conserved = (&$crate::Of::<OwnSystem>::NEW).names();
                    $crate::Layout::of::<OwnSystem>(&parameters, conserved, &[$(::core::stringify!($method)),*])
                }

                fn stepper(
                    &self,
                    parameters: &[::core::primitive::f64],
                    step_size: ::core::primitive::f64,
                    method: ::core::option::Option<&::core::primitive::str>,
                ) -> ::core::result::Result<::std::boxed::Box<dyn $crate::Engine>, $crate::Failure> {
                    let needed = 0 $(+ <$type as $crate::clebsch::Columns<OwnScalar>>::FORM.width())*;
                    let mut numbers = $crate::parameters::<OwnScalar>(parameters, needed)?;
                    let few = || $crate::Failure::Count { name: "the system", given: parameters.len(), needed };
                    let _ = (&mut numbers, &few);
                    let system: OwnSystem = $name {
                        $($field: <$type as $crate::clebsch::Space<OwnScalar>>::from_columns(&mut numbers).ok_or_else(few)?),*
                    };
                    let conserved = (&$crate::Of::<OwnSystem>::NEW).names().len();
                    match method {
                        ::core::option::Option::None => $crate::engine::<OwnSystem, $crate::clebsch::Declared>(
                            system,
                            step_size,
                            |stepper, state, into| (&$crate::Of::<OwnSystem>::NEW).momenta(stepper, state, into),
                            conserved,
                        ),
                        $(::core::option::Option::Some(::core::stringify!($method)) => {
                            $crate::engine::<OwnSystem, $method>(
                                system,
                                step_size,
                                |stepper, state, into| (&$crate::Of::<OwnSystem>::NEW).momenta(stepper, state, into),
                                conserved,
                            )
                        })*
                        ::core::option::Option::Some(name) => {
                            ::core::result::Result::Err($crate::Failure::NoMethod { name: name.into() })
                        }
                    }
                }
            }

            #[pymodule]
            #[pyo3(crate = "::clebsch_module::pyo3")]
            fn declaration(contents: &Bound<'_, PyModule>) -> PyResult<()> {
                $crate::fill(contents, Declared)
            }
        }
    };
}
