//! Steps of other sizes than the stepper's own.

use super::stepping::check_input;
use super::{Stepper, check_step_size, whole_or_lane};
use crate::parameters::check_finite;
use crate::parts::{Mu, T, U};
use crate::scheme::{At, Constants, Scheme, time_after};
use crate::space::minus;
use crate::{Clebsch, Error, Mask, Method, Scalar, Space, State, Time};

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// A stepper of another step size, on a copy of this system. Its states are those of this stepper, and the other way
    /// round: a step of either goes on from them.
    ///
    /// It checks the parameters again and computes the constants of its steps, as [`Clebsch::stepper_by`] does. For one
    /// step of its own size, such as that of a frame, [`step_for`](Self::step_for) needs no copy.
    ///
    /// With `order = 1` take states over by [`state_of`](Self::state_of): their momenta are ahead by half a kick of the
    /// step size.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
    /// # struct Particle { mass: f64 }
    /// # use nalgebra::Vector1;
    /// let coarse = Particle { mass: 2.0 }.into_stepper(0.5)?;
    /// let fine = coarse.with_step_size(0.125)?;
    /// let start = coarse.state(Vector1::zeros(), Vector1::new(6.0))?;
    /// let later = fine.step(&coarse.step(&start)?)?;
    /// assert_eq!(later.configuration().x, 1.875);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::StepSize`], and those of [`Method::constants`].
    pub fn with_step_size(&self, h: S::Scalar) -> Result<Self, Error>
    where
        S: Clone,
    {
        self.system.stepper_by(h)
    }

    /// One step of the size `duration`, in place of that of the stepper: of the same method, and so of the same order.
    ///
    /// It is for frames of an engine, for a time between two steps, and for the end of a run. Conserved momenta stay
    /// exact. The energy stays in its band for steps of one size only: over a long run of different sizes it drifts.
    ///
    /// A step of the stepper's own size is [`step`](Self::step), to the last bit.
    /// The constants of another one are computed each time. That costs about as much as a step where the system is small. A
    /// step that is the free motion itself needs none, as of a body with `discretization = exact`. Exact drifts with a potential
    /// take far longer than a step, for their series. There make a stepper [of that size](Self::with_step_size), once.
    ///
    /// The state that it returns goes on by this stepper, also with `order = 1`.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<1>, x: Vector1| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
    /// # )]
    /// # struct Spring { mass: f64, stiffness: f64 }
    /// # use nalgebra::Vector1;
    /// let stepper = Spring { mass: 2.0, stiffness: 8.0 }.into_stepper(0.01)?;
    /// let mut state = stepper.state(Vector1::new(0.5), Vector1::zeros())?;
    /// // frames of a sixtieth of a second, more or less
    /// for frame in [0.016, 0.017, 0.018, 0.016] {
    ///     state = stepper.step_for(&state, frame)?;
    /// }
    /// let angle: f64 = 2.0 * 0.067;
    /// assert!((state.configuration().x - 0.5 * angle.cos()).abs() < 1e-5);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::StepSize`] where the duration is zero or not finite, and those of [`step`](Self::step).
    #[inline]
    pub fn step_for(&self, state: &State<S, M>, duration: S::Scalar) -> Result<State<S, M>, Error> {
        self.step_for_with(state, duration, &S::Input::origin())
    }

    /// The same while the input of the forces is `u`, as [`step_with`](Self::step_with).
    ///
    /// # Errors
    /// As [`step_for`](Self::step_for), and [`Error::NotFinite`] where the input is not.
    pub fn step_for_with(&self, state: &State<S, M>, duration: S::Scalar, u: &S::Input) -> Result<State<S, M>, Error> {
        check_input::<S>(u)?;
        check_step_size(duration)?;
        if duration == self.h {
            return self.step_with(state, u);
        }
        if M::IS_FREE_MOTION && size_of::<S::Time>() == 0 && S::Scalar::EPSILON.at_most((duration / self.h).abs()).all()
        {
            return self.moved_freely(state, duration);
        }
        let constants = M::Scheme::constants(&self.system, duration)?;
        let start = self.resized(state, [self.h, duration], &constants)?;
        let State { time, configuration, held, left, .. } = &start;
        let at = At::new(&self.system, &constants, time.now());
        let (configuration, held, left) = match M::Scheme::step(at, (configuration, held, left), u) {
            Ok(stepped) => stepped,
            Err(error) => return Err(self.refused_for(&start, u, error)),
        };
        let time = time_after::<S, M>(*time, (duration, 1), &left);
        let next = State { time, configuration, held, left, h: duration };
        if !self.is_sound(&next) {
            return Err(self.beyond(&next));
        }
        if M::ORDER == 1 { self.resized(&next, [duration, self.h], &self.constants) } else { Ok(next) }
    }

    /// A free motion of the time τ with the momentum N is one of the time h with τ/h N: no constants are computed.
    fn moved_freely(&self, state: &State<S, M>, duration: T<S>) -> Result<State<S, M>, Error> {
        let ratio = duration / self.h;
        let (at, q) = (self.at(state.time.now()), &state.configuration);
        let times = |mu: Mu<S>, factor| mu.zip_map(&mu, |mu, _| mu * factor);
        let mu = times(state.momentum(), ratio);
        check_finite("the momentum of a step of this size", &mu)?;
        let held = M::Scheme::held(q, &mu);
        let left = M::Scheme::left_after(at, q, &mu, &self.left_of(state));
        let start = State { held, left, h: duration, ..*state };
        let (configuration, held, left) = match M::Scheme::step(at, (q, &held, &left), &S::Input::origin()) {
            Ok(stepped) => stepped,
            Err(error) => return Err(self.refused_for(&start, &S::Input::origin(), error)),
        };
        let q = &configuration;
        let mu = times(M::Scheme::momentum(q, &held), ratio.recip());
        let left = M::Scheme::left_after(at, q, &mu, &left);
        let next = State { configuration, held: M::Scheme::held(q, &mu), left, h: self.h, ..*state };
        if self.is_sound(&next) { Ok(next) } else { Err(self.beyond(&next)) }
    }

    /// A state for steps of another size with these constants. With `order = 1` its momentum is ahead by half a kick, of
    /// the size `from` before and of the size h after.
    fn resized(
        &self,
        state: &State<S, M>,
        [from, h]: [T<S>; 2],
        constants: &Constants<S, M>,
    ) -> Result<State<S, M>, Error> {
        if state.h == h && (M::ORDER != 1 || from == h) {
            return Ok(*state);
        }
        let (t, q) = (state.time.now(), &state.configuration);
        let at = At::new(&self.system, constants, t);
        let left = M::Scheme::left_after(at, q, &state.momentum(), &state.left);
        let mut resized = State { left, h, ..*state };
        if M::ORDER == 1 {
            let ahead = |h| M::stagger(&self.system, h, t, q);
            let impulse = minus(&ahead(h), &ahead(from));
            check_finite("the momentum half a kick ahead", &impulse)?;
            (resized.held, resized.left) = M::Scheme::kicked(at, q, (&resized.held, &resized.left), &impulse);
        }
        Ok(resized)
    }

    /// The error of a step whose state is for steps of its size.
    #[cold]
    #[inline(never)]
    fn refused_for(&self, state: &State<S, M>, u: &U<S>, error: Error) -> Error {
        let error = if S::Scalar::LANES == 1 { self.refusal_of(state.h, state, u, 0, error) } else { error };
        whole_or_lane::<S::Scalar>(0, error)
    }
}
