//! How much of a correction is made: as much as makes an augmented Lagrangian smaller, or comes nearer to the target than ever.
//!
//! The correction makes J − μ Σ ln s + ν⁺·g + ½ g·Rg + z⁺·(a + s) smallest in its quadratic model, g = −e the gap, with the multipliers
//! ν⁺ and z⁺ that come next and the Hessian that the backward sweep had: its slope is known, and near a solution whole steps pass.

use super::Stage;
use super::end::PlanEnd;
use super::rollout::Rolled;
use super::sweep::{PlanSummary, Problem, Settings};
use crate::newton::Equilibrated;
use crate::space::larger;
use crate::{Controlled, Real, Scalar};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// Roll-outs of one correction.
const TRIALS: usize = 12;

/// The plan that a correction starts from.
pub(super) struct Descent<'a, T, const D: usize> {
    end: &'a PlanEnd<T, D>,
    pub settings: Settings<T, D>,
    /// Γ⁺
    inverse: SMatrix<T, D, D>,
    /// V_ν
    lack: SVector<T, D>,
    /// Σℓ + φ
    price: T,
    /// −Σ Q_u·k
    descent: T,
}

/// What a correction is judged by.
pub(super) struct Evidence<T> {
    /// The size of prices, of which round-off is a part ε.
    pub magnitude: T,
    /// Whether a full step needs no proof.
    pub is_trusted: bool,
    /// The smallest distance to the target of all plans.
    pub nearest: T,
    /// Whether bounds are relaxed.
    pub is_relaxed: bool,
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

impl<'a, T: Real, const D: usize> Descent<'a, T, D> {
    /// From what a sweep told.
    pub fn of<const U: usize>(
        summary: &PlanSummary<T, D, U>,
        end: &'a PlanEnd<T, D>,
        gramian: &Equilibrated<T, D>,
        settings: &Settings<T, D>,
    ) -> Self {
        Self {
            end,
            settings: *settings,
            inverse: gramian.inverse(),
            lack: summary.lack,
            price: summary.price,
            descent: summary.descent,
        }
    }

    /// δν of the correction that closes a part of the gap, Γ δν = V_ν + (1 − part) e, and twice what it takes from the model.
    pub fn correction(&self, part: T) -> (SVector<T, D>, T) {
        if self.settings.gap_price.is_some() {
            return (SVector::from_element(T::zero()), self.descent);
        }
        let wanted = self.lack + self.end.lack * (T::one() - part);
        let change = self.inverse * wanted;
        let gain = change.dot(&wanted) - (change.dot(&self.lack) + change.dot(&self.end.lack)) * T::from_f64(2.0);
        (change, self.descent + gain)
    }

    /// By how much the augmented Lagrangian is larger after a step.
    pub fn difference<X>(&self, rolled: &Rolled<X, T>, change: &SVector<T, D>, end: &PlanEnd<T, D>, fraction: T) -> T {
        let penalties = self.penalty(change, end) - self.penalty(change, self.end);
        let barriers = self.settings.barrier.weight * rolled.slack_logarithms + fraction * rolled.excess_price;
        rolled.price - self.price - barriers + penalties
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

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// Makes a part of the correction; `None` where none that is large enough helps.
    ///
    /// Where slacks allow only a part, as much of the gap is left to later corrections, before the whole is made shorter.
    pub fn descend(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        descent: &Descent<'_, S::Scalar, D>,
        evidence: &Evidence<S::Scalar>,
    ) -> Option<Made<S::Place, S::Scalar, D>> {
        let one = S::Scalar::one();
        let (mut fraction, mut part, mut refused) = (one, one, 0);
        let barrier = descent.settings.barrier;
        for _ in 0..TRIALS {
            let half = fraction * S::Scalar::from_ratio(1, 2);
            let (change, decrement) = descent.correction(part);
            if let Ok(rolled) = self.roll_out(plan, fraction, &change, barrier) {
                if let Some(allowed) = rolled.allowed {
                    // Bounds that curve allow less than they did from afar.
                    let least = fraction * S::Scalar::from_f64(1e-3);
                    let allowed = larger(allowed * S::Scalar::from_ratio(99, 100), least);
                    let is_far = descent.settings.gap_price.is_none()
                        && descent.end.distance > S::Scalar::zero()
                        && !evidence.is_relaxed;
                    if part >= one && allowed < S::Scalar::from_ratio(1, 2) && is_far {
                        part = allowed * S::Scalar::from_ratio(4, 5);
                    } else {
                        fraction = allowed;
                    }
                    continue;
                }
                let end = self.goal.end(self.system, &rolled.last);
                let difference = descent.difference(&rolled, &change, &end, fraction);
                let promised = fraction * decrement * S::Scalar::from_f64(1e-4);
                let round_off = S::Scalar::from_f64(16.0) * S::Scalar::EPSILON * evidence.magnitude;
                let is_lower = difference <= round_off - promised;
                let nearer = descent.settings.gap_price.is_none()
                    && end.distance < evidence.nearest * S::Scalar::from_ratio(9, 10);
                let feasible = evidence.is_relaxed && fraction >= S::Scalar::from_ratio(1, 10);
                let trusted = evidence.is_trusted && fraction >= one;
                if difference.is_finite() && (is_lower || nearer || feasible || trusted) {
                    self.accept(plan, fraction, barrier);
                    return Some(Made { last: rolled.last, fraction, change, refused });
                }
            }
            refused += 1;
            fraction = half;
        }
        None
    }
}
