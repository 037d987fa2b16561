//! A system with a step size: what a person integrates with.

mod each;
mod formulas;
mod refusal;
mod staggered;
mod step_size;

use crate::space::check_lanes;
use crate::{Clebsch, Clock, Conserves, CotangentState, Error, Mask, Scalar, Space, State, Time, Trajectory};
use num_traits::Zero;

/// A system, a step size and what no step changes, computed once.
///
/// Made by [`Clebsch::stepper`]. Nothing in it changes from step to step: one stepper can serve any number of states.
#[derive(Clone, Debug)]
pub struct Stepper<S: Clebsch> {
    pub(crate) system: S,
    pub(crate) h: S::Scalar,
    pub(crate) constants: S::Constants,
}

impl<S: Clebsch> Stepper<S> {
    /// Checks `h` and the parameters of `system`.
    pub(crate) fn new(system: S, h: S::Scalar) -> Result<Self, Error> {
        check_lanes::<S::Scalar>(|lane| match h.lane(lane) {
            h if h.is_finite() && h != Zero::zero() => Ok(()),
            h => Err(Error::StepSize { value: h.to_f64() }),
        })?;
        let constants = system.constants(h)?;
        Ok(Self { system, h, constants })
    }

    /// The state (q, N), after checks: finite, q on its orbit, N in 𝔤_q^⊥, the momenta that motions of q can have.
    ///
    /// What is accepted as round-off of the input is √ε: 1.5e-8 for `f64`, 3.5e-4 for `f32`; for N relative to its largest
    /// component. [`project`](Self::project) gives the nearest N that is accepted. Where the time matters it starts at 0.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OffOrbit`] or [`Error::OutsideMomentumSpace`].
    pub fn state(&self, q: S::Configuration, mu: S::Momentum) -> Result<State<S>, Error> {
        self.checked_state(S::Scalar::zero(), q, mu)
    }

    /// The state (q, p) on T*Q, after checks: finite, q on its orbit. Where the time matters it starts at 0.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::OffOrbit`].
    pub fn cotangent_state(&self, q: S::Configuration, p: S::Configuration) -> Result<CotangentState<S>, Error> {
        self.checked_cotangent_state(S::Scalar::zero(), q, p)
    }

    /// The momentum nearest to `mu` that motions of q can have: the orthogonal projection of its components to 𝔤_q^⊥.
    ///
    /// `mu` itself where the action is free or the declaration says `isotropy = free`.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::OffOrbit`].
    pub fn project(&self, q: &S::Configuration, mu: &S::Momentum) -> Result<S::Momentum, Error> {
        self.check_configuration(q)?;
        let projected = self.system.project_momentum(q, mu);
        if !(mu.is_finite() && projected.is_finite()) {
            return Err(Error::NotFinite { name: "the momentum" });
        }
        Ok(projected)
    }

    /// One step of the discrete Euler–Poincaré representation: (q_k, N_k) ↦ (q_{k+1}, N_{k+1}).
    ///
    /// # Errors
    /// [`Error::Unsolvable`] where the step is too long for the momentum, [`Error::NotFinite`] where the potential gave
    /// NaN or numbers overflowed, [`Error::NotConverged`]. Where the scalar has lanes: [`Error::InLane`].
    // a call hands states through memory, which costs as much as half of a short step; long ones stay calls within
    #[inline(always)]
    pub fn step(&self, state: &State<S>) -> Result<State<S>, Error> {
        self.step_with(state, &S::Input::origin())
    }

    /// One step during which the input of the forces is `u`; [`step`](Self::step) is that with none, all zero.
    ///
    /// By the discrete Lagrange–d'Alembert principle the force acts at both ends, of second order in h. A forced step is not symplectic,
    /// and conserves those momenta alone on which the force does not act.
    ///
    /// # Errors
    /// As [`step`](Self::step), and [`Error::NotFinite`] where the input is not.
    #[inline(always)]
    pub fn step_with(&self, state: &State<S>, u: &S::Input) -> Result<State<S>, Error> {
        if size_of::<S::Input>() > 0 && !u.is_finite() {
            return Err(Error::NotFinite { name: "the input" });
        }
        // copies: what is handed on by reference would be kept in memory at every step; and without the error, with which the numbers of a step that
        // succeeds would be read by halves
        let Ok(next) = self.attempt(state, u) else {
            let (before, u) = (*state, *u);
            return Err(self.refused(&before, &u));
        };
        if !next.is_finite() {
            let reached = next;
            return Err(self.beyond(&reached));
        }
        Ok(next)
    }

