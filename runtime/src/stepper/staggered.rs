//! Momenta of steps of first order, which are staggered: read at the time of their configuration, started from there, and taken over from other methods.

use super::{GRADIENT, Stepper};
use crate::parameters::check_finite;
use crate::parts::{Mu, Q, T};
use crate::scheme::Scheme;
use crate::space::{minus, plus};
use crate::{Clebsch, Error, Method, State, Time};
use num_traits::Zero;

/// With `order = 1` a step drifts, then kicks, and the momentum N of a state is ahead of its configuration by half of the kick there.
impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The momentum π at the configuration of a state. With `order = 1` it is N before the second half of its kick:
    /// ```text
    /// π = N − ½ J(q, ∂(U₁ − U₀)) = N + h/2 J(q, ∂V(t, q))
    /// ```
    /// With every other order it is N itself. So a program may read π whatever the order is.
    ///
    /// If the kinetic cost is time-symmetric, (q, π) moves by half kick, drift, half kick, of *second* order. Steps of
    /// both orders make the same configurations, if those of first order start by
    /// [`staggered_state`](Self::staggered_state) from the same q and π. So the step of first order has the accuracy of
    /// second order, for a gradient at each reading. A state that [`state`](Self::state) has made of N = π is read as
    /// another motion of second order, whose start is off by half a kick.
    ///
    /// Some errors stay of first order: those of a cost that is not time-symmetric, and those of motions under a
    /// `force`. The force takes the velocity and the input of the drift before it, and the kick is that of the
    /// potential alone. `DERIVATION` says so where it is.
    ///
    /// The components and the basis are those of N. NaN where the gradient is.
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
    /// let stepper = Pendulum.stepper(0.01)?;
    /// let start = stepper.staggered_state(Vector3::y(), Vector3::new(0.6, 0.0, 0.2))?;
    /// assert!((stepper.synchronized(&start) - Vector3::new(0.6, 0.0, 0.2)).norm() < 1e-16);
    /// let late = stepper.advance(&start, 1000)?;
    /// let error = |energy: f64| (energy - 0.2).abs(); // (0.6² + 0.2²)/2, at the height 0
    /// assert!(error(stepper.synchronized_energy(&late)) < 1e-4);
    /// # let worst = stepper.trajectory(start).take(1000).flatten().map(|state| error(stepper.energy(&state))).fold(0.0, f64::max);
    /// # assert!(worst > 1e-3);
    ///
    /// let fine = Pendulum.stepper_by::<Fine>(0.1)?;
    /// let state = fine.state_of(&stepper, &start)?;
    /// assert!(error(fine.energy(&fine.advance(&state, 100)?)) < 1e-7);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// Source: Hairer, Lubich and Wanner, *Geometric Numerical Integration*. §I.1.4 is the staggered form of the
    /// Störmer–Verlet method. §V.3.3 is processing: methods that are conjugate to one of higher order.
    #[inline]
    pub fn synchronized(&self, state: &State<S, M>) -> S::Momentum {
        let ahead = M::stagger(&self.system, self.h, state.time.now(), &state.configuration);
        minus(&state.momentum(), &ahead)
    }

    /// Kinetic energy plus potential, with the momentum that [`synchronized`](Self::synchronized) reads. With
    /// `order = 1` its error has the order of the error of π, while that of [`energy`](Self::energy) is of order h.
    /// With every other order both are the same.
    #[inline]
    pub fn synchronized_energy(&self, state: &State<S, M>) -> S::Scalar {
        let (t, q) = (state.time.now(), &state.configuration);
        let constants = M::Scheme::whole(&self.constants);
        M::kinetic_energy(&self.system, constants, t, q, &self.synchronized(state)) + self.system.potential(t, q)
    }

    /// The state of a body at q whose momentum there is π, after the checks of [`state`](Self::state). With `order = 1` its N is ahead of π by half a kick,
    /// and [`synchronized`](Self::synchronized) gives π back but for rounding. With every other order it is the state (q, π). The time starts at 0.
    ///
    /// # Errors
    /// As [`state`](Self::state), for π.
    pub fn staggered_state(&self, q: S::Configuration, mu: S::Momentum) -> Result<State<S, M>, Error> {
        self.checked_staggered_state(S::Scalar::zero(), q, mu)
    }

    /// The state of this stepper that is the same body as `state` of `other`, which may have another method or another step size.
    ///
    /// Time and configuration are taken over, and the momentum that [`synchronized`](Self::synchronized) reads; half a kick is added where this method needs it. See the example there.
    ///
    /// # Errors
    /// As [`state`](Self::state).
    pub fn state_of<N: Method<S>>(&self, other: &Stepper<S, N>, state: &State<S, N>) -> Result<State<S, M>, Error> {
        self.checked_staggered_state(state.time.now(), *state.configuration(), other.synchronized(state))
    }

    pub(super) fn checked_staggered_state(&self, t: T<S>, q: Q<S>, mu: Mu<S>) -> Result<State<S, M>, Error> {
        self.check_state(t, &q, &mu)?;
        let stagger = M::stagger(&self.system, self.h, t, &q);
        check_finite(GRADIENT, &stagger)?;
        let staggered = plus(&mu, &stagger);
        check_finite("the momentum half a kick ahead", &staggered)?;
        self.made_state(t, q, staggered)
    }
}
