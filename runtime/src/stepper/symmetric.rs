//! States on the cotangent bundle.

use super::{Stepper, first_without, whole_or_lane};
use crate::parameters::check_finite;
use crate::scheme::{At, Scheme};
use crate::{Clebsch, CotangentState, Error, Mask, Method, Scalar, Space, Time};
use num_traits::Zero;

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The state (q, p) on T*Q, after checks: finite, q on its orbit. Where the time matters it starts at 0.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::OffOrbit`].
    pub fn cotangent_state(&self, q: S::Configuration, p: S::Configuration) -> Result<CotangentState<S>, Error> {
        self.checked_cotangent_state(S::Scalar::zero(), q, p)
    }

    /// One step of the discrete symmetric representation on T*Q: (q_k, p_k) ↦ (q_{k+1}, p_{k+1}).
    ///
    /// # Errors
    /// As [`step`](Self::step), and [`Error::NoCovector`] where forces act or momenta are stepped alone.
    #[inline]
    pub fn step_symmetric(&self, state: &CotangentState<S>) -> Result<CotangentState<S>, Error> {
        let CotangentState { time, configuration, covector } = state;
        let (configuration, covector) = match M::Scheme::step_symmetric(self.at(time.now()), configuration, covector) {
            Ok(next) => next,
            Err(_) if S::Scalar::LANES > 1 => return Err(Error::InLane { lane: 0 }),
            Err(error) => {
                return Err(self.explained(0, error, |constants| {
                    let at = At::new(&self.system, constants, time.now());
                    let (q, p) = M::Scheme::step_symmetric(at, configuration, covector)?;
                    Ok((q.finite() & p.finite()).lane(0))
                }));
            }
        };
        let next = CotangentState { time: time.after_step(self.h), configuration, covector };
        let finite: <S::Scalar as Scalar>::Mask = next.finite();
        if finite.all() {
            return Ok(next);
        }
        let lane = first_without::<S::Scalar>(finite);
        Err(whole_or_lane::<S::Scalar>(lane, Error::NotFinite { name: next.overflowed(lane) }))
    }

    pub(super) fn checked_cotangent_state(
        &self,
        t: S::Scalar,
        q: S::Configuration,
        p: S::Configuration,
    ) -> Result<CotangentState<S>, Error> {
        self.check_configuration(&q)?;
        check_finite("the covector", &p)?;
        Ok(CotangentState { time: S::Time::at(t), configuration: q, covector: p })
    }
}
