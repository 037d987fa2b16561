//! Kick, drift, kick; or drift and kick, of first order.

use super::sequence::{CarryKick, From, InSequence, Sequence, To, parted};
use super::substep::{inverse_legendre, substep};
use super::{At, Push};
use crate::parts::{Mu, Q, Substep};
use crate::{Error, Method};
use core::marker::PhantomData;

/// (q, N) ↦ (q⁺, N⁺): kick, solve for the group element, move, kick. W is the substep that is inverted: 0, or 1 where a force joins the equation.
///
/// ```text
/// M = N + J(q, ∂U₀),    r(F) = M,    q⁺ = Φ_F(q),    N⁺ = Ad* M + J(q⁺, ∂U₁)
/// ```
/// A step of first order has no U₀. A constraint adds its force Aᵀλ to M, and N⁺ is brought to the constraint at q⁺.
pub type KickDriftKick<C, const W: usize = 0> = InSequence<Order<C, W>>;

/// The order of a [`KickDriftKick`].
pub struct Order<C, const W: usize>(PhantomData<C>);

impl<S: Substep<0, M> + Substep<W, M>, M: Method<S>, C: CarryKick<S, M>, const W: usize> Sequence<S, M>
    for Order<C, W>
{
    type Carry = C;

    #[inline(always)]
    fn step(at: At<'_, S, M>, state: From<'_, S, M, C>, u: &S::Input) -> To<S, M, C> {
        Self::step_pushed(at, state, u, |_| ())
    }

    #[inline(always)]
    fn step_pushed(
        at: At<'_, S, M>,
        (q, mu, left): From<'_, S, M, C>,
        u: &S::Input,
        mut pushed: impl FnMut(Push<'_, S, M>),
    ) -> To<S, M, C> {
        let (impulse, rests) = parted::<S, M, C>(left);
        let kick = C::kick(impulse, || Substep::<0, M>::start_kick(at.system, at.constants, at.t, q));
        let mut state = substep::<S, M, 0>(at, (q, mu), rests, kick, u, |momentum| {
            pushed(Push { at, place: q, momentum, is_after: false });
        })?;
        let kick = Substep::<0, M>::end_kick(at.system, at.constants, at.t, &state.q);
        state.push(kick);
        let projection = Substep::<0, M>::projection(at.system, at.constants, at.t, &state.q, &state.mu);
        if let Some(momentum) = &projection {
            pushed(Push { at, place: &state.q, momentum, is_after: true });
        }
        state.push(projection);
        state.on_space();
        Ok(state.end::<C>(C::impulse(kick)))
    }

    #[inline]
    fn inverse_legendre(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>) -> Result<S::Element, Error> {
        inverse_legendre::<S, M, W>(at, q, mu)
    }
}
