//! The common part of all schemes that are sequences of the parts of a step.

use super::substep::{RestsOf, inverse_legendre, symmetric};
use super::{At, Before, Pair, Push, Scheme, Stepped, as_made, one_by_one};
use crate::parts::{Mu, Parts, Q, Substep, T, U};
use crate::sums::Sums;
use crate::{Clebsch, Error, Method, Space};
use core::marker::PhantomData;

/// The order in which a step calls the parts of a system, with one set of constants, and with states that hold N itself.
pub trait Sequence<S: Substep<0, M>, M: Method<S>>: Sized {
    /// The data that one step passes to the next, in addition to the rounding errors of compensated sums.
    type Carry: Carry<S, M>;

    /// As [`Scheme::step`].
    fn step(at: At<'_, S, M>, state: From<'_, S, M, Self::Carry>, u: &S::Input) -> To<S, M, Self::Carry>;

    /// As [`Scheme::step_pushed`].
    #[inline]
    fn step_pushed(
        at: At<'_, S, M>,
        state: From<'_, S, M, Self::Carry>,
        u: &S::Input,
        _pushed: impl FnMut(Push<'_, S, M>),
    ) -> To<S, M, Self::Carry> {
        Self::step(at, state, u)
    }

    /// As [`Scheme::steps`].
    #[inline]
    fn steps(
        at: At<'_, S, M>,
        h: S::Scalar,
        steps: usize,
        state: From<'_, S, M, Self::Carry>,
        u: &S::Input,
    ) -> To<S, M, Self::Carry> {
        one_by_one::<S, InSequence<Self>, M>(at, h, steps, state, u)
    }

    /// As [`Scheme::step_symmetric`].
    #[inline]
    fn step_symmetric(at: At<'_, S, M>, q: &Q<S>, p: &Q<S>) -> Result<Pair<S>, Error> {
        symmetric::<S, M, 0>(at, (*q, *p))
    }

    /// As [`Scheme::inverse_legendre`].
    #[inline]
    fn inverse_legendre(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>) -> Result<S::Element, Error> {
        inverse_legendre::<S, M, 0>(at, q, mu)
    }
}

/// The scheme with the sequence P.
pub struct InSequence<P>(PhantomData<P>);

impl<S: Substep<0, M>, M: Method<S>, P: Sequence<S, M>> Scheme<S, M> for InSequence<P> {
    type Left = LeftBy<S, M, P::Carry>;

    momentum_is_held!(M);

    #[inline]
    fn left(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>) -> Self::Left {
        S::Sums::joined(P::Carry::first(at, q, mu), (Space::origin(), Space::origin()))
    }

    #[inline]
    fn left_after(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>, left: &Self::Left) -> Self::Left {
        let (impulse, rests) = parted::<S, M, P::Carry>(left);
        let rests = (S::Sums::resumed(q, rests.0), S::Sums::resumed(mu, rests.1));
        S::Sums::joined(P::Carry::after(at, q, mu, impulse), rests)
    }

    #[inline]
    fn left_elsewhere(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>, left: &Self::Left) -> Self::Left {
        let (_, rests) = parted::<S, M, P::Carry>(left);
        // rounding errors of another q or N may be larger than the last place of these
        let rests = (S::Sums::resumed(q, rests.0), S::Sums::resumed(mu, rests.1));
        S::Sums::joined(P::Carry::first(at, q, mu), rests)
    }

    #[inline]
    fn kicked(at: At<'_, S, M>, q: &Q<S>, (mu, left): (&Mu<S>, &Self::Left), push: &Mu<S>) -> (Mu<S>, Self::Left) {
        let (impulse, mut rests) = parted::<S, M, P::Carry>(left);
        let mu = S::Sums::sum(mu, &mut rests.1, push);
        (mu, S::Sums::joined(P::Carry::kicked(at, q, &mu, impulse), rests))
    }

    fn resumed(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>, left: &Self::Left) -> Self::Left {
        let (impulse, rests) = parted::<S, M, P::Carry>(left);
        let rests = (S::Sums::resumed(q, rests.0), S::Sums::resumed(mu, rests.1));
        S::Sums::joined(P::Carry::resumed(at, q, mu, impulse), rests)
    }

    #[inline(always)]
    fn scaled(left: Self::Left, ratio: S::Scalar) -> Self::Left {
        let (impulse, rests) = parted::<S, M, P::Carry>(&left);
        S::Sums::joined(P::Carry::scaled(*impulse, ratio), rests)
    }

    #[inline(always)]
    fn now(left: &Self::Left) -> Option<S::Scalar> {
        P::Carry::now(parted::<S, M, P::Carry>(left).0)
    }

    #[inline(always)]
    fn check_monitor(at: At<'_, S, M>, q: &Q<S>) -> Result<(), Error> {
        P::Carry::check_monitor(at, q)
    }

    #[inline(always)]
    fn step(at: At<'_, S, M>, state: Before<'_, S, Self, M>, u: &S::Input) -> Stepped<S, Self, M> {
        if S::IS_SHORT { P::step(at, state, u) } else { called::<S, M, P>(at, state, u) }
    }

