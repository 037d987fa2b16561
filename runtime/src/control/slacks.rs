//! The slacks and multipliers of the bounds of one step.
//!
//! A bound a ≤ 0 has a slack s > 0 with a + s = excess. A soft bound may be violated at a price, and its slacks are closed forms of a.

use crate::space::larger;
use crate::{Error, Real};
use nalgebra::{SMatrix, SVector};

/// The part of a slack that one step may take.
pub(super) const TO_BOUNDARY: f64 = 0.995;

/// Whether a bound with this slack is none.
pub(super) fn is_none<T: Real>(slack: T) -> bool {
    slack > T::zero() && !slack.is_finite()
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
    pub fn price_of_motion(&self, moved: &SVector<T, C>) -> T {
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
    pub fn take_values(
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
    pub fn values(&self) -> SVector<T, C> {
        self.excess - self.slack
    }

    /// Relaxes bounds that have a least slack to it.
    pub fn relax(&mut self, least: impl Fn(usize) -> Option<T>) {
        for i in 0..C {
            if let Some(least) = least(i).filter(|_| !is_none(self.slack[i]) && !self.price[i].is_finite()) {
                let value = self.excess[i] - self.slack[i];
                self.slack[i] = larger(-value, least);
                self.excess[i] = self.slack[i] + value;
            }
        }
    }

    /// Multipliers μ/s for the slacks.
    pub fn begin(&mut self, barrier: T) {
        self.multipliers = SVector::from_fn(|i, _| match self.soft(i) {
            Some(soft) => soft.force(barrier),
            None => barrier / self.slack[i],
        });
    }

    /// Whether multipliers are inside their bounds, so that a search may go on with them.
    pub fn is_warm(&self) -> bool {
        let is_within = |i: usize| {
            let (z, s) = (self.multipliers[i], self.slack[i]);
            is_none(s) || z > T::zero() && z < self.price[i] && (s > T::zero() || self.price[i].is_finite())
        };
        (0..C).all(is_within)
    }

    /// Σ z s, for soft bounds Σ z max(−a, 0) + (w − z) max(a, 0).
    pub fn complementarity(&self) -> T {
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
    pub fn accept(&mut self, fraction: T, barrier: T) {
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
    pub fn settle(&mut self, moved: &SVector<T, C>, barrier: T) {
        let Condensed { force, stiffness } = self.condensed(barrier);
        self.multipliers = SVector::from_fn(|i, _| {
            let next = larger(T::zero(), force[i] + stiffness[i] * moved[i]);
            if next < self.price[i] { next } else { self.price[i] }
        });
    }

    pub fn is_relaxed(&self) -> bool {
        self.excess.iter().any(|excess| *excess > T::zero())
    }
}
