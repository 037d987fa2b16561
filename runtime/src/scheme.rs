//! Schemes: the order in which the parts of a step are called, the same for every declaration.
//!
//! ```text
//! KickDriftKick   half kick, drift, half kick; or drift, kick where the step is of first order
//! AdjointPair     half a step, and half a step of its adjoint
//! Composed        steps of several sizes, of order 4, 6 and 8
//! Split           exact drifts and kicks in turn
//! FreeMotion      one exact motion
//! Collocated      Hamilton's equations at the nodes of Gauss and Legendre, of order 16
//! GreatCircle     points on large spheres in (q, w)
//! Sites           equal sites, one after the other
//! ```
//! A method names its scheme, [`Method::Scheme`](crate::Method), and the system implements the parts that this scheme calls, [`crate::parts`].

/// What most schemes have in common: one set of constants, and states that hold N itself.
macro_rules! momentum_is_held {
    ($method:ty) => {
        type Held = S::Momentum;
        type Constants = <$method as crate::Method<S>>::Constants;

        fn constants(system: &S, h: S::Scalar) -> Result<<$method as crate::Method<S>>::Constants, Error> {
            <$method as crate::Method<S>>::constants(system, h)
        }

        #[inline(always)]
        fn whole(constants: &Self::Constants) -> &<$method as crate::Method<S>>::Constants {
            constants
        }

        #[inline(always)]
        fn held(_: &S::Configuration, mu: &S::Momentum) -> S::Momentum {
            *mu
        }

        #[inline(always)]
        fn momentum(_: &S::Configuration, held: &S::Momentum) -> S::Momentum {
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
mod kick_drift_kick;
mod sites;
mod split;
mod substep;
mod unstepped;

use crate::{Clebsch, Clock, Declared, Error, Method, Space, Time};
use core::fmt::Debug;

pub use adjoint_pair::AdjointPair;
pub use collocated::Collocated;
pub use composed::{Composed, OfOrderEight, OfOrderFour, OfOrderSix, Sizes, Stages, compose};
pub use free_motion::AlongFreeMotion;
pub use great_circle::{FreeGreatCircle, GreatCircle};
pub use kick_drift_kick::KickDriftKick;
pub use sites::{FreeSites, SitesOfFirstOrder, SitesOfSecondOrder};
pub use split::{GradientFour, GradientSix, Kicks, PlainFour, PlainSix, Split, split};
pub use substep::{Apart, Shared};
pub use unstepped::Unstepped;

/// What a state of S holds of its momentum.
pub type Held<S, M = Declared> = <<M as Method<S>>::Scheme as Scheme<S, M>>::Held;
/// What one step of S leaves to the next.
pub type Left<S, M = Declared> = <<M as Method<S>>::Scheme as Scheme<S, M>>::Left;
/// What no step of S by M changes.
pub type Constants<S, M = Declared> = <<M as Method<S>>::Scheme as Scheme<S, M>>::Constants;
/// The parts of a state: q, what is held of N, and what the last step has left.
pub type Parted<S, P, M = Declared> =
    (<S as Clebsch>::Configuration, <P as Scheme<S, M>>::Held, <P as Scheme<S, M>>::Left);

/// How a system S is stepped by the method M.
pub trait Scheme<S: Clebsch + ?Sized, M: Method<S> = Declared> {
    /// What a state holds of its momentum from step to step: N itself, or, of a point on a large sphere, the covector w ⊥ q with N = J(q, w), n numbers
    /// in place of n(n − 1)/2.
    type Held: Space<S::Scalar>;
    /// What one step leaves to the next: the kick that the end of one and the start of the other share, or what a free motion keeps, and what rounding
    /// has taken off q and N where sums are compensated.
    type Left: Space<S::Scalar>;
    /// What no step changes.
    type Constants: Clone + Debug;

    /// Checks the parameters and computes what no step of the size h changes.
    ///
    /// # Errors
    /// Those of [`Method::constants`].
    fn constants(system: &S, h: S::Scalar) -> Result<Self::Constants, Error>;

    /// The constants of one step of the whole size.
    fn whole(constants: &Self::Constants) -> &M::Constants;

    /// What a state at q with the momentum μ holds of it.
    fn held(q: &S::Configuration, mu: &S::Momentum) -> Self::Held;

    /// The momentum of a state at q that holds this of it; the inverse of [`held`](Self::held) on 𝔤_q^⊥.
    fn momentum(q: &S::Configuration, held: &Self::Held) -> S::Momentum;

    /// What the first step from q takes, at the time t of q.
    fn left(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Self::Left;

    /// The same for steps that go on where others, of another size, have ended: what these have left that does not depend on their size stays.
    fn left_after(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
        left: &Self::Left,
    ) -> Self::Left {
        let _ = left;
        Self::left(system, constants, t, q, mu)
    }

    /// What a step has left, for a step that is `ratio` times as long.
    #[inline(always)]
    fn scaled(left: Self::Left, ratio: S::Scalar) -> Self::Left {
        let _ = ratio;
        left
    }

    /// One step of the discrete Euler–Poincaré representation: (q, N) ↦ (q⁺, N⁺), from the time t to t + h, with the input u of its forces.
    ///
    /// # Errors
    /// Those of [`Stepper::step`](crate::Stepper::step).
    fn step(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        state: (&S::Configuration, &Self::Held, &Self::Left),
        u: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error>;

    /// The same step, into the place of another state. After an error that state is unspecified.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    #[inline]
    fn step_into(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        state: (&S::Configuration, &Self::Held, &Self::Left),
        u: &S::Input,
        (next, held, left): (&mut S::Configuration, &mut Self::Held, &mut Self::Left),
    ) -> Result<(), Error> {
        (*next, *held, *left) = Self::step(system, constants, t, state, u)?;
        Ok(())
    }

    /// `steps` steps of the size h from the time t, as [`step`](Self::step) makes them but for rounding: where a step ends as the next one starts, both
    /// may be made at once.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    #[inline]
    fn steps(
        system: &S,
        constants: &Self::Constants,
        (t, h): (S::Scalar, S::Scalar),
        steps: usize,
        (q, held, left): (&S::Configuration, &Self::Held, &Self::Left),
        u: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        let mut state = (*q, *held, *left);
        let mut clock = Clock::at(t);
        for _ in 0..steps {
            let (q, held, left) = &state;
            state = Self::step(system, constants, clock.now(), (q, held, left), u)?;
            clock = clock.after_step(h);
        }
        Ok(state)
    }

    /// One step of the discrete symmetric representation on T*Q: (q, p) ↦ (q⁺, p⁺), from the time t to t + h.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    fn step_symmetric(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        p: &S::Configuration,
    ) -> Result<(S::Configuration, S::Configuration), Error>;

    /// The group element F with `legendre(h, t, q, F)` = μ that is connected to the identity.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    fn inverse_legendre(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<S::Element, Error>;
}

/// The methods of a system's scheme as methods of the system.
pub trait Stepping: Clebsch {
    /// As [`Scheme::constants`].
    ///
    /// # Errors
    /// Those of [`Clebsch::constants`].
    #[inline]
    fn step_constants(&self, h: Self::Scalar) -> Result<Constants<Self>, Error> {
        Self::Scheme::constants(self, h)
    }

    /// As [`Scheme::held`].
    #[inline]
    fn held(q: &Self::Configuration, mu: &Self::Momentum) -> Held<Self> {
        Self::Scheme::held(q, mu)
    }

    /// As [`Scheme::momentum`].
    #[inline]
    fn momentum_held(q: &Self::Configuration, held: &Held<Self>) -> Self::Momentum {
        Self::Scheme::momentum(q, held)
    }

    /// As [`Scheme::left`].
    #[inline]
    fn impulse(
        &self,
        constants: &Constants<Self>,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
    ) -> Left<Self> {
        Self::Scheme::left(self, constants, t, q, mu)
    }

    /// As [`Scheme::step`].
    ///
    /// # Errors
    /// Those of a step.
    #[inline]
    fn step(
        &self,
        constants: &Constants<Self>,
        t: Self::Scalar,
        q: &Self::Configuration,
        held: &Held<Self>,
        left: &Left<Self>,
        u: &Self::Input,
    ) -> Result<Parted<Self, Self::Scheme>, Error> {
        Self::Scheme::step(self, constants, t, (q, held, left), u)
    }

    /// As [`Scheme::step_symmetric`].
    ///
    /// # Errors
    /// Those of a step.
    #[inline]
    fn step_symmetric(
        &self,
        constants: &Constants<Self>,
        t: Self::Scalar,
        q: &Self::Configuration,
        p: &Self::Configuration,
    ) -> Result<(Self::Configuration, Self::Configuration), Error> {
        Self::Scheme::step_symmetric(self, constants, t, q, p)
    }

    /// As [`Scheme::inverse_legendre`].
    ///
    /// # Errors
    /// Those of a step.
    #[inline]
    fn inverse_legendre(
        &self,
        constants: &Constants<Self>,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
    ) -> Result<Self::Element, Error> {
        Self::Scheme::inverse_legendre(self, constants, t, q, mu)
    }
}

impl<S: Clebsch> Stepping for S {}
