//! Why a picture or a page could not be made.

use std::error::Error as StdError;
use std::fmt::{self, Display, Formatter};
use std::io;
use std::path::PathBuf;

/// Why a picture or a page could not be made. Nothing was written.
///
/// ```
/// use clebsch_plot::{PlotError, Sphere};
/// use nalgebra::Vector3;
///
/// let points = [Vector3::x(), Vector3::new(0.0, f64::NAN, 1.0)];
/// let error = Sphere::new().path("axis", points).unwrap_err();
/// assert!(matches!(&error, PlotError::NotFinite { name, index: 1 } if name == "axis"));
/// assert!(Sphere::new().svg().unwrap_err().to_string().starts_with("there is nothing to draw"));
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub enum PlotError {
    /// There is no state, no point or no curve.
    Nothing,
    /// A number is NaN or infinite.
    NotFinite {
        /// The column, the path or the body.
        name: String,
        /// The state or the point, counted from 0.
        index: usize,
    },
    /// A point of a path on a sphere is the origin, which has no direction.
    NoDirection {
        /// The path.
        name: String,
        /// The point, counted from 0.
        index: usize,
    },
    /// A name is not that of a value of the table.
    UnknownName {
        /// The name that was given.
        name: String,
        /// Those of the table.
        known: Vec<String>,
    },
    /// A state could not be reached.
    Step {
        /// The states before it.
        index: usize,
        /// Why.
        error: clebsch::Error,
    },
    /// A time does not come after the one before it.
    TimeOrder {
        /// The state, counted from 0.
        index: usize,
    },
    /// A body has a side that is negative or not finite, or no side above zero. Moments of inertia may say so too: none is
    /// more than the sum of the other two.
    NoBody {
        /// Its name.
        name: String,
    },
    /// A method has no run: each of its step sizes was refused.
    NoRun {
        /// The label of the method.
        label: String,
        /// Why the shortest step was refused.
        error: clebsch::Error,
    },
    /// A duration or a count that cannot be: it is zero, negative or not finite.
    Range {
        /// Its name.
        name: &'static str,
        /// The number.
        value: f64,
    },
    /// The backend of the drawing failed.
    Drawing(String),
    /// The file could not be written.
    File {
        /// Where.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
}

impl Display for PlotError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => f.write_str("there is nothing to draw: give at least one state, point or curve"),
            Self::NotFinite { name, index } => {
                write!(f, "`{name}` is not finite at state {index} (the first is 0): look for NaN or overflow there")
            }
            Self::NoDirection { name, index } => {
                write!(f, "point {index} of `{name}` is the origin, which lies on no sphere")
            }
            Self::UnknownName { name, known } => {
                write!(f, "no value is called `{name}`; those of the table are `{}`", known.join("`, `"))
            }
            Self::Step { index, error } => write!(f, "state {index} (the first is 0) was not reached: {error}"),
            Self::TimeOrder { index } => {
                write!(f, "the time of state {index} (the first is 0) does not come after the one before")
            }
            Self::NoBody { name } => write!(
                f,
                "`{name}` has no shape: sides are finite and not negative, and no moment of inertia is more than the sum of the others"
            ),
            Self::NoRun { label, error } => write!(f, "`{label}` has no run with any of the step sizes: {error}"),
            Self::Range { name, value } => write!(f, "the {name} is {value}: it must be above zero, and finite"),
            Self::Drawing(text) => write!(f, "the picture cannot be drawn: {text}"),
            Self::File { path, error } => write!(f, "cannot write {}: {error}", path.display()),
        }
    }
}

impl StdError for PlotError {
    fn source(&self) -> Option<&(dyn StdError + 'static)> {
        match self {
            Self::Step { error, .. } | Self::NoRun { error, .. } => Some(error),
            Self::File { error, .. } => Some(error),
            _ => None,
        }
    }
}

/// For `map_err` on a state that could not be reached.
pub(crate) fn at_step(index: usize) -> impl Fn(clebsch::Error) -> PlotError {
    move |error| PlotError::Step { index, error }
}

/// The same numbers, if all of them are finite.
pub(crate) fn finite<const N: usize>(numbers: [f64; N], name: &str, index: usize) -> Result<[f64; N], PlotError> {
    if numbers.iter().all(|number| number.is_finite()) {
        Ok(numbers)
    } else {
        Err(PlotError::NotFinite { name: name.to_owned(), index })
    }
}
