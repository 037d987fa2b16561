//! States that another method has made.

use super::Stepper;
use crate::{Clebsch, Error, Method, State, Time};

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The state of this stepper that is the same body as `state` of `other`, which may have another method or another step size.
    ///
    /// Time and configuration are taken over, and the momentum that [`synchronized`](Self::synchronized) reads; half a kick is added where this method needs it.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # use nalgebra::Vector3;
    /// /// Fewer steps for a small error.
    /// struct Fine;
    ///
    /// /// A pendulum by drift, then kick.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action      = |F: SO<3>, q: Unit<Vector3>| F * q,
    ///     cost        = |h, F| (F - I).norm_squared() / (4 * h),
    ///     potential   = |q| q.z,
    ///     order       = 1,
    ///     method Fine = (order = 6),
    /// )]
    /// struct Pendulum;
    ///
    /// let coarse = Pendulum.stepper(0.01)?;
    /// let fine = Pendulum.stepper_by::<Fine>(0.1)?;
    /// let state = coarse.staggered_state(Vector3::y(), Vector3::new(0.6, 0.0, 0.2))?;
    /// let state = fine.state_of(&coarse, &state)?;
    /// assert!((fine.energy(&fine.advance(&state, 100)?) - 0.2).abs() < 1e-7);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`state`](Self::state).
    pub fn state_of<N: Method<S>>(&self, other: &Stepper<S, N>, state: &State<S, N>) -> Result<State<S, M>, Error> {
        self.checked_staggered_state(state.time.now(), *state.configuration(), other.synchronized(state))
    }
}
