//! A system with a step size, for integration.

// first, as a page shows methods in the order of their files
mod stepping;

mod formulas;
mod impulses;
mod reactions;
mod refusal;
mod sizes;
mod staggered;
pub(crate) mod step_size;
mod symmetric;

use crate::constraint::within;
use crate::fields::{debug_fields, getters};
use crate::parameters::check_finite;
use crate::scheme::{At, Constants, Scheme};
use crate::{
    Clebsch, Clock, Conserves, Constrained, CotangentState, Declared, Error, Mask, Method, Scalar, Space, State, Time,
};
use core::fmt::Debug;
use num_traits::{One, Zero};

/// A system, a step size and the constants of its steps, computed once.
///
/// Made by [`Clebsch::stepper`], or by [`Clebsch::stepper_by`] for a [`Method`] with a name. Nothing in it changes from step to step: one stepper can serve any number of states.
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
/// // 8 N/m on 2 kg: 2 radians per second
/// let stepper = Spring { mass: 2.0, stiffness: 8.0 }.into_stepper(0.01)?;
/// let start = stepper.state(Vector1::new(0.5), Vector1::zeros())?;
/// let later = stepper.advance(&start, 314)?; // a period of π s
/// assert!((later.configuration().x - 0.5).abs() < 1e-4);
/// assert!((stepper.energy(&later) - stepper.energy(&start)).abs() < 1e-4);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Stepper<S: Clebsch, M: Method<S> = Declared> {
    pub(crate) system: S,
    pub(crate) h: S::Scalar,
    pub(crate) constants: Constants<S, M>,
}

// a derived one would ask for methods that are `Clone`
impl<S: Clebsch + Clone, M: Method<S>> Clone for Stepper<S, M> {
    fn clone(&self) -> Self {
        Self { system: self.system.clone(), h: self.h, constants: self.constants.clone() }
    }
}

debug_fields!(Stepper<S, M> where [S: Clebsch + Debug, M: Method<S>]: system, h, constants);

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// Checks `h` and the parameters of `system`.
    pub(crate) fn new(system: S, h: S::Scalar) -> Result<Self, Error> {
        check_step_size(h)?;
        let constants = M::Scheme::constants(&system, h)?;
        Ok(Self { system, h, constants })
    }

    /// At the time t.
    #[inline(always)]
    pub(crate) fn at(&self, t: S::Scalar) -> At<'_, S, M, Constants<S, M>> {
        At::new(&self.system, &self.constants, t)
    }

    /// q is finite and on its orbit, up to √ε.
    pub(crate) fn check_configuration(&self, q: &S::Configuration) -> Result<(), Error> {
        check_on_orbit(q, self.system.orbit_defect(q))
    }

    /// The same, the kinetic energy is positive there at the time t, and steps can start there.
    pub(crate) fn check_place(&self, t: S::Scalar, q: &S::Configuration) -> Result<(), Error> {
        self.check_configuration(q)?;
        self.system.check_kinetic_energy(t, q)?;
        M::Scheme::check_monitor(self.at(t), q)
    }

    /// (q, N) is a state at the time t.
    pub(crate) fn check_state(&self, t: S::Scalar, q: &S::Configuration, mu: &S::Momentum) -> Result<(), Error> {
        check_momentum(&self.system, q, mu)?;
        self.system.check_kinetic_energy(t, q)?;
        self.system.check_place(t, q)?;
        M::Scheme::check_monitor(self.at(t), q)?;
        M::constraint_defect(&self.system, M::Scheme::whole(&self.constants), t, q, mu)?.check()
    }

    /// Kinetic energy plus potential, at the time of the state.
    ///
    /// Nearly constant for an autonomous system: its oscillation shrinks with the order.
    #[inline]
    pub fn energy(&self, state: &State<S, M>) -> S::Scalar {
        self.kinetic_energy(state) + self.system.potential(state.time.now(), &state.configuration)
    }

    /// Kinetic energy N·ξ − ℓ(q, ξ) at the velocity with N = ∂ℓ/∂ξ. It is ½ N·Σ⁻¹N for a quadratic ℓ with the Hessian
    /// Σ, and +∞ if no velocity has this momentum.
    #[inline]
    pub fn kinetic_energy(&self, state: &State<S, M>) -> S::Scalar {
        let constants = M::Scheme::whole(&self.constants);
        M::kinetic_energy(&self.system, constants, state.time.now(), &state.configuration, &state.momentum())
    }

    /// The step size h, seconds in SI units. With `step` it is that of s, in the units of the time over those of the monitor.
    #[inline]
    pub fn step_size(&self) -> S::Scalar {
        self.h
    }

    getters! {
        /// The system.
        ref system: S;
    }

    /// The state nearest to (q, N), which need not be one. Where the time matters it starts at 0.
    ///
    /// Its momentum is the orthogonal projection of N to 𝔤_q^⊥, the momenta that motions of q can have. With a
    /// constraint it is nearest in the kinetic energy: N + Aᵀκ, whose velocity obeys the constraint.
    ///
    /// A constraint on places moves q first. Newton's method takes motions along Σ⁻¹Aᵀ until φ(q) = 0 to rounding. The
    /// distance is of the order of the violation.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<2>, x: Vector2| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     constraint = |x| [x.norm_squared() == 25],
    /// # )]
    /// # struct Bob { mass: f64 }
    /// # use nalgebra::Vector2;
    /// let stepper = Bob { mass: 2.0 }.into_stepper(0.1)?;
    /// let start = stepper.project(Vector2::new(3.3, 4.4), Vector2::new(1.0, 0.0))?;
    /// assert!((start.configuration() - Vector2::new(3.0, 4.0)).norm() < 1e-14);
    /// assert!((start.momentum() - Vector2::new(0.64, -0.48)).norm() < 1e-14);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OffOrbit`], [`Error::FarFromConstraint`], [`Error::DependentConstraints`], or
    /// [`Error::IndefiniteKineticEnergy`] as for [`state`](Self::state).
    pub fn project(&self, q: S::Configuration, mu: S::Momentum) -> Result<State<S, M>, Error> {
        self.projected_at(Zero::zero(), q, mu)
    }

    pub(crate) fn projected_at(
        &self,
        t: S::Scalar,
        q: S::Configuration,
        mu: S::Momentum,
    ) -> Result<State<S, M>, Error> {
        self.check_configuration(&q)?;
        check_finite("the momentum", &mu)?;
        let constants = M::Scheme::whole(&self.constants);
        let q = M::placed(&self.system, constants, t, &q)?;
        let projected = self.system.project_momentum(&q, &mu);
        check_finite("the momentum", &projected)?;
        let projected = M::constrained(&self.system, constants, t, &q, &projected)?;
        self.checked_state(t, q, projected)
    }
}

