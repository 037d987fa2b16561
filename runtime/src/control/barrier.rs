//! Bounds by a primal-dual interior point method: a + s = excess with slacks s > 0 that cost −μ ln s each.
//!
//! If a guess violates bounds, they are relaxed by the excess. A step of fraction α shrinks the excess exactly by 1 −
//! α. So slacks are s = excess − a, for bounds of any form. Steps keep a two-hundredth of each slack.
//!
//! A bound a = −∞ is none, as from an infinite parameter. Its slack is infinite, it has no multiplier and does not
//! count.
//!
//! Sources: Wächter and Biegler, *On the implementation of an interior-point filter line-search algorithm* (2006), for
//! multipliers and the sequence of μ. Pavlov, Shames and Manzie, *Interior point differential dynamic programming*
//! (2021), for slacks in roll-outs.

use super::Stage;
use super::quadratic::Slopes;
use super::sweep::{Plan, Settings};
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

/// If the guess violates or reaches a bound, this part of its size relaxes it.
const PART: (i64, i64) = (1, 100);
/// The same for a bound that is 0 in all stages, as a part of its first change. Corrections without bounds go further
/// than those within.
const PART_OF_CHANGE: (i64, i64) = (1, 10);

/// Whether a bound with this slack is none.
pub(super) fn is_none<T: Real>(slack: T) -> bool {
    slack > T::zero() && !slack.is_finite()
}

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

/// The bounds a ≤ 0 of a step, with slacks and multipliers.
#[derive(Clone, Copy)]
pub(super) struct Barriers<T, const C: usize> {
    /// z
    pub multipliers: SVector<T, C>,
    /// s > 0 with a + s = excess.
    pub slack: SVector<T, C>,
    /// By how much the bounds are still relaxed, 0 once a full step was made.
    pub excess: SVector<T, C>,
    /// The slacks that a correction proposes.
    pub next_slack: SVector<T, C>,
    /// w: the price of a unit of a, infinite where a bound has to hold. A soft bound has the slack −a, of any sign.
    pub price: SVector<T, C>,
}

/// The slacks of all bounds after a correction, against those before.
pub(super) struct Proposed<T> {
    /// The fraction of the correction that slacks allow, where it is smaller than the one that was made.
    pub allowed: Option<T>,
    /// Σ ln(s⁺/s)
    pub logarithms: T,
    /// z·(a + s) before, with the multipliers of the full correction.
    pub excess_price: T,
    /// The largest part to which bounds stay relaxed.
    pub relaxed: T,
    /// By how much soft bounds become dearer, with barriers.
    pub dearer: T,
    /// The price of soft bounds, with barriers.
    pub soft: T,
}

/// A bound a ≤ 0 that may be violated at the price w of each unit. With the barrier it costs
/// ```text
/// ρ(a) = min over t of w t − μ ln t − μ ln(t − a),    ρ′(a) = μ/(t − a) = w − μ/t
/// ```
/// which is w max(a, 0) where μ vanishes. So it needs no slack that a step could reach.
#[derive(Clone, Copy)]
struct Soft<T> {
    price: T,
    value: T,
}

impl<T: Real> Soft<T> {
    /// t and t − a: the roots of w t (t − a) = μ (2t − a).
    fn slacks(self, barrier: T) -> [T; 2] {
        let two = T::from_f64(2.0);
        let (forced, smoothing) = (self.price * self.value, two * barrier);
        let root = (forced * forced + smoothing * smoothing).sqrt();
        // the smaller one without cancellation, from t (t − a) = μ (2t − a)/w
        let larger_one = (forced.abs() + smoothing + root) / (two * self.price);
        let smaller_one = barrier * (smoothing + root) / (self.price * self.price * larger_one);
        if self.value > T::zero() { [larger_one, smaller_one] } else { [smaller_one, larger_one] }
    }

    /// ρ(a), with w max(a, 0) for no barrier.
    fn smoothed(self, barrier: T) -> T {
        if barrier == T::zero() {
            return self.price * larger(self.value, T::zero());
        }
        let [t, s] = self.slacks(barrier);
        self.price * t - barrier * (t.ln() + s.ln())
    }

    /// ρ′(a). Before there is a barrier nothing is known of it.
    fn force(self, barrier: T) -> T {
        if barrier == T::zero() { T::zero() } else { barrier / self.slacks(barrier)[1] }
    }

