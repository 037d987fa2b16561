//! Schemes: the order in which the parts of a step are called, the same for every declaration.
//!
//! ```text
//! KickDriftKick   half kick, drift, half kick; or drift, kick where the step is of first order
//! AdjointPair     half a step, and half a step of its adjoint
//! Composed        steps of several sizes, of order 4, 6 and 8
//! Split           exact drifts and kicks in turn
//! FreeMotion      one exact motion
//! Collocated      Hamilton's equations at the nodes of Gauss and Legendre, of order 16
//! Transformed     drifts and kicks whose times follow a monitor
//! GreatCircle     points on large spheres in (q, w)
//! Sites           equal sites, one after the other
//! JoinedSites     the same, with joints between neighbours
//! ```
//! A method names its scheme, [`Method::Scheme`](crate::Method), and the system implements the parts that this scheme calls, [`crate::parts`].

/// Of a scheme with one set of constants.
macro_rules! constants_of_method {
    ($method:ty) => {
        type Constants = <$method as crate::Method<S>>::Constants;

        fn constants(system: &S, h: S::Scalar) -> Result<Self::Constants, Error> {
            <$method as crate::Method<S>>::constants(system, h)
        }

        #[inline(always)]
        fn whole(constants: &Self::Constants) -> &Self::Constants {
            constants
        }
    };
}

/// The same, where states hold N itself.
macro_rules! momentum_is_held {
    ($method:ty) => {
        type Held = S::Momentum;

        constants_of_method!($method);

        #[inline(always)]
        fn held(_: &Q<S>, mu: &Mu<S>) -> Mu<S> {
            *mu
        }

        #[inline(always)]
        fn momentum(_: &Q<S>, held: &Mu<S>) -> Mu<S> {
            *held
        }
    };
}

mod adjoint_pair;
mod collocated;
mod composed;
pub(crate) mod edges;
mod free_motion;
mod great_circle;
mod joined;
mod kick_drift_kick;
mod sequence;
mod sites;
mod split;
mod substep;
mod transformed;
mod unstepped;

use crate::fields::copy;
use crate::parts::{Mu, Q};
use crate::space::{larger, plus};
use crate::{Clebsch, Clock, Declared, Error, Mask, Method, Scalar, Space, Time};
use core::fmt::Debug;
use core::marker::PhantomData;
use num_traits::Zero;

pub(crate) use composed::{OfOrderEight, OfOrderFour, OfOrderSix};
pub use composed::{Sizes, Stages, compose};
pub use joined::JoinedInStorage;
pub use sites::{AtSite, InStorage, Stored};
pub use split::{Kicks, split};

/// The types by which a declaration names its scheme.
pub mod kinds {
    pub use super::adjoint_pair::AdjointPair;
    pub use super::collocated::Collocated;
    pub use super::composed::{Composed, OfOrderEight, OfOrderFour, OfOrderSix};
    pub use super::free_motion::AlongFreeMotion;
    pub use super::great_circle::{FreeGreatCircle, GreatCircle};
    pub use super::joined::{FreeJoinedSites, JoinedSitesOfSecondOrder};
    pub use super::kick_drift_kick::KickDriftKick;
    pub use super::sequence::{Apart, Shared};
    pub use super::sites::{FreeSites, SitesOfFirstOrder, SitesOfSecondOrder};
    pub use super::split::{GradientFour, GradientSix, PlainFour, PlainSix, Split};
    pub use super::transformed::{OfOrderTwo, Transformed};
    pub use super::unstepped::Unstepped;
}

