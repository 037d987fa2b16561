//! The slacks and multipliers of the bounds of one step.
//!
//! A bound a ≤ 0 has a slack s > 0 with a + s = excess. A soft bound may be violated at a price, and its slacks are closed forms of a.
//!
//! An equation a = 0 has no slack, and its multiplier z has any sign. It adds z a + ½ ρ a² to the price, an augmented Lagrangian. A correction
//! that moves a by m to first order leads to z⁺ = z + ρ (a + m). This is Newton's method with the equation a + m = (z⁺ − z)/ρ. So no
//! equation needs to be independent of others, and no input needs to move it. As z settles, a vanishes for any ρ.
//!
//! Source: Hestenes, *Multiplier and gradient methods* (1969), for the augmented Lagrangian.

use crate::space::larger;
use crate::{Error, Real};
use nalgebra::{SMatrix, SVector};

/// The part of a slack that one step may take.
pub(super) const TO_BOUNDARY: f64 = 0.995;
/// The same for a bound that is reached, by its multiplier.
const TO_REACHED: f64 = 0.9999;

/// Whether a bound with this slack is none.
pub(super) fn is_none<T: Real>(slack: T) -> bool {
    slack > T::zero() && !slack.is_finite()
}

/// The kind of a bound, by its value a.
#[derive(Clone, Copy)]
pub(super) enum Kind<T> {
    /// a ≤ 0
    Inequality,
    /// a ≤ 0, or the price w of each unit of a.
    Soft(T),
    /// a = 0, where a has this size: 0 where it is not known yet.
    Equation(T),
}

/// How strictly a plan on its way obeys its bounds.
#[derive(Clone, Copy)]
pub struct Strictness<T> {
    /// The price μ of e-fold smaller slacks.
    pub barrier: T,
    /// ρ̂, and the price p of a step. An equation has the stiffness ρ = ρ̂ (p/c² + |z|/c), with values of the size c. So the effect of
    /// rounding of a on z is the same part of any z.
    pub rigidity: T,
    pub price: T,
}

impl<T: Real> Strictness<T> {
    /// Of a plan without bounds.
    pub fn none() -> Self {
        Self { barrier: T::zero(), rigidity: T::zero(), price: T::zero() }
    }
}

/// The bounds of a step, with slacks and multipliers.
#[derive(Clone, Copy)]
pub(super) struct Barriers<T, const C: usize> {
    /// z
    pub multipliers: SVector<T, C>,
    /// s > 0 with a + s = excess. Soft bounds and equations have the slack −a, of any sign.
    pub slack: SVector<T, C>,
    /// By how much the bounds are still relaxed, 0 once a full step was made.
    pub excess: SVector<T, C>,
    /// The slacks that a correction proposes.
    pub next_slack: SVector<T, C>,
    pub kinds: [Kind<T>; C],
}

/// The values, the prices and the names of bounds. The first ones are equations.
pub(super) struct Values<T, const C: usize> {
    pub values: SVector<T, C>,
    pub prices: SVector<T, C>,
    pub names: [&'static str; C],
    pub equations: usize,
}

/// The slacks of all bounds after a correction, against those before.
pub(super) struct Proposed<T> {
    /// The fraction of the correction that slacks allow, where it is smaller than the one that was made.
    pub allowed: Option<T>,
    /// Σ ln(s⁺/s)
    pub logarithms: T,
    /// z·(a + s) before, with the multipliers of the full correction.
    pub excess_price: T,
    /// By how much soft bounds become dearer, with barriers, and equations.
    pub dearer: T,
    /// The price of soft bounds, with barriers.
    pub soft: T,
    /// Σ |a| of equations, by their sizes.
    pub unequal: T,
}

/// An equation a = 0 in the augmented Lagrangian.
#[derive(Clone, Copy)]
struct Equation<T> {
    size: T,
    multiplier: T,
    value: T,
}

impl<T: Real> Equation<T> {
    /// ρ. Multipliers count in full from ρ̂ = ε^(−1/4) on: plans on their way bend more easily without them.
    fn stiffness(self, strictness: Strictness<T>) -> T {
        let Strictness { rigidity, price, .. } = strictness;
        if self.size > T::zero() {
            let part = rigidity * T::EPSILON.sqrt().sqrt();
            let by_multiplier = self.multiplier.abs() * if part < T::one() { part } else { T::one() };
            rigidity * (price / self.size + by_multiplier) / self.size
        } else {
            T::zero()
        }
    }

