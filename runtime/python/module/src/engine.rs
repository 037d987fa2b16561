//! A stepper whose types are hidden: everything goes in and out by numbers.

use crate::failure::Failure;
use crate::run::{self, Watch};
use clebsch::{Clebsch, Columns, Method, Real, SavedState, Scalar, Space, State, Stepper, Time};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::any::Any;
use std::sync::Arc;

/// A state of any system.
pub type Point = Arc<dyn Any + Send + Sync>;

/// Writes the conserved momenta of a state.
pub type Momenta<S, M> = fn(&Stepper<S, M>, &State<S, M>, &mut [f64]);

/// A stepper whose types are hidden.
///
/// A row is the time, the configuration, the momentum, the energy and the conserved momenta. A state is a row without the last two.
pub trait Engine: Send + Sync {
    /// The state with these numbers, or the nearest one.
    ///
    /// # Errors
    /// [`Failure::Count`]; [`Failure::Refused`] with a `StateError`.
    fn start(&self, row: &[f64], nearest: bool) -> Result<Point, Failure>;

    /// One step with an input of the forces; without one it is zero.
    ///
    /// # Errors
    /// [`Failure::Stopped`]; [`Failure::Count`] for the input.
    fn step(&self, point: &Point, input: Option<&[f64]>) -> Result<Point, Failure>;

    /// So many steps.
    ///
    /// # Errors
    /// [`Failure::Stopped`], [`Failure::Interrupted`].
    fn advance(&self, point: &Point, steps: u64, watch: Watch<'_>) -> Result<Point, Failure>;

    /// The rows at these times, and the state at the last one.
    ///
    /// # Errors
    /// [`Failure::Stopped`], [`Failure::Interrupted`].
    fn run(&self, point: &Point, times: &[f64], rows: &mut [f64], watch: Watch<'_>) -> Result<Point, Failure>;

    /// An impulse, added to the momentum.
    ///
    /// # Errors
    /// [`Failure::Count`]; [`Failure::Refused`] with a `StateError`.
    fn kick(&self, point: &Point, impulse: &[f64]) -> Result<Point, Failure>;

    /// The row of a state. The time is 0 where it does not matter.
    ///
    /// # Errors
    /// [`Failure::Foreign`].
    fn row(&self, point: &Point) -> Result<Vec<f64>, Failure>;

    /// How many numbers a row has.
    fn width(&self) -> usize;

    /// The state as bytes, with all that the next step takes.
    ///
    /// # Errors
    /// [`Failure::Foreign`].
    fn save(&self, point: &Point) -> Result<Vec<u8>, Failure>;

    /// The state of these bytes.
    ///
    /// # Errors
    /// [`Failure::Saved`]; [`Failure::Refused`] with a `StateError`.
    fn resume(&self, bytes: &[u8]) -> Result<Point, Failure>;
}

/// The engine of a stepper.
pub struct Driven<S: Clebsch, M: Method<S>> {
    pub(crate) stepper: Stepper<S, M>,
    momenta: Momenta<S, M>,
    conserved: usize,
}

/// Numbers in the scalar of a system.
pub(crate) fn scalars<T: Scalar>(numbers: &[f64]) -> impl Iterator<Item = T> + '_ {
    numbers.iter().map(|number| T::from_f64(*number))
}

/// The value of these numbers, if there are as many as it has.
pub(crate) fn value<T: Scalar, V: Space<T>>(name: &'static str, numbers: &[f64]) -> Result<V, Failure> {
    let (given, needed) = (numbers.len(), V::FORM.width());
    let read = (given == needed).then(|| V::from_columns(&mut scalars(numbers))).flatten();
    read.ok_or(Failure::Count { name, given, needed })
}

impl<S: Clebsch<Scalar: Real>, M: Method<S>> Driven<S, M> {
    /// The engine of a stepper with so many conserved momenta.
    pub fn new(stepper: Stepper<S, M>, momenta: Momenta<S, M>, conserved: usize) -> Self {
        Self { stepper, momenta, conserved }
    }

