//! One exact motion, step after step.

use super::sequence::{Carry, From, InSequence, Sequence, To};
use super::substep::Moving;
use super::{At, is_due, is_near, look};
use crate::parts::{FreeMotion, Mu, Q, Substep, T, U};
use crate::{Error, Method, Scalar, Space};

/// (q, N) ↦ (q⁺, N⁺) along a free motion. The constants of the motion are computed once, and are a part of the state.
pub type AlongFreeMotion = InSequence<Order>;

/// The order of steps [`AlongFreeMotion`].
pub struct Order;

/// The data that steps share: the constants of the motion.
pub struct Kept;

impl<S: FreeMotion<M>, M: Method<S>> Carry<S, M> for Kept {
    type Impulse = S::Kept;

    fn first(at: At<'_, S, M>, _: &Q<S>, mu: &Mu<S>) -> S::Kept {
        at.system.kept(at.constants, mu)
    }

    #[inline]
    fn kicked(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>, _: &S::Kept) -> S::Kept {
        Self::first(at, q, mu)
    }

    /// Steps are compared, not constants: those of the start of a motion may be another choice for the same motion.
    fn resumed(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>, kept: &S::Kept) -> S::Kept {
        let anew = Self::first(at, q, mu);
        let motion = |kept| {
            let (x, mu) = at.system.follow(at.constants, kept, mu)?;
            Ok::<_, Error>((at.system.increment(&x), mu))
        };
        let Ok((wanted, end)) = motion(&anew) else { return anew };
        let Ok((found, found_end)) = motion(kept) else { return anew };
        let is_same = is_near(&found, &wanted, wanted.max_abs()) & is_near(&found_end, &end, end.max_abs());
        kept.zip_map(&anew, |kept, anew| T::<S>::select(is_same, kept, anew))
    }
}

impl<S: Substep<0, M> + FreeMotion<M>, M: Method<S>> Sequence<S, M> for Order {
    type Carry = Kept;

    #[inline(always)]
    fn step(at: At<'_, S, M>, (q, mu, left): From<'_, S, M, Kept>, _: &S::Input) -> To<S, M, Kept> {
        let (mut state, kept) = Moving::<S, M>::start::<Kept>(q, mu, left);
        follow(at, kept, &mut state)?;
        Ok(state.end::<Kept>(*kept))
    }

    fn steps(at: At<'_, S, M>, _: T<S>, steps: usize, (q, mu, left): From<'_, S, M, Kept>, _: &U<S>) -> To<S, M, Kept> {
        let (mut state, kept) = Moving::<S, M>::start::<Kept>(q, mu, left);
        for number in 0..steps {
            follow(at, kept, &mut state)?;
            if is_due(number) {
                let (q, mu) = (state.q, state.mu);
                look(&q, &mu)?;
            }
        }
        Ok(state.end::<Kept>(*kept))
    }
}

/// (q, N) after one step along a motion.
#[inline(always)]
fn follow<S: Substep<0, M> + FreeMotion<M>, M: Method<S>>(
    at: At<'_, S, M>,
    kept: &S::Kept,
    state: &mut Moving<S, M>,
) -> Result<(), Error> {
    // a copy: a reference to a part of the state would put all of it in memory
    let mu = state.mu;
    let (x, mu) = at.system.follow(at.constants, kept, &mu)?;
    state.mu = mu;
    state.drift(at, &x);
    state.on_space();
    Ok(())
}