/// The form in which a state of S stores its momentum.
pub type Held<S, M = Declared> = <<M as Method<S>>::Scheme as Scheme<S, M>>::Held;
/// The data that one step of S passes to the next.
pub type Left<S, M = Declared> = <<M as Method<S>>::Scheme as Scheme<S, M>>::Left;
/// The constants of the steps of S by M.
pub type Constants<S, M = Declared> = <<M as Method<S>>::Scheme as Scheme<S, M>>::Constants;
/// The components of a state: q, the stored form of N, and the data that the last step passes on.
pub type Parted<S, P, M = Declared> = (Q<S>, <P as Scheme<S, M>>::Held, <P as Scheme<S, M>>::Left);
/// The state after steps, or why there is none.
pub type Stepped<S, P, M = Declared> = Result<Parted<S, P, M>, Error>;
/// The components of the state before a step.
pub type Before<'a, S, P, M = Declared> = (&'a Q<S>, &'a <P as Scheme<S, M>>::Held, &'a <P as Scheme<S, M>>::Left);
/// (q, p)
pub type Pair<S> = (Q<S>, Q<S>);
/// The place of a step by the scheme P.
pub type AtOf<'a, S, P, M = Declared> = At<'a, S, M, <P as Scheme<S, M>>::Constants>;

/// The arguments that all parts of a step share: the system, the constants, and the time at which the step starts.
pub struct At<'a, S: Clebsch, M: Method<S> = Declared, C = <M as Method<S>>::Constants> {
    /// The system.
    pub system: &'a S,
    /// The constants, which no step changes.
    pub constants: &'a C,
    /// t
    pub t: S::Scalar,
    method: PhantomData<M>,
}

impl<'a, S: Clebsch, M: Method<S>, C> At<'a, S, M, C> {
    /// At the time t.
    #[inline(always)]
    pub fn new(system: &'a S, constants: &'a C, t: S::Scalar) -> Self {
        Self { system, constants, t, method: PhantomData }
    }
}

copy!(At<'_, S, M, C> where [S: Clebsch, M: Method<S>, C]);

/// A push of a constraint in a step: Aᵀλ at q before the move, or Aᵀμ at q⁺ after it.
pub struct Push<'a, S: Clebsch, M: Method<S> = Declared> {
    /// The system and the constants, with the time at which the step starts.
    pub at: At<'a, S, M>,
    /// q or q⁺.
    pub place: &'a Q<S>,
    /// The push.
    pub momentum: &'a Mu<S>,
    /// Whether the push is a step later than the time.
    pub is_after: bool,
}

impl<S: Clebsch, M: Method<S>> Push<'_, S, M> {
    /// The same with its own time, in a step of the size h.
    #[inline]
    pub(crate) fn at_its_time(self, h: S::Scalar) -> Self {
        let At { t, .. } = self.at;
        let t = if self.is_after { t + h } else { t };
        Self { at: At { t, ..self.at }, is_after: false, ..self }
    }
}

/// How a system S is stepped by the method M.
pub trait Scheme<S: Clebsch, M: Method<S> = Declared>: Sized {
    /// The stored form of the momentum. It is N itself, except for a point on a large sphere. There it is the covector
    /// w ⊥ q with N = J(q, w): n numbers for n(n − 1)/2.
    type Held: Space<S::Scalar>;
    /// The data that one step passes to the next. It is the kick that the end of one step and the start of the next
    /// share, or the constants of a free motion. With compensated sums the rounding errors of q and N come too.
    type Left: Space<S::Scalar>;
    /// The constants, which no step changes.
    type Constants: Clone + Debug;

    /// Checks the parameters and computes the constants of steps of the size h.
    fn constants(system: &S, h: S::Scalar) -> Result<Self::Constants, Error>;

    /// The constants of one step of the full size.
    fn whole(constants: &Self::Constants) -> &M::Constants;

    /// The stored form of the momentum μ of a state at q.
    fn held(q: &Q<S>, mu: &Mu<S>) -> Self::Held;

    /// The momentum of a state at q that holds this of it; the inverse of [`held`](Self::held) on 𝔤_q^⊥.
    fn momentum(q: &Q<S>, held: &Self::Held) -> Mu<S>;