    /// The numbers of a row in front of the energy.
    const STATE: usize =
        1 + <S::Configuration as Columns<S::Scalar>>::FORM.width() + <S::Momentum as Columns<S::Scalar>>::FORM.width();

    /// How many numbers a row has.
    pub(crate) fn row_width(&self) -> usize {
        Self::STATE + 1 + self.conserved
    }

    /// Writes the row of a state at a time.
    pub(crate) fn write(&self, t: f64, state: &State<S, M>, row: &mut [f64]) {
        let of_state = self.stepper.table().energy().row(S::Scalar::from_f64(t), state);
        row.iter_mut().zip(of_state).for_each(|(place, number)| *place = number.to_f64());
        if let Some(conserved) = row.get_mut(Self::STATE + 1..) {
            (self.momenta)(&self.stepper, state, conserved);
        }
    }
}

impl<S, M> Driven<S, M>
where
    S: Clebsch + 'static,
    M: Method<S> + 'static,
{
    /// The state behind a point.
    pub(crate) fn state<'p>(&self, point: &'p Point) -> Result<&'p State<S, M>, Failure> {
        point.downcast_ref().ok_or(Failure::Foreign)
    }
}

impl<S, M> Engine for Driven<S, M>
where
    S: Clebsch<Scalar: Real> + 'static,
    M: Method<S> + 'static,
    Stepper<S, M>: Send + Sync,
    State<S, M>: Send + Sync + Serialize,
    SavedState<S, M>: DeserializeOwned,
{
    fn start(&self, row: &[f64], nearest: bool) -> Result<Point, Failure> {
        let count = Failure::Count { name: "the state", given: row.len(), needed: Self::STATE };
        let table = self.stepper.table();
        let read = if nearest { table.project(scalars(row)) } else { table.state(scalars(row)) };
        let state = read.filter(|_| row.len() == Self::STATE).ok_or(count)?;
        Ok(Arc::new(state.map_err(Failure::refused("StateError"))?))
    }

    fn step(&self, point: &Point, input: Option<&[f64]>) -> Result<Point, Failure> {
        let state = self.state(point)?;
        let stepped = match input {
            Some(input) => self.stepper.step_with(state, &value("the input", input)?),
            None => self.stepper.step(state),
        };
        let stopped = |error| Failure::Stopped { error, point: point.clone(), done: 0, unit: "steps" };
        Ok(Arc::new(stepped.map_err(stopped)?))
    }

    fn advance(&self, point: &Point, steps: u64, watch: Watch<'_>) -> Result<Point, Failure> {
        run::advance(self, self.state(point)?, steps, watch)
    }

    fn run(&self, point: &Point, times: &[f64], rows: &mut [f64], watch: Watch<'_>) -> Result<Point, Failure> {
        run::run(self, self.state(point)?, times, rows, watch)
    }

    fn kick(&self, point: &Point, impulse: &[f64]) -> Result<Point, Failure> {
        let kicked = self.stepper.kick(self.state(point)?, value("the impulse", impulse)?);
        Ok(Arc::new(kicked.map_err(Failure::refused("StateError"))?))
    }

    fn row(&self, point: &Point) -> Result<Vec<f64>, Failure> {
        let state = self.state(point)?;
        let mut row = vec![0.0; self.width()];
        self.write(state.clock().now().to_f64(), state, &mut row);
        Ok(row)
    }

    fn width(&self) -> usize {
        self.row_width()
    }

    fn save(&self, point: &Point) -> Result<Vec<u8>, Failure> {
        let saved = postcard::to_stdvec(self.state(point)?);
        saved.map_err(|error| Failure::Saved { reason: error.to_string() })
    }

    fn resume(&self, bytes: &[u8]) -> Result<Point, Failure> {
        let saved = postcard::from_bytes::<SavedState<S, M>>(bytes);
        let saved = saved.map_err(|error| Failure::Saved { reason: error.to_string() })?;
        Ok(Arc::new(self.stepper.resume(saved).map_err(Failure::refused("StateError"))?))
    }
}