    /// 1/(t/(w − z) + (t − a)/z), which is ρ″ where z is ρ′. Before there is a barrier it makes unit values as dear as they are.
    fn stiffness(self, barrier: T, z: T) -> T {
        if barrier == T::zero() {
            return self.price;
        }
        let [t, s] = self.slacks(barrier);
        (t / (self.price - z) + s / z).recip()
    }

    /// A multiplier between a part of the one before and the one that is left to w, near ρ′.
    fn within(self, barrier: T, before: T, next: T) -> T {
        let wide = T::EPSILON.sqrt().recip();
        let part = T::from_f64(1.0 - TO_BOUNDARY);
        let [t, s] = self.slacks(barrier);
        let least = larger(part * before, barrier / s / wide);
        let from_top = larger(part * (self.price - before), barrier / t / wide);
        let most = self.price - from_top;
        let next = if next < least { least } else { next };
        let next = if next > most { most } else { next };
        // for a price so small that both ends meet
        if next > T::zero() && next < self.price { next } else { self.price * T::from_ratio(1, 2) }
    }
}

impl<T: Real> Proposed<T> {
    /// Of no bounds.
    pub fn none() -> Self {
        let zero = T::zero();
        Self { allowed: None, logarithms: zero, excess_price: zero, relaxed: zero, dearer: zero, soft: zero }
    }
}

/// The force of bounds on a step and their stiffness.
pub(super) struct Condensed<T, const C: usize> {
    /// ζ = μ/s + Σ(a + s)
    pub force: SVector<T, C>,
    /// Σ = z/s
    pub stiffness: SVector<T, C>,
}

impl<T: Real, const C: usize> Barriers<T, C> {
    pub fn none() -> Self {
        let zero = SVector::from_element(T::zero());
        let price = SVector::from_element(T::from_f64(f64::INFINITY));
        Self { multipliers: zero, slack: zero, excess: zero, next_slack: zero, price }
    }

    #[inline]
    pub fn condensed(&self, barrier: T) -> Condensed<T, C> {
        let stiffness = SVector::<T, C>::from_fn(|i, _| match self.soft(i) {
            Some(soft) => soft.stiffness(barrier, self.multipliers[i]),
            None => self.multipliers[i] / self.slack[i],
        });
        let force = SVector::from_fn(|i, _| match self.soft(i) {
            Some(soft) => soft.force(barrier),
            None => barrier / self.slack[i] + stiffness[i] * self.excess[i],
        });
        Condensed { force, stiffness }
    }

    /// A bound that may be violated.
    #[inline]
    fn soft(&self, i: usize) -> Option<Soft<T>> {
        let price = self.price[i];
        (price > T::zero() && price.is_finite()).then(|| Soft { price, value: -self.slack[i] })
    }

    /// Σ w max(a, 0)
    pub fn price_of_violations(&self) -> T {
        let soft = (0..C).filter_map(|i| self.soft(i));
        soft.fold(T::zero(), |sum, soft| sum + soft.price * larger(soft.value, T::zero()))
    }

    /// By how much a soft bound is violated, 0 for others.
    pub fn excess_of_soft(&self, i: usize) -> T {
        self.soft(i).map_or(T::zero(), |soft| larger(soft.value, T::zero()))
    }

    /// Σ w |a| of bounds that are moved so far, the price that they may come to.
    fn price_of_motion(&self, moved: &SVector<T, C>) -> T {
        let of = |i: usize| self.soft(i).map(|soft| soft.price * (soft.value + moved[i]).abs());
        (0..C).filter_map(of).fold(T::zero(), |sum, price| sum + price)
    }

    /// Σ z |∂a/∂u|: how hard bounds push each input, without signs.
    #[cold]
    pub fn pushes<const U: usize>(&self, by_input: &SMatrix<T, C, U>) -> SVector<T, U> {
        let present = |i: &usize| !is_none(self.slack[*i]);
        let push = |j: usize| (0..C).filter(present).map(move |i| self.multipliers[i] * by_input[(i, j)].abs());
        SVector::from_fn(|j, _| push(j).fold(T::zero(), |sum, push| sum + push))
    }

    /// The slopes of bounds that are present. Those of others may be infinite.
    #[inline]
    pub fn clear_absent<const K: usize>(&self, slopes: &mut SMatrix<T, C, K>) {
        (0..C).filter(|i| is_none(self.slack[*i])).for_each(|i| slopes.row_mut(i).fill(T::zero()));
    }

