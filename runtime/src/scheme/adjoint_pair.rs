//! Half a step, and half a step of its adjoint.

use super::kick_drift_kick::{After, changed, first_left};
use super::substep::{Before, Carry, LeftOf, inverse_legendre, substep, symmetric};
use super::{Parted, Scheme};
use crate::parts::Substep;
use crate::summation::Sums;
use crate::{Error, Method};
use core::marker::PhantomData;

/// A step of ℓd with h/2 and one of its adjoint with h/2: of second order where ℓd is of first. Substep 2 is ℓd itself, which is inverted.
///
/// Source: Marsden and West, *Discrete mechanics and variational integrators*, section 2.4.
#[derive(Clone, Copy, Debug)]
pub struct AdjointPair<C>(PhantomData<C>);

impl<S: Substep<0, M> + Substep<1, M> + Substep<2, M>, M: Method<S>, C: Carry<S>> Scheme<S, M> for AdjointPair<C> {
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

    #[inline]
    fn step(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        (q, mu, left): (&S::Configuration, &S::Momentum, &Self::Left),
        u: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        step::<S, M, C>(system, constants, t, (q, mu, left), u)
    }

    #[inline]
    fn step_symmetric(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        p: &S::Configuration,
    ) -> Result<(S::Configuration, S::Configuration), Error> {
        if !S::HAS_COVECTORS {
            return Err(Error::NoCovector);
        }
        let half = symmetric::<S, M, 0>(system, constants, t, (*q, *p))?;
        symmetric::<S, M, 1>(system, constants, t, half)
    }

    #[inline]
    fn inverse_legendre(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<S::Element, Error> {
        inverse_legendre::<S, M, 2>(system, constants, t, q, mu)
    }
}

#[inline]
fn step<S: Substep<0, M> + Substep<1, M>, M: Method<S>, C: Carry<S>>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    (q, mu, left): Before<'_, S, M, C::Impulse>,
    u: &S::Input,
) -> Result<After<S, M, C>, Error> {
    let (impulse, rests) = S::Sums::parted(left);
    let kick = C::kick(impulse, || Substep::<0, M>::start_kick(system, constants, t, q));
    let mut half = substep::<S, M, 0>(system, constants, t, (q, mu), rests, kick, u)?;
    half.push(Substep::<0, M>::end_kick(system, constants, t, &half.q));
    let kick = Substep::<1, M>::start_kick(system, constants, t, &half.q);
    let mut state = substep::<S, M, 1>(system, constants, t, (&half.q, &half.mu), half.rests, kick, u)?;
    let kick = Substep::<1, M>::end_kick(system, constants, t, &state.q);
    state.push(kick);
    Ok(state.end(C::impulse(kick)))
}
