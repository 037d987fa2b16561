//! Steps of several bodies side by side, where the scalar has lanes: one that fails does not keep the others.

use super::Stepper;
use crate::scheme::{Held, Left};
use crate::{Clebsch, Error, Mask, Method, Scalar, Space, State};
use num_traits::Zero;

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// One step in each lane by itself, and the lanes in which it succeeded; in the others the state stays as it is.
    ///
    /// [`step`](Self::step) is this where all lanes succeed.
    #[inline]
    pub fn step_each(&self, state: &State<S, M>) -> (State<S, M>, <S::Scalar as Scalar>::Mask) {
        let Ok(next) = self.attempt(state, &S::Input::origin()) else {
            return (*state, <S::Scalar as Scalar>::Mask::nowhere());
        };
        let stepped = next.finite();
        if stepped.all() { (next, stepped) } else { (merged(&next, state, stepped), stepped) }
    }

    /// Why the step of a lane fails; `None` where it does not.
    ///
    /// The step is made once more, with the momenta of all other lanes NaN: what is left to fail is this lane.
    #[cold]
    pub fn failure(&self, state: &State<S, M>, lane: usize) -> Option<Error> {
        let mut alone = *state;
        alone.held = Held::<S, M>::filled(S::Scalar::zero() / S::Scalar::zero());
        alone.held.set_lane(lane, &state.held.lane(lane));
        // nothing is known of their motions
        alone.left = Left::<S, M>::filled(S::Scalar::zero());
        alone.left.set_lane(lane, &state.left.lane(lane));
        match self.attempt(&alone, &S::Input::origin()) {
            Err(error) => Some(self.refusal(&alone, &S::Input::origin(), lane, error)),
            Ok(next) if next.finite().lane(lane) => None,
            Ok(next) => Some(self.overflow(&next, lane)),
        }
    }
}

/// `next` in the lanes of `stepped`, `before` in the others.
#[cold]
fn merged<S: Clebsch, M: Method<S>>(
    next: &State<S, M>,
    before: &State<S, M>,
    stepped: <S::Scalar as Scalar>::Mask,
) -> State<S, M> {
    let mut merged = *next;
    (0..S::Scalar::LANES).filter(|&lane| !stepped.lane(lane)).for_each(|lane| merged.take_lane(lane, before));
    merged
}
