//! Optimal control: the inputs that lead from one place to another, or to none in particular, at the least price and within bounds.
//!
//! ```text
//! minimise Σ ℓ(t_k, h, x_k, u_k) + φ(t_N, x_N)   subject to   x_{k+1} = f(t_k, h, x_k, u_k),   a(t_k, x_k, u_k) ≤ 0,   x_N = target
//! ```
//! The unknowns are the inputs, from which places follow. Newton's method for them is a Riccati sweep backward, with exact second
//! derivatives on the manifold, and a roll-out forward, which the gains of the sweep keep stable.
//!
//! | file | what it does |
//! |---|---|
//! | `stage` | what the caller keeps for each step |
//! | `attempt` | approaches the target in one way after another |
//! | `newton` | iterates, and goes downhill where iterations do not contract |
//! | `iterate` | what is known between sweeps, and decided by it |
//! | `sweep` | linearises and eliminates backward |
//! | `quadratic` | the model of one step, and its elimination |
//! | `pivot` | the U×U linear algebra of one input |
//! | `gramian` | the D×D linear algebra of the target |
//! | `end` | the gap to the target and the changes that close it |
//! | `barrier` | bounds: slacks, multipliers and their sequence of barriers |
//! | `rollout` | follows corrected inputs forward |
//! | `search` | how much of a correction is made |
//! | `escape` | leaves saddles |
//! | `stir` | varies inputs where by symmetry no first derivative leads to the target |
//! | `free_time` | the step size of least price |
//! | `optimum` | what a problem is answered with |

mod attempt;
mod barrier;
mod end;
mod escape;
mod free_time;
mod gramian;
mod iterate;
mod newton;
mod optimum;
mod pivot;
mod quadratic;
mod rollout;
mod search;
mod stage;
mod stir;
mod sweep;

pub use optimum::Optimum;
pub use stage::Stage;

use crate::stepper::check_time;
use crate::{Controlled, Error, Real, Scalar, Space};
use end::Goal;
use nalgebra::SVector;
use num_traits::Zero;
use sweep::Problem;

/// A system whose inputs are chosen, with its step size. Made by [`Controlled::control`].
#[derive(Clone, Debug)]
pub struct Control<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> {
    system: S,
    h: S::Scalar,
    constants: S::Constants,
    time: S::Scalar,
}

/// Where a plan is to end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target<X> {
    /// At this place.
    Place(X),
    /// At the configuration of this place, with any momentum.
    Configuration(X),
    /// Anywhere: the price of the end decides.
    Free,
}

impl<X> Target<X> {
    fn place(&self) -> Option<&X> {
        match self {
            Self::Place(x) | Self::Configuration(x) => Some(x),
            Self::Free => None,
        }
    }
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Control<S, D, U, C> {
    /// Checks `h` and the parameters of `system`.
    pub(crate) fn new(system: S, h: S::Scalar) -> Result<Self, Error> {
        if !h.is_finite() || h == S::Scalar::zero() {
            return Err(Error::StepSize { value: h.to_f64() });
        }
        let constants = system.prepare(h)?;
        Ok(Self { system, h, constants, time: S::Scalar::zero() })
    }

    /// The same with plans that start at the time `t` instead of 0.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn starting_at(self, t: S::Scalar) -> Result<Self, Error> {
        check_time(t)?;
        Ok(Self { time: t, ..self })
    }

    /// The system.
    #[inline]
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The step size h.
    #[inline]
    pub fn step_size(&self) -> S::Scalar {
        self.h
    }

    /// The step from `x` without input, as storage: a plan of N steps has N of them.
    pub fn stage(&self, x: &S::Place) -> Stage<S, D, U, C> {
        Stage::rest(x)
    }

    /// One step at the start time: f(t₀, h, x, u).
    ///
    /// # Errors
    /// Those of a step.
    pub fn follow(&self, x: &S::Place, u: &SVector<S::Scalar, U>) -> Result<S::Place, Error> {
        self.system.follow(&self.constants, self.time, x, u)
    }

    /// The input u_k + K δ for a place `x` near x_k.
    pub fn feedback(&self, stage: &Stage<S, D, U, C>, x: &S::Place) -> SVector<S::Scalar, U> {
        stage.input + stage.gain * self.system.displacement(&stage.place, x)
    }

    /// The plan of least price from `start` to `target`, as near to the guess as Newton's method finds it.
    ///
    /// The number of steps is that of `plan`. The inputs, costates and multipliers that its stages hold are the guess: none of
    /// [`stage`](Self::stage), a solution for another start, target or system, or inputs from elsewhere. They need neither lead to the
    /// target nor keep the bounds.
    ///
    /// Work: two or three linearisations where the system is linear and its price quadratic, four to eight from a good guess, ten to forty
    /// with bounds or from standing still, each linear in the number of stages; at most 400 in each of up to six attempts. Where the
    /// guess does not lead to the target, the gap is priced in place of being closed, and inputs are varied: what is found then is a
    /// local minimum like any other, and need not be the best one.
    ///
    /// # Errors
    /// * [`Error::PathLength`], [`Error::NotFinite`], [`Error::OffOrbit`], [`Error::OutsideMomentumSpace`] for what was given;
    /// * [`Error::Uncontrollable`] where inputs do not move the end towards the target;
    /// * [`Error::Infeasible`] and [`Error::TargetMissed`] where bounds cannot be kept, or leave no way to the target;
    /// * [`Error::NoExtremal`] where the work was not enough;
    /// * those of a step.
    ///
    /// After an error the stages hold the inputs of the guess.
    pub fn solve<'p>(
        &self,
        start: &S::Place,
        target: Target<S::Place>,
        plan: &'p mut [Stage<S, D, U, C>],
    ) -> Result<Optimum<'p, S, D, U, C>, Error> {
        self.check(start, &target, plan)?;
        let solved = self.problem(start, &target, self.h, &self.constants).attempt(plan)?;
        Ok(Optimum::new(plan, solved, self.h))
    }

    /// The problem with the step size `h`, for which there are these constants.
    fn problem<'a>(
        &'a self,
        start: &'a S::Place,
        target: &'a Target<S::Place>,
        h: S::Scalar,
        constants: &'a S::Constants,
    ) -> Problem<'a, S, D, U, C> {
        Problem { system: &self.system, constants, h, time: self.time, start, goal: Goal::of(&self.system, target) }
    }

    /// Start, target and guess are finite and where places are.
    fn check(&self, start: &S::Place, target: &Target<S::Place>, plan: &[Stage<S, D, U, C>]) -> Result<(), Error> {
        if plan.is_empty() {
            return Err(Error::PathLength { nodes: 0, per_step: 1 });
        }
        self.system.check_place(start)?;
        if let Some(goal) = target.place() {
            self.system.check_place(goal)?;
        }
        if plan.iter().all(|stage| stage.input.is_finite()) {
            Ok(())
        } else {
            Err(Error::NotFinite { name: "the guessed inputs" })
        }
    }
}