    #[inline]
    fn step_pushed(
        at: At<'_, S, M>,
        state: Before<'_, S, Self, M>,
        u: &S::Input,
        pushed: impl FnMut(Push<'_, S, M>),
    ) -> Stepped<S, Self, M> {
        P::step_pushed(at, state, u, pushed)
    }

    #[inline]
    fn steps(at: At<'_, S, M>, h: T<S>, steps: usize, state: Before<'_, S, Self, M>, u: &U<S>) -> Stepped<S, Self, M> {
        P::steps(at, h, steps, state, u)
    }

    #[inline]
    fn step_symmetric(at: At<'_, S, M>, q: &Q<S>, p: &Q<S>) -> Result<Pair<S>, Error> {
        if S::HAS_COVECTORS { P::step_symmetric(at, q, p) } else { Err(Error::NoCovector) }
    }

    #[inline]
    fn inverse_legendre(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>) -> Result<S::Element, Error> {
        P::inverse_legendre(at, q, mu)
    }
}

/// A long step, which the compiler may call.
#[inline]
fn called<S: Substep<0, M>, M: Method<S>, P: Sequence<S, M>>(
    at: At<'_, S, M>,
    state: From<'_, S, M, P::Carry>,
    u: &S::Input,
) -> To<S, M, P::Carry> {
    P::step(at, state, u)
}

/// The data that one step passes to the next: an impulse, and the rounding errors of compensated sums.
pub(super) type LeftBy<S, M, C> =
    <<S as Parts<M>>::Sums as Sums>::Left<<S as Clebsch>::Scalar, <C as Carry<S, M>>::Impulse, Q<S>, Mu<S>>;

/// The state before a step: q, N, and the data that the last step passes on.
pub(super) type From<'a, S, M, C> = (&'a Q<S>, &'a Mu<S>, &'a LeftBy<S, M, C>);

/// The state after a step.
pub(super) type To<S, M, C> = Result<(Q<S>, Mu<S>, LeftBy<S, M, C>), Error>;

/// The impulse and the rounding errors in the data of a step.
#[inline(always)]
pub(super) fn parted<S: Parts<M>, M: Method<S>, C: Carry<S, M>>(
    left: &LeftBy<S, M, C>,
) -> (&C::Impulse, RestsOf<S, M>) {
    S::Sums::parted(left)
}

/// The data that the end of one step and the start of the next share.
pub trait Carry<S: Parts<M>, M: Method<S>> {
    /// The data that one step passes to the next.
    type Impulse: Space<S::Scalar>;

    /// The impulse that the first step takes.
    fn first(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>) -> Self::Impulse;

    /// The same after steps of another size.
    #[inline]
    fn after(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>, _impulse: &Self::Impulse) -> Self::Impulse {
        Self::first(at, q, mu)
    }

    /// The data after a push at q, which made the momentum μ: unchanged where it does not depend on μ.
    #[inline]
    fn kicked(_at: At<'_, S, M>, _q: &Q<S>, _mu: &Mu<S>, impulse: &Self::Impulse) -> Self::Impulse {
        *impulse
    }

    /// The impulse as it was read, in the lanes where it agrees with [`first`](Self::first). That one in the other lanes.
    fn resumed(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>, impulse: &Self::Impulse) -> Self::Impulse {
        as_made(impulse, &Self::first(at, q, mu), mu.max_abs())
    }

    /// The impulse of a step that is `ratio` times as long.
    #[inline(always)]
    fn scaled(impulse: Self::Impulse, _ratio: S::Scalar) -> Self::Impulse {
        impulse
    }

    /// As [`Scheme::now`].
    #[inline(always)]
    fn now(_impulse: &Self::Impulse) -> Option<S::Scalar> {
        None
    }

    /// As [`Scheme::check_monitor`].
    #[inline(always)]
    fn check_monitor(_at: At<'_, S, M>, _q: &Q<S>) -> Result<(), Error> {
        Ok(())
    }
}

/// How the kick at the end of one step and that at the start of the next are made.
pub trait CarryKick<S: Parts<M>, M: Method<S>>: Carry<S, M> {
    /// The impulse of this kick.
    fn impulse(kick: Option<Mu<S>>) -> Self::Impulse;

    /// The kick at the start of a step, where the last one has left this impulse.
    fn kick(impulse: &Self::Impulse, anew: impl FnOnce() -> Option<Mu<S>>) -> Option<Mu<S>>;
}

/// The kick at the end of one step is that at the start of the next.
pub struct Shared;

impl<S: Substep<0, M>, M: Method<S>> Carry<S, M> for Shared {
    type Impulse = S::Momentum;

    #[inline(always)]
    fn first(at: At<'_, S, M>, q: &Q<S>, _: &Mu<S>) -> Mu<S> {
        <Self as CarryKick<S, M>>::impulse(at.system.start_kick(at.constants, at.t, q))
    }

    // kicks are linear in the step size
    #[inline(always)]
    fn scaled(impulse: Mu<S>, ratio: S::Scalar) -> Mu<S> {
        impulse.zip_map(&impulse, |kick, _| kick * ratio)
    }
}

impl<S: Substep<0, M>, M: Method<S>> CarryKick<S, M> for Shared {
    #[inline(always)]
    fn impulse(kick: Option<Mu<S>>) -> Mu<S> {
        kick.unwrap_or_else(Space::origin)
    }

    #[inline(always)]
    fn kick(impulse: &Mu<S>, _: impl FnOnce() -> Option<Mu<S>>) -> Option<Mu<S>> {
        Some(*impulse)
    }
}

/// Each step makes its own kicks.
pub struct Apart;

impl<S: Parts<M>, M: Method<S>> Carry<S, M> for Apart {
    type Impulse = ();

    #[inline(always)]
    fn first(_: At<'_, S, M>, _: &Q<S>, _: &Mu<S>) {}
}

impl<S: Parts<M>, M: Method<S>> CarryKick<S, M> for Apart {
    #[inline(always)]
    fn impulse(_: Option<Mu<S>>) {}

    #[inline(always)]
    fn kick((): &(), anew: impl FnOnce() -> Option<Mu<S>>) -> Option<Mu<S>> {
        anew()
    }
}