    /// z + ρ a
    fn force(self, strictness: Strictness<T>) -> T {
        self.multiplier + self.stiffness(strictness) * self.value
    }

    /// z a + ½ ρ a²
    fn price(self, strictness: Strictness<T>) -> T {
        (self.multiplier + self.stiffness(strictness) * self.value * T::from_ratio(1, 2)) * self.value
    }
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
        Self { allowed: None, logarithms: zero, excess_price: zero, dearer: zero, soft: zero, unequal: zero }
    }
}

/// The force of bounds on a step and their stiffness.
pub(super) struct Condensed<T, const C: usize> {
    /// ζ = μ/s + Σ(a + s), z + ρ a for equations.
    pub force: SVector<T, C>,
    /// Σ = z/s, ρ for equations.
    pub stiffness: SVector<T, C>,
}

impl<T: Real, const C: usize> Barriers<T, C> {
    pub fn none() -> Self {
        let zero = SVector::from_element(T::zero());
        Self { multipliers: zero, slack: zero, excess: zero, next_slack: zero, kinds: [Kind::Inequality; C] }
    }

    #[inline]
    pub fn condensed(&self, strictness: Strictness<T>) -> Condensed<T, C> {
        let barrier = strictness.barrier;
        let (mut force, mut stiffness) = (SVector::from_element(T::zero()), SVector::from_element(T::zero()));
        for i in 0..C {
            let (z, s) = (self.multipliers[i], self.slack[i]);
            (force[i], stiffness[i]) = match (self.soft(i), self.equation(i)) {
                (Some(soft), _) => (soft.force(barrier), soft.stiffness(barrier, z)),
                (_, Some(equation)) => (equation.force(strictness), equation.stiffness(strictness)),
                _ => (barrier / s + z / s * self.excess[i], z / s),
            };
        }
        Condensed { force, stiffness }
    }

    /// A bound that may be violated.
    #[inline]
    fn soft(&self, i: usize) -> Option<Soft<T>> {
        match self.kinds[i] {
            Kind::Soft(price) if !is_none(self.slack[i]) => Some(Soft { price, value: -self.slack[i] }),
            Kind::Inequality | Kind::Soft(_) | Kind::Equation(_) => None,
        }
    }

    #[inline]
    fn equation(&self, i: usize) -> Option<Equation<T>> {
        match self.kinds[i] {
            Kind::Equation(size) => Some(Equation { size, multiplier: self.multipliers[i], value: -self.slack[i] }),
            Kind::Inequality | Kind::Soft(_) => None,
        }
    }

    #[inline]
    fn is_inequality(&self, i: usize) -> bool {
        matches!(self.kinds[i], Kind::Inequality)
    }

    /// Whether it is no bound: an inequality with a = −∞, or a soft one without a price.
    #[inline]
    fn is_absent(&self, i: usize) -> bool {
        is_none(self.slack[i]) && !matches!(self.kinds[i], Kind::Equation(_))
    }

    /// Whether there are equations.
    pub fn has_equations(&self) -> bool {
        self.kinds.iter().any(|kind| matches!(kind, Kind::Equation(_)))
    }

