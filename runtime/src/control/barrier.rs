//! Bounds by a primal-dual interior point method: a + s = excess with slacks s > 0 that cost −μ ln s each.
//!
//! Where a guess violates bounds they are relaxed by the excess, which shrinks by 1 − α with each step of fraction α, exactly: slacks are
//! what is left, s = excess − a, for bounds of any form. Steps keep a two-hundredth of each slack.
//!
//! Source: Wächter and Biegler, *On the implementation of an interior-point filter line-search algorithm* (2006), for multipliers and the
//! sequence of μ; Pavlov, Shames and Manzie, *Interior point differential dynamic programming* (2021), for slacks in roll-outs.

use super::Stage;
use super::sweep::Problem;
use crate::space::larger;
use crate::{Controlled, Real, Scalar};
use nalgebra::SVector;
use num_traits::{One, Zero};

/// The price μ of e-fold smaller slacks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Barrier<T> {
    pub weight: T,
}

/// What μ is first and last, all bounds together, relative to the price.
const FIRST: f64 = 0.1;
/// The last is this power of ε.
const LAST: (i64, i64) = (3, 4);

impl<T: Real> Barrier<T> {
    /// Without any.
    pub fn none() -> Self {
        Self { weight: T::zero() }
    }

    /// The first of a sequence, for so many bounds and a price of this size: the larger of what the plan costs and of what it costs to keep
    /// the bounds that it violates. A guess that costs nothing would have no barrier by its own price, and nothing would push it back.
    pub fn first(bounds: T, price: T) -> Self {
        Self { weight: T::from_f64(FIRST) * price / bounds }
    }

    /// The last μ.
    pub fn last(bounds: T, price: T) -> Self {
        Self { weight: T::EPSILON.powf(T::from_ratio(LAST.0, LAST.1)) * price / bounds }
    }

    /// The next: μ̂ ↦ min(μ̂/5, μ̂^(3/2)) relative to the price.
    pub fn next(self, bounds: T, price: T) -> Self {
        let relative = self.weight * bounds / price;
        let fifth = relative * T::from_ratio(1, 5);
        let power = relative * relative.sqrt();
        let next = if power < fifth { power } else { fifth };
        Self { weight: larger(next * price / bounds, Self::last(bounds, price).weight) }
    }

    /// ζ = μ/s + Σ(a + s) and Σ = z/s: the force and the stiffness of the bounds of a stage.
    #[inline]
    pub fn condense<S, const D: usize, const U: usize, const C: usize>(
        &self,
        stage: &Stage<S, D, U, C>,
    ) -> (SVector<T, C>, SVector<T, C>)
    where
        S: Controlled<D, U, C, Scalar = T>,
    {
        let stiffness = SVector::<T, C>::from_fn(|i, _| stage.multipliers[i] / stage.slack[i]);
        let force = SVector::from_fn(|i, _| self.weight / stage.slack[i] + stiffness[i] * stage.excess[i]);
        (force, stiffness)
    }

    /// z after a step of this fraction that moved the slack from `slack` to `moved`: kept positive and near μ/s.
    #[inline]
    pub fn multiplier(&self, z: T, slack: T, moved: T, fraction: T) -> T {
        let target = self.weight / slack;
        let next = z + fraction * (target - z) - z / slack * (moved - slack);
        let (wide, kept) = (T::EPSILON.sqrt().recip(), T::from_f64(1.0 - super::rollout::TO_BOUNDARY));
        let central = self.weight / moved;
        let least = larger(kept * z, central / wide);
        let most = central * wide;
        if next < least {
            least
        } else if next > most {
            most
        } else {
            next
        }
    }
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// Slacks of the plan, and by how much its bounds must be relaxed for them to be positive.
    pub fn relax(&self, plan: &mut [Stage<S, D, U, C>]) {
        let zero = S::Scalar::zero();
        let mut sizes = SVector::<S::Scalar, C>::from_element(zero);
        for (index, stage) in plan.iter_mut().enumerate() {
            let values = self.system.bounds(self.time_after(index), &stage.place, &stage.input);
            stage.slack = -values;
            (0..C).for_each(|i| sizes[i] = larger(sizes[i], values[i].abs()));
        }
        let largest = sizes.iter().fold(zero, |max, x| larger(max, *x));
        let least = SVector::<S::Scalar, C>::from_fn(|i, _| {
            let size = if sizes[i] > zero { sizes[i] } else { largest };
            if size > zero { size * S::Scalar::from_ratio(1, 100) } else { S::Scalar::one() }
        });
        for stage in plan {
            for i in 0..C {
                let slack = larger(stage.slack[i], least[i]);
                stage.excess[i] = slack - stage.slack[i];
                stage.slack[i] = slack;
            }
        }
    }

    /// The barrier of a plan that holds multipliers of its bounds, which it keeps: the mean of z·s. `None` where there are none.
    pub fn resume(&self, plan: &mut [Stage<S, D, U, C>]) -> Option<Barrier<S::Scalar>> {
        let (zero, mut sum) = (S::Scalar::zero(), S::Scalar::zero());
        for (index, stage) in plan.iter_mut().enumerate() {
            stage.slack = -self.system.bounds(self.time_after(index), &stage.place, &stage.input);
            stage.excess = SVector::from_element(zero);
            for (z, s) in stage.multipliers.iter().zip(stage.slack.iter()) {
                if !(*z > zero && *s > zero && z.is_finite()) {
                    return None;
                }
                sum += *z * *s;
            }
        }
        Some(Barrier { weight: sum / S::Scalar::from_f64((plan.len() * C) as f64) })
    }

    /// Multipliers μ/s for the slacks.
    pub fn begin(&self, plan: &mut [Stage<S, D, U, C>], barrier: Barrier<S::Scalar>) {
        for stage in plan {
            for i in 0..C {
                stage.multipliers[i] = barrier.weight / stage.slack[i];
            }
        }
    }
}