    /// Σ a/s of violated bounds, and 1/s for each of them.
    #[inline]
    pub fn violated(&self) -> (T, SVector<T, C>) {
        let violation = self.excess - self.slack;
        let is_violated = |i: usize| violation[i] > T::zero() && !self.price[i].is_finite();
        let sum = (0..C).filter(|i| is_violated(*i)).fold(T::zero(), |sum, i| sum + violation[i] / self.slack[i]);
        (sum, SVector::from_fn(|i, _| if is_violated(i) { self.slack[i].recip() } else { T::zero() }))
    }

    /// Takes these values of the bounds with their prices, without excess, and returns how many bounds are present.
    fn take_values(
        &mut self,
        values: SVector<T, C>,
        price: SVector<T, C>,
        name: impl Fn(usize) -> &'static str,
    ) -> Result<usize, Error> {
        (self.slack, self.price) = (-values, price);
        self.excess = SVector::from_element(T::zero());
        let mut present = 0;
        for i in 0..C {
            // Written so that NaN is refused.
            match price[i] {
                none if none == T::zero() => self.slack[i] = T::from_f64(f64::INFINITY),
                positive if positive > T::zero() => {}
                negative => return Err(Error::NegativePrice { term: name(i), price: negative.to_f64() }),
            }
            match self.slack[i] {
                slack if slack.is_finite() => present += 1,
                slack if is_none(slack) => self.multipliers[i] = T::zero(),
                _ => return Err(Error::NotFinite { name: name(i) }),
            }
        }
        Ok(present)
    }

    /// The values that excess and slack stand for.
    fn values(&self) -> SVector<T, C> {
        self.excess - self.slack
    }

    /// Relaxes bounds that have a least slack to it.
    fn relax(&mut self, least: impl Fn(usize) -> Option<T>) {
        for i in 0..C {
            if let Some(least) = least(i).filter(|_| !is_none(self.slack[i]) && !self.price[i].is_finite()) {
                let value = self.excess[i] - self.slack[i];
                self.slack[i] = larger(-value, least);
                self.excess[i] = self.slack[i] + value;
            }
        }
    }

    /// Multipliers μ/s for the slacks.
    fn begin(&mut self, barrier: T) {
        self.multipliers = SVector::from_fn(|i, _| match self.soft(i) {
            Some(soft) => soft.force(barrier),
            None => barrier / self.slack[i],
        });
    }

    /// Whether multipliers are inside their bounds, so that a search may go on with them.
    fn is_warm(&self) -> bool {
        let is_within = |i: usize| {
            let (z, s) = (self.multipliers[i], self.slack[i]);
            is_none(s) || z > T::zero() && z < self.price[i] && (s > T::zero() || self.price[i].is_finite())
        };
        (0..C).all(is_within)
    }

    /// Σ z s, for soft bounds Σ z max(−a, 0) + (w − z) max(a, 0).
    fn complementarity(&self) -> T {
        let of = |i: usize| {
            let (z, s) = (self.multipliers[i], self.slack[i]);
            match self.soft(i) {
                _ if is_none(s) => T::zero(),
                Some(soft) if s < T::zero() => (soft.price - z) * -s,
                _ => z * s,
            }
        };
        (0..C).map(of).fold(T::zero(), |sum, part| sum + part)
    }

    /// Stores the slacks after a fraction of a correction that leads to these values of the bounds, and adds them to `proposed`.
    #[inline]
    pub fn propose(
        &mut self,
        values: &SVector<T, C>,
        (fraction, barrier): (T, T),
        name: impl Fn(usize) -> &'static str,
        proposed: &mut Proposed<T>,
    ) -> Result<(), Error> {
        let (zero, one) = (T::zero(), T::one());
        let least = one - T::from_f64(TO_BOUNDARY);
        for i in 0..C {
            let (z, s) = (self.multipliers[i], self.slack[i]);
            if is_none(s) {
                self.next_slack[i] = s;
                // Written so that NaN is refused.
                if values[i] <= zero || self.price[i] == zero {
                    continue;
                }
                return Err(Error::NotFinite { name: name(i) });
            }
            if let Some(soft) = self.soft(i) {
                let value = values[i];
                if !value.is_finite() {
                    return Err(Error::NotFinite { name: name(i) });
                }
                self.next_slack[i] = -value;
                let next = Soft { value, ..soft }.smoothed(barrier);
                proposed.dearer += next - soft.smoothed(barrier);
                proposed.soft += next;
                continue;
            }
            let excess = (one - fraction) * self.excess[i];
            let next = excess - values[i];
            self.next_slack[i] = next;
            if excess > zero {
                proposed.relaxed = larger(proposed.relaxed, excess / s);
            }
            let ratio = next / s;
            if ratio < least {
                let limit = fraction * T::from_f64(TO_BOUNDARY) / (one - ratio);
                if limit < proposed.allowed.unwrap_or(fraction) {
                    proposed.allowed = Some(limit);
                }
            } else {
                proposed.logarithms += ratio.ln();
                let full = (barrier - z * (next - s) / fraction) / s;
                proposed.excess_price += full * self.excess[i];
            }
        }
        Ok(())
    }

