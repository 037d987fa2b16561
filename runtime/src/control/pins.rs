//! Inputs that two equal bounds fix, as `0 <= u.x, u.x <= 0` does.
//!
//! No input lies between such bounds, so no barrier keeps a distance to them. They are the equation a = 0, and its
//! directions are no inputs: derivatives along them are taken out of each step. The multipliers follow from the slope
//! of the price along them.

use super::Stage;
use super::sweep::{Plan, Problem};
use crate::space::larger;
use crate::{BoundsExpansion, Controlled, Error, Expansion, Real, Space};
use nalgebra::{SMatrix, SVector};

/// Corrections of an input by its equations, which are linear: the second takes the round-off of the first.
const CORRECTIONS: usize = 2;
/// Units in the last place that round-off leaves of a bound.
const ROUNDING: f64 = 16.0;

/// The equations of the input of a stage.
pub(super) struct Pins<T, const U: usize, const C: usize> {
    /// Of each pair the slope of the first bound, in its place; 0 in others.
    slopes: SMatrix<T, C, U>,
    /// The same directions, orthonormal.
    directions: SMatrix<T, C, U>,
    /// The second bound of each pair.
    partners: [Option<usize>; C],
}

impl<T: Real, const U: usize, const C: usize> Pins<T, U, C> {
    /// The pairs of bounds of the input alone that have opposite slopes and values, but for round-off. `None` without any.
    fn of<const D: usize>(bounds: &BoundsExpansion<T, D, U, C>, input: &SVector<T, U>) -> Option<Self> {
        let is_opposite = |i: usize, j: usize| {
            let slopes = (0..U).all(|k| bounds.by_input[(i, k)] == -bounds.by_input[(j, k)]);
            let terms = bounds.values[i].abs() + bounds.values[j].abs() + terms(bounds, input, i);
            let values = (bounds.values[i] + bounds.values[j]).abs() <= T::from_f64(ROUNDING) * T::EPSILON * terms;
            slopes && values && bounds.values[i].is_finite()
        };
        let is_of_input = |i: usize| {
            let by_place = bounds.by_place.row(i).iter().all(|slope| *slope == T::zero());
            by_place && bounds.by_input.row(i).iter().any(|slope| *slope != T::zero())
        };
        let mut taken = [false; C];
        let mut partners = [None; C];
        for i in (0..C).filter(|&i| is_of_input(i)) {
            for j in (0..C).filter(|&j| j > i && is_of_input(j)) {
                if !taken[i] && !taken[j] && is_opposite(i, j) {
                    (taken[i], taken[j]) = (true, true);
                    partners[i] = Some(j);
                }
            }
        }
        partners.iter().any(Option::is_some).then(|| Self::between(bounds, partners))
    }

    /// The equations of these pairs.
    fn between<const D: usize>(bounds: &BoundsExpansion<T, D, U, C>, partners: [Option<usize>; C]) -> Self {
        let mut slopes = SMatrix::<T, C, U>::from_element(T::zero());
        let mut directions = slopes;
        for i in (0..C).filter(|&i| partners[i].is_some()) {
            let slope = SVector::<T, U>::from_fn(|k, _| bounds.by_input[(i, k)]);
            let along = slope - within(&directions, &slope);
            let length = along.dot(&along).sqrt();
            // an equation that others imply adds no direction
            if length > T::EPSILON.sqrt() * slope.max_abs() {
                slopes.set_row(i, &slope.transpose());
                directions.set_row(i, &(along / length).transpose());
            }
        }
        Self { slopes, directions, partners }
    }

    /// The change of the input after which the equations hold, by these values of the bounds.
    fn correction(&self, values: &SVector<T, C>) -> SVector<T, U> {
        (0..C).filter(|&i| self.is_direction(i)).fold(SVector::from_element(T::zero()), |change, i| {
            let missing = -values[i] - self.slopes.row(i).transpose().dot(&change);
            let along = self.slopes.row(i).dot(&self.directions.row(i));
            change + self.directions.row(i).transpose() * (missing / along)
        })
    }

    /// Whether a bound is in a pair.
    fn contains(&self, i: usize) -> bool {
        self.partners[i].is_some() || self.partners.contains(&Some(i))
    }

    fn is_direction(&self, i: usize) -> bool {
        self.directions.row(i).iter().any(|entry| *entry != T::zero())
    }