    /// The data that the first step from q takes, at the time of q.
    fn left(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>) -> Self::Left;

    /// The same for steps that continue others of another size: data that does not depend on it stays.
    fn left_after(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>, _left: &Self::Left) -> Self::Left {
        Self::left(at, q, mu)
    }

    /// The same for steps that go on from another q.
    fn left_elsewhere(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>, left: &Self::Left) -> Self::Left {
        Self::left_after(at, q, mu, left)
    }

    /// The stored form of the momentum after an impulse at q, and the data that the next step takes. Data that does not
    /// depend on the momentum stays.
    fn kicked(
        _at: AtOf<'_, S, Self, M>,
        q: &Q<S>,
        (held, left): (&Self::Held, &Self::Left),
        impulse: &Mu<S>,
    ) -> (Self::Held, Self::Left) {
        (Self::held(q, &plus(&Self::momentum(q, held), impulse)), *left)
    }

    /// `left` as it was read, checked against [`left`](Self::left) of the same time, q and μ. Lanes that differ by more
    /// than √ε of the momentum get the new one.
    fn resumed(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>, left: &Self::Left) -> Self::Left {
        as_made(left, &Self::left(at, q, mu), mu.max_abs())
    }

    /// The distance from `held` to the values that [`held`](Self::held) returns, in the units of the momentum.
    fn held_defect(_q: &Q<S>, _held: &Self::Held) -> S::Scalar {
        S::Scalar::zero()
    }

    /// The data that a step passes on, for a step that is `ratio` times as long.
    #[inline(always)]
    fn scaled(left: Self::Left, _ratio: S::Scalar) -> Self::Left {
        left
    }

    /// The time at which the step ended that left this, where it is not h after the start.
    #[inline(always)]
    fn now(_left: &Self::Left) -> Option<S::Scalar> {
        None
    }

    /// Whether steps can start at q.
    ///
    /// # Errors
    /// [`Error::Monitor`]
    #[inline(always)]
    fn check_monitor(_at: AtOf<'_, S, Self, M>, _q: &Q<S>) -> Result<(), Error> {
        Ok(())
    }

    /// One step of the discrete Euler–Poincaré representation: (q, N) ↦ (q⁺, N⁺), from the time t to t + h, with the input u of its forces.
    fn step(at: AtOf<'_, S, Self, M>, state: Before<'_, S, Self, M>, u: &S::Input) -> Stepped<S, Self, M>;

