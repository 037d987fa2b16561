//! Step after step as an iterator.

use crate::{Clebsch, Declared, Error, Method, State, Stepper};
use core::fmt::{self, Debug, Formatter};
use core::iter::FusedIterator;

/// The states q_0, q_1, … of a [`Stepper`], the start first. Endless; after an error it yields nothing more.
///
/// A step is made when its state is asked for, so `take(n)` makes n − 1 steps.
pub struct Trajectory<'a, S: Clebsch, M: Method<S> = Declared> {
    stepper: &'a Stepper<S, M>,
    cursor: Cursor<S, M>,
}

/// Where the iterator stands.
enum Cursor<S: Clebsch, M: Method<S>> {
    Start(State<S, M>),
    After(State<S, M>),
    End,
}

impl<'a, S: Clebsch, M: Method<S>> Trajectory<'a, S, M> {
    #[inline]
    pub(crate) fn new(stepper: &'a Stepper<S, M>, start: State<S, M>) -> Self {
        Self { stepper, cursor: Cursor::Start(start) }
    }
}

impl<S: Clebsch, M: Method<S>> Iterator for Trajectory<'_, S, M> {
    type Item = Result<State<S, M>, Error>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let item = match &self.cursor {
            Cursor::Start(start) => Ok(*start),
            Cursor::After(state) => self.stepper.step(state),
            Cursor::End => return None,
        };
        self.cursor = match item {
            Ok(state) => Cursor::After(state),
            Err(_) => Cursor::End,
        };
        Some(item)
    }
}

impl<S: Clebsch, M: Method<S>> FusedIterator for Trajectory<'_, S, M> {}

impl<S: Clebsch, M: Method<S>> Clone for Trajectory<'_, S, M> {
    fn clone(&self) -> Self {
        let cursor = match &self.cursor {
            Cursor::Start(state) => Cursor::Start(*state),
            Cursor::After(state) => Cursor::After(*state),
            Cursor::End => Cursor::End,
        };
        Self { stepper: self.stepper, cursor }
    }
}

impl<S: Clebsch, M: Method<S>> Debug for Trajectory<'_, S, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.cursor {
            Cursor::Start(state) => f.debug_tuple("Trajectory from").field(state).finish(),
            Cursor::After(state) => f.debug_tuple("Trajectory after").field(state).finish(),
            Cursor::End => f.write_str("Trajectory ended"),
        }
    }
}
