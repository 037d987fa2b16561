//! Bounds by a primal-dual interior point method: a + s = excess with slacks s > 0 that cost −μ ln s each.
//!
//! Where a guess violates bounds they are relaxed by the excess, which shrinks by 1 − α with each step of fraction α, exactly: slacks are
//! what is left, s = excess − a, for bounds of any form. Steps keep a two-hundredth of each slack.
//!
//! Source: Wächter and Biegler, *On the implementation of an interior-point filter line-search algorithm* (2006), for multipliers and the
//! sequence of μ; Pavlov, Shames and Manzie, *Interior point differential dynamic programming* (2021), for slacks in roll-outs.

use super::Stage;
use super::sweep::{Plan, Problem};
use crate::space::larger;
use crate::{Controlled, Error, Real};
use nalgebra::SVector;

/// The part of a slack that one step may take.
pub(super) const TO_BOUNDARY: f64 = 0.995;
/// What μ is first, all bounds together, relative to the price.
const FIRST: f64 = 0.1;
/// What μ is last: this power of ε.
const LAST: (i64, i64) = (3, 4);

/// The first μ, for so many bounds and a price of this size: the larger of what the plan costs and of what it costs to keep the bounds that
/// it violates. A guess that costs nothing would have no barrier by its own price, and nothing would push it back.
pub(super) fn first<T: Real>(bounds: T, price: T) -> T {
    T::from_f64(FIRST) * price / bounds
}

/// The last μ.
pub(super) fn last<T: Real>(bounds: T, price: T) -> T {
    T::EPSILON.powf(T::from_ratio(LAST.0, LAST.1)) * price / bounds
}

