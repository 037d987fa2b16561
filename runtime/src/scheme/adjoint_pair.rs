//! Half a step, and half a step of its adjoint.

use super::sequence::{CarryKick, From, InSequence, Sequence, To, parted};
use super::substep::{inverse_legendre, substep, symmetric};
use super::{At, Pair};
use crate::parts::{Mu, Q, Substep};
use crate::{Error, Method};
use core::marker::PhantomData;

/// A step of ℓd with h/2 and one of its adjoint with h/2: of second order where ℓd is of first. Substep 2 is ℓd itself, which is inverted.
///
/// Source: Marsden and West, *Discrete mechanics and variational integrators*, section 2.4.
pub type AdjointPair<C> = InSequence<Order<C>>;

/// The order of an [`AdjointPair`].
pub struct Order<C>(PhantomData<C>);

impl<S: Substep<0, M> + Substep<1, M> + Substep<2, M>, M: Method<S>, C: CarryKick<S, M>> Sequence<S, M> for Order<C> {
    type Carry = C;

    #[inline]
    fn step(at: At<'_, S, M>, (q, mu, left): From<'_, S, M, C>, u: &S::Input) -> To<S, M, C> {
        let At { system, constants, t, .. } = at;
        let (impulse, rests) = parted::<S, M, C>(left);
        let kick = C::kick(impulse, || Substep::<0, M>::start_kick(system, constants, t, q));
        let mut half = substep::<S, M, 0>(at, (q, mu), rests, kick, u, |_| ())?;
        half.push(Substep::<0, M>::end_kick(system, constants, t, &half.q));
        let kick = Substep::<1, M>::start_kick(system, constants, t, &half.q);
        let mut state = substep::<S, M, 1>(at, (&half.q, &half.mu), half.rests, kick, u, |_| ())?;
        let kick = Substep::<1, M>::end_kick(system, constants, t, &state.q);
        state.push(kick);
        state.on_space();
        Ok(state.end::<C>(C::impulse(kick)))
    }

    #[inline]
    fn step_symmetric(at: At<'_, S, M>, q: &Q<S>, p: &Q<S>) -> Result<Pair<S>, Error> {
        symmetric::<S, M, 1>(at, symmetric::<S, M, 0>(at, (*q, *p))?)
    }

    #[inline]
    fn inverse_legendre(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>) -> Result<S::Element, Error> {
        inverse_legendre::<S, M, 2>(at, q, mu)
    }
}