/// A step size is finite, and not zero.
pub(crate) fn check_step_size<T: Scalar>(h: T) -> Result<(), Error> {
    (0..T::LANES).try_for_each(|lane| match h.lane(lane) {
        h if h.is_finite() && h != Zero::zero() => Ok(()),
        h => Err(Error::StepSize { value: h.to_f64() }),
    })
}

// a bound of the method, not of the block: its error then names the missing part
impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The momenta that no step changes, with their names: those that the symmetry of cost and potential conserves.
    ///
    /// It exists where conserved momenta were found, and gives a [`Conserved`](crate::Conserved).
    #[inline]
    pub fn conserved<C>(&self, state: &State<S, M>) -> C
    where
        S: Conserves<Conserved = C>,
    {
        self.system.conserved(&state.configuration, &state.momentum())
    }
}

/// Where the declaration has a constraint.
impl<S: Constrained, M: Method<S>> Stepper<S, M> {
    /// The state at q with the velocity ξ, in the components of all factors: N is the momentum ∂ℓ/∂ξ. Where the time
    /// matters it starts at 0.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<2>, x: Vector2| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     constraint = |x, v| [v.x == x.x * v.y],
    /// # )]
    /// # struct Particle { mass: f64 }
    /// # use nalgebra::Vector2;
    /// let stepper = Particle { mass: 2.0 }.into_stepper(0.1)?;
    /// let place = Vector2::new(0.5, 0.0);
    /// let start = stepper.state_moving(place, Vector2::new(0.5, 1.0))?;
    /// assert_eq!(start.momentum(), Vector2::new(1.0, 2.0));
    ///
    /// let refused = stepper.state_moving(place, Vector2::new(1.0, 1.0));
    /// assert!(matches!(refused, Err(Error::ConstraintViolated { violation: 0.5, .. })));
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`state`](Self::state); [`Error::NotFinite`] for the velocity too.
    pub fn state_moving(&self, q: S::Configuration, velocity: S::Momentum) -> Result<State<S, M>, Error> {
        check_finite("the velocity", &velocity)?;
        let t = Zero::zero();
        let mu = self.system.momentum_of_velocity(t, &q, &velocity);
        self.checked_state(t, q, mu)
    }
}

