//! Kick, drift, kick; or drift and kick, of first order.

use super::substep::{Before, Carry, LeftOf, inverse_legendre, substep, symmetric};
use super::{Parted, Scheme};
use crate::parts::{Parts, Substep};
use crate::summation::Sums;
use crate::{Error, Method, Space};
use core::marker::PhantomData;

/// (q, N) ↦ (q⁺, N⁺): kick, solve for the group element, move, kick. W is the substep that is inverted: 0, or 1 where a force joins the equation.
///
/// ```text
/// M = N + J(q, ∂U₀),    r(F) = M,    q⁺ = Φ_F(q),    N⁺ = Ad* M + J(q⁺, ∂U₁)
/// ```
/// A step of first order has no U₀.
#[derive(Clone, Copy, Debug)]
pub struct KickDriftKick<C, const W: usize = 0>(PhantomData<C>);

impl<S: Substep<0, M> + Substep<W, M>, M: Method<S>, C: Carry<S>, const W: usize> Scheme<S, M> for KickDriftKick<C, W> {
    type Left = LeftOf<S, M, C::Impulse>;

    momentum_is_held!(M);

    #[inline]
    fn left(system: &S, constants: &M::Constants, t: S::Scalar, q: &S::Configuration, _: &S::Momentum) -> Self::Left {
        first_left::<S, M, C>(C::impulse(Substep::<0, M>::start_kick(system, constants, t, q)))
    }

    #[inline]
    fn left_after(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        _: &S::Momentum,
        left: &Self::Left,
    ) -> Self::Left {
        changed::<S, M, C>(left, |_| C::impulse(Substep::<0, M>::start_kick(system, constants, t, q)))
    }

    #[inline(always)]
    fn scaled(left: Self::Left, ratio: S::Scalar) -> Self::Left {
        changed::<S, M, C>(&left, |impulse| C::scaled(impulse, ratio))
    }

    #[inline(always)]
    fn step(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        state: (&S::Configuration, &S::Momentum, &Self::Left),
        u: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        if S::IS_SHORT {
            step::<S, M, C>(system, constants, t, state, u)
        } else {
            called::<S, M, C>(system, constants, t, state, u)
        }
    }

    #[inline]
    fn step_symmetric(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        p: &S::Configuration,
    ) -> Result<(S::Configuration, S::Configuration), Error> {
        if S::HAS_COVECTORS { symmetric::<S, M, 0>(system, constants, t, (*q, *p)) } else { Err(Error::NoCovector) }
    }

    #[inline]
    fn inverse_legendre(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<S::Element, Error> {
        inverse_legendre::<S, M, W>(system, constants, t, q, mu)
    }
}

/// What the first step takes: an impulse, and sums that begin.
#[inline(always)]
pub(super) fn first_left<S: Parts<M>, M: Method<S>, C: Carry<S>>(impulse: C::Impulse) -> LeftOf<S, M, C::Impulse> {
    S::Sums::joined(impulse, (Space::origin(), Space::origin()))
}

/// What a step has left, with another impulse.
#[inline(always)]
pub(super) fn changed<S: Parts<M>, M: Method<S>, C: Carry<S>>(
    left: &LeftOf<S, M, C::Impulse>,
    change: impl FnOnce(C::Impulse) -> C::Impulse,
) -> LeftOf<S, M, C::Impulse> {
    let (impulse, rests) = S::Sums::parted(left);
    S::Sums::joined(change(*impulse), rests)
}

/// A state after a step: q, N, and what the step leaves.
pub(super) type After<S, M, C> =
    (<S as crate::Clebsch>::Configuration, <S as crate::Clebsch>::Momentum, LeftOf<S, M, <C as Carry<S>>::Impulse>);

#[inline(always)]
fn step<S: Substep<0, M>, M: Method<S>, C: Carry<S>>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    (q, mu, left): Before<'_, S, M, C::Impulse>,
    u: &S::Input,
) -> Result<After<S, M, C>, Error> {
    let (impulse, rests) = S::Sums::parted(left);
    let kick = C::kick(impulse, || system.start_kick(constants, t, q));
    let mut state = substep::<S, M, 0>(system, constants, t, (q, mu), rests, kick, u)?;
    let kick = system.end_kick(constants, t, &state.q);
    state.push(kick);
    Ok(state.end(C::impulse(kick)))
}

/// A long step, which the compiler may call.
#[inline]
fn called<S: Substep<0, M>, M: Method<S>, C: Carry<S>>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    state: Before<'_, S, M, C::Impulse>,
    u: &S::Input,
) -> Result<After<S, M, C>, Error> {
    step::<S, M, C>(system, constants, t, state, u)
}
