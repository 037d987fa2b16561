//! Step after step as an iterator.

use crate::{Clebsch, Error, State, Stepper};
use core::fmt::{self, Debug, Formatter};
use core::iter::FusedIterator;

/// The states q_0, q_1, … of a [`Stepper`], the start first. Endless; after an error it yields nothing more.
///
/// A step is made when its state is asked for, so `take(n)` makes n − 1 steps.
pub struct Trajectory<'a, S: Clebsch> {
    stepper: &'a Stepper<S>,
    place: Place<S>,
}

/// Where the iterator stands.
enum Place<S: Clebsch> {
    Start(State<S>),
    After(State<S>),
    End,
}

impl<'a, S: Clebsch> Trajectory<'a, S> {
    #[inline]
    pub(crate) fn new(stepper: &'a Stepper<S>, start: State<S>) -> Self {
        Self { stepper, place: Place::Start(start) }
    }
}

impl<S: Clebsch> Iterator for Trajectory<'_, S> {
    type Item = Result<State<S>, Error>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let item = match &self.place {
            Place::Start(start) => Ok(*start),
            Place::After(state) => self.stepper.step(state),
            Place::End => return None,
        };
        self.place = match item {
            Ok(state) => Place::After(state),
            Err(_) => Place::End,
        };
        Some(item)
    }
}

impl<S: Clebsch> FusedIterator for Trajectory<'_, S> {}

impl<S: Clebsch> Clone for Trajectory<'_, S> {
    fn clone(&self) -> Self {
        let place = match &self.place {
            Place::Start(state) => Place::Start(*state),
            Place::After(state) => Place::After(*state),
            Place::End => Place::End,
        };
        Self { stepper: self.stepper, place }
    }
}

impl<S: Clebsch> Debug for Trajectory<'_, S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.place {
            Place::Start(state) => f.debug_tuple("Trajectory from").field(state).finish(),
            Place::After(state) => f.debug_tuple("Trajectory after").field(state).finish(),
            Place::End => f.write_str("Trajectory ended"),
        }
    }
}
