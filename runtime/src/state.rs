//! The states that a step maps: (q, N), or (q, p) on the cotangent bundle.

use crate::fields::{copy, debug_fields, getters};
use crate::parts::{Mu, Q, T};
use crate::scheme::{Held, Left, Scheme};
use crate::{Clebsch, Clock, Declared, Error, Method, Scalar, Space, Time};
use core::fmt::{self, Debug, DebugStruct, Display, Formatter};

/// A configuration q with its momentum N, checked by [`Stepper::state`](crate::Stepper::state).
///
/// N is the momentum *before* the kick of the next step. It is the physical momentum at q, but with order 1 half a kick
/// ahead: read that by [`Stepper::synchronized`](crate::Stepper::synchronized). A state also carries the impulse at q,
/// which two steps share, or the constants of a free motion. A stepper of another step size computes its own. To go on
/// with another *system*, make a new state of [`configuration`](Self::configuration) and [`momentum`](Self::momentum).
/// Where the cost or the potential depends on the time, or with `step`, a state has its [`time`](Self::time).
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// let next = stepper.step(&start)?; // `start` stays as it is
/// assert_eq!((next.configuration().x, next.momentum().x), (1.5, 6.0));
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct State<S: Clebsch, M: Method<S> = Declared> {
    pub(crate) time: S::Time,
    pub(crate) configuration: S::Configuration,
    /// N, or its stored form.
    pub(crate) held: Held<S, M>,
    pub(crate) left: Left<S, M>,
    /// The step size that the impulse is for.
    pub(crate) h: S::Scalar,
}

impl<S: Clebsch, M: Method<S>> State<S, M> {
    getters! {
        /// The configuration q.
        ref configuration: S::Configuration;
    }

    /// The clock of the configuration: `()` where the time does not matter.
    ///
    /// For code over every system. Where the time matters, [`time`](Self::time) is the number.
    #[inline]
    pub fn clock(&self) -> S::Time {
        self.time
    }

    /// The momentum N in the basis that [`group`](crate::group) documents.
    ///
    /// A state of a point on a large sphere, which is turned in (q, w), makes its components here, n(n − 1)/2 of them.
    #[inline]
    pub fn momentum(&self) -> S::Momentum {
        M::Scheme::momentum(&self.configuration, &self.held)
    }

    /// (q, N)
    #[inline]
    pub fn into_parts(self) -> (S::Configuration, S::Momentum) {
        (self.configuration, self.momentum())
    }

    /// (q, N) of the body in lane `lane`, where the scalar has lanes.
    #[inline]
    pub fn lane(&self, lane: usize) -> Body<S> {
        (self.configuration.lane(lane), self.momentum().lane(lane))
    }

    /// The lanes in which all of it is finite.
    #[inline]
    pub(crate) fn finite(&self) -> <S::Scalar as Scalar>::Mask {
        self.configuration.finite() & self.held.finite() & Scalar::finite(self.time.now())
    }

    /// Whether all of it is finite in all lanes.
    #[inline]
    pub(crate) fn is_finite(&self) -> bool {
        self.configuration.all_finite() & self.held.all_finite() & Scalar::is_finite(self.time.now())
    }

    /// Takes lane `lane` of another state.
    pub(crate) fn take_lane(&mut self, lane: usize, other: &Self) {
        self.time.take_lane(lane, &other.time);
        self.configuration.set_lane(lane, &other.configuration.lane(lane));
        self.held.set_lane(lane, &other.held.lane(lane));
        self.left.set_lane(lane, &other.left.lane(lane));
        self.h.set_lane(lane, &Space::lane(&other.h, lane));
    }
}

/// A run that ended at a step that failed, with the last good state; see [`Stepper::advance_or_stop`](crate::Stepper::advance_or_stop).
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(1e307)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(16.0))?;
/// let stopped = stepper.advance_or_stop(&start, 1000).unwrap_err();
/// assert!(stopped.to_string().starts_with("after 2 steps: "));
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Stopped<S: Clebsch, M: Method<S> = Declared> {
    /// The last state that was reached.
    pub state: State<S, M>,
    /// The number of steps to it.
    pub steps: usize,
    /// Why the next step failed.
    pub error: Error,
}

copy!(Stopped<S, M> where [S: Clebsch, M: Method<S>]);
debug_fields!(Stopped<S, M> where [S: Clebsch, M: Method<S>]: state, steps, error);

