//! Bounds by a primal-dual interior point method: a + s = excess with slacks s > 0 that cost −μ ln s each.
//!
//! If a guess violates bounds, they are relaxed by the excess. A step of fraction α shrinks the excess exactly by 1 −
//! α. So slacks are s = excess − a, for bounds of any form. Steps keep a two-hundredth of each slack.
//!
//! Sources: Wächter and Biegler, *On the implementation of an interior-point filter line-search algorithm* (2006), for
//! multipliers and the sequence of μ. Pavlov, Shames and Manzie, *Interior point differential dynamic programming*
//! (2021), for slacks in roll-outs.

use super::Stage;
use super::quadratic::Slopes;
use super::sweep::{Plan, Problem, Settings};
use crate::space::larger;
use crate::{BoundsExpansion, Controlled, Error, Expansion, Real, Space};
use nalgebra::{SMatrix, SVector};

/// The part of a slack that one step may take.
pub(super) const TO_BOUNDARY: f64 = 0.995;
/// The first μ, for all bounds together, relative to the price. The price is that of the plan, or the price of
/// satisfying the bounds that it violates if that is larger. A guess that costs nothing would have no barrier by its
/// own price, and nothing would push it back.
pub(super) const FIRST: f64 = 0.1;
/// The last μ: this power of ε.
const LAST: (i64, i64) = (3, 4);

/// The last μ, for so many bounds and a price of this size.
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

    /// Adds ζ·a + ½ Σ (aδ)² with the curvature of z·a to the model of the step; in the last sweep z·a. Returns Σ a/s of violated bounds, and its slopes.
    #[inline]
    pub(super) fn add_bounds(
        &self,
        step: &mut Expansion<S::Place, T, D, U>,
        bounds: &BoundsExpansion<T, D, U, C>,
        settings: &Settings<T, D>,
    ) -> (T, Slopes<T, D, U>) {
        let (force, stiffness) = self.condensed(settings.barrier);
        let force = if settings.is_last { self.multipliers } else { force };
        let by_place = SMatrix::<T, C, D>::from_fn(|i, j| stiffness[i] * bounds.by_place[(i, j)]);
        let by_input = SMatrix::<T, C, U>::from_fn(|i, j| stiffness[i] * bounds.by_input[(i, j)]);
        step.price_by_place += bounds.by_place.tr_mul(&force);
        step.price_by_input += bounds.by_input.tr_mul(&force);
        step.place_curvature += bounds.place_curvature + bounds.by_place.tr_mul(&by_place);
        step.mixed_curvature += bounds.mixed_curvature + bounds.by_input.tr_mul(&by_place);
        step.input_curvature += bounds.input_curvature + bounds.by_input.tr_mul(&by_input);
        let violation = self.excess - self.slack;
        let is_violated = |i: usize| violation[i] > T::zero();
        let sum = (0..C).filter(|i| is_violated(*i)).fold(T::zero(), |sum, i| sum + violation[i] / self.slack[i]);
        let weights = SVector::<T, C>::from_fn(|i, _| if is_violated(i) { self.slack[i].recip() } else { T::zero() });
        (sum, (bounds.by_place.tr_mul(&weights), bounds.by_input.tr_mul(&weights)))
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Plan<'_, S, D, U, C> {
    /// The number of bounds of all stages.
    pub fn bounds(&self) -> T {
        T::from_f64((self.stages.len() * C) as f64)
    }

    /// The barrier of a plan with multipliers of its bounds, which it keeps: the mean of z·s. Otherwise `None`, and bounds are relaxed.
    pub fn resume_or_relax(&mut self) -> Option<T> {
        let zero = T::zero();
        if C == 0 {
            return Some(zero);
        }
        for (index, stage) in self.stages.iter_mut().enumerate() {
            stage.slack = -self.problem.system.bounds(self.problem.time_after(index), &stage.place, &stage.input);
            stage.excess = SVector::from_element(zero);
        }
        let pairs = self.stages.iter().flat_map(|stage| stage.multipliers.iter().zip(stage.slack.iter()));
        if pairs.clone().all(|(z, s)| *z > zero && *s > zero && z.is_finite()) {
            return Some(pairs.fold(zero, |sum, (z, s)| sum + *z * *s) / self.bounds());
        }
        let size = |sizes: SVector<T, C>, stage: &Stage<S, D, U, C>| {
            sizes.zip_map(&stage.slack, |size, slack| larger(size, slack.abs()))
        };
        let sizes = self.stages.iter().fold(SVector::from_element(zero), size);
        let largest = sizes.max_abs();
        let least = sizes.map(|size| {
            let size = if size > zero { size } else { largest };
            if size > zero { size * T::from_ratio(1, 100) } else { T::one() }
        });
        for stage in self.stages.iter_mut() {
            let slack = stage.slack.zip_map(&least, larger);
            stage.excess = slack - stage.slack;
            stage.slack = slack;
        }
        self.begin(zero);
        None
    }

    /// Multipliers μ/s for the slacks.
    pub fn begin(&mut self, barrier: T) {
        self.stages.iter_mut().for_each(|stage| stage.multipliers = stage.slack.map(|slack| barrier / slack));
    }

    /// Takes the plan that a roll-out with this fraction of the correction proposes, which leads to `last`. Multipliers stay positive, near μ/s.
    pub fn accept(&mut self, fraction: T, barrier: T, last: S::Place) {
        let wide = T::EPSILON.sqrt().recip();
        for stage in self.stages.iter_mut() {
            for i in 0..C {
                let (z, slack, moved) = (stage.multipliers[i], stage.slack[i], stage.next_slack[i]);
                let next = z + fraction * (barrier / slack - z) - z / slack * (moved - slack);
                let central = barrier / moved;
                let least = larger(T::from_f64(1.0 - TO_BOUNDARY) * z, central / wide);
                let most = central * wide;
                let smaller = if next > most { most } else { next };
                stage.multipliers[i] = if next < least { least } else { smaller };
                stage.excess[i] *= T::one() - fraction;
                stage.slack[i] = moved;
            }
            (stage.place, stage.input) = (stage.next_place, stage.next_input);
        }
        self.last = last;
    }

    /// Multipliers of the bounds from the next correction. The slacks of active bounds have few digits, so μ/s has few
    /// too.
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

    /// Whether a bound is violated by more than round-off of its slack and of the first excess. This part of the excess
    /// still relaxes all bounds.
    pub fn is_violated(&self, relaxation: T) -> bool {
        let round_off = T::from_f64(16.0) * T::EPSILON;
        let mut bounds = self.stages.iter().flat_map(|stage| stage.slack.iter().zip(stage.excess.iter()));
        relaxation > round_off && bounds.any(|(slack, excess)| *excess - *slack > round_off * *excess)
    }

    /// The bound that keeps all from being relaxed less, with the stage and by how much it is violated.
    pub fn worst_bound(&self) -> Option<(usize, usize, T)> {
        let (mut least, mut worst) = (T::one(), None);
        for (index, stage) in self.stages.iter().enumerate() {
            for i in 0..C {
                let (slack, excess) = (stage.slack[i], stage.excess[i]);
                if slack / excess < least {
                    (least, worst) = (slack / excess, Some((index, i, excess - slack)));
                }
            }
        }
        worst
    }
}
