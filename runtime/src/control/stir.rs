//! The way out of symmetry: where no first derivative leads to the target, inputs are varied.

use super::Stage;
use super::sweep::{PlanSummary, Problem};
use crate::{Controlled, Real, Scalar};
use nalgebra::SVector;
use num_traits::Zero;

/// A pattern of inputs.
#[derive(Clone, Copy)]
struct Pattern<T, const U: usize> {
    amplitudes: SVector<T, U>,
    /// Turns in the whole plan, positive or negative.
    turns: T,
}

/// Doublings of the amplitudes that are tried.
const SIZES: usize = 6;

impl<T: Real, const U: usize> Pattern<T, U> {
    /// The inputs in the middle of a step: turning one way and, half as far and twice as fast, the other.
    fn at(&self, index: usize, steps: usize) -> SVector<T, U> {
        let half = T::from_ratio(1, 2);
        let part = (T::from_f64(index as f64) + half) / T::from_f64(steps as f64);
        let angle = T::from_f64(2.0) * T::PI * part * self.turns;
        SVector::from_fn(|j, _| {
            let phase = T::PI * half * T::from_f64(j as f64);
            let back = angle + angle - phase + T::from_f64(1.0);
            self.amplitudes[j] * ((angle + phase).cos() + half * back.cos())
        })
    }
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// Adds the pattern, of several sizes and turning either way, that ends nearest to the target. Later attempts turn more often.
    #[cold]
    pub fn stir(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        summary: &PlanSummary<S::Scalar, D, U>,
        far: S::Scalar,
        attempt: u32,
    ) {
        let part = far * S::Scalar::from_ratio(1, 4);
        let amplitudes =
            summary.reach.map(|reach| if reach > S::Scalar::zero() { part / reach } else { S::Scalar::zero() });
        let turns = S::Scalar::from_f64(f64::from(attempt));
        let mut best: Option<(Pattern<S::Scalar, U>, S::Scalar)> = None;
        for turns in [turns, -turns] {
            let mut pattern = Pattern { amplitudes, turns };
            for _ in 0..SIZES {
                if let Some(distance) = self.distance(plan, &pattern)
                    && best.is_none_or(|(_, least)| distance < least)
                {
                    best = Some((pattern, distance));
                }
                pattern.amplitudes += pattern.amplitudes;
            }
        }
        if let Some((pattern, _)) = best {
            let steps = plan.len();
            for (index, stage) in plan.iter_mut().enumerate() {
                stage.input += pattern.at(index, steps);
            }
        }
    }

    /// The distance to the target where a pattern is added.
    fn distance(&self, plan: &[Stage<S, D, U, C>], pattern: &Pattern<S::Scalar, U>) -> Option<S::Scalar> {
        let mut x = *self.start;
        for (index, stage) in plan.iter().enumerate() {
            let input = stage.input + pattern.at(index, plan.len());
            x = self.system.follow(self.constants, self.time_after(index), &x, &input).ok()?;
        }
        let distance = self.goal.end(self.system, &x).distance;
        if distance.is_finite() { Some(distance) } else { None }
    }
}
