//! States on the cotangent bundle.

use super::Stepper;
use crate::parameters::check_finite;
use crate::parts::{Q, T};
use crate::scheme::Scheme;
use crate::{Clebsch, CotangentState, Error, Mask, Method, Scalar, Space, Time};
use num_traits::Zero;

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The state (q, p) on T*Q, after checks: finite, q on its orbit. Where the time matters it starts at 0.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OffOrbit`], or [`Error::IndefiniteKineticEnergy`] as for [`state`](Self::state).
    pub fn cotangent_state(&self, q: S::Configuration, p: S::Configuration) -> Result<CotangentState<S>, Error> {
        self.checked_cotangent_state(S::Scalar::zero(), q, p)
    }

    /// One step of the discrete symmetric representation on T*Q: (q_k, p_k) ↦ (q_{k+1}, p_{k+1}).
    ///
    /// # Errors
    /// As [`step`](Self::step), and [`Error::NoCovector`] where forces act or momenta are stepped alone.
    #[inline]
    pub fn step_symmetric(&self, state: &CotangentState<S>) -> Result<CotangentState<S>, Error> {
        let time = state.time.after_step(self.h);
        let name = |(q, now, _): &(Q<S>, T<S>, Q<S>), lane| {
            if !q.finite().lane(lane) {
                "the configuration after the step"
            } else if !Scalar::finite(*now).lane(lane) {
                "the time after the step"
            } else {
                "the covector after the step"
            }
        };
        let (configuration, _, covector) = self.computed(state.time.now(), name, |at| {
            let (q, p) = M::Scheme::step_symmetric(at, &state.configuration, &state.covector)?;
            Ok((q, time.now(), p))
        })?;
        if S::MAY_LEAVE_ORBIT {
            self.check_configuration(&configuration)?;
        }
        Ok(CotangentState { time, configuration, covector })
    }

    pub(super) fn checked_cotangent_state(&self, t: T<S>, q: Q<S>, p: Q<S>) -> Result<CotangentState<S>, Error> {
        self.check_place(t, &q)?;
        check_finite("the covector", &p)?;
        Ok(CotangentState { time: S::Time::at(t), configuration: q, covector: p })
    }
}
