//! How much of a correction is made: as much as makes an augmented Lagrangian smaller, or comes nearer to the target than ever. And the way
//! down from a saddle, where no gradient leads: along a direction in which the price curves down.
//!
//! The correction makes J − μ Σ ln s + ν⁺·g + ½ g·Rg + z⁺·(a + s) smallest in its quadratic model, g = −e the gap, with the multipliers
//! ν⁺ and z⁺ that come next and the Hessian that the backward sweep had: its slope is known, and near a solution whole steps pass.
//!
//! A negative eigenvalue of one Q_uu, counted with all curvature as it is, is one of the Hessian L Δ Lᵀ of the augmented Lagrangian: the input
//! of that stage changed along its eigenvector, and those that follow by their gains, is the column of L⁻ᵀ.
//!
//! Source: Moré and Sorensen, *On the use of directions of negative curvature in a modified Newton method* (1979), for saddles.

use super::barrier::TO_BOUNDARY;
use super::end::PlanEnd;
use super::sweep::{Plan, PlanSummary, Problem, Settings};
use crate::newton::Equilibrated;
use crate::space::larger;
use crate::{Controlled, Error, Real, Space};
use nalgebra::{SMatrix, SVector};

/// Roll-outs of one correction.
const TRIALS: usize = 12;
/// Halvings of the first change away from a saddle, which would make the price smaller by a hundredth: what is looked for is the minimum next
/// to the saddle.
const HALVINGS: usize = 30;

/// The plan that a correction starts from.
pub(super) struct Descent<'a, T, const D: usize, const U: usize> {
    pub summary: &'a PlanSummary<T, D, U>,
    pub end: &'a PlanEnd<T, D>,
    pub settings: Settings<T, D>,
    /// Γ⁺
    inverse: SMatrix<T, D, D>,
}

/// Where a proposed plan leads.
struct Rolled<X, T> {
    last: X,
    /// Σℓ + φ
    price: T,
    /// Σ ln(s⁺/s)
    slack_logarithms: T,
    /// z·(a + s) with the multipliers of the full step, before it.
    excess_price: T,
    /// The fraction of the correction that slacks allow, where it is smaller than the one that was made.
    allowed: Option<T>,
}

/// A correction that was made.
pub(super) struct Made<X, T, const D: usize> {
    pub last: X,
    pub fraction: T,
    /// δν of the whole correction.
    pub change: SVector<T, D>,
    /// Roll-outs that were refused, other than by slacks.
    pub refused: usize,
}

impl<'a, T: Real, const D: usize, const U: usize> Descent<'a, T, D, U> {
    /// From what a sweep told.
    pub fn of(
        summary: &'a PlanSummary<T, D, U>,
        end: &'a PlanEnd<T, D>,
        gramian: &Equilibrated<T, D>,
        settings: &Settings<T, D>,
    ) -> Self {
        Self { summary, end, settings: *settings, inverse: gramian.inverse() }
    }

    /// δν of the correction that closes a part of the gap, Γ δν = V_ν + (1 − part) e, and twice what it takes from the model.
    pub fn correction(&self, part: T) -> (SVector<T, D>, T) {
        let PlanSummary { lack, descent, .. } = self.summary;
        if self.settings.gap_price.is_some() {
            return (SVector::from_element(T::zero()), *descent);
        }
        let wanted = lack + self.end.lack * (T::one() - part);
        let change = self.inverse * wanted;
        let gain = change.dot(&wanted) - (change.dot(lack) + change.dot(&self.end.lack)) * T::from_f64(2.0);
        (change, *descent + gain)
    }

    /// By how much the augmented Lagrangian is larger after a step.
    fn difference<X>(&self, rolled: &Rolled<X, T>, change: &SVector<T, D>, end: &PlanEnd<T, D>, fraction: T) -> T {
        let penalties = self.penalty(change, end) - self.penalty(change, self.end);
        let barriers = self.settings.barrier * rolled.slack_logarithms + fraction * rolled.excess_price;
        rolled.price - self.summary.price - barriers + penalties
    }