/// Where the cost or the potential depends on the time.
impl<S: Clebsch<Time = Clock<<S as Clebsch>::Scalar>>, M: Method<S>> Stepper<S, M> {
    /// The state (q, N) at the time t, checked as by [`state`](Self::state).
    ///
    /// # Errors
    /// As [`state`](Self::state); [`Error::NotFinite`] for the time too.
    pub fn state_at(&self, t: S::Scalar, q: S::Configuration, mu: S::Momentum) -> Result<State<S, M>, Error> {
        check_finite("the time", &t)?;
        self.checked_state(t, q, mu)
    }

    /// The state nearest to (q, N) at the time t, as [`project`](Self::project).
    ///
    /// # Errors
    /// As [`project`](Self::project); [`Error::NotFinite`] for the time too.
    pub fn project_at(&self, t: S::Scalar, q: S::Configuration, mu: S::Momentum) -> Result<State<S, M>, Error> {
        check_finite("the time", &t)?;
        self.projected_at(t, q, mu)
    }

    /// The state at the time t, made as by [`staggered_state`](Self::staggered_state).
    ///
    /// # Errors
    /// As [`staggered_state`](Self::staggered_state); [`Error::NotFinite`] for the time too.
    pub fn staggered_state_at(&self, t: S::Scalar, q: S::Configuration, mu: S::Momentum) -> Result<State<S, M>, Error> {
        check_finite("the time", &t)?;
        self.checked_staggered_state(t, q, mu)
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
        check_finite("the time", &t)?;
        self.checked_cotangent_state(t, q, p)
    }
}

/// q is finite and, by this defect, on its orbit, up to √ε.
pub fn check_on_orbit<T: Scalar, Q: Space<T>>(q: &Q, defect: T) -> Result<(), Error> {
    check_finite("the configuration", q)?;
    let tolerance = T::Lane::EPSILON.sqrt();
    (0..T::LANES).try_for_each(|lane| {
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

/// Whether (q, N) is a state: its momentum is checked. The kinetic energy is positive at q where it does not depend on the time.
pub fn check_state<S: Clebsch>(system: &S, q: &S::Configuration, mu: &S::Momentum) -> Result<(), Error> {
    check_momentum(system, q, mu)?;
    // a plan starts at a time that is not known here
    let is_autonomous = size_of::<S::Time>() == 0;
    if is_autonomous { system.check_kinetic_energy(Zero::zero(), q) } else { Ok(()) }
}

/// Whether q obeys the constraint at the time t, and (q, N) if it moves. A violation may move it by a part √ε of 1 + |q| in a step: a
/// body at rest has no velocity to compare with.
pub fn check_constraint<S: Clebsch>(
    system: &S,
    constants: &S::Constants,
    (t, h): (S::Scalar, S::Scalar),
    (q, mu): &(S::Configuration, S::Momentum),
    moves: bool,
) -> Result<(), Error> {
    system.check_place(t, q)?;
    if !moves {
        return Ok(());
    }
    let violation = system.constraint_defect(constants, t, q, mu)?;
    let slight = S::Scalar::EPSILON.sqrt() * (S::Scalar::one() + q.max_abs());
    if (violation.largest * h.abs()).at_most(slight).all() { Ok(()) } else { violation.check() }
}

/// Whether q is on its orbit, and N is finite. Up to √ε of its largest component, N is a momentum that motions of q can have.
pub(crate) fn check_momentum<S: Clebsch>(system: &S, q: &S::Configuration, mu: &S::Momentum) -> Result<(), Error> {
    check_on_orbit(q, system.orbit_defect(q))?;
    check_finite("the momentum", mu)?;
    check_violation(system.isotropy_defect(q, mu), mu)
}

/// The part of μ that is no momentum of a motion is at most √ε of the largest component.
pub(crate) fn check_violation<T: Scalar, N: Space<T>>(violation: T, mu: &N) -> Result<(), Error> {
    within(violation, T::EPSILON.sqrt() * mu.max_abs())
        .map_err(|[violation, tolerance]| Error::OutsideMomentumSpace { violation, tolerance })
}

/// The name of a kick that is not finite.
pub(crate) const GRADIENT: &str = "the gradient of the potential at the configuration";

/// The first lane that is not in a mask; 0 where all are.
fn first_without<T: Scalar>(mask: T::Mask) -> usize {
    (0..T::LANES).find(|&lane| !mask.lane(lane)).unwrap_or(0)
}

/// The error itself where the scalar is a single number, else the lane.
fn whole_or_lane<T: Scalar>(lane: usize, error: Error) -> Error {
    if T::LANES == 1 { error } else { Error::InLane { lane } }
}
