//! Half a step, and half a step of its adjoint.

use super::kick_drift_kick::{After, changed, first_left};
use super::substep::{Carry, LeftOf, Moving, inverse_legendre, symmetric};
use super::{Parted, Scheme};
use crate::Error;
use crate::parts::Substep;
use core::marker::PhantomData;

/// A step of ℓd with h/2 and one of its adjoint with h/2: of second order where ℓd is of first. Substep 2 is ℓd itself, which is inverted.
///
/// Source: Marsden and West, *Discrete mechanics and variational integrators*, section 2.4.
#[derive(Clone, Copy, Debug)]
pub struct AdjointPair<C>(PhantomData<C>);

impl<S: Substep<0> + Substep<1> + Substep<2>, C: Carry<S>> Scheme<S> for AdjointPair<C> {
    type Left = LeftOf<S, C::Impulse>;

    momentum_is_held!();

    #[inline]
    fn left(system: &S, constants: &S::Constants, t: S::Scalar, q: &S::Configuration, _: &S::Momentum) -> Self::Left {
        first_left::<S, C>(C::impulse(Substep::<0>::start_kick(system, constants, t, q)))
    }

    #[inline]
    fn left_after(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        _: &S::Momentum,
        left: &Self::Left,
    ) -> Self::Left {
        changed::<S, C>(left, |_| C::impulse(Substep::<0>::start_kick(system, constants, t, q)))
    }

    #[inline(always)]
    fn scaled(left: Self::Left, ratio: S::Scalar) -> Self::Left {
        changed::<S, C>(&left, |impulse| C::scaled(impulse, ratio))
    }

    #[inline]
    fn step(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        (q, mu, left): (&S::Configuration, &S::Momentum, &Self::Left),
        u: &S::Input,
    ) -> Result<Parted<S, Self>, Error> {
        step::<S, C>(system, constants, t, (q, mu, left), u)
    }

    #[inline]
    fn step_symmetric(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        p: &S::Configuration,
    ) -> Result<(S::Configuration, S::Configuration), Error> {
        if !S::HAS_COVECTORS {
            return Err(Error::NoCovector);
        }
        let half = symmetric::<S, 0>(system, constants, t, (*q, *p))?;
        symmetric::<S, 1>(system, constants, t, half)
    }

    #[inline]
    fn inverse_legendre(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<S::Element, Error> {
        inverse_legendre::<S, 2>(system, constants, t, q, mu)
    }
}

#[inline]
fn step<S: Substep<0> + Substep<1>, C: Carry<S>>(
    system: &S,
    constants: &S::Constants,
    t: S::Scalar,
    (q, mu, left): (&S::Configuration, &S::Momentum, &LeftOf<S, C::Impulse>),
    u: &S::Input,
) -> Result<After<S, C>, Error> {
    let (mut state, impulse) = Moving::start(q, mu, left);
    let kick = C::kick(impulse, || Substep::<0>::start_kick(system, constants, t, q));
    state.substep::<0>(system, constants, t, kick, u)?;
    state.push(Substep::<0>::end_kick(system, constants, t, &state.q));
    let kick = Substep::<1>::start_kick(system, constants, t, &state.q);
    state.substep::<1>(system, constants, t, kick, u)?;
    let kick = Substep::<1>::end_kick(system, constants, t, &state.q);
    state.push(kick);
    Ok(state.end(C::impulse(kick)))
}
