//! Why something cannot be done, as an exception of Python.

use crate::Point;
use crate::classes::PyState;
use clebsch::Error;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// Why something cannot be done.
pub enum Failure {
    /// A system, a state or an impulse is refused.
    Refused {
        /// The name of its exception in `clebsch.errors`.
        exception: &'static str,
        /// The cause.
        error: Error,
    },
    /// A step has no solution.
    Stopped {
        /// The cause.
        error: Error,
        /// The last good state.
        point: Point,
        /// The number of steps, or of times, before it.
        done: u64,
        /// What is counted.
        unit: &'static str,
    },
    /// A value has another number of numbers.
    Count {
        /// The name of the value.
        name: &'static str,
        /// How many it has.
        given: usize,
        /// How many it needs.
        needed: usize,
    },
    /// There is no method of this name.
    NoMethod {
        /// The name.
        name: String,
    },
    /// The state is one of another declaration or method.
    Foreign,
    /// The bytes are no saved state of this system.
    Saved {
        /// What the reader says.
        reason: String,
    },
    /// The user interrupted it.
    Interrupted,
}

impl Failure {
    /// A system, a state or an impulse is refused.
    pub fn refused(exception: &'static str) -> impl Fn(Error) -> Self {
        move |error| Self::Refused { exception, error }
    }

    /// The exception.
    pub fn raise(self, py: Python<'_>) -> PyErr {
        match self {
            Self::Refused { exception, error } => exception_of(py, exception, (error.to_string(), kind(&error))),
            Self::Stopped { error, point, done, unit } => {
                let text = format!("after {done} {unit}: {error}");
                exception_of(py, "SolveError", (text, kind(&error), PyState::new(point), done))
            }
            Self::Count { name, given, needed } => {
                PyValueError::new_err(format!("{name} has {given} numbers, and {needed} are needed"))
            }
            Self::NoMethod { name } => PyValueError::new_err(format!("the declaration has no method `{name}`")),
            Self::Foreign => PyTypeError::new_err("this state belongs to another declaration or to another method"),
            Self::Saved { reason } => {
                PyValueError::new_err(format!("the bytes are no saved state of this system: {reason}"))
            }
            Self::Interrupted => {
                PyErr::take(py).unwrap_or_else(|| pyo3::exceptions::PyKeyboardInterrupt::new_err("interrupted"))
            }
        }
    }
}

/// The name of the variant of an error.
fn kind(error: &Error) -> String {
    let text = format!("{error:?}");
    text.split([' ', '{', '(']).next().unwrap_or_default().to_owned()
}

/// An exception of the module `clebsch.errors`.
fn exception_of<'py>(py: Python<'py>, name: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let made = py.import("clebsch.errors").and_then(|errors| errors.getattr(name)?.call1(arguments));
    made.map_or_else(|error| error, PyErr::from_value)
}
