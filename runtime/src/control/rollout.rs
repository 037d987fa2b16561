//! The forward sweep: a plan is followed with its corrections, which feedback keeps near the plan before.

use super::Stage;
use super::barrier::Barrier;
use super::sweep::Problem;
use crate::space::larger;
use crate::{Controlled, Error, Real, Scalar, Space};
use nalgebra::SVector;
use num_traits::{One, Zero};

/// The part of a slack that one step may take.
pub(super) const TO_BOUNDARY: f64 = 0.995;

/// Where a proposed plan leads.
pub(super) struct Rolled<X, T> {
    pub last: X,
    /// Σℓ + φ
    pub price: T,
    /// Σ ln(s⁺/s)
    pub slack_logarithms: T,
    /// z·(a + s) with the multipliers of the full step, before it.
    pub excess_price: T,
    /// The fraction of the correction that slacks allow, where it is smaller than the one that was made.
    pub allowed: Option<T>,
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// The places that the inputs lead to. Returns x_N.
    ///
    /// # Errors
    /// Those of a step; [`Error::NotFinite`].
    pub fn follow(&self, plan: &mut [Stage<S, D, U, C>]) -> Result<S::Place, Error> {
        let mut x = *self.start;
        for (index, stage) in plan.iter_mut().enumerate() {
            stage.place = x;
            x = self.system.follow(self.constants, self.time_after(index), &x, &stage.input)?;
        }
        if x.is_finite() { Ok(x) } else { Err(Error::NotFinite { name: "the end of the guessed plan" }) }
    }

    /// Proposes the plan after `fraction` of the correction with the change δν of the multipliers of the target.
    ///
    /// # Errors
    /// Those of a step.
    pub fn roll_out(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        fraction: S::Scalar,
        change: &SVector<S::Scalar, D>,
        barrier: Barrier<S::Scalar>,
    ) -> Result<Rolled<S::Place, S::Scalar>, Error> {
        let (zero, one) = (S::Scalar::zero(), S::Scalar::one());
        let (mut x, mut price, mut logarithms, mut excess_price) = (*self.start, zero, zero, zero);
        let (to_boundary, mut allowed) = (S::Scalar::from_f64(TO_BOUNDARY), one);
        for (index, stage) in plan.iter_mut().enumerate() {
            let t = self.time_after(index);
            let shift = (stage.shift + stage.by_multiplier * change) * fraction;
            let mut input = stage.input + shift;
            if index > 0 {
                input += stage.gain * self.system.displacement(&stage.place, &x);
            }
            if C > 0 {
                let bounds = self.system.bounds(t, &x, &input);
                for i in 0..C {
                    let (z, s) = (stage.multipliers[i], stage.slack[i]);
                    let next = (one - fraction) * stage.excess[i] - bounds[i];
                    stage.trial.slack[i] = next;
                    let ratio = next / s;
                    if ratio < one - to_boundary {
                        let limit = fraction * to_boundary / (one - ratio);
                        allowed = if limit < allowed { limit } else { allowed };
                    } else {
                        logarithms += ratio.ln();
                        let full = (barrier.weight - z * (next - s) / fraction) / s;
                        excess_price += full * stage.excess[i];
                    }
                }
            }
            price += self.system.price(self.constants, t, &x, &input);
            (stage.trial.place, stage.trial.input) = (x, input);
            x = self.system.follow(self.constants, t, &x, &input)?;
        }
        price += self.system.endpoint(self.time_after(plan.len()), &x);
        let allowed = if allowed < fraction { Some(allowed) } else { None };
        Ok(Rolled { last: x, price, slack_logarithms: logarithms, excess_price, allowed })
    }

    /// Takes the proposed plan, made with this fraction of the correction.
    pub fn accept(&self, plan: &mut [Stage<S, D, U, C>], fraction: S::Scalar, barrier: Barrier<S::Scalar>) {
        let kept = S::Scalar::one() - fraction;
        for stage in plan {
            for i in 0..C {
                let (z, s, moved) = (stage.multipliers[i], stage.slack[i], stage.trial.slack[i]);
                stage.multipliers[i] = barrier.multiplier(z, s, moved, fraction);
                stage.excess[i] *= kept;
                stage.slack[i] = moved;
            }
            (stage.place, stage.input) = (stage.trial.place, stage.trial.input);
        }
    }

    /// Multipliers of the bounds from the correction that would come next, for a plan that needs none: slacks of active bounds, of
    /// which μ/s is made, have few digits.
    ///
    /// # Errors
    /// Those of a step.
    pub fn settle(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        change: &SVector<S::Scalar, D>,
        barrier: Barrier<S::Scalar>,
    ) -> Result<(), Error> {
        let zero = S::Scalar::zero();
        let mut displacement = SVector::<S::Scalar, D>::from_element(zero);
        for (index, stage) in plan.iter_mut().enumerate().filter(|_| C > 0) {
            let t = self.time_after(index);
            let step = self.system.expand(self.constants, t, &stage.place, &stage.input, &stage.next_costate)?;
            let bounds = self.system.bounds_expanded(t, &stage.place, &stage.input, &stage.multipliers);
            let input = stage.shift + stage.by_multiplier * change + stage.gain * displacement;
            let moved = bounds.by_place * displacement + bounds.by_input * input;
            let (force, stiffness) = barrier.condense(stage);
            stage.multipliers = SVector::from_fn(|i, _| larger(zero, force[i] + stiffness[i] * moved[i]));
            displacement = step.by_place * displacement + step.by_input * input;
        }
        Ok(())
    }

    /// Whether bounds are relaxed.
    pub fn is_relaxed(&self, plan: &[Stage<S, D, U, C>]) -> bool {
        plan.iter().any(|stage| stage.excess.iter().any(|excess| *excess > S::Scalar::zero()))
    }

    /// Whether a bound is violated, where all are still relaxed by this part of the first excess: by more than the round-off of its slack,
    /// and by more than that of the first excess.
    pub fn is_violated(&self, plan: &[Stage<S, D, U, C>], relaxation: S::Scalar) -> bool {
        let round_off = S::Scalar::from_f64(16.0) * S::Scalar::EPSILON;
        let mut bounds = plan.iter().flat_map(|stage| stage.slack.iter().zip(stage.excess.iter()));
        relaxation > round_off && bounds.any(|(slack, excess)| *excess - *slack > round_off * *excess)
    }

    /// The bound that keeps all from being relaxed less, with the stage and by how much it is violated.
    pub fn worst_bound(&self, plan: &[Stage<S, D, U, C>]) -> Option<(usize, usize, S::Scalar)> {
        let mut worst = None;
        let mut least = S::Scalar::one();
        for (index, stage) in plan.iter().enumerate() {
            for i in 0..C {
                let room = stage.slack[i] / stage.excess[i];
                if room < least {
                    least = room;
                    worst = Some((index, i, stage.excess[i] - stage.slack[i]));
                }
            }
        }
        worst
    }
}