    /// Takes the directions out of the derivatives of a step. The curvature along them, which no input sees, is that of the others.
    pub fn take_out<X, const D: usize>(&self, step: &mut Expansion<X, T, D, U>) {
        let free = SMatrix::<T, U, U>::identity() - self.directions.tr_mul(&self.directions);
        step.by_input *= free;
        step.price_by_input = free * step.price_by_input;
        step.mixed_curvature = free * step.mixed_curvature;
        let curvature = free * step.input_curvature * free;
        let most = curvature.diagonal().max_abs();
        let along = if most > T::zero() { most } else { T::one() };
        step.input_curvature = curvature + self.directions.tr_mul(&self.directions) * along;
    }

    /// The multipliers that balance the slope of the price along the directions.
    pub fn multipliers(&self, slope: &SVector<T, U>, multipliers: &mut SVector<T, C>) {
        let mut slope = *slope;
        for i in (0..C).rev().filter(|&i| self.is_direction(i)) {
            let along = self.slopes.row(i).dot(&self.directions.row(i));
            let force = -self.directions.row(i).transpose().dot(&slope) / along;
            slope += self.slopes.row(i).transpose() * force;
            multipliers[i] = larger(force, T::zero());
            // by the range of j, without an index that the optimiser cannot bound
            for j in (0..C).filter(|&j| self.partners[i] == Some(j)) {
                multipliers[j] = larger(-force, T::zero());
            }
        }
    }
}

/// The part of a vector in the span of some orthonormal rows.
fn within<T: Real, const U: usize, const C: usize>(rows: &SMatrix<T, C, U>, vector: &SVector<T, U>) -> SVector<T, U> {
    rows.tr_mul(&(rows * vector))
}

/// Σ |∂a/∂u| |u| of a bound.
fn terms<T: Real, const D: usize, const U: usize, const C: usize>(
    bounds: &BoundsExpansion<T, D, U, C>,
    input: &SVector<T, U>,
    i: usize,
) -> T {
    (0..U).fold(T::zero(), |sum, k| sum + (bounds.by_input[(i, k)] * input[k]).abs())
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Stage<S, D, U, C> {
    /// The equations of its input, where bounds fix it.
    pub(super) fn pins(&self, system: &S, t: T) -> Option<Pins<T, U, C>> {
        let is_pinned = self.partners.iter().any(Option::is_some);
        is_pinned.then(|| Pins::between(&self.expanded_bounds(system, t, &self.input), self.partners))
    }

    /// Whether a bound is one of a pair that fixes the input.
    pub(super) fn is_pinned(&self, i: usize) -> bool {
        self.partners[i].is_some() || self.partners.contains(&Some(i))
    }

    /// Moves the input to where its equations hold, if there are any; whether it has moved.
    fn pin(&mut self, system: &S, t: T) -> bool {
        self.partners = [None; C];
        let Some(pins) = Pins::of(&self.expanded_bounds(system, t, &self.input), &self.input) else { return false };
        let corrected = |input: SVector<T, U>, _| input + pins.correction(&system.bounds(t, &self.place, &input));
        let input = (0..CORRECTIONS).fold(self.input, corrected);
        let bounds = self.expanded_bounds(system, t, &input);
        let round_off = T::from_f64(ROUNDING) * T::EPSILON;
        let holds = |i: usize| bounds.values[i].abs() <= round_off * terms(&bounds, &input, i);
        // equal but for the round-off of a larger input, or in contradiction to others: bounds as all others
        let is_fixed = (0..C).filter(|&i| pins.contains(i)).all(holds);
        let has_moved = is_fixed && input != self.input;
        if is_fixed {
            (self.input, self.partners) = (input, pins.partners);
        }
        has_moved
    }

    fn expanded_bounds(&self, system: &S, t: T, input: &SVector<T, U>) -> BoundsExpansion<T, D, U, C> {
        system.bounds_expanded(t, &self.place, input, &SVector::from_element(T::zero()))
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Plan<'_, S, D, U, C> {
    /// The places that the inputs lead to, where those that bounds fix have their values.
    pub fn lead(&mut self) -> Result<(), Error> {
        self.follow()?;
        let Problem { system, time, h, .. } = self.problem;
        let mut has_moved = false;
        for (index, stage) in self.stages.iter_mut().enumerate().filter(|_| C > 1) {
            has_moved |= stage.pin(system, time + T::from_f64(index as f64) * h);
        }
        if has_moved { self.follow() } else { Ok(()) }
    }
}
