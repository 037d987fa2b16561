//! What the caller keeps for each step of a plan.

use crate::{Controlled, Real, Scalar};
use core::fmt::{self, Debug, Formatter};
use nalgebra::{SMatrix, SVector};
use num_traits::Zero;

/// One step of a plan. Made by [`Control::stage`](crate::Control::stage), filled by [`Control::solve`](crate::Control::solve).
pub struct Stage<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> {
    pub(super) place: S::Place,
    pub(super) input: SVector<S::Scalar, U>,
    /// The costates p_k and p_{k+1}.
    pub(super) costate: SVector<S::Scalar, D>,
    pub(super) next_costate: SVector<S::Scalar, D>,
    pub(super) gain: SMatrix<S::Scalar, U, D>,
    pub(super) multipliers: SVector<S::Scalar, C>,
    /// s > 0 with a + s = excess.
    pub(super) slack: SVector<S::Scalar, C>,
    /// By how much the bounds are still relaxed, 0 once a full step was made.
    pub(super) excess: SVector<S::Scalar, C>,
    /// k and G: the change of the input is k + G δν + K δ.
    pub(super) shift: SVector<S::Scalar, U>,
    pub(super) by_multiplier: SMatrix<S::Scalar, U, D>,
    pub(super) trial: Trial<S::Place, S::Scalar, U, C>,
    /// The input before the solution began, given back after an error.
    pub(super) guess: SVector<S::Scalar, U>,
}

/// What a roll-out proposes for a stage.
#[derive(Clone, Copy)]
pub(super) struct Trial<X, T, const U: usize, const C: usize> {
    pub place: X,
    pub input: SVector<T, U>,
    pub slack: SVector<T, C>,
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Stage<S, D, U, C> {
    /// The step from `x` without input.
    pub(super) fn rest(x: &S::Place) -> Self {
        let zero = S::Scalar::zero();
        let (input, bounds) = (SVector::from_element(zero), SVector::from_element(zero));
        Self {
            place: *x,
            input,
            costate: SVector::from_element(zero),
            next_costate: SVector::from_element(zero),
            gain: SMatrix::from_element(zero),
            multipliers: bounds,
            slack: bounds,
            excess: bounds,
            shift: input,
            by_multiplier: SMatrix::from_element(zero),
            trial: Trial { place: *x, input, slack: bounds },
            guess: input,
        }
    }

    /// The same with this input, as a guess.
    #[inline]
    #[must_use]
    pub fn with_input(self, input: SVector<S::Scalar, U>) -> Self {
        Self { input, ..self }
    }

    /// Goes back to the input of the guess, without multipliers.
    pub(super) fn forget(&mut self) {
        *self = Self { input: self.guess, guess: self.guess, ..Self::rest(&self.place) };
    }

    /// Σ a/s of the bounds that are violated, and the weights 1/s of those.
    pub(super) fn violation(&self) -> (S::Scalar, SVector<S::Scalar, C>) {
        let mut sum = S::Scalar::zero();
        let weights = SVector::from_fn(|i, _| {
            let (slack, violation) = (self.slack[i], self.excess[i] - self.slack[i]);
            if violation > S::Scalar::zero() {
                sum += violation / slack;
                slack.recip()
            } else {
                S::Scalar::zero()
            }
        });
        (sum, weights)
    }

    /// The place x_k where the step starts.
    #[inline]
    pub fn place(&self) -> &S::Place {
        &self.place
    }

    /// The input u_k of the step from x_k to x_{k+1}.
    #[inline]
    pub fn input(&self) -> &SVector<S::Scalar, U> {
        &self.input
    }

    /// The costate p_k = ∂V/∂x at x_k, V the least price from there on: a covector of the small changes of x_k.
    #[inline]
    pub fn costate(&self) -> &SVector<S::Scalar, D> {
        &self.costate
    }

    /// The matrix K of optimal feedback: where x_k is found changed by δ, the optimal plan from there to the same target begins with
    /// u_k + Kδ + O(δ²). Near the end, where not all of the target can be reached any more, what can be is.
    ///
    /// Shape U×D.
    #[inline]
    pub fn gain(&self) -> &SMatrix<S::Scalar, U, D> {
        &self.gain
    }

    /// The multipliers z ≥ 0 of the bounds a ≤ 0: by how much the least price falls where a bound is relaxed by one unit.
    #[inline]
    pub fn multipliers(&self) -> &SVector<S::Scalar, C> {
        &self.multipliers
    }

    /// Which bounds hold the inputs back: those whose multiplier is larger than what separates them from being reached.
    #[inline]
    pub fn active(&self) -> [bool; C] {
        core::array::from_fn(|i| self.multipliers[i] > self.slack[i])
    }
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Copy for Stage<S, D, U, C> {}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Clone for Stage<S, D, U, C> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Debug for Stage<S, D, U, C> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Stage")
            .field("place", &self.place)
            .field("input", &self.input)
            .field("costate", &self.costate)
            .field("gain", &self.gain)
            .field("multipliers", &self.multipliers)
            .finish_non_exhaustive()
    }
}
