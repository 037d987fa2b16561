//! State after state.

use super::{GRADIENT, Stepper, first_without, whole_or_lane};
use crate::parts::{Mu, Q, T, U};
use crate::scheme::{Left, Scheme, time_after};
use crate::{Clebsch, Error, Mask, Method, NoInputs, Scalar, Space, State, Stopped, Time, Trajectory};
use num_traits::Zero;

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The state (q, N), after checks: finite, q on its orbit, N in 𝔤_q^⊥, the momenta that motions of q can have.
    ///
    /// The tolerance for round-off of the input is √ε: 1.5e-8 for `f64`, 3.5e-4 for `f32`; for N relative to its
    /// largest component. [`project`](Self::project) gives the nearest N that is accepted. Where the time matters it
    /// starts at 0.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OffOrbit`], [`Error::OutsideMomentumSpace`], or [`Error::IndefiniteKineticEnergy`] where the inertia depends on q or on the time.
    /// With a constraint also [`Error::OffConstraint`], [`Error::ConstraintViolated`] or [`Error::DependentConstraints`]. With `step`
    /// also [`Error::Monitor`].
    pub fn state(&self, q: S::Configuration, mu: S::Momentum) -> Result<State<S, M>, Error> {
        self.checked_state(S::Scalar::zero(), q, mu)
    }

    /// One step of the discrete Euler–Poincaré representation: (q_k, N_k) ↦ (q_{k+1}, N_{k+1}).
    ///
    /// # Errors
    /// [`Error::Unsolvable`] or [`Error::StepTooLong`] where the step is too long for the momentum, [`Error::NotFinite`] where the potential gave
    /// NaN or numbers overflowed, [`Error::NotConverged`], with `step` [`Error::Monitor`]. Where the scalar has lanes: [`Error::InLane`].
    // a call hands states through memory, which costs as much as half of a short step; long ones stay calls within
    #[inline(always)]
    pub fn step(&self, state: &State<S, M>) -> Result<State<S, M>, Error> {
        self.step_with(state, &S::Input::origin())
    }

    /// The state after `steps` steps.
    ///
    /// The same as stepping so often but for rounding, and faster: no state between is made, and splittings drift from one step into the next.
    ///
    /// # Errors
    /// As [`step`](Self::step), at whichever step; `state` is untouched. If the scalar has lanes, [`Error::InLane`]
    /// names one of those that fail. Take the lanes one by one, or step after step, to know the others and how far each
    /// came.
    #[inline]
    pub fn advance(&self, state: &State<S, M>, steps: usize) -> Result<State<S, M>, Error> {
        let State { time, configuration, held, .. } = state;
        let left = self.left_of(state);
        let start = (configuration, held, &left);
        let none = S::Input::origin();
        let advanced = M::Scheme::steps(self.at(time.now()), self.h, steps, start, &none);
        let (configuration, held, left) = advanced.map_err(|error| self.refused_after(state, steps, error))?;
        let time = time_after::<S, M>(*time, (self.h, steps), &left);
        let next = State { time, configuration, held, left, h: self.h };
        if !self.is_sound(&next) {
            return Err(self.refused_after(state, steps, self.beyond(&next)));
        }
        Ok(next)
    }

    /// The state after `steps` steps, as [`advance`](Self::advance) makes them. If one fails, the error has the last good state and the
    /// number of steps to it.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error, Stopped};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
    /// # struct Particle { mass: f64 }
    /// # use nalgebra::Vector1;
    /// let stepper = Particle { mass: 2.0 }.into_stepper(1e307)?;
    /// let start = stepper.state(Vector1::zeros(), Vector1::new(16.0))?;
    /// let Err(Stopped { state, steps, error }) = stepper.advance_or_stop(&start, 1000) else { panic!("it overflows") };
    /// assert_eq!((state.configuration().x, steps), (1.6e308, 2));
    /// assert!(matches!(error, Error::NotFinite { .. }));
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn advance_or_stop(&self, state: &State<S, M>, steps: usize) -> Result<State<S, M>, Stopped<S, M>> {
        let failed = match self.advance(state, steps) {
            Ok(state) => return Ok(state),
            Err(error) => error,
        };
        // made once more, to know how far they come
        let mut state = *state;
        for made in 0..steps {
            match self.step(&state) {
                Ok(next) => state = next,
                Err(error) => return Err(Stopped { state, steps: made, error }),
            }
        }
        // steps that are merged differ by rounding, which may decide whether the last one succeeds
        Err(Stopped { state, steps, error: failed })
    }

    /// The states of all steps, `start` first; ends after the first error.
    #[inline]
    pub fn trajectory(&self, start: State<S, M>) -> Trajectory<'_, S, M> {
        Trajectory { stepper: self, state: start, has_started: false, has_failed: false, inputs: NoInputs }
    }

    /// One step during which the input of the forces is `u`; [`step`](Self::step) is that with none, all zero.
    ///
    /// By the discrete Lagrange–d'Alembert principle the force acts at both ends, of second order in h. A forced step is not symplectic,
    /// and conserves those momenta alone on which the force does not act.
    ///
    /// # Errors
    /// As [`step`](Self::step), and [`Error::NotFinite`] where the input is not.
    #[inline(always)]
    pub fn step_with(&self, state: &State<S, M>, u: &S::Input) -> Result<State<S, M>, Error> {
        check_input::<S>(u)?;
        // Copy the state on the cold path only: a reference would force it into memory. So with the error: LLVM splits the loads of a result.
        let Ok(next) = self.attempt(state, u) else {
            let (before, u) = (*state, *u);
            return Err(self.refused(&before, &u));
        };
        if !self.is_sound(&next) {
            let reached = next;
            return Err(self.beyond(&reached));
        }
        Ok(next)
    }

    /// One step into the place of another state, which holds none where this fails.
    #[inline]
    pub(crate) fn step_into(&self, state: &State<S, M>, u: &S::Input, next: &mut State<S, M>) -> Result<(), Error> {
        check_input::<S>(u)?;
        let State { configuration: q, held, left, .. } = state;
        let at = self.at(state.time.now());
        let into = (&mut next.configuration, &mut next.held, &mut next.left);
        let anew;
        let left = if self.has_left(state) {
            left
        } else {
            anew = self.left_of(state);
            &anew
        };
        if M::Scheme::step_into(at, (q, held, left), u, into).is_err() {
            return Err(self.refused(state, u));
        }
        (next.time, next.h) = (time_after::<S, M>(state.time, (self.h, 1), &next.left), self.h);
        if self.is_sound(next) { Ok(()) } else { Err(self.beyond(next)) }
    }

    pub(crate) fn checked_state(&self, t: T<S>, q: Q<S>, mu: Mu<S>) -> Result<State<S, M>, Error> {
        self.check_state(t, &q, &mu)?;
        self.made_state(t, q, mu)
    }

    /// The state (q, N) with the data that its first step takes.
    pub(super) fn made_state(&self, t: T<S>, q: Q<S>, mu: Mu<S>) -> Result<State<S, M>, Error> {
        let left = M::Scheme::left(self.at(t), &q, &mu);
        self.check_left(t, &q, &left)?;
        let held = M::Scheme::held(&q, &mu);
        Ok(State { time: S::Time::at(t), configuration: q, held, left, h: self.h })
    }

    /// The data for the first step from q are finite.
    pub(crate) fn check_left(&self, t: T<S>, q: &Q<S>, left: &Left<S, M>) -> Result<(), Error> {
        if left.all_finite() {
            return Ok(());
        }
        let has_gradient = (0..S::Scalar::LANES).all(|lane| self.has_gradient(t, q, lane));
        Err(Error::NotFinite { name: if has_gradient { "the velocity of this momentum" } else { GRADIENT } })
    }

    /// A step before it is checked, NaN in lanes that have no solution. Where no lane has one, the error is that of the first with a finite momentum.
    #[inline(always)]
    pub(super) fn attempt(&self, state: &State<S, M>, u: &S::Input) -> Result<State<S, M>, Error> {
        self.attempt_with(state, &self.left_of(state), u)
    }

    /// The same where it has failed before, or may: one copy of the step serves all of its errors.
    #[cold]
    #[inline(never)]
    pub(super) fn attempt_again(&self, state: &State<S, M>, u: &S::Input) -> Result<State<S, M>, Error> {
        self.attempt(state, u)
    }

    /// The same with the impulse at the configuration.
    #[inline(always)]
    pub(crate) fn attempt_with(&self, state: &State<S, M>, left: &Left<S, M>, u: &U<S>) -> Result<State<S, M>, Error> {
        let State { time, configuration, held, .. } = state;
        match M::Scheme::step(self.at(time.now()), (configuration, held, left), u) {
            Ok((configuration, held, left)) => {
                let time = time_after::<S, M>(*time, (self.h, 1), &left);
                Ok(State { time, configuration, held, left, h: self.h })
            }
            Err(error) => Err(error),
        }
    }

    /// Whether the data in a state is for steps of this size.
    #[inline(always)]
    fn has_left(&self, state: &State<S, M>) -> bool {
        size_of::<Left<S, M>>() == 0 || state.h == self.h
    }

    /// The impulse that a state brings along, or a new one in the lanes in which a stepper of another step size has made it.
    #[inline]
    pub(crate) fn left_of(&self, state: &State<S, M>) -> Left<S, M> {
        if self.has_left(state) {
            return state.left;
        }
        let State { time, configuration, left, .. } = state;
        let anew = M::Scheme::left_after(self.at(time.now()), configuration, &state.momentum(), left);
        if S::Scalar::LANES == 1 { anew } else { kept_in_lanes(anew, left, state.h.equals(self.h)) }
    }

    /// The error of a step that no lane can make, which is tried once more for it.
    #[cold]
    #[inline(never)]
    pub(super) fn refused(&self, state: &State<S, M>, u: &S::Input) -> Error {
        match self.attempt_again(state, u) {
            Err(error) if S::Scalar::LANES == 1 => self.refusal(state, u, 0, error),
            // by construction an error: the same step has the same result
            _ => Error::InLane { lane: 0 },
        }
    }

    /// The error of the first of so many steps that fails, each made by itself; `known` where none does.
    #[cold]
    #[inline(never)]
    fn refused_after(&self, start: &State<S, M>, steps: usize, known: Error) -> Error {
        let failed = self.trajectory(*start).take(steps.saturating_add(1)).find_map(Result::err);
        failed.unwrap_or_else(|| whole_or_lane::<S::Scalar>(0, known))
    }

    /// Whether a state after a step is finite and on its orbit.
    #[inline(always)]
    pub(crate) fn is_sound(&self, next: &State<S, M>) -> bool {
        next.is_finite() && (!S::MAY_LEAVE_ORBIT || self.on_orbit(&next.configuration).all())
    }

    /// The lanes in which a state after a step is finite and on its orbit.
    #[inline(always)]
    pub(crate) fn sound(&self, next: &State<S, M>) -> <S::Scalar as Scalar>::Mask {
        let finite = next.finite();
        if S::MAY_LEAVE_ORBIT { finite & self.on_orbit(&next.configuration) } else { finite }
    }

    /// The lanes in which a configuration is on its orbit, up to √ε as [`state`](Self::state) accepts it.
    fn on_orbit(&self, q: &Q<S>) -> <S::Scalar as Scalar>::Mask {
        self.system.orbit_defect(q).at_most(S::Scalar::EPSILON.sqrt())
    }

    /// The error of a step whose state is not finite, or off its orbit, in some lane.
    #[cold]
    pub(super) fn beyond(&self, next: &State<S, M>) -> Error {
        let lane = first_without::<S::Scalar>(self.sound(next));
        whole_or_lane::<S::Scalar>(lane, self.overflow(next, lane))
    }
}

/// The input is finite.
#[inline(always)]
pub(super) fn check_input<S: Clebsch>(u: &S::Input) -> Result<(), Error> {
    if size_of::<S::Input>() == 0 || u.all_finite() { Ok(()) } else { Err(Error::NotFinite { name: "the input" }) }
}

/// The impulse `kept` in the lanes of the mask, `anew` in the others.
#[cold]
#[inline(never)]
fn kept_in_lanes<T: Scalar, I: Space<T>>(mut anew: I, kept: &I, mask: T::Mask) -> I {
    let lanes = (0..T::LANES).filter(|&lane| mask.lane(lane));
    lanes.for_each(|lane| anew.set_lane(lane, &kept.lane(lane)));
    anew
}
