//! What a problem of optimal control is answered with.

use super::Stage;
use super::newton::CriticalPlan;
use crate::{Controlled, Real};
use core::fmt::{self, Debug, Formatter};
use nalgebra::SVector;

/// A plan on which the price is critical, solved to round-off by [`Control::solve`](crate::Control::solve). The stages that it was solved
/// in hold the plan itself.
pub struct Optimum<'p, S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> {
    plan: &'p [Stage<S, D, U, C>],
    h: S::Scalar,
    price: S::Scalar,
    residual: S::Scalar,
    gap: S::Scalar,
    negative: usize,
    iterations: u32,
    end: S::Place,
    costate: SVector<S::Scalar, D>,
}

impl<'p, S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Optimum<'p, S, D, U, C> {
    pub(super) fn new(plan: &'p [Stage<S, D, U, C>], solved: CriticalPlan<S, D, U, C>, h: S::Scalar) -> Self {
        Self {
            plan,
            h,
            price: solved.summary.price,
            residual: solved.summary.residual,
            gap: solved.end.distance,
            negative: solved.negative,
            iterations: solved.sweeps,
            end: solved.last,
            costate: solved.summary.costate,
        }
    }

    /// The price Σ ℓ + φ.
    pub fn price(&self) -> S::Scalar {
        self.price
    }

    /// The step size h.
    pub fn step_size(&self) -> S::Scalar {
        self.h
    }

    /// The number of linearisations that were made, but for the last, which is for gains and the index.
    pub fn iterations(&self) -> u32 {
        self.iterations
    }

    /// The largest entry of ∂ℓ/∂u + Bᵀp + ∂a/∂uᵀz that round-off has left.
    pub fn residual(&self) -> S::Scalar {
        self.residual
    }

    /// The distance to what was asked of the end, as the root of the sum of squares of all entries; 0 for [`Target::Free`](crate::Target).
    pub fn gap(&self) -> S::Scalar {
        self.gap
    }

    /// The Morse index: the number of independent changes of the inputs, among those that keep the target and the active bounds, that make
    /// the price smaller. 0 on a local minimum.
    pub fn negative(&self) -> usize {
        self.negative
    }

    /// Whether no small change of the inputs, to second order, makes the price smaller.
    pub fn is_minimum(&self) -> bool {
        self.negative == 0
    }

    /// The place x_N: the target up to the [`gap`](Self::gap).
    pub fn end(&self) -> &S::Place {
        &self.end
    }

    /// The costate p_N at the end: ∂φ/∂x and the multipliers of the target.
    pub fn final_costate(&self) -> &SVector<S::Scalar, D> {
        &self.costate
    }

    /// The steps in order, with place, input, costate, gain and multipliers.
    pub fn stages(&self) -> &'p [Stage<S, D, U, C>] {
        self.plan
    }
}

/// Without the plan, which is long.
impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Debug
    for Optimum<'_, S, D, U, C>
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Optimum")
            .field("price", &self.price)
            .field("iterations", &self.iterations)
            .field("residual", &self.residual)
            .field("gap", &self.gap)
            .field("negative", &self.negative)
            .finish_non_exhaustive()
    }
}