    /// Σ ln s of the slacks that are proposed.
    pub fn logarithms(&self) -> T {
        let present = (0..C).filter(|i| !is_none(self.next_slack[*i]) && !self.price[*i].is_finite());
        present.fold(T::zero(), |sum, i| sum + self.next_slack[i].ln())
    }

    /// Takes the slacks that a fraction of a correction proposes. Multipliers stay positive, near μ/s.
    #[inline]
    fn accept(&mut self, fraction: T, barrier: T) {
        let wide = T::EPSILON.sqrt().recip();
        for i in 0..C {
            if is_none(self.slack[i]) {
                continue;
            }
            let (z, slack, moved) = (self.multipliers[i], self.slack[i], self.next_slack[i]);
            if let Some(soft) = self.soft(i) {
                let next = z + fraction * (soft.force(barrier) - z) + soft.stiffness(barrier, z) * (slack - moved);
                self.slack[i] = moved;
                self.multipliers[i] = Soft { value: -moved, ..soft }.within(barrier, z, next);
                continue;
            }
            let next = z + fraction * (barrier / slack - z) - z / slack * (moved - slack);
            let central = barrier / moved;
            let least = larger(T::from_f64(1.0 - TO_BOUNDARY) * z, central / wide);
            let most = central * wide;
            let smaller = if next > most { most } else { next };
            self.multipliers[i] = if next < least { least } else { smaller };
            self.excess[i] *= T::one() - fraction;
            self.slack[i] = moved;
        }
    }

    /// Multipliers from a correction that moves bounds so far, to first order. The slacks of active bounds have few digits, so μ/s has few too.
    fn settle(&mut self, moved: &SVector<T, C>, barrier: T) {
        let Condensed { force, stiffness } = self.condensed(barrier);
        self.multipliers = SVector::from_fn(|i, _| {
            let next = larger(T::zero(), force[i] + stiffness[i] * moved[i]);
            if next < self.price[i] { next } else { self.price[i] }
        });
    }

