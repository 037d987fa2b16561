//! One attempt after another, from the guess to plans that only a search finds.
//!
//! Corrections that close all of the gap to the target at once are the fastest. If the first whose model reaches the target leads astray,
//! multiple shooting goes on. If corrections drive the slacks of bounds to zero, they get stuck. The gap g then has the price ν·g + ½ g·Rg, in addition to the barriers of the bounds. ν and R
//! are raised between critical plans until little of the gap is left. Where that ends at a plan from which no small
//! change leads nearer, inputs are varied before.
//!
//! Sources: Wächter and Biegler, *Failure of global convergence for a class of interior point methods for nonlinear
//! programming* (2000). Bertsekas, *Constrained Optimization and Lagrange Multiplier Methods* (1982), chapter 2.

use super::iterate::Iterate;
use super::start::Start;
use super::sweep::{Plan, PlanSummary, Way};
use super::{Ended, Optimum, Stage, Target};
use crate::{Controlled, Error, Real, Space};
use nalgebra::SVector;

/// Variations of the inputs from which the target is approached.
const VARIATIONS: u32 = 3;
/// How many of them, with the guess as it is, are tried by multiple shooting.
const LIFTS: u32 = 2;

/// The amplitudes of a pattern that are tried: the smallest, in those that close the gap where nothing bends, and how often it is doubled.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Amplitudes(f64, usize);

impl Amplitudes {
    /// Those that lead out of symmetry, where the first derivative vanishes or nearly does.
    pub const NEAR: Amplitudes = Amplitudes(0.25, 6);
    /// Those that lead away from the plan that misled a search.
    pub const FAR: Amplitudes = Amplitudes(16.0, 3);
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Plan<'_, S, B, D, U, C>
{
    /// The critical plan near the guess that the stages hold; without their multipliers where those mislead, and from further away where
    /// there is none. If all attempts fail, the error is that of the one that came nearest, and the stages hold the inputs of the guess.
    pub fn attempt<'p>(&mut self) -> Result<Optimum<'p, S, D, U, C>, Error> {
        self.stages.iter_mut().for_each(|stage| stage.guess = stage.input);
        let is_warm = self.stages.iter().any(|stage| stage.next_costate.max_abs() > T::zero());
        let is_aimed = !matches!(self.problem.target, Target::Free);
        self.way = if is_aimed && !is_warm { Way::Open } else { Way::Kept };
        let mut solved = self.newton(false);
        let way = core::mem::replace(&mut self.way, Way::Kept);
        let gave_way = matches!(way, Way::Given(_));
        if let Way::Given(amplitudes) = way {
            self.forget();
            if (0..LIFTS).any(|variation| self.lift(variation, &amplitudes)) {
                solved = self.newton(false);
            }
        }
        let again = (is_warm || gave_way).then_some((false, 0));
        let variations = if is_aimed { 0..1 + VARIATIONS } else { 0..0 };
        let (before, after) = if is_warm { (again, None) } else { (None, again) };
        let priced = variations.map(|variation| (true, variation));
        // a search that has given way says nothing of the plan
        let mut says_nothing = gave_way;
        for (is_priced, variation) in before.into_iter().chain(priced).chain(after) {
            let error = match solved {
                Err(error) if may_be_found(&error) => error,
                _ => break,
            };
            self.forget();
            solved = match self.vary(variation, &Amplitudes::FAR) {
                Ok(()) => self.newton(is_priced).map_err(|next| match (says_nothing, gave_way && !is_priced) {
                    (true, _) => next,
                    (_, true) => nearer(next, error),
                    _ => nearer(error, next),
                }),
                Err(error) => Err(error),
            };
            says_nothing = false;
        }
        if solved.is_err() {
            self.forget();
        }
        solved
    }

    /// The critical plan near these places from x_1 to x_N, which need not be a motion of the system. If that search fails, the plan is sought
    /// from the inputs of the guess alone.
    pub fn attempt_along<'p>(
        &mut self,
        path: impl FnMut(usize, T) -> S::Place,
    ) -> Result<Optimum<'p, S, D, U, C>, Error> {
        self.stages.iter_mut().for_each(|stage| stage.guess = stage.input);
        self.forget();
        if self.lift_along(path)? {
            match self.newton(false) {
                Err(_) => self.forget(),
                found => return found,
            }
        }
        self.attempt()
    }

    /// The plan that one search from the guess has reached, whether it ends or not. After an error, which is one of a step,
    /// the stages hold the inputs of the guess.
    pub fn attempt_once<'p>(&mut self) -> Result<Optimum<'p, S, D, U, C>, Error> {
        self.stages.iter_mut().for_each(|stage| stage.guess = stage.input);
        let reached = self.newton(false).or_else(|error| {
            if !may_be_found(&error) {
                return Err(error);
            }
            // the multipliers have misled it
            let now = self.start(false)?;
            let reached = self.interrupted(&now, Ended::Failed(error));
            self.stages.iter_mut().for_each(Stage::forget_multipliers);
            reached
        });
        if reached.is_err() {
            self.forget();
        }
        reached
    }

    /// Varies the inputs of the guess so that they end nearer to the target; those of variation 0 stay as they are.
    #[cold]
    pub fn vary(&mut self, variation: u32, amplitudes: &Amplitudes) -> Result<(), Error> {
        if variation > 0 {
            self.follow()?;
            let end = self.end();
            // multipliers and slacks are forgotten: the reach of inputs is that without bounds
            (self.bounds, self.has_equations) = (T::zero(), false);
            let summary = self.eliminate(&end, &Iterate::new(SVector::zeros(), None, end.distance).settings)?;
            self.stir(&summary, end.lack.max_abs(), variation, amplitudes);
        }
        Ok(())
    }

    /// The way out of symmetry: adds the pattern of inputs, of several sizes and turning either way, that ends nearest to the target.
    #[cold]
    pub fn stir(
        &mut self,
        summary: &PlanSummary<T, D, U>,
        far: T,
        attempt: u32,
        &Amplitudes(smallest, sizes): &Amplitudes,
    ) {
        let steps = self.stages.len();
        let part = far * T::from_f64(smallest);
        let turns = T::from_f64(f64::from(attempt));
        let mut best: Option<(SVector<T, U>, T, T)> = None;
        for turns in [turns, -turns] {
            let mut amplitudes = summary.reach.map(|reach| if reach > T::zero() { part / reach } else { T::zero() });
            for _ in 0..sizes {
                if let Some(distance) = self.distance(&amplitudes, turns)
                    && best.is_none_or(|(.., least)| distance < least)
                {
                    best = Some((amplitudes, turns, distance));
                }
                amplitudes += amplitudes;
            }
        }
        if let Some((amplitudes, turns, _)) = best {
            for (index, stage) in self.stages.iter_mut().enumerate() {
                stage.input += pattern(&amplitudes, turns, index, steps);
            }
        }
    }

    /// The distance to the target where a pattern is added.
    fn distance(&self, amplitudes: &SVector<T, U>, turns: T) -> Option<T> {
        let problem = &self.problem;
        let mut x = self.origin();
        for (index, stage) in self.stages.iter().enumerate() {
            let input = stage.input + pattern(amplitudes, turns, index, self.stages.len());
            x = problem.follow(stage, problem.time_after(index), &x, &input).ok()?;
        }
        let distance = problem.end(&x, T::zero(), &self.pushing).distance;
        distance.is_finite().then_some(distance)
    }
}