    /// One step into the place of another state, which holds none where this fails.
    ///
    /// # Errors
    /// Those of [`step_with`](Self::step_with).
    #[inline]
    pub(crate) fn step_into(&self, state: &State<S>, u: &S::Input, next: &mut State<S>) -> Result<(), Error> {
        if size_of::<S::Input>() > 0 && !u.is_finite() {
            return Err(Error::NotFinite { name: "the input" });
        }
        let (t, State { configuration: q, held, impulse, .. }) = (state.time.now(), state);
        let into = (&mut next.configuration, &mut next.held, &mut next.impulse);
        let stepped = match size_of::<S::Impulse>() == 0 || state.h == self.h {
            true => self.system.step_into(&self.constants, t, (q, held, impulse), u, into),
            false => self.system.step_into(&self.constants, t, (q, held, &self.impulse_of(state)), u, into),
        };
        if stepped.is_err() {
            return Err(self.refused(state, u));
        }
        (next.time, next.h) = (state.time.after_step(self.h), self.h);
        if next.is_finite() { Ok(()) } else { Err(self.beyond(next)) }
    }

    /// The state after `steps` steps.
    ///
    /// The same as stepping so often but for rounding, and faster: no state between is made, and splittings drift from one step into the next.
    ///
    /// # Errors
    /// As [`step`](Self::step), at whichever step; `state` is untouched. Where the scalar has lanes, [`Error::InLane`] names one of those that fail:
    /// take the lanes one by one, or step after step, to know the others and how far each came.
    #[inline]
    pub fn advance(&self, state: &State<S>, steps: usize) -> Result<State<S>, Error> {
        let State { time, configuration, held, .. } = state;
        let (impulse, none) = (self.impulse_of(state), S::Input::origin());
        let advanced =
            self.system.steps(&self.constants, (time.now(), self.h), steps, configuration, held, &impulse, &none);
        let (configuration, held, impulse) = match advanced {
            Ok(next) => next,
            Err(error) => return Err(self.refused_after(state, steps, error)),
        };
        let time = (0..steps).fold(*time, |time, _| time.after_step(self.h));
        let next = State { time, configuration, held, impulse, h: self.h };
        if !next.is_finite() {
            let error = self.beyond(&next);
            return Err(self.refused_after(state, steps, error));
        }
        Ok(next)
    }

    /// The error of the first of so many steps that fails, each made by itself; `known` where none does.
    #[cold]
    #[inline(never)]
    fn refused_after(&self, start: &State<S>, steps: usize, known: Error) -> Error {
        let mut state = *start;
        for _ in 0..steps {
            match self.step(&state) {
                Ok(next) => state = next,
                Err(error) => return error,
            }
        }
        whole_or_lane::<S::Scalar>(0, known)
    }

    /// A step before it is checked. Lanes in which the implicit equation has no solution are NaN.
    ///
    /// # Errors
    /// Where no lane has a solution, the error of the first whose momentum is finite.
    #[inline(always)]
    fn attempt(&self, state: &State<S>, u: &S::Input) -> Result<State<S>, Error> {
        self.attempt_with(state, &self.impulse_of(state), u)
    }

    /// The same with the impulse at the configuration.
    ///
    /// # Errors
    /// Those of [`attempt`](Self::attempt).
    #[inline(always)]
    pub(crate) fn attempt_with(&self, state: &State<S>, impulse: &S::Impulse, u: &S::Input) -> Result<State<S>, Error> {
        let State { time, configuration, held, .. } = state;
        match self.system.step(&self.constants, time.now(), configuration, held, impulse, u) {
            Ok((configuration, held, impulse)) => {
                Ok(State { time: time.after_step(self.h), configuration, held, impulse, h: self.h })
            }
            Err(error) => Err(error),
        }
    }

    /// The error of a step that no lane can make, which is tried once more for it.
    #[cold]
    #[inline(never)]
    fn refused(&self, state: &State<S>, u: &S::Input) -> Error {
        match self.attempt(state, u) {
            Err(error) if S::Scalar::LANES == 1 => self.refusal(state, u, 0, error),
            // by construction an error: the same step has the same result
            _ => Error::InLane { lane: 0 },
        }
    }

    /// The error of a step whose state is not finite in some lane.
    #[cold]
    fn beyond(&self, next: &State<S>) -> Error {
        let finite = next.finite();
        let lane = (0..S::Scalar::LANES).find(|&lane| !finite.lane(lane)).unwrap_or(0);
        whole_or_lane::<S::Scalar>(lane, self.overflow(next, lane))
    }