    fn is_relaxed(&self) -> bool {
        self.excess.iter().any(|excess| *excess > T::zero())
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Stage<S, D, U, C> {
    /// Adds ζ·a + ½ Σ (aδ)² with the curvature of z·a to the model of the step; in the last sweep z·a. Returns Σ a/s of violated bounds, and its slopes.
    #[inline]
    pub(super) fn add_bounds(
        &self,
        step: &mut Expansion<S::Place, T, D, U>,
        bounds: &mut BoundsExpansion<T, D, U, C>,
        settings: &Settings<T, D>,
    ) -> (T, Slopes<T, D, U>) {
        let limits = &self.limits;
        limits.clear_absent(&mut bounds.by_place);
        limits.clear_absent(&mut bounds.by_input);
        let Condensed { force, stiffness } = limits.condensed(settings.barrier);
        let force = if settings.is_last { limits.multipliers } else { force };
        let by_place = SMatrix::<T, C, D>::from_fn(|i, j| stiffness[i] * bounds.by_place[(i, j)]);
        let by_input = SMatrix::<T, C, U>::from_fn(|i, j| stiffness[i] * bounds.by_input[(i, j)]);
        step.price_by_place += bounds.by_place.tr_mul(&force);
        step.price_by_input += bounds.by_input.tr_mul(&force);
        step.place_curvature += bounds.place_curvature + bounds.by_place.tr_mul(&by_place);
        step.mixed_curvature += bounds.mixed_curvature + bounds.by_input.tr_mul(&by_place);
        step.input_curvature += bounds.input_curvature + bounds.by_input.tr_mul(&by_input);
        let (sum, weights) = limits.violated();
        (sum, (bounds.by_place.tr_mul(&weights), bounds.by_input.tr_mul(&weights)))
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Plan<'_, S, D, U, C> {
    /// The barrier of a plan that has multipliers and satisfies its bounds: the mean of z·s. Otherwise `None`, and bounds
    /// are relaxed.
    ///
    /// The least slack is a hundredth of the size of the bound, the largest |a|. A bound that is 0 in all stages has no
    /// size yet. [`size`](Self::size) finds it.
    pub fn resume_or_relax(&mut self) -> Result<Option<T>, Error> {
        let zero = T::zero();
        let mut bounds: usize = 0;
        for (index, stage) in self.stages.iter_mut().enumerate() {
            let t = self.problem.time_after(index);
            let values = self.problem.bounds(stage, t, &stage.place, &stage.input)?;
            let prices = self.problem.bound_prices(stage, t);
            bounds += stage.limits.take_values(values, prices, |i| S::BOUNDS[i])?;
        }
        self.bounds = T::from_f64(bounds as f64);
        if bounds == 0 {
            return Ok(Some(zero));
        }
        let sum = self.stages.iter().fold(zero, |sum, stage| sum + stage.limits.complementarity());
        // none is left where all kinks are reached
        if sum > zero && self.stages.iter().all(|stage| stage.limits.is_warm()) {
            return Ok(Some(sum / self.bounds));
        }
        let sizes = self.sizes();
        self.relax(|i| Some(if sizes[i] > zero { sizes[i] * T::from_ratio(PART.0, PART.1) } else { T::one() }));
        self.begin(zero);
        Ok(None)
    }

    /// The largest |a| of each bound, in all stages.
    fn sizes(&self) -> SVector<T, C> {
        let size = |size: T, value: T| if value.is_finite() { larger(size, value.abs()) } else { size };
        let of_stage = |sizes: SVector<T, C>, stage: &Stage<S, D, U, C>| sizes.zip_map(&stage.limits.values(), size);
        self.stages.iter().fold(SVector::from_element(T::zero()), of_stage)
    }

    /// Relaxes bounds that have a least slack to it, each in all stages.
    fn relax(&mut self, least: impl Fn(usize) -> Option<T>) {
        self.stages.iter_mut().for_each(|stage| stage.limits.relax(&least));
    }

    /// Relaxes the bounds that are 0 in all stages, each by its own size. That is its first change, by a correction
    /// without bounds. If nothing changes it, its size is the smallest of the others. Too small a slack shortens steps,
    /// and too large a slack switches the bound off.
    #[cold]
    pub fn size(&mut self, change: &SVector<T, D>) -> Result<(), Error> {
        let zero = T::zero();
        let sizes = self.sizes();
        if sizes.iter().all(|size| *size > zero) {
            return Ok(());
        }
        let mut moved = SVector::<T, C>::from_element(zero);
        self.follow_correction(change, |stage, by| {
            moved = SVector::from_fn(|i, _| match by[i].abs() {
                by if by.is_finite() && !is_none(stage.limits.slack[i]) => larger(moved[i], by),
                _ => moved[i],
            });
        })?;
        self.size_by(&sizes, &moved);
        Ok(())
    }

    /// Relaxes the bounds that are 0 in all stages, and that nothing changes, by the smallest size of the others.
    #[cold]
    pub fn size_by_others(&mut self) {
        self.size_by(&self.sizes(), &SVector::zeros());
    }

    fn size_by(&mut self, sizes: &SVector<T, C>, moved: &SVector<T, C>) {
        let zero = T::zero();
        let known = sizes.iter().chain(moved.iter()).copied().filter(|size| *size > zero);
        let least = known.reduce(|least, size| if size < least { size } else { least });
        let part = |size: T, (numerator, denominator)| size * T::from_ratio(numerator, denominator);
        self.relax(|i| match (sizes[i] > zero, moved[i] > zero) {
            (true, _) => None,
            (_, true) => Some(part(moved[i], PART_OF_CHANGE)),
            _ => least.map(|least| part(least, PART)),
        });
    }

    /// Multipliers μ/s for the slacks.
    pub fn begin(&mut self, barrier: T) {
        self.stages.iter_mut().for_each(|stage| stage.limits.begin(barrier));
    }

    /// Takes the plan that a roll-out with this fraction of the correction proposes, which leads to `last`. Multipliers stay positive, near μ/s.
    pub fn accept(&mut self, fraction: T, barrier: T, last: S::Place) {
        for stage in self.stages.iter_mut() {
            stage.limits.accept(fraction, barrier);
            (stage.place, stage.input) = (stage.next_place, stage.next_input);
        }
        self.last = last;
    }

    /// Multipliers of the bounds from the next correction.
    pub fn settle(&mut self, change: &SVector<T, D>, barrier: T) -> Result<(), Error> {
        self.follow_correction(change, |stage, moved| stage.limits.settle(&moved, barrier))
    }

    /// Visits each stage with how far a full correction moves its bounds, to first order.
    fn follow_correction(
        &mut self,
        change: &SVector<T, D>,
        mut visit: impl FnMut(&mut Stage<S, D, U, C>, SVector<T, C>),
    ) -> Result<(), Error> {
        let problem = &self.problem;
        let mut displacement = SVector::<T, D>::from_element(T::zero());
        for (index, stage) in self.stages.iter_mut().enumerate().filter(|_| C > 0) {
            let t = self.problem.time_after(index);
            let step = problem.expand(stage, t, &stage.next_costate)?;
            let bounds = problem.bounds_expanded(stage, t, &stage.limits.multipliers)?;
            let input = stage.shift + stage.by_multiplier * change + stage.gain * displacement;
            let moved = bounds.by_place * displacement + bounds.by_input * input;
            visit(stage, moved);
            displacement = step.by_place * displacement + step.by_input * input;
        }
        Ok(())
    }

    /// The price that soft bounds come to by a correction without barriers.
    #[cold]
    pub fn price_of_kinks(&mut self, change: &SVector<T, D>) -> Result<T, Error> {
        let mut sum = T::zero();
        self.follow_correction(change, |stage, moved| sum += stage.limits.price_of_motion(&moved))?;
        Ok(sum)
    }

    /// Whether any bound is soft.
    pub fn has_kinks(&self) -> bool {
        self.stages.iter().any(|stage| stage.limits.price.iter().any(|price| price.is_finite()))
    }

    /// Σ w max(a, 0) of all stages.
    pub fn price_of_violations(&self) -> T {
        self.stages.iter().fold(T::zero(), |sum, stage| sum + stage.limits.price_of_violations())
    }

    /// Whether bounds are relaxed.
    pub fn is_relaxed(&self) -> bool {
        self.stages.iter().any(|stage| stage.limits.is_relaxed())
    }

    /// Whether a relaxed bound is violated by more than round-off of its own terms. These are |∂a/∂x| |x| and
    /// |∂a/∂u| |u| of the present plan.
    pub fn is_violated(&self) -> bool {
        let zero = T::zero();
        let round_off = T::from_f64(16.0) * T::EPSILON;
        self.stages.iter().enumerate().any(|(index, stage)| {
            if !stage.limits.is_relaxed() {
                return false;
            }
            let (t, x, u) = (self.problem.time_after(index), &stage.place, &stage.input);
            // bounds of a step that cannot be made are not satisfied
            let Ok(bounds) = self.problem.bounds_expanded(stage, t, &stage.limits.multipliers) else { return true };
            let place = x.max_abs();
            // Written so that NaN is a violation.
            !(0..C).all(|i| {
                let by_place = (0..D).fold(zero, |sum, j| sum + bounds.by_place[(i, j)].abs() * place);
                let terms = (0..U).fold(by_place, |sum, j| sum + (bounds.by_input[(i, j)] * u[j]).abs());
                stage.limits.price[i].is_finite() || bounds.values[i] <= larger(zero, round_off * terms)
            })
        })
    }

    /// The largest a of all bounds, 0 where none is violated by more than round-off.
    pub fn violation(&self) -> T {
        if !self.is_violated() {
            return T::zero();
        }
        self.stages.iter().enumerate().fold(T::zero(), |largest, (index, stage)| {
            let t = self.problem.time_after(index);
            let values = self.problem.bounds(stage, t, &stage.place, &stage.input);
            let hard = |values: SVector<T, C>| {
                let hard = (0..C).filter(|i| !stage.limits.price[*i].is_finite());
                hard.fold(largest, |largest, i| larger(largest, values[i]))
            };
            values.map_or(largest, hard)
        })
    }

    /// The bound that keeps all from being relaxed less: its stage, its name and by how much it is violated.
    pub fn worst_bound(&self) -> Option<(usize, &'static str, T)> {
        let (mut most, mut worst) = (T::zero(), None);
        for (index, stage) in self.stages.iter().enumerate() {
            let t = self.problem.time_after(index);
            let Ok(values) = self.problem.bounds(stage, t, &stage.place, &stage.input) else { continue };
            for i in 0..C {
                let part = values[i] / stage.limits.excess[i];
                if part > most && stage.limits.excess[i] > T::zero() {
                    (most, worst) = (part, Some((index, S::BOUNDS[i], values[i])));
                }
            }
        }
        worst
    }
}
