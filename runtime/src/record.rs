//! Tables of states in files, row after row: as text, and for NumPy. With the feature `record`.
//!
//! ```
//! use clebsch::Clebsch;
//! use clebsch::record::Recorder;
//! # use nalgebra::Vector1;
//! # #[derive(Clebsch, Clone, Debug)]
//! # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
//! # struct Particle { mass: f64 }
//!
//! let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
//! let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
//! # let file = Vec::new();
//! let mut recorder = Recorder::csv(file, stepper.table().energy())?; // a file, or whatever takes bytes
//! recorder.record_all(stepper.trajectory(start).every(0.25).with_times().take(3))?;
//! let text = recorder.finish()?;
//! assert_eq!(text, b"t,x.x,N[0],energy\n0.0,0.0,6.0,9.0\n0.25,0.75,6.0,9.0\n0.5,1.5,6.0,9.0\n");
//! # Ok::<(), clebsch::record::RecordError>(())
//! ```
//!
//! Rows go to the file as they come, through a buffer of fixed size: a run of any length takes no more memory.
//! Numbers are written as `f64`. Those of `DoubleDouble` are rounded to it.

mod archive;
mod checksum;
mod csv;
mod npy;
mod sink;

pub use archive::{Entry, Npz};
pub use csv::Csv;
pub use npy::Npy;

use crate::columns::Names;
use crate::fields::debug_fields;
use crate::table::{Quantities, Sample, Table};
use crate::{Clebsch, Declared, Error, Form, Method, Real, Scalar};
use core::fmt::{self, Debug, Display, Formatter};
use sink::Sink;
use std::io::{self, Seek, Write};
use std::string::{String, ToString};
use std::vec::Vec;

/// Writes states as rows of a file.
///
/// [`csv`](Self::csv) and [`npy`](Self::npy) make one for a file, and [`npz`](Self::npz) for an entry of an archive.
/// [`record`](Self::record) takes a state with its time, and [`record_all`](Self::record_all) an iterator of these.
/// [`finish`](Self::finish) completes the file and tells of errors. A recorder that is dropped completes it too, and ignores them.
///
/// ```
/// use clebsch::Clebsch;
/// use clebsch::record::Recorder;
/// use nalgebra::Vector3;
///
/// /// A pendulum of length one and mass one.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action    = |F: SO<3>, q: Unit<Vector3>| F * q,
///     cost      = |h, F| (F - I).norm_squared() / (4 * h),
///     potential = |q| self.gravity * q.z,
/// )]
/// struct Bob {
///     /// g, m/s².
///     gravity: f64,
/// }
///
/// let stepper = Bob { gravity: 9.81 }.into_stepper(0.01)?;
/// let start = stepper.state(Vector3::x(), Vector3::new(0.0, 0.3, 0.5))?;
/// # let file = std::io::Cursor::new(Vec::new());
/// // let file = std::fs::File::create("bob.npy")?;
/// let mut recorder = Recorder::npy(file, stepper.table().energy().conserved())?;
/// recorder.record_all(stepper.trajectory(start).every(0.1).with_times().take(100))?;
/// assert_eq!(recorder.rows(), 100);
/// recorder.finish()?;
/// # Ok::<(), clebsch::record::RecordError>(())
/// ```
///
/// In Python, `data = numpy.load("bob.npy")` then has `data["q"]` of shape (100, 3), `data["N"]`, `data["t"]` and
/// `data["about e3, spatial"]`.
pub struct Recorder<'a, S: Clebsch, K, L = (), M: Method<S> = Declared> {
    table: Table<'a, S, M, L>,
    sink: K,
    rows: u64,
}

impl<'a, S: Clebsch, W: Write, L: Quantities<S, M>, M: Method<S>> Recorder<'a, S, Csv<W>, L, M> {
    /// Writes text: a line with the names of the columns, then a line of numbers for each state.
    ///
    /// Numbers have as many digits as give the same `f64` when they are read. A name with a comma is quoted, as RFC 4180
    /// says. A unit stands behind its name: `x.x (m)`.
    ///
    /// # Errors
    /// [`RecordError::SameName`], [`RecordError::UnknownName`] and [`RecordError::Io`].
    pub fn csv(writer: W, table: Table<'a, S, M, L>) -> Result<Self, RecordError> {
        check_names(&table)?;
        let mut sink = Csv::new(writer);
        for column in table.columns() {
            let name = column.to_string();
            sink.name(&column.unit().map_or(name.clone(), |unit| std::format!("{name} ({unit})")))?;
        }
        sink.end_row()?;
        Ok(Self { table, sink, rows: 0 })
    }
}

impl<'a, S: Clebsch, W: Write + Seek, L: Quantities<S, M>, M: Method<S>> Recorder<'a, S, Npy<W>, L, M> {
    /// Writes an array of NumPy with one entry for each state. It has a field for each value: `R` has the shape (3, 3).
    ///
    /// The file begins where the writer stands. Its first line has the number of rows, so it is written again at the end.
    ///
    /// # Errors
    /// [`RecordError::SameName`], [`RecordError::UnknownName`] and [`RecordError::Io`].
    ///
    /// Source: NumPy, *A simple file format for NumPy arrays*, NEP 1, versions 1.0 to 3.0.
    pub fn npy(writer: W, table: Table<'a, S, M, L>) -> Result<Self, RecordError> {
        check_names(&table)?;
        let sink = Npy::new(writer, npy::fields(table.quantities()))?;
        Ok(Self { table, sink, rows: 0 })
    }
}