/// The inputs in the middle of a step, which turn so often in the plan. They turn one way and, half as far and twice as
/// fast, the other.
fn pattern<T: Real, const U: usize>(amplitudes: &SVector<T, U>, turns: T, index: usize, steps: usize) -> SVector<T, U> {
    let half = T::from_ratio(1, 2);
    let part = (T::from_f64(index as f64) + half) / T::from_f64(steps as f64);
    let angle = T::from_f64(2.0) * T::PI * part * turns;
    SVector::from_fn(|j, _| {
        let phase = T::PI * half * T::from_f64(j as f64);
        let back = angle + angle - phase + T::from_f64(1.0);
        amplitudes[j] * ((angle + phase).cos() + half * back.cos())
    })
}

/// Whether a search failed that another may end better.
fn may_be_found(error: &Error) -> bool {
    matches!(
        error,
        Error::Infeasible { .. }
            | Error::TargetMissed { .. }
            | Error::NoExtremal { .. }
            | Error::NotStationary { .. }
            | Error::Uncontrollable { .. }
            | Error::SingularTangent { .. }
    )
}

/// The error that is reported after two failed attempts.
fn nearer(first: Error, second: Error) -> Error {
    match (first, second) {
        (Error::TargetMissed { distance, .. }, Error::TargetMissed { distance: other, iterations }) => {
            Error::TargetMissed { distance: if other < distance { other } else { distance }, iterations }
        }
        (Error::Infeasible { .. } | Error::NoExtremal { .. }, Error::TargetMissed { .. }) => second,
        _ => first,
    }
}
