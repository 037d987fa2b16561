//! A declaration, as its library shows it.

use crate::classes::{PyLibrary, PyState, PyStepper};
use crate::engine::{Driven, Engine, Momenta, scalars};
use crate::failure::Failure;
use crate::layout::Layout;
use clebsch::{Clebsch, Columns, Conserves, Method, Real, SavedState, Scalar, State, Stepper};
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::marker::PhantomData;

/// A declaration, as its library shows it; [`library!`](crate::library) implements it.
pub trait Library: Send + Sync {
    /// The names and the shapes of its numbers.
    fn layout(&self) -> Layout;

    /// The stepper of a system with these parameters, by the declared dials or by a method.
    ///
    /// # Errors
    /// [`Failure::Count`], [`Failure::NoMethod`]; [`Failure::Refused`] with a `ParameterError`.
    fn stepper(&self, parameters: &[f64], step_size: f64, method: Option<&str>) -> Result<Box<dyn Engine>, Failure>;
}

/// A system as a type, to ask it for its conserved momenta.
pub struct Of<S>(PhantomData<S>);

impl<S> Of<S> {
    /// The system.
    pub const NEW: Self = Self(PhantomData);
}

/// The conserved momenta of a system that has some. A call by `(&Of::<S>::NEW).names()` takes this trait where it is implemented.
pub trait WithConserved<S: Clebsch> {
    /// Their names.
    fn names(&self) -> &'static [&'static str];
    /// Writes their values.
    fn momenta<M: Method<S>>(&self, stepper: &Stepper<S, M>, state: &State<S, M>, into: &mut [f64]);
}

impl<S: Conserves<Scalar: Real>> WithConserved<S> for Of<S> {
    fn names(&self) -> &'static [&'static str] {
        S::CONSERVED_NAMES
    }

    fn momenta<M: Method<S>>(&self, stepper: &Stepper<S, M>, state: &State<S, M>, into: &mut [f64]) {
        let values: S::Conserved = stepper.conserved(state);
        let values = (0..).map_while(|k| values.entry(k));
        into.iter_mut().zip(values).for_each(|(place, value)| *place = value.to_f64());
    }
}

/// The conserved momenta of a system without any.
pub trait WithoutConserved<S: Clebsch> {
    /// No names.
    fn names(&self) -> &'static [&'static str] {
        &[]
    }
    /// Writes no values.
    fn momenta<M: Method<S>>(&self, _: &Stepper<S, M>, _: &State<S, M>, _: &mut [f64]) {}
}

impl<S: Clebsch> WithoutConserved<S> for &Of<S> {}

/// The engine of a system.
///
/// # Errors
/// [`Failure::Refused`] with a `ParameterError`.
pub fn engine<S, M>(
    system: S,
    step_size: f64,
    momenta: Momenta<S, M>,
    conserved: usize,
) -> Result<Box<dyn Engine>, Failure>
where
    S: Clebsch<Scalar: Real> + 'static,
    M: Method<S> + 'static,
    Stepper<S, M>: Send + Sync,
    State<S, M>: Send + Sync + Serialize,
    SavedState<S, M>: DeserializeOwned,
{
    let stepper = system.into_stepper_by::<M>(S::Scalar::from_f64(step_size));
    let stepper = stepper.map_err(Failure::refused("ParameterError"))?;
    Ok(Box::new(Driven::new(stepper, momenta, conserved)))
}

/// The parameters one after the other, as many as there are.
///
/// # Errors
/// [`Failure::Count`].
pub fn parameters<T: Scalar>(numbers: &[f64], needed: usize) -> Result<impl Iterator<Item = T> + '_, Failure> {
    let given = numbers.len();
    if given == needed { Ok(scalars(numbers)) } else { Err(Failure::Count { name: "the system", given, needed }) }
}

/// Puts a declaration and its classes into the module of Python.
///
/// # Errors
/// Those of Python.
pub fn fill(module: &Bound<'_, PyModule>, library: impl Library + 'static) -> PyResult<()> {
    module.add_class::<PyStepper>()?;
    module.add_class::<PyState>()?;
    module.add("library", PyLibrary::new(library))?;
    module.add_function(wrap_pyfunction!(crate::ensemble::run_all, module)?)
}