    /// The impulse that a state brings along, or a new one in the lanes in which a stepper of another step size has made it.
    #[inline]
    fn impulse_of(&self, state: &State<S>) -> S::Impulse {
        if size_of::<S::Impulse>() == 0 || state.h == self.h {
            return state.impulse;
        }
        let State { time, configuration, impulse, .. } = state;
        let anew = self.system.impulse_after(&self.constants, time.now(), configuration, &state.momentum(), impulse);
        if S::Scalar::LANES == 1 { anew } else { kept_in_lanes(anew, &state.impulse, state.h.equals(self.h)) }
    }

    /// One step of the discrete symmetric representation on T*Q: (q_k, p_k) ↦ (q_{k+1}, p_{k+1}).
    ///
    /// # Errors
    /// As [`step`](Self::step), and [`Error::NoCovector`] where forces act or momenta are stepped alone.
    #[inline]
    pub fn step_symmetric(&self, state: &CotangentState<S>) -> Result<CotangentState<S>, Error> {
        let CotangentState { time, configuration, covector } = state;
        let (configuration, covector) =
            match self.system.step_symmetric(&self.constants, time.now(), configuration, covector) {
                Ok(next) => next,
                Err(_) if S::Scalar::LANES > 1 => return Err(Error::InLane { lane: 0 }),
                Err(error) => return Err(self.refusal_of_covector(state, error)),
            };
        let next = CotangentState { time: time.after_step(self.h), configuration, covector };
        let finite: <S::Scalar as Scalar>::Mask = next.finite();
        match (0..S::Scalar::LANES).find(|&lane| !finite.lane(lane)) {
            None => Ok(next),
            Some(lane) => Err(whole_or_lane::<S::Scalar>(lane, Error::NotFinite { name: next.overflowed(lane) })),
        }
    }

    /// The states of all steps, `start` first; ends after the first error.
    #[inline]
    pub fn trajectory(&self, start: State<S>) -> Trajectory<'_, S> {
        Trajectory::new(self, start)
    }

    /// Kinetic energy plus potential, at the time of the state.
    ///
    /// Nearly constant for an autonomous system: its oscillation shrinks with the order.
    #[inline]
    pub fn energy(&self, state: &State<S>) -> S::Scalar {
        self.kinetic_energy(state) + self.system.potential(state.time.now(), &state.configuration)
    }

    /// Kinetic energy N·ξ − ℓ(q, ξ) at the velocity ξ with the momentum N = ∂ℓ/∂ξ: ½ N·Σ⁻¹N where ℓ is quadratic with the
    /// Hessian Σ; +∞ where no velocity has this momentum.
    #[inline]
    pub fn kinetic_energy(&self, state: &State<S>) -> S::Scalar {
        self.system.kinetic_energy(&self.constants, state.time.now(), &state.configuration, &state.momentum())
    }

    /// The step size h, seconds in SI units.
    #[inline]
    pub fn step_size(&self) -> S::Scalar {
        self.h
    }

    /// The system.
    #[inline]
    pub fn system(&self) -> &S {
        &self.system
    }

    /// What no step changes.
    #[inline]
    pub(crate) fn constants(&self) -> &S::Constants {
        &self.constants
    }

    fn checked_state(&self, t: S::Scalar, q: S::Configuration, mu: S::Momentum) -> Result<State<S>, Error> {
        self.check_configuration(&q)?;
        check_momentum(&self.system, &q, &mu)?;
        self.made_state(t, q, mu)
    }

    /// The state (q, N) with what its first step takes.
    fn made_state(&self, t: S::Scalar, q: S::Configuration, mu: S::Momentum) -> Result<State<S>, Error> {
        let impulse = self.system.impulse(&self.constants, t, &q, &mu);
        if !impulse.is_finite() {
            let has_gradient = (0..S::Scalar::LANES).all(|lane| self.has_gradient(t, &q, lane));
            let name = if has_gradient { "the velocity of this momentum" } else { GRADIENT };
            return Err(Error::NotFinite { name });
        }
        let held = S::held(&q, &mu);
        Ok(State { time: S::Time::at(t), configuration: q, held, impulse, h: self.h })
    }

    fn checked_cotangent_state(
        &self,
        t: S::Scalar,
        q: S::Configuration,
        p: S::Configuration,
    ) -> Result<CotangentState<S>, Error> {
        self.check_configuration(&q)?;
        if !p.is_finite() {
            return Err(Error::NotFinite { name: "the covector" });
        }
        Ok(CotangentState { time: S::Time::at(t), configuration: q, covector: p })
    }

    /// q is finite and on its orbit, up to √ε.
    pub(crate) fn check_configuration(&self, q: &S::Configuration) -> Result<(), Error> {
        check_configuration(&self.system, q)
    }
}