    /// The same step, which tells each push of a constraint to `pushed`. As provided there is none.
    #[inline]
    fn step_pushed(
        at: AtOf<'_, S, Self, M>,
        state: Before<'_, S, Self, M>,
        u: &S::Input,
        _pushed: impl FnMut(Push<'_, S, M>),
    ) -> Stepped<S, Self, M> {
        Self::step(at, state, u)
    }

    /// The same step, into the place of another state. After an error that state is unspecified.
    #[inline]
    fn step_into(
        at: AtOf<'_, S, Self, M>,
        state: Before<'_, S, Self, M>,
        u: &S::Input,
        (next, held, left): (&mut Q<S>, &mut Self::Held, &mut Self::Left),
    ) -> Result<(), Error> {
        (*next, *held, *left) = Self::step(at, state, u)?;
        Ok(())
    }

    /// `steps` steps of the size h. They differ from calls of [`step`](Self::step) only by rounding: the end of one
    /// step and the start of the next may be one.
    #[inline]
    fn steps(
        at: AtOf<'_, S, Self, M>,
        h: S::Scalar,
        steps: usize,
        state: Before<'_, S, Self, M>,
        u: &S::Input,
    ) -> Stepped<S, Self, M> {
        one_by_one::<S, Self, M>(at, h, steps, state, u)
    }

    /// One step of the discrete symmetric representation on T*Q: (q, p) ↦ (q⁺, p⁺), from the time t to t + h.
    fn step_symmetric(at: AtOf<'_, S, Self, M>, q: &Q<S>, p: &Q<S>) -> Result<Pair<S>, Error>;

    /// The group element F with `legendre(h, t, q, F)` = μ that is connected to the identity.
    fn inverse_legendre(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>) -> Result<S::Element, Error>;
}

/// `found` in the lanes where it differs from `made` by at most √ε of that and of `size`. `made` in the other lanes.
fn as_made<T: Scalar, V: Space<T>>(found: &V, made: &V, size: T) -> V {
    let is_same = is_near(found, made, larger(made.max_abs(), size));
    found.zip_map(made, |found, made| T::select(is_same, found, made))
}

/// The lanes in which two values differ by at most √ε of a size.
fn is_near<T: Scalar, V: Space<T>>(found: &V, made: &V, size: T) -> T::Mask {
    let most = T::EPSILON.sqrt() * size;
    let difference = found.zip_map(made, |found, made| (found - made).abs());
    made.finite() & difference.reduce(T::Mask::everywhere(), |entry| entry.at_most(most), |a, b| a & b)
}

/// The time after so many steps of the size h from a time, which have left `left`.
#[inline(always)]
pub(crate) fn time_after<S: Clebsch, M: Method<S>>(
    time: S::Time,
    (h, steps): (S::Scalar, usize),
    left: &Left<S, M>,
) -> S::Time {
    match M::Scheme::now(left) {
        Some(now) => {
            let mut after = S::Time::at(now);
            // a body that fails stays at the time before
            if S::Scalar::LANES > 1 {
                let known = Scalar::finite(now);
                let lanes = (0..S::Scalar::LANES).filter(|&lane| !known.lane(lane));
                lanes.for_each(|lane| after.take_lane(lane, &time));
            }
            after
        }
        None => (0..steps).fold(time, |time, _| time.after_step(h)),
    }
}

/// Whether a long run looks at its state after the step with this number: every 1024 steps, so that NaN ends it soon.
#[inline(always)]
fn is_due(number: usize) -> bool {
    number % 1024 == 1023
}

/// Whether a state is finite. Its sum tells sooner, but may overflow.
#[cold]
#[inline(never)]
fn look<T: Scalar>(q: &impl Space<T>, held: &impl Space<T>) -> Result<(), Error> {
    let is_finite = q.all_finite() && held.all_finite();
    if is_finite { Ok(()) } else { Err(Error::NotFinite { name: "the state after a step" }) }
}

/// q and N after a step that starts anew, with the input u of its forces.
#[inline(always)]
pub(crate) fn moved<S: Clebsch>(
    at: At<'_, S, Declared, Constants<S>>,
    (q, mu): (&Q<S>, &Mu<S>),
    u: &S::Input,
) -> Result<(Q<S>, Mu<S>), Error> {
    let left = S::Scheme::left(at, q, mu);
    let held = S::Scheme::held(q, mu);
    let (q, held, _) = S::Scheme::step(at, (q, &held, &left), u)?;
    Ok((q, S::Scheme::momentum(&q, &held)))
}

/// Steps, one after the other.
#[inline]
fn one_by_one<S: Clebsch, P: Scheme<S, M>, M: Method<S>>(
    at: AtOf<'_, S, P, M>,
    h: S::Scalar,
    steps: usize,
    (q, held, left): Before<'_, S, P, M>,
    u: &S::Input,
) -> Stepped<S, P, M> {
    let mut state = (*q, *held, *left);
    let mut clock = Clock::at(at.t);
    for number in 0..steps {
        let (q, held, left) = &state;
        state = P::step(At { t: clock.now(), ..at }, (q, held, left), u)?;
        clock = clock.after_step(h);
        if is_due(number) {
            // A copy, as a reference would force the state into memory in every step.
            let (q, held, _) = state;
            look(&q, &held)?;
        }
    }
    Ok(state)
}
