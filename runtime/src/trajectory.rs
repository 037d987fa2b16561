//! Step after step as an iterator.

mod events;
mod inputs;
mod times;

pub use events::{Crossing, Event, Events};
pub use inputs::{Inputs, InputsBy, NoInputs};
pub use times::{Multiples, Timed, WithTimes};

use crate::{Clebsch, Declared, Error, Method, State, Stepper};
use core::fmt::{self, Debug, Formatter};
use core::iter::FusedIterator;

/// The states q_0, q_1, … of a [`Stepper`], the start first. Endless; after an error it yields nothing more.
///
/// A step is made when its state is asked for, so `take(n)` makes n − 1 steps. For states at times of your own see
/// [`at`](Self::at) and [`every`](Self::every), for crossings of a surface [`events`](Self::events), for inputs of the forces
/// [`forced_by`](Self::forced_by).
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// let mut places = Vec::new();
/// for state in stepper.trajectory(start).take(3) {
///     places.push(state?.configuration().x);
/// }
/// assert_eq!(places, [0.0, 1.5, 3.0]);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Trajectory<'a, S: Clebsch, M: Method<S> = Declared, U = NoInputs> {
    pub(crate) stepper: &'a Stepper<S, M>,
    /// The start, or the state that has been asked for last; after an error the one before it.
    pub(crate) state: State<S, M>,
    pub(crate) has_started: bool,
    pub(crate) has_failed: bool,
    pub(crate) inputs: U,
}

impl<S: Clebsch, M: Method<S>, U> Trajectory<'_, S, M, U> {
    /// The state that has been asked for last, or the start. After an error it is the state before the step that failed.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
    /// # struct Particle { mass: f64 }
    /// # use nalgebra::Vector1;
    /// let stepper = Particle { mass: 2.0 }.into_stepper(1e307)?;
    /// let start = stepper.state(Vector1::zeros(), Vector1::new(16.0))?;
    /// let mut trajectory = stepper.trajectory(start);
    /// let error = trajectory.by_ref().find_map(Result::err);
    /// assert!(matches!(error, Some(Error::NotFinite { .. })));
    /// assert_eq!(trajectory.state().configuration().x, 1.6e308); // the last one before the overflow
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    #[inline]
    pub fn state(&self) -> &State<S, M> {
        &self.state
    }
}

impl<S: Clebsch, M: Method<S>, U: Inputs<S, M>> Iterator for Trajectory<'_, S, M, U> {
    type Item = Result<State<S, M>, Error>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        if self.has_failed {
            return None;
        }
        if !self.has_started {
            self.has_started = true;
            return Some(Ok(self.state));
        }
        let input = self.inputs.input(&self.state);
        let item = self.stepper.step_with(&self.state, &input);
        match &item {
            Ok(state) => self.state = *state,
            Err(_) => self.has_failed = true,
        }
        Some(item)
    }
}

impl<S: Clebsch, M: Method<S>, U: Inputs<S, M>> FusedIterator for Trajectory<'_, S, M, U> {}

impl<S: Clebsch, M: Method<S>, U: Clone> Clone for Trajectory<'_, S, M, U> {
    fn clone(&self) -> Self {
        Self { inputs: self.inputs.clone(), ..*self }
    }
}

impl<S: Clebsch, M: Method<S>, U> Debug for Trajectory<'_, S, M, U> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let name = match (self.has_failed, self.has_started) {
            (true, _) => "Trajectory ended after",
            (false, true) => "Trajectory after",
            (false, false) => "Trajectory from",
        };
        f.debug_tuple(name).field(&self.state).finish()
    }
}