/// The impulse `kept` in the lanes of the mask, `anew` in the others.
#[cold]
#[inline(never)]
fn kept_in_lanes<T: Scalar, I: Space<T>>(mut anew: I, kept: &I, mask: T::Mask) -> I {
    let lanes = (0..T::LANES).filter(|&lane| mask.lane(lane));
    lanes.for_each(|lane| anew.set_lane(lane, &kept.lane(lane)));
    anew
}

/// The error itself where the scalar is a single number, else the lane.
fn whole_or_lane<T: Scalar>(lane: usize, error: Error) -> Error {
    if T::LANES == 1 { error } else { Error::InLane { lane } }
}

/// q is finite and on its orbit, up to √ε.
pub(crate) fn check_configuration<S: Clebsch>(system: &S, q: &S::Configuration) -> Result<(), Error> {
    check_on_orbit(q, system.orbit_defect(q))
}

/// The same with the defect of q.
pub(crate) fn check_on_orbit<T: Scalar, Q: Space<T>>(q: &Q, defect: T) -> Result<(), Error> {
    if !q.is_finite() {
        return Err(Error::NotFinite { name: "the configuration" });
    }
    let tolerance = T::Lane::EPSILON.sqrt();
    check_lanes::<T>(|lane| {
        let defect = defect.lane(lane);
        if defect <= tolerance {
            return Ok(());
        }
        let size = q.max_abs().lane(lane);
        // NaN, or infinite though of the right component
        let overflows = defect.partial_cmp(&tolerance).is_none() || !(size * size).is_finite();
        let defect = if overflows { f64::MAX } else { defect.to_f64() };
        Err(Error::OffOrbit { defect, tolerance: tolerance.to_f64() })
    })
}

/// N is finite and, up to √ε of its largest component, a momentum that motions of q can have.
pub(crate) fn check_momentum<S: Clebsch>(system: &S, q: &S::Configuration, mu: &S::Momentum) -> Result<(), Error> {
    if !mu.is_finite() {
        return Err(Error::NotFinite { name: "the momentum" });
    }
    let tolerance = S::Scalar::EPSILON.sqrt() * mu.max_abs();
    let violation = system.isotropy_defect(q, mu);
    check_lanes::<S::Scalar>(|lane| {
        let (violation, tolerance) = (violation.lane(lane), tolerance.lane(lane));
        // Written so that NaN is a violation.
        if violation <= tolerance {
            return Ok(());
        }
        // the length of many of the largest numbers is beyond them
        let violation = violation.to_f64().min(f64::MAX);
        Err(Error::OutsideMomentumSpace { violation, tolerance: tolerance.to_f64() })
    })
}

/// Where the cost or the potential depends on the time.
impl<S: Clebsch<Time = Clock<<S as Clebsch>::Scalar>>> Stepper<S> {
    /// The state (q, N) at the time t, checked as by [`state`](Self::state).
    ///
    /// # Errors
    /// As [`state`](Self::state); [`Error::NotFinite`] for the time too.
    pub fn state_at(&self, t: S::Scalar, q: S::Configuration, mu: S::Momentum) -> Result<State<S>, Error> {
        check_time(t)?;
        self.checked_state(t, q, mu)
    }

    /// The state (q, p) on T*Q at the time t, checked as by [`cotangent_state`](Self::cotangent_state).
    ///
    /// # Errors
    /// As [`cotangent_state`](Self::cotangent_state); [`Error::NotFinite`] for the time too.
    pub fn cotangent_state_at(
        &self,
        t: S::Scalar,
        q: S::Configuration,
        p: S::Configuration,
    ) -> Result<CotangentState<S>, Error> {
        check_time(t)?;
        self.checked_cotangent_state(t, q, p)
    }
}

/// What is not finite where a kick is not.
const GRADIENT: &str = "the gradient of the potential at the configuration";

fn check_gradient<T: Scalar, I: Space<T>>(kick: &I) -> Result<(), Error> {
    if kick.is_finite() { Ok(()) } else { Err(Error::NotFinite { name: GRADIENT }) }
}

pub(crate) fn check_time<T: Scalar>(t: T) -> Result<(), Error> {
    if t.is_finite() { Ok(()) } else { Err(Error::NotFinite { name: "the time" }) }
}

/// Where conserved momenta were found.
impl<S: Conserves> Stepper<S> {
    /// The momenta that no step changes, with their names: what the symmetry of cost and potential leaves.
    #[inline]
    pub fn conserved(&self, state: &State<S>) -> S::Conserved {
        self.system.conserved(&state.configuration, &state.momentum())
    }
}
