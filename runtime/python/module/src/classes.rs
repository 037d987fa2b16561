//! The classes of Python. Numbers go in and out as bytes of `f64`, which NumPy reads without a copy.

use crate::engine::{Engine, Point};
use crate::failure::Failure;
use crate::layout::{Layout, Quantity};
use crate::library::Library;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyDict};
use std::cell::Cell;
use std::time::{Duration, Instant};

/// Between two looks at the user's interrupt.
pub(crate) const LOOK: Duration = Duration::from_millis(50);

/// Numbers from their bytes.
pub(crate) fn numbers(bytes: &[u8]) -> Vec<f64> {
    let eight = bytes.chunks_exact(8).filter_map(|eight| eight.try_into().ok());
    eight.map(f64::from_ne_bytes).collect()
}

/// The bytes of numbers.
pub(crate) fn bytes<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyByteArray>> {
    PyByteArray::new_with(py, 8 * numbers.len(), |bytes| {
        bytes.chunks_exact_mut(8).zip(numbers).for_each(|(eight, number)| eight.copy_from_slice(&number.to_ne_bytes()));
        Ok(())
    })
}

/// A value, or its exception.
pub(crate) fn raised<T>(py: Python<'_>, result: Result<T, Failure>) -> PyResult<T> {
    result.map_err(|failure| failure.raise(py))
}

/// Answers whether the user has not interrupted, from the thread of the interpreter. Asks the interpreter now and then only.
pub(crate) fn watch() -> impl Fn() -> bool {
    let last = Cell::new(Instant::now());
    move || {
        if last.get().elapsed() < LOOK {
            return true;
        }
        last.set(Instant::now());
        Python::attach(|py| match py.check_signals() {
            Ok(()) => true,
            Err(interrupt) => {
                interrupt.restore(py);
                false
            }
        })
    }
}

/// A state.
#[pyclass(frozen, name = "State")]
pub struct PyState {
    pub(crate) point: Point,
}

impl PyState {
    pub(crate) fn new(point: Point) -> Self {
        Self { point }
    }
}

/// A system with a step size.
#[pyclass(frozen, name = "Stepper")]
pub struct PyStepper {
    pub(crate) engine: Box<dyn Engine>,
}

#[pymethods]
impl PyStepper {
    /// The state with these numbers, or the nearest one.
    fn state(&self, py: Python<'_>, row: &[u8], nearest: bool) -> PyResult<PyState> {
        raised(py, self.engine.start(&numbers(row), nearest).map(PyState::new))
    }

    /// One step.
    #[pyo3(signature = (state, input=None))]
    fn step(&self, py: Python<'_>, state: &PyState, input: Option<&[u8]>) -> PyResult<PyState> {
        let input = input.map(numbers);
        raised(py, self.engine.step(&state.point, input.as_deref()).map(PyState::new))
    }

    /// So many steps.
    fn advance(&self, py: Python<'_>, state: &PyState, steps: u64) -> PyResult<PyState> {
        let advanced = py.detach(|| self.engine.advance(&state.point, steps, &watch()));
        raised(py, advanced.map(PyState::new))
    }

    /// The rows at these times, and the state at the last one.
    fn run<'py>(&self, py: Python<'py>, state: &PyState, times: &[u8]) -> PyResult<(Bound<'py, PyByteArray>, PyState)> {
        let times = numbers(times);
        let mut rows = vec![0.0; times.len() * self.engine.width()];
        let end = py.detach(|| self.engine.run(&state.point, &times, &mut rows, &watch()));
        let end = raised(py, end)?;
        Ok((bytes(py, &rows)?, PyState::new(end)))
    }

    /// An impulse, added to the momentum.
    fn kick(&self, py: Python<'_>, state: &PyState, impulse: &[u8]) -> PyResult<PyState> {
        raised(py, self.engine.kick(&state.point, &numbers(impulse)).map(PyState::new))
    }

    /// The row of a state.
    fn row<'py>(&self, py: Python<'py>, state: &PyState) -> PyResult<Bound<'py, PyByteArray>> {
        bytes(py, &raised(py, self.engine.row(&state.point))?)
    }

    /// The state as bytes.
    fn save<'py>(&self, py: Python<'py>, state: &PyState) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &raised(py, self.engine.save(&state.point))?))
    }

    /// The state of these bytes.
    fn resume(&self, py: Python<'_>, bytes: &[u8]) -> PyResult<PyState> {
        raised(py, self.engine.resume(bytes).map(PyState::new))
    }
}

/// A declaration.
#[pyclass(frozen, name = "Library")]
pub struct PyLibrary {
    library: Box<dyn Library>,
}

impl PyLibrary {
    pub(crate) fn new(library: impl Library + 'static) -> Self {
        Self { library: Box::new(library) }
    }
}

#[pymethods]
impl PyLibrary {
    /// The names and the shapes of its numbers.
    fn layout<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Layout {
            name,
            derivation,
            order,
            is_timed,
            parameters,
            configuration,
            momentum,
            input,
            conserved,
            methods,
        } = self.library.layout();
        let pairs = |all: Vec<Quantity>| all.into_iter().map(|one| (one.name, one.shape)).collect::<Vec<_>>();
        let layout = PyDict::new(py);
        layout.set_item("name", name)?;
        layout.set_item("derivation", derivation)?;
        layout.set_item("order", order)?;
        layout.set_item("is_timed", is_timed)?;
        layout.set_item("parameters", pairs(parameters))?;
        layout.set_item("configuration", pairs(configuration))?;
        layout.set_item("momentum", pairs(vec![momentum]))?;
        layout.set_item("input", pairs(vec![input]))?;
        layout.set_item("conserved", conserved)?;
        layout.set_item("methods", methods)?;
        Ok(layout)
    }

    /// The stepper of a system with these parameters.
    #[pyo3(signature = (parameters, step_size, method=None))]
    fn stepper(&self, py: Python<'_>, parameters: &[u8], step_size: f64, method: Option<&str>) -> PyResult<PyStepper> {
        let engine = self.library.stepper(&numbers(parameters), step_size, method);
        Ok(PyStepper { engine: raised(py, engine)? })
    }
}