/// The next μ: μ̂ ↦ min(μ̂/5, μ̂^(3/2)) relative to the price.
pub(super) fn next<T: Real>(barrier: T, bounds: T, price: T) -> T {
    let relative = barrier * bounds / price;
    let fifth = relative * T::from_ratio(1, 5);
    let power = relative * relative.sqrt();
    larger((if power < fifth { power } else { fifth }) * price / bounds, last(bounds, price))
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Stage<S, D, U, C> {
    /// ζ = μ/s + Σ(a + s) and Σ = z/s: the force and the stiffness of the bounds.
    #[inline]
    pub(super) fn condensed(&self, barrier: T) -> (SVector<T, C>, SVector<T, C>) {
        let stiffness = SVector::<T, C>::from_fn(|i, _| self.multipliers[i] / self.slack[i]);
        (SVector::from_fn(|i, _| barrier / self.slack[i] + stiffness[i] * self.excess[i]), stiffness)
    }

    /// Σ a/s of the bounds that are violated, and the weights 1/s of those.
    pub(super) fn violation(&self) -> (T, SVector<T, C>) {
        let mut sum = T::zero();
        let weights = SVector::from_fn(|i, _| {
            let violation = self.excess[i] - self.slack[i];
            if violation > T::zero() {
                sum += violation / self.slack[i];
                self.slack[i].recip()
            } else {
                T::zero()
            }
        });
        (sum, weights)
    }

    /// Takes the slacks of a roll-out of this fraction. Multipliers stay positive and near μ/s.
    pub(super) fn accept_slacks(&mut self, fraction: T, barrier: T) {
        let wide = T::EPSILON.sqrt().recip();
        for i in 0..C {
            let (z, slack, moved) = (self.multipliers[i], self.slack[i], self.trial.slack[i]);
            let next = z + fraction * (barrier / slack - z) - z / slack * (moved - slack);
            let central = barrier / moved;
            let least = larger(T::from_f64(1.0 - TO_BOUNDARY) * z, central / wide);
            let most = central * wide;
            self.multipliers[i] = if next < least {
                least
            } else if next > most {
                most
            } else {
                next
            };
            self.excess[i] *= T::one() - fraction;
            self.slack[i] = moved;
        }
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Plan<'_, S, D, U, C> {
    /// The number of bounds of all stages.
    pub fn bounds(&self) -> T {
        T::from_f64((self.stages.len() * C) as f64)
    }

    /// Slacks of the plan, and by how much its bounds must be relaxed for them to be positive.
    pub fn relax(&mut self) {
        let zero = T::zero();
        let mut sizes = SVector::<T, C>::from_element(zero);
        for (index, stage) in self.stages.iter_mut().enumerate() {
            let values = self.problem.system.bounds(self.problem.time_after(index), &stage.place, &stage.input);
            stage.slack = -values;
            sizes = sizes.zip_map(&values, |size, value| larger(size, value.abs()));
        }
        let largest = sizes.iter().fold(zero, |max, x| larger(max, *x));
        let least = sizes.map(|size| {
            let size = if size > zero { size } else { largest };
            if size > zero { size * T::from_ratio(1, 100) } else { T::one() }
        });
        for stage in self.stages.iter_mut() {
            let slack = stage.slack.zip_map(&least, larger);
            stage.excess = slack - stage.slack;
            stage.slack = slack;
        }
    }

    /// The barrier of a plan that holds multipliers of its bounds, which it keeps: the mean of z·s. `None` where there are none.
    pub fn resume(&mut self) -> Option<T> {
        let zero = T::zero();
        let mut sum = zero;
        for (index, stage) in self.stages.iter_mut().enumerate() {
            stage.slack = -self.problem.system.bounds(self.problem.time_after(index), &stage.place, &stage.input);
            stage.excess = SVector::from_element(zero);
            for (z, s) in stage.multipliers.iter().zip(stage.slack.iter()) {
                if !(*z > zero && *s > zero && z.is_finite()) {
                    return None;
                }
                sum += *z * *s;
            }
        }
        Some(sum / self.bounds())
    }

    /// Multipliers μ/s for the slacks.
    pub fn begin(&mut self, barrier: T) {
        self.stages.iter_mut().for_each(|stage| stage.multipliers = stage.slack.map(|slack| barrier / slack));
    }

    /// Multipliers of the bounds from the correction that would come next, for a plan that needs none: slacks of active bounds, of
    /// which μ/s is made, have few digits.
    ///
    /// # Errors
    /// Those of a step.
    pub fn settle(&mut self, change: &SVector<T, D>, barrier: T) -> Result<(), Error> {
        let Problem { system, constants, .. } = self.problem;
        let mut displacement = SVector::<T, D>::from_element(T::zero());
        for (index, stage) in self.stages.iter_mut().enumerate().filter(|_| C > 0) {
            let t = self.problem.time_after(index);
            let step = system.expand(constants, t, &stage.place, &stage.input, &stage.next_costate)?;
            let bounds = system.bounds_expanded(t, &stage.place, &stage.input, &stage.multipliers);
            let input = stage.shift + stage.by_multiplier * change + stage.gain * displacement;
            let moved = bounds.by_place * displacement + bounds.by_input * input;
            let (force, stiffness) = stage.condensed(barrier);
            stage.multipliers = SVector::from_fn(|i, _| larger(T::zero(), force[i] + stiffness[i] * moved[i]));
            displacement = step.by_place * displacement + step.by_input * input;
        }
        Ok(())
    }

    /// Whether bounds are relaxed.
    pub fn is_relaxed(&self) -> bool {
        self.stages.iter().any(|stage| stage.excess.iter().any(|excess| *excess > T::zero()))
    }

    /// Whether a bound is violated, where all are still relaxed by this part of the first excess: by more than the round-off of its slack,
    /// and by more than that of the first excess.
    pub fn is_violated(&self, relaxation: T) -> bool {
        let round_off = T::from_f64(16.0) * T::EPSILON;
        let mut bounds = self.stages.iter().flat_map(|stage| stage.slack.iter().zip(stage.excess.iter()));
        relaxation > round_off && bounds.any(|(slack, excess)| *excess - *slack > round_off * *excess)
    }

    /// The bound that keeps all from being relaxed less, with the stage and by how much it is violated.
    pub fn worst_bound(&self) -> Option<(usize, usize, T)> {
        let mut worst = None;
        let mut least = T::one();
        for (index, stage) in self.stages.iter().enumerate() {
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
