//! One exact motion, step after step.

use super::substep::{Before, LeftOf, Moving, inverse_legendre, symmetric};
use super::{Parted, Scheme};
use crate::parts::{FreeMotion, Substep};
use crate::summation::Sums;
use crate::{Error, Method, Space};

/// (q, N) ↦ (q⁺, N⁺) along a free motion. What the motion keeps is made once, and travels along with the state.
#[derive(Clone, Copy, Debug)]
pub struct AlongFreeMotion;

impl<S: Substep<0, M> + FreeMotion<M>, M: Method<S>> Scheme<S, M> for AlongFreeMotion {
    type Left = LeftOf<S, M, S::Kept>;

    momentum_is_held!(M);

    fn left(system: &S, constants: &M::Constants, _: S::Scalar, _: &S::Configuration, mu: &S::Momentum) -> Self::Left {
        S::Sums::joined(system.kept(constants, mu), (Space::origin(), Space::origin()))
    }

    fn left_after(
        system: &S,
        constants: &M::Constants,
        _: S::Scalar,
        _: &S::Configuration,
        mu: &S::Momentum,
        left: &Self::Left,
    ) -> Self::Left {
        let (_, rests) = S::Sums::parted::<S::Scalar, S::Kept, S::Configuration, S::Momentum>(left);
        S::Sums::joined(system.kept(constants, mu), rests)
    }

    #[inline(always)]
    fn step(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        state: (&S::Configuration, &S::Momentum, &Self::Left),
        _: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        if S::IS_SHORT { step(system, constants, t, state) } else { called(system, constants, t, state) }
    }

    fn steps(
        system: &S,
        constants: &M::Constants,
        (t, _): (S::Scalar, S::Scalar),
        count: usize,
        (q, mu, left): (&S::Configuration, &S::Momentum, &Self::Left),
        _: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        let (mut state, kept) = Moving::<S, M>::start::<S::Kept>(q, mu, left);
        for _ in 0..count {
            follow(system, constants, t, kept, &mut state)?;
        }
        Ok(state.finish(*kept))
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
        inverse_legendre::<S, M, 0>(system, constants, t, q, mu)
    }
}

/// (q, N) after one step along a motion.
///
/// # Errors
/// Those of [`FreeMotion::follow`].
#[inline(always)]
fn follow<S: Substep<0, M> + FreeMotion<M>, M: Method<S>>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    kept: &S::Kept,
    state: &mut Moving<S, M>,
) -> Result<(), Error> {
    // copies: a reference to a part of the state would keep all of it in memory
    let from = state.q;
    let mu = state.mu;
    let (x, mu) = system.follow(constants, kept, &mu)?;
    state.mu = mu;
    let motion = system.motion(&x, || system.increment(&x));
    state.advance(system, &motion);
    state.update(system.update(constants, t, &from, &mu, &motion));
    state.on_space();
    Ok(())
}

#[inline(always)]
fn step<S: Substep<0, M> + FreeMotion<M>, M: Method<S>>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    (q, mu, left): Before<'_, S, M, S::Kept>,
) -> Result<Parted<S, AlongFreeMotion, M>, Error> {
    let (mut state, kept) = Moving::<S, M>::start::<S::Kept>(q, mu, left);
    follow(system, constants, t, kept, &mut state)?;
    Ok(state.finish(*kept))
}

/// A long step, which the compiler may call.
#[inline]
fn called<S: Substep<0, M> + FreeMotion<M>, M: Method<S>>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    state: Before<'_, S, M, S::Kept>,
) -> Result<Parted<S, AlongFreeMotion, M>, Error> {
    step(system, constants, t, state)
}
