//! The inputs of the forces, step by step.

use super::Trajectory;
use crate::{Clebsch, Method, Space, State};
use core::fmt::{self, Debug, Formatter};

/// The inputs of the forces in the steps of a [`Trajectory`]. Made by [`Trajectory::forced_by`].
///
/// ```
/// # use clebsch::{Clebsch, Inputs, Trajectory};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// /// The last of so many states, whether forces have inputs or not.
/// fn last<U: Inputs<Particle, clebsch::Declared>>(
///     trajectory: Trajectory<'_, Particle, clebsch::Declared, U>,
///     count: usize,
/// ) -> Option<f64> {
///     trajectory.take(count).last()?.ok().map(|state| state.configuration().x)
/// }
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// assert_eq!(last(stepper.trajectory(start), 3), Some(3.0));
/// # Ok::<(), clebsch::Error>(())
/// ```
pub trait Inputs<S: Clebsch, M: Method<S>> {
    /// The input of the step from this state.
    fn input(&mut self, state: &State<S, M>) -> S::Input;
}

/// No input, or an input of zeros.
///
/// ```
/// # use clebsch::{Clebsch, Declared, Inputs, NoInputs};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     force      = |v, u: Vector1| u,
/// # )]
/// # struct Cart { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Cart { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// assert_eq!(NoInputs.input(&start), Vector1::zeros());
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoInputs;

impl<S: Clebsch, M: Method<S>> Inputs<S, M> for NoInputs {
    #[inline(always)]
    fn input(&mut self, _: &State<S, M>) -> S::Input {
        Space::origin()
    }
}

/// Inputs by a function of the state at the start of a step: [`Trajectory::forced_by`].
///
/// ```
/// # use clebsch::{Clebsch, Declared, InputsBy, State, Trajectory};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     force      = |v, u: Vector1| u,
/// # )]
/// # struct Cart { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Cart { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// let brake: fn(&State<Cart>) -> Vector1<f64> = |state| -state.momentum();
/// let stopping: Trajectory<'_, Cart, Declared, InputsBy<fn(&State<Cart>) -> Vector1<f64>>> =
///     stepper.trajectory(start).forced_by(brake);
/// assert_eq!(stopping.take(2).last().transpose()?.map(|state| state.momentum().x), Some(3.0));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct InputsBy<F>(F);

impl<F> Debug for InputsBy<F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("InputsBy").finish_non_exhaustive()
    }
}

impl<S: Clebsch, M: Method<S>, F: FnMut(&State<S, M>) -> S::Input> Inputs<S, M> for InputsBy<F> {
    #[inline]
    fn input(&mut self, state: &State<S, M>) -> S::Input {
        (self.0)(state)
    }
}

impl<'a, S: Clebsch, M: Method<S>, U> Trajectory<'a, S, M, U> {
    /// The same motion with an input of the forces in each step, from the state at its start: a controller, a pilot, a thruster.
    ///
    /// The function is called once for each step, and the input stays the same during it. Times between and events have
    /// the input of their step.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Crossing};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<1>, x: Vector1| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     force      = |v, u: Vector1| u,
    /// # )]
    /// # struct Cart { mass: f64 }
    /// # use nalgebra::Vector1;
    /// // 3 m/s, and brakes of 4 N
    /// let stepper = Cart { mass: 2.0 }.into_stepper(0.4)?;
    /// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
    /// let braking = stepper.trajectory(start).forced_by(|_| Vector1::new(-4.0));
    /// // it stands after 6 kg m/s over 4 N, within the fourth step
    /// let mut stops = braking.events(100, |state| [Crossing::Falling(state.momentum().x)]);
    /// let Some(event) = stops.next().transpose()? else { panic!("it stops") };
    /// assert!((event.time - 1.5).abs() < 1e-15 && (event.state.configuration().x - 2.25).abs() < 1e-15);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    pub fn forced_by<F: FnMut(&State<S, M>) -> S::Input>(self, input: F) -> Trajectory<'a, S, M, InputsBy<F>> {
        let Self { stepper, state, has_started, has_failed, inputs: _ } = self;
        Trajectory { stepper, state, has_started, has_failed, inputs: InputsBy(input) }
    }
}
