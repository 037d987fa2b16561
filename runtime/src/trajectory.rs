//! Step after step as an iterator.

use crate::{Clebsch, Declared, Error, Method, State, Stepper};
use core::fmt::{self, Debug, Formatter};
use core::iter::FusedIterator;

/// The states q_0, q_1, … of a [`Stepper`], the start first. Endless; after an error it yields nothing more.
///
/// A step is made when its state is asked for, so `take(n)` makes n − 1 steps.
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
pub struct Trajectory<'a, S: Clebsch, M: Method<S> = Declared> {
    pub(crate) stepper: &'a Stepper<S, M>,
    /// The start, or the state that has been asked for last; `None` after an error.
    pub(crate) state: Option<State<S, M>>,
    pub(crate) has_started: bool,
}

impl<S: Clebsch, M: Method<S>> Iterator for Trajectory<'_, S, M> {
    type Item = Result<State<S, M>, Error>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let state = self.state.as_ref()?;
        let item = if self.has_started { self.stepper.step(state) } else { Ok(*state) };
        (self.state, self.has_started) = (item.ok(), true);
        Some(item)
    }
}

impl<S: Clebsch, M: Method<S>> FusedIterator for Trajectory<'_, S, M> {}

impl<S: Clebsch, M: Method<S>> Clone for Trajectory<'_, S, M> {
    fn clone(&self) -> Self {
        Self { ..*self }
    }
}

impl<S: Clebsch, M: Method<S>> Debug for Trajectory<'_, S, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let name = if self.has_started { "Trajectory after" } else { "Trajectory from" };
        match &self.state {
            Some(state) => f.debug_tuple(name).field(state).finish(),
            None => f.write_str("Trajectory ended"),
        }
    }
}