    /// Whether any bound is soft.
    pub fn has_kinks(&self) -> bool {
        (0..C).any(|i| self.soft(i).is_some())
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

    /// Whether the price changes as the value of the bound does.
    pub fn pushes(&self, i: usize) -> bool {
        self.multipliers[i] != T::zero() || self.excess_of_soft(i) > T::zero()
    }

    /// Whether a bound limits the inputs: an equation, or an inequality whose multiplier is larger than the distance to it.
    pub fn is_active(&self, i: usize) -> bool {
        self.equation(i).is_some() || self.multipliers[i] > self.slack[i]
    }

    /// By how much this value violates a bound that has to hold: a of an inequality, |a| of an equation.
    pub fn violation(&self, i: usize, value: T) -> T {
        match self.kinds[i] {
            Kind::Inequality => value,
            Kind::Soft(_) => T::zero(),
            Kind::Equation(_) => value.abs(),
        }
    }

    /// The violation of a bound as a part of that by which it is relaxed. Of an equation it is a part of its size, where that is more than `least`.
    pub fn relative_violation(&self, i: usize, value: T, least: Option<T>) -> T {
        match self.kinds[i] {
            Kind::Inequality if self.excess[i] > T::zero() => value / self.excess[i],
            Kind::Equation(size) if least.is_some_and(|least| value.abs() > least * size) => value.abs() / size,
            Kind::Inequality | Kind::Soft(_) | Kind::Equation(_) => T::zero(),
        }
    }

    /// Σ w |a| of bounds that are moved so far, the price that they may come to.
    pub fn price_of_motion(&self, moved: &SVector<T, C>) -> T {
        let of = |i: usize| self.soft(i).map(|soft| soft.price * (soft.value + moved[i]).abs());
        (0..C).filter_map(of).fold(T::zero(), |sum, price| sum + price)
    }

    /// Σ |z ∂a/∂u|: how hard bounds push each input, without signs.
    #[cold]
    pub fn forces<const U: usize>(&self, by_input: &SMatrix<T, C, U>) -> SVector<T, U> {
        let present = |i: &usize| !self.is_absent(*i);
        let push = |j: usize| (0..C).filter(present).map(move |i| (self.multipliers[i] * by_input[(i, j)]).abs());
        SVector::from_fn(|j, _| push(j).fold(T::zero(), |sum, push| sum + push))
    }

    /// The slopes of bounds that are present. Those of others may be infinite.
    #[inline]
    pub fn clear_absent<const K: usize>(&self, slopes: &mut SMatrix<T, C, K>) {
        (0..C).filter(|i| self.is_absent(*i)).for_each(|i| slopes.row_mut(i).fill(T::zero()));
    }

    /// Σ a/s of violated bounds, and 1/s for each of them. With equations it has a²/c² and a/c², c the size of a.
    #[inline]
    pub fn violated(&self) -> (T, SVector<T, C>) {
        let (mut sum, mut weights) = (T::zero(), SVector::from_element(T::zero()));
        for i in 0..C {
            let value = self.excess[i] - self.slack[i];
            let (part, weight) = match self.kinds[i] {
                Kind::Inequality if value > T::zero() => (value / self.slack[i], self.slack[i].recip()),
                Kind::Equation(size) if size > T::zero() => (value * value / (size * size), value / (size * size)),
                Kind::Inequality | Kind::Soft(_) | Kind::Equation(_) => continue,
            };
            sum += part;
            weights[i] = weight;
        }
        (sum, weights)
    }

    /// Takes these values of the bounds with their prices, without excess, and returns how many inequalities are present.
    pub fn take_values(&mut self, taken: Values<T, C>) -> Result<usize, Error> {
        let Values { values, prices, names, equations } = taken;
        self.slack = -values;
        self.excess = SVector::from_element(T::zero());
        let mut present = 0;
        for i in 0..C {
            // Written so that NaN is refused.
            self.kinds[i] = match prices[i] {
                _ if i < equations => Kind::Equation(self.equation(i).map_or(T::zero(), |equation| equation.size)),
                none if none == T::zero() => {
                    self.slack[i] = T::from_f64(f64::INFINITY);
                    Kind::Soft(none)
                }
                price if price > T::zero() && price.is_finite() => Kind::Soft(price),
                positive if positive > T::zero() => Kind::Inequality,
                negative => return Err(Error::NegativePrice { term: names[i], price: negative.to_f64() }),
            };
            match self.slack[i] {
                slack if slack.is_finite() => present += usize::from(i >= equations),
                _ if self.is_absent(i) => self.multipliers[i] = T::zero(),
                _ => return Err(Error::NotFinite { name: names[i] }),
            }
        }
        Ok(present)
    }

    /// The values that excess and slack stand for.
    pub fn values(&self) -> SVector<T, C> {
        self.excess - self.slack
    }

    /// Relaxes inequalities that have a least slack to it.
    pub fn relax(&mut self, least: impl Fn(usize) -> Option<T>) {
        for i in 0..C {
            if let Some(least) = least(i).filter(|_| !self.is_absent(i) && self.is_inequality(i)) {
                let value = self.excess[i] - self.slack[i];
                self.slack[i] = larger(-value, least);
                self.excess[i] = self.slack[i] + value;
            }
        }
    }

    /// The size of a motion that moves the value of a bound so far, in place of `most` at most. An equation that hardly moves, by cancellation or
    /// because the motion is along it, has a part of the latter.
    pub fn size_of_motion(&self, i: usize, moved: T, most: T) -> T {
        match self.kinds[i] {
            Kind::Equation(_) => larger(moved.abs(), most * T::from_ratio(1, 100)),
            Kind::Inequality | Kind::Soft(_) => moved.abs(),
        }
    }

    /// Makes an equation none.
    pub fn except(&mut self, i: usize) {
        if let Kind::Equation(_) = self.kinds[i] {
            (self.kinds[i], self.slack[i]) = (Kind::Soft(T::zero()), T::from_f64(f64::INFINITY));
            self.multipliers[i] = T::zero();
        }
    }

    /// Gives these sizes to equations.
    pub fn size_equations(&mut self, sizes: impl Fn(usize) -> T) {
        for (i, kind) in self.kinds.iter_mut().enumerate() {
            if let Kind::Equation(size) = kind {
                *size = sizes(i);
            }
        }
    }

    /// Multipliers μ/s for the slacks, none for equations.
    pub fn begin(&mut self, barrier: T) {
        self.multipliers = SVector::from_fn(|i, _| match (self.soft(i), self.equation(i)) {
            (Some(soft), _) => soft.force(barrier),
            (_, Some(_)) => T::zero(),
            _ => barrier / self.slack[i],
        });
    }

    /// Forgets the multipliers, and the sizes of equations.
    pub fn forget(&mut self) {
        self.multipliers = SVector::from_element(T::zero());
        self.size_equations(|_| T::zero());
    }

    /// Whether multipliers are inside their bounds, so that a search may go on with them.
    pub fn is_warm(&self) -> bool {
        (0..C).all(|i| {
            let (z, s) = (self.multipliers[i], self.slack[i]);
            match self.kinds[i] {
                Kind::Equation(size) => size > T::zero(),
                _ if is_none(s) => true,
                Kind::Soft(price) => z > T::zero() && z < price,
                Kind::Inequality => z > T::zero() && s > T::zero(),
            }
        })
    }

    /// Σ z s, for soft bounds Σ z max(−a, 0) + (w − z) max(a, 0).
    pub fn complementarity(&self) -> T {
        let of = |i: usize| {
            let (z, s) = (self.multipliers[i], self.slack[i]);
            match self.kinds[i] {
                Kind::Equation(_) => T::zero(),
                _ if is_none(s) => T::zero(),
                Kind::Soft(price) if s < T::zero() => (price - z) * -s,
                Kind::Inequality | Kind::Soft(_) => z * s,
            }
        };
        (0..C).map(of).fold(T::zero(), |sum, part| sum + part)
    }

    /// Stores the slacks after a fraction of a correction that leads to these values of the bounds, and adds them to `proposed`. Where the end
    /// is near its target, slacks may become as small as their multipliers promise.
    #[inline]
    pub fn propose(
        &mut self,
        values: &SVector<T, C>,
        (fraction, strictness, is_near): (T, Strictness<T>, bool),
        name: impl Fn(usize) -> &'static str,
        proposed: &mut Proposed<T>,
    ) -> Result<(), Error> {
        let (zero, one) = (T::zero(), T::one());
        let barrier = strictness.barrier;
        let least = one - T::from_f64(TO_BOUNDARY);
        for i in 0..C {
            let (z, s, value) = (self.multipliers[i], self.slack[i], values[i]);
            if self.is_absent(i) {
                self.next_slack[i] = s;
                // Written so that NaN is refused.
                if value <= zero || matches!(self.kinds[i], Kind::Soft(_)) {
                    continue;
                }
                return Err(Error::NotFinite { name: name(i) });
            }
            if !self.is_inequality(i) {
                if !value.is_finite() {
                    return Err(Error::NotFinite { name: name(i) });
                }
                self.next_slack[i] = -value;
            }
            if let Some(soft) = self.soft(i) {
                let next = Soft { value, ..soft }.smoothed(barrier);
                proposed.dearer += next - soft.smoothed(barrier);
                proposed.soft += next;
                continue;
            }
            if let Some(equation) = self.equation(i) {
                let next = Equation { value, ..equation };
                proposed.dearer += next.price(strictness) - equation.price(strictness);
                if equation.size > zero {
                    proposed.unequal += value.abs() / equation.size;
                }
                continue;
            }
            let excess = (one - fraction) * self.excess[i];
            let next = excess - value;
            self.next_slack[i] = next;
            let ratio = next / s;
            // the slack μ/z of a bound that is reached is where the correction leads
            let reached = larger(T::from_ratio(1, 2) * barrier / (z * s), T::from_f64(1.0 - TO_REACHED));
            let least = if is_near && reached < least { reached } else { least };
            if ratio < least {
                let limit = fraction * (one - least) / (one - ratio);
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
        let present = (0..C).filter(|i| !is_none(self.next_slack[*i]) && self.is_inequality(*i));
        present.fold(T::zero(), |sum, i| sum + self.next_slack[i].ln())
    }

    /// Takes the slacks that a fraction of a correction proposes. Multipliers stay positive, near μ/s. Those of equations stay as they are.
    #[inline]
    pub fn accept(&mut self, fraction: T, barrier: T) {
        let wide = T::EPSILON.sqrt().recip();
        for i in 0..C {
            let (z, slack, moved) = (self.multipliers[i], self.slack[i], self.next_slack[i]);
            if self.is_absent(i) {
                continue;
            }
            self.slack[i] = moved;
            match self.kinds[i] {
                Kind::Soft(price) => {
                    let soft = Soft { price, value: -slack };
                    let next = z + fraction * (soft.force(barrier) - z) + soft.stiffness(barrier, z) * (slack - moved);
                    self.multipliers[i] = Soft { value: -moved, ..soft }.within(barrier, z, next);
                }
                Kind::Equation(_) => {}
                Kind::Inequality => {
                    let next = z + fraction * (barrier / slack - z) - z / slack * (moved - slack);
                    let central = barrier / moved;
                    let least = larger(T::from_f64(1.0 - TO_BOUNDARY) * z, central / wide);
                    let most = central * wide;
                    let smaller = if next > most { most } else { next };
                    self.multipliers[i] = if next < least { least } else { smaller };
                    self.excess[i] *= T::one() - fraction;
                }
            }
        }
    }

    /// The multipliers of equations after a fraction of a correction. The full correction moves bounds so far, to first order.
    pub fn equate(&mut self, moved: &SVector<T, C>, fraction: T, strictness: Strictness<T>) {
        for i in 0..C {
            if let Some(equation) = self.equation(i) {
                self.multipliers[i] += fraction * equation.stiffness(strictness) * (equation.value + moved[i]);
            }
        }
    }

    /// Multipliers from a correction that moves bounds so far, to first order. The slacks of active bounds have few digits, so μ/s has few too.
    pub fn settle(&mut self, moved: &SVector<T, C>, strictness: Strictness<T>) {
        let Condensed { force, stiffness } = self.condensed(strictness);
        self.multipliers = SVector::from_fn(|i, _| {
            let next = force[i] + stiffness[i] * moved[i];
            match self.kinds[i] {
                Kind::Equation(_) => next,
                Kind::Soft(price) if next > price => price,
                Kind::Inequality | Kind::Soft(_) => larger(T::zero(), next),
            }
        });
    }

    pub fn is_relaxed(&self) -> bool {
        self.excess.iter().any(|excess| *excess > T::zero())
    }
}