impl<S: Clebsch, M: Method<S>> PartialEq for Stopped<S, M> {
    fn eq(&self, other: &Self) -> bool {
        self.state == other.state && self.steps == other.steps && self.error == other.error
    }
}

impl<S: Clebsch, M: Method<S>> Display for Stopped<S, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "after {} steps: {}", self.steps, self.error)
    }
}

impl<S: Clebsch, M: Method<S>> core::error::Error for Stopped<S, M> {}

impl<S: Clebsch, M: Method<S>> From<Stopped<S, M>> for Error {
    fn from(stopped: Stopped<S, M>) -> Self {
        stopped.error
    }
}

/// (q, N) of one body: of the single one, or of that in a lane.
///
/// ```
/// # use clebsch::{Body, Clebsch};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let body: Body<Particle> = (Vector1::zeros(), Vector1::new(6.0));
/// assert_eq!(body.1.x, 6.0);
/// ```
pub type Body<S> = (<Q<S> as Space<T<S>>>::Lane, <Mu<S> as Space<T<S>>>::Lane);

impl<S: Clebsch<Time = Clock<<S as Clebsch>::Scalar>>, M: Method<S>> State<S, M> {
    /// The time t of the configuration, seconds in SI units.
    #[inline]
    pub fn time(&self) -> S::Scalar {
        Time::now(&self.time)
    }
}

copy!(State<S, M> where [S: Clebsch, M: Method<S>]);

impl<S: Clebsch, M: Method<S>> PartialEq for State<S, M> {
    fn eq(&self, other: &Self) -> bool {
        self.time == other.time && self.configuration == other.configuration && self.held == other.held
    }
}

impl<S: Clebsch, M: Method<S>> Debug for State<S, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut state = f.debug_struct("State");
        show_time::<S>(&mut state, &self.time);
        state.field("configuration", &self.configuration).field("momentum", &self.momentum()).finish()
    }
}

/// A configuration q with a covector p at it, checked by [`Stepper::cotangent_state`](crate::Stepper::cotangent_state).
///
/// p has the shape of q and pairs with velocities of q entry by entry: ⟨p, v⟩ = tr(pᵀv). It belongs to no method: with `order = 1` p is half a kick ahead, as N is.
/// It has a [`time`](Self::time) where the cost or the potential depends on it.
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
/// let start = stepper.cotangent_state(Vector1::new(0.5), Vector1::new(1.0))?;
/// let next = stepper.step_symmetric(&start)?;
/// // translations: the covector is the momentum
/// let same = stepper.step(&stepper.state(Vector1::new(0.5), Vector1::new(1.0))?)?;
/// assert_eq!(next.configuration(), same.configuration());
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct CotangentState<S: Clebsch> {
    pub(crate) time: S::Time,
    pub(crate) configuration: S::Configuration,
    pub(crate) covector: S::Configuration,
}

impl<S: Clebsch> CotangentState<S> {
    getters! {
        /// The configuration q.
        ref configuration: S::Configuration;
        /// The covector p.
        ref covector: S::Configuration;
    }

    /// (q, p)
    #[inline]
    pub fn into_parts(self) -> (S::Configuration, S::Configuration) {
        (self.configuration, self.covector)
    }
}

impl<S: Clebsch<Time = Clock<<S as Clebsch>::Scalar>>> CotangentState<S> {
    /// The time t of the configuration, seconds in SI units.
    #[inline]
    pub fn time(&self) -> S::Scalar {
        Time::now(&self.time)
    }
}

copy!(CotangentState<S> where [S: Clebsch]);

impl<S: Clebsch> PartialEq for CotangentState<S> {
    fn eq(&self, other: &Self) -> bool {
        self.time == other.time && self.configuration == other.configuration && self.covector == other.covector
    }
}

impl<S: Clebsch> Debug for CotangentState<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut state = f.debug_struct("CotangentState");
        show_time::<S>(&mut state, &self.time);
        state.field("configuration", &self.configuration).field("covector", &self.covector).finish()
    }
}

/// The time as a number, where there is one.
fn show_time<S: Clebsch>(state: &mut DebugStruct<'_, '_>, time: &S::Time) {
    if size_of::<S::Time>() > 0 {
        state.field("time", &time.now());
    }
}
