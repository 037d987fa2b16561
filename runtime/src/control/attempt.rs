//! One attempt after another, from the guess to plans that only a search finds.
//!
//! Corrections that close the whole gap to the target at once are the fastest; where they drive the slacks of bounds to nothing they get
//! stuck there. Then the gap g is priced instead, by ν·g + ½ g·Rg beside the barriers of the bounds, and ν and R are raised between critical
//! plans until little of it is left. Where that ends at a plan from which no small change leads nearer, inputs are varied before.
//!
//! Sources: Wächter and Biegler, *Failure of global convergence for a class of interior point methods for nonlinear programming* (2000);
//! Bertsekas, *Constrained Optimization and Lagrange Multiplier Methods* (1982), chapter 2.

use super::barrier::Barrier;
use super::iterate::Iterate;
use super::newton::CriticalPlan;
use super::sweep::Problem;
use super::{Stage, Target};
use crate::{Controlled, Error, Real, Space};
use nalgebra::SVector;
use num_traits::Zero;

/// How the target is approached.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Approach {
    /// Corrections close the gap.
    Close,
    /// The gap is priced, and closed where little of it is left.
    Price,
}

/// Variations of the inputs from which the target is approached.
const VARIATIONS: u32 = 3;

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// The critical plan near the guess that the stages hold; without their multipliers where those mislead, and from further away where
    /// there is none.
    ///
    /// # Errors
    /// Those of [`newton`](Self::newton), of the attempt that came nearest. The stages hold the inputs of the guess then.
    pub fn attempt(&self, plan: &mut [Stage<S, D, U, C>]) -> Result<CriticalPlan<S, D, U, C>, Error> {
        plan.iter_mut().for_each(|stage| stage.guess = stage.input);
        let is_warm = plan.iter().any(|stage| stage.next_costate.max_abs() > S::Scalar::zero());
        let mut sweeps = 0;
        let mut solved = self.newton(plan, Approach::Close, &mut sweeps);
        if is_warm {
            solved = self.unless_found(solved, plan, Approach::Close, 0, &mut sweeps);
        }
        if !matches!(self.goal.target, Target::Free) {
            for variation in 0..=VARIATIONS {
                solved = self.unless_found(solved, plan, Approach::Price, variation, &mut sweeps);
            }
        }
        if solved.is_err() {
            plan.iter_mut().for_each(Stage::forget);
        }
        solved
    }

    /// What was found, or else what the next attempt finds from the guess. An error is that of the attempt that came nearer.
    fn unless_found(
        &self,
        found: Result<CriticalPlan<S, D, U, C>, Error>,
        plan: &mut [Stage<S, D, U, C>],
        approach: Approach,
        variation: u32,
        sweeps: &mut u32,
    ) -> Result<CriticalPlan<S, D, U, C>, Error> {
        let error = match found {
            Err(error) if may_be_found(&error) => error,
            _ => return found,
        };
        plan.iter_mut().for_each(Stage::forget);
        if variation > 0 {
            self.vary(plan, variation)?;
        }
        self.newton(plan, approach, sweeps).map_err(|next| nearer(error, next))
    }

    /// Varies the inputs of the guess so that they end nearer to the target.
    ///
    /// # Errors
    /// Those of a step.
    #[cold]
    fn vary(&self, plan: &mut [Stage<S, D, U, C>], variation: u32) -> Result<(), Error> {
        let last = self.follow(plan)?;
        let end = self.goal.end(self.system, &last);
        let now = Iterate::new(last, SVector::from_element(S::Scalar::zero()), Some(Barrier::none()), end.distance);
        let summary = self.eliminate(plan, &now.last, &end, &now.settings)?;
        self.stir(plan, &summary, end.lack.max_abs(), variation);
        Ok(())
    }
}

/// Whether a search failed that another may end better.
fn may_be_found(error: &Error) -> bool {
    matches!(
        error,
        Error::Infeasible { .. } | Error::TargetMissed { .. } | Error::NoExtremal { .. } | Error::Uncontrollable { .. }
    )
}

/// What is told of two attempts that failed.
fn nearer(first: Error, second: Error) -> Error {
    match (first, second) {
        (Error::TargetMissed { distance, .. }, Error::TargetMissed { distance: other, iterations }) => {
            Error::TargetMissed { distance: if other < distance { other } else { distance }, iterations }
        }
        (Error::Infeasible { .. } | Error::NoExtremal { .. }, Error::TargetMissed { .. }) => second,
        _ => first,
    }
}