    /// ν⁺·g + ½ g·Rg, or ½ w d²
    fn penalty(&self, change: &SVector<T, D>, end: &PlanEnd<T, D>) -> T {
        let half = T::from_ratio(1, 2);
        if let Some([by_motion, by_momentum]) = self.settings.gap_price {
            return (by_motion * end.squares[0] + by_momentum * end.squares[1]) * half;
        }
        let weighted: SVector<T, D> = self.settings.weight * end.lack;
        weighted.dot(&end.lack) * half - (self.settings.multipliers + change).dot(&end.lack)
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Plan<'_, S, D, U, C> {
    /// Makes a part of the correction; `None` where none that is large enough helps. Prices have the size `magnitude`, of which round-off is a part
    /// ε; a full step that is trusted needs no proof; all plans before were no nearer to the target than `nearest`.
    ///
    /// Where slacks allow only a part, as much of the gap is left to later corrections, before the whole is made shorter.
    pub fn descend(
        &mut self,
        descent: &Descent<'_, T, D, U>,
        magnitude: T,
        is_trusted: bool,
        nearest: T,
    ) -> Option<Made<S::Place, T, D>> {
        let one = T::one();
        let half = T::from_ratio(1, 2);
        let (mut fraction, mut part, mut refused) = (one, one, 0);
        let Settings { barrier, gap_price, .. } = descent.settings;
        let is_closed = gap_price.is_none();
        let is_relaxed = self.is_relaxed();
        for _ in 0..TRIALS {
            let (change, decrement) = descent.correction(part);
            if let Ok(rolled) = self.roll_out(fraction, &change, barrier) {
                if let Some(allowed) = rolled.allowed {
                    // Bounds that curve allow less than they did from afar.
                    let allowed = larger(allowed * T::from_ratio(99, 100), fraction * T::from_f64(1e-3));
                    let is_far = is_closed && descent.end.distance > T::zero() && !is_relaxed;
                    if part >= one && allowed < half && is_far {
                        part = allowed * T::from_ratio(4, 5);
                    } else {
                        fraction = allowed;
                    }
                    continue;
                }
                let end = self.problem.end(&rolled.last);
                let difference = descent.difference(&rolled, &change, &end, fraction);
                let promised = fraction * decrement * T::from_f64(1e-4);
                let round_off = T::from_f64(16.0) * T::EPSILON * magnitude;
                let is_lower = difference <= round_off - promised;
                let is_nearer = is_closed && end.distance < nearest * T::from_ratio(9, 10);
                let is_feasible = is_relaxed && fraction >= T::from_ratio(1, 10);
                let is_enough = is_lower || is_nearer || is_feasible || is_trusted && fraction >= one;
                if difference.is_finite() && is_enough {
                    self.accept(fraction, barrier);
                    return Some(Made { last: rolled.last, fraction, change, refused });
                }
            }
            refused += 1;
            fraction *= half;
        }
        None
    }

    /// Goes down from where a sweep with all curvature as it is found a direction to do so. Returns x_N; `None` where nothing gets smaller.
    #[cold]
    pub fn escape(&mut self, descent: &Descent<'_, T, D, U>, magnitude: T) -> Option<S::Place> {
        let zero = T::zero();
        let one = T::one();
        let fall = descent.summary.fall?;
        let barrier = descent.settings.barrier;
        let mut size = (magnitude * T::from_ratio(1, 1_000) / fall.curvature.abs()).sqrt();
        self.stages.iter_mut().for_each(|stage| stage.shift = SVector::from_element(zero));
        for _ in 0..HALVINGS {
            for part in [size, -size] {
                if let Some(stage) = self.stages.get_mut(fall.stage) {
                    stage.shift = fall.direction * part;
                }
                let none = SVector::from_element(zero);
                if let Ok(rolled) = self.roll_out(one, &none, barrier)
                    && rolled.allowed.is_none()
                {
                    let end = self.problem.end(&rolled.last);
                    let promised = size * size * fall.curvature.abs() * T::from_ratio(1, 8);
                    if descent.difference(&rolled, &none, &end, one) <= -promised {
                        self.accept(one, barrier);
                        return Some(rolled.last);
                    }
                }
            }
            size *= T::from_ratio(1, 2);
        }
        None
    }

    /// The places that the inputs lead to. Returns x_N.
    ///
    /// # Errors
    /// Those of a step; [`Error::NotFinite`].
    pub fn follow(&mut self) -> Result<S::Place, Error> {
        let mut x = *self.problem.start;
        for (index, stage) in self.stages.iter_mut().enumerate() {
            stage.place = x;
            x = self.problem.follow(index, &x, &stage.input)?;
        }
        if x.is_finite() { Ok(x) } else { Err(Error::NotFinite { name: "the end of the guessed plan" }) }
    }

    /// Proposes the plan after `fraction` of the correction with the change δν of the multipliers of the target.
    ///
    /// # Errors
    /// Those of a step.
    fn roll_out(&mut self, fraction: T, change: &SVector<T, D>, barrier: T) -> Result<Rolled<S::Place, T>, Error> {
        let Problem { system, constants, start, .. } = self.problem;
        let (zero, one) = (T::zero(), T::one());
        let least = one - T::from_f64(TO_BOUNDARY);
        let mut rolled =
            Rolled { last: *start, price: zero, slack_logarithms: zero, excess_price: zero, allowed: None };
        for (index, stage) in self.stages.iter_mut().enumerate() {
            let t = self.problem.time_after(index);
            let x = rolled.last;
            let mut input = stage.input + (stage.shift + stage.by_multiplier * change) * fraction;
            if index > 0 {
                input += stage.gain * system.displacement(&stage.place, &x);
            }
            if C > 0 {
                let bounds = system.bounds(t, &x, &input);
                for i in 0..C {
                    let (z, s) = (stage.multipliers[i], stage.slack[i]);
                    let next = (one - fraction) * stage.excess[i] - bounds[i];
                    stage.trial.slack[i] = next;
                    let ratio = next / s;
                    if ratio < least {
                        let limit = fraction * T::from_f64(TO_BOUNDARY) / (one - ratio);
                        if limit < rolled.allowed.unwrap_or(fraction) {
                            rolled.allowed = Some(limit);
                        }
                    } else {
                        rolled.slack_logarithms += ratio.ln();
                        let full = (barrier - z * (next - s) / fraction) / s;
                        rolled.excess_price += full * stage.excess[i];
                    }
                }
            }
            rolled.price += system.price(constants, t, &x, &input);
            (stage.trial.place, stage.trial.input) = (x, input);
            rolled.last = system.follow(constants, t, &x, &input)?;
        }
        rolled.price += system.endpoint(self.problem.time_after(self.stages.len()), &rolled.last);
        Ok(rolled)
    }

    /// Takes the proposed plan, made with this fraction of the correction.
    fn accept(&mut self, fraction: T, barrier: T) {
        for stage in self.stages.iter_mut() {
            stage.accept_slacks(fraction, barrier);
            (stage.place, stage.input) = (stage.trial.place, stage.trial.input);
        }
    }
}
