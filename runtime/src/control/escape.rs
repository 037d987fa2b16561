//! The way down from a saddle, where no gradient leads: along a direction in which the price curves down.
//!
//! A negative eigenvalue of one Q_uu, counted with all curvature as it is, is one of the Hessian L Δ Lᵀ of the augmented Lagrangian: the input
//! of that stage changed along its eigenvector, and those that follow by their gains, is the column of L⁻ᵀ.
//!
//! Source: Moré and Sorensen, *On the use of directions of negative curvature in a modified Newton method* (1979).

use super::Stage;
use super::search::Descent;
use super::sweep::{PlanSummary, Problem};
use crate::{Controlled, Real, Scalar};
use nalgebra::SVector;
use num_traits::{One, Zero};

/// Halvings of the first change, which would make the price smaller by a hundredth: what is looked for is the minimum next to the saddle.
const HALVINGS: usize = 30;

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// Goes down from where a sweep with all curvature as it is found a direction to do so. Returns x_N; `None` where nothing gets smaller.
    #[cold]
    pub fn escape(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        descent: &Descent<'_, S::Scalar, D>,
        summary: &PlanSummary<S::Scalar, D, U>,
        magnitude: S::Scalar,
    ) -> Option<S::Place> {
        let (zero, one) = (S::Scalar::zero(), S::Scalar::one());
        let (chosen, fall, _) = summary.fall?;
        let none = SVector::from_element(zero);
        let barrier = descent.settings.barrier;
        let mut size = (magnitude * S::Scalar::from_ratio(1, 1_000) / fall.curvature.abs()).sqrt();
        plan.iter_mut().for_each(|stage| stage.shift = SVector::from_element(zero));
        for trial in 0..2 * HALVINGS {
            let part = if trial % 2 == 0 { size } else { -size };
            if let Some(stage) = plan.get_mut(chosen) {
                stage.shift = fall.direction * part;
            }
            if let Ok(rolled) = self.roll_out(plan, one, &none, barrier)
                && rolled.allowed.is_none()
            {
                let end = self.goal.end(self.system, &rolled.last);
                let promised = size * size * fall.curvature.abs() * S::Scalar::from_ratio(1, 8);
                if descent.difference(&rolled, &none, &end, one) <= -promised {
                    self.accept(plan, one, barrier);
                    return Some(rolled.last);
                }
            }
            if trial % 2 == 1 {
                size *= S::Scalar::from_ratio(1, 2);
            }
        }
        None
    }
}