impl<S: Clebsch<Scalar: Real>, K: Sink, L: Quantities<S, M>, M: Method<S>> Recorder<'_, S, K, L, M> {
    /// Writes a row: a state with its time, `(time, state)` or an [`Event`](crate::Event).
    ///
    /// # Errors
    /// [`RecordError::Io`].
    pub fn record(&mut self, sample: impl Sample<S, M>) -> Result<(), RecordError> {
        for value in self.table.row(sample.time(), sample.state()) {
            self.sink.number(value.to_f64())?;
        }
        self.sink.end_row()?;
        self.rows += 1;
        Ok(())
    }

    /// Writes a row for each state of an iterator, such as `trajectory.every(interval).with_times().take(n)`, up to its first error.
    ///
    /// # Errors
    /// [`RecordError::Step`] if a state is an error, after the rows of those before; [`RecordError::Io`].
    pub fn record_all<A: Sample<S, M>>(
        &mut self,
        samples: impl IntoIterator<Item = Result<A, Error>>,
    ) -> Result<(), RecordError> {
        samples.into_iter().try_for_each(|sample| self.record(sample?))
    }

    /// The number of rows so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Makes the file complete as it is, so that others can read it while the run goes on.
    ///
    /// # Errors
    /// [`RecordError::Io`].
    pub fn flush(&mut self) -> Result<(), RecordError> {
        Ok(self.sink.complete()?)
    }

    /// Completes the file, and gives back the writer.
    ///
    /// # Errors
    /// [`RecordError::Io`].
    pub fn finish(self) -> Result<K::Writer, RecordError> {
        Ok(self.sink.finish()?)
    }
}

debug_fields!(Recorder<'_, S, K, L, M> where [S: Clebsch, K: Debug, L: Quantities<S, M>, M: Method<S>]: table, sink, rows);

/// The leaves of a value with their names: parts of a tuple of names are values of their own.
fn each_value(names: Names, form: Form, visit: &mut impl FnMut(&'static str, Form)) {
    match (names, form) {
        (Names::One(name) | Names::Components(name), form) => visit(name, form),
        (Names::Each(names), Form::Tuple(forms)) => {
            names.iter().zip(forms).for_each(|(names, form)| each_value(*names, **form, visit));
        }
        // by construction: names nest as the configuration does
        (Names::Each(_), _) => {}
    }
}

/// No name is there twice, and units are given to values that are there.
fn check_names<S: Clebsch, M: Method<S>, L: Quantities<S, M>>(table: &Table<'_, S, M, L>) -> Result<(), RecordError> {
    let mut names: Vec<&str> = Vec::new();
    let mut same = None;
    for (of_value, form) in table.quantities() {
        each_value(of_value, form, &mut |name, _| {
            if names.contains(&name) {
                same = same.or(Some(name));
            }
            names.push(name);
        });
    }
    if let Some(name) = same {
        return Err(RecordError::SameName { name: name.to_string() });
    }
    match table.given_units().iter().find(|(name, _)| !names.contains(name)) {
        Some((name, _)) => Err(RecordError::UnknownName { name: (*name).to_string() }),
        None => Ok(()),
    }
}

/// Why a file could not be written.
///
/// ```
/// # use clebsch::Clebsch;
/// use clebsch::record::{RecordError, Recorder};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let twice = stepper.table().energy().with("x", |state| state.momentum());
/// let error = Recorder::csv(Vec::new(), twice).unwrap_err();
/// assert!(matches!(&error, RecordError::SameName { name } if name == "x"));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub enum RecordError {
    /// The writer failed.
    Io(io::Error),
    /// A step failed. The rows before it are in the file.
    Step(Error),
    /// Two values of a table, or two entries of an archive, have this name.
    SameName {
        /// The name.
        name: String,
    },
    /// A unit was given to a value that the table does not have.
    UnknownName {
        /// The name.
        name: String,
    },
    /// The name of an entry of an archive has more than 65531 bytes.
    LongName {
        /// Their number.
        bytes: usize,
    },
}

impl Display for RecordError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(f, "the file cannot be written: {error}"),
            Self::Step(error) => write!(f, "a step failed, after the rows before it were written: {error}"),
            Self::SameName { name } => {
                write!(
                    f,
                    "two values are called `{name}`; give yours another name, or rename the argument of the action"
                )
            }
            Self::UnknownName { name } => {
                write!(
                    f,
                    "the table has no value `{name}` to give a unit to; units go by the names of values, such as `x` or `N`"
                )
            }
            Self::LongName { bytes } => {
                write!(f, "the name of an entry has {bytes} bytes, and an archive takes at most 65531; shorten it")
            }
        }
    }
}

impl std::error::Error for RecordError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            Self::Step(error) => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for RecordError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<Error> for RecordError {
    fn from(error: Error) -> Self {
        Self::Step(error)
    }
}
