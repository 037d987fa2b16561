//! How much of a correction is made: as much as makes an augmented Lagrangian smaller, or comes nearer to the target than ever.
//!
//! The correction makes J − μ Σ ln s + ν⁺·g + ½ g·Rg + z⁺·(a + s) smallest in its quadratic model, g = −e the gap, with the multipliers
//! ν⁺ and z⁺ that come next and the Hessian that the backward sweep had: its slope is known, and near a solution whole steps pass.

use super::Stage;
use super::end::End;
use super::sweep::{Problem, Settings};
use crate::space::larger;
use crate::{Controlled, Scalar};
use nalgebra::SVector;
use num_traits::One;

/// Roll-outs of one correction.
const TRIALS: usize = 12;

/// The plan that a correction starts from.
pub(super) struct Descent<'a, T, const D: usize> {
    pub end: &'a End<T, D>,
    pub settings: &'a Settings<'a, T, D>,
    /// δν
    pub change: SVector<T, D>,
    /// Σℓ + φ
    pub price: T,
    /// Twice what the model promises.
    pub decrement: T,
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
pub(super) struct Made<X, T> {
    pub last: X,
    pub fraction: T,
    /// Roll-outs that were refused, other than by slacks.
    pub refused: usize,
}

impl<T: Scalar, const D: usize> Descent<'_, T, D> {
    /// ν⁺·g + ½ g·Rg
    fn penalty(&self, lack: &SVector<T, D>) -> T {
        let weighted: SVector<T, D> = self.settings.weight * lack;
        weighted.dot(lack) * T::from_ratio(1, 2) - (self.settings.multipliers + self.change).dot(lack)
    }

    /// What the augmented Lagrangian is compared with: a small part of the promise, and round-off.
    fn is_lower(&self, change: T, fraction: T) -> bool {
        let promised = fraction * self.decrement * T::from_f64(1e-4);
        change <= T::from_f64(16.0) * T::EPSILON * self.magnitude - promised
    }
}

impl<S: Controlled<D, U, C>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// Makes a part of the correction; `None` where none that is large enough helps.
    pub fn descend(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        descent: &Descent<'_, S::Scalar, D>,
    ) -> Option<Made<S::Place, S::Scalar>> {
        let (mut fraction, mut refused) = (S::Scalar::one(), 0);
        let barrier = descent.settings.barrier;
        let before = descent.penalty(&descent.end.lack);
        for _ in 0..TRIALS {
            let half = fraction * S::Scalar::from_ratio(1, 2);
            if let Ok(rolled) = self.roll_out(plan, fraction, &descent.change, barrier) {
                if let Some(allowed) = rolled.allowed {
                    // Bounds that curve allow less than they did from afar.
                    let enough = larger(allowed * S::Scalar::from_ratio(99, 100), fraction * S::Scalar::from_f64(1e-3));
                    fraction = if enough < half || refused > 0 { enough } else { larger(half, enough) };
                    continue;
                }
                let end = self.goal.end(self.system, &rolled.last);
                let change = rolled.price
                    - descent.price
                    - barrier.weight * rolled.slack_logarithms
                    - fraction * rolled.excess_price
                    + (descent.penalty(&end.lack) - before);
                let nearer = end.distance < descent.nearest * S::Scalar::from_ratio(9, 10);
                let feasible = descent.is_relaxed && fraction >= S::Scalar::from_ratio(1, 10);
                let is_whole = fraction >= S::Scalar::one();
                if change.is_finite()
                    && (descent.is_lower(change, fraction) || nearer || feasible || descent.is_trusted && is_whole)
                {
                    self.accept(plan, fraction, barrier);
                    return Some(Made { last: rolled.last, fraction, refused });
                }
            }
            refused += 1;
            fraction = half;
        }
        None
    }
}
