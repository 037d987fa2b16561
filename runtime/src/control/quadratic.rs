//! The quadratic model of one step in the backward sweep, and its elimination.

use super::pivot::{Fall, Pivot};
use crate::newton::Curvature;
use crate::{BoundsExpansion, EndpointExpansion, Expansion, Real};
use nalgebra::{SMatrix, SVector};

/// The price of a step and of all that follow, to second order in δ and δu: gradient and Hessian.
pub(super) struct Quadratic<T, const D: usize, const U: usize> {
    pub by_place: SVector<T, D>,
    pub by_input: SVector<T, U>,
    place: SMatrix<T, D, D>,
    mixed: SMatrix<T, U, D>,
    input: SMatrix<T, U, U>,
    /// The part of it that is of this step alone.
    own: SMatrix<T, U, U>,
    /// Where there are bounds: the diagonal of that part without them.
    unbounded: Option<SVector<T, U>>,
    /// Q_xν, Q_uν
    place_multiplier: SMatrix<T, D, D>,
    pub input_multiplier: SMatrix<T, U, D>,
    /// The slopes of what violates bounds.
    violation_by_place: SVector<T, D>,
    violation_by_input: SVector<T, U>,
}

/// The least price from a place on, to second order in δ and δν.
pub(super) struct Value<T, const D: usize> {
    /// p = ∂V/∂x
    pub costate: SVector<T, D>,
    /// P = ∂²V/∂x²
    pub hessian: SMatrix<T, D, D>,
    /// Ψ = ∂²V/∂x∂ν
    pub by_multiplier: SMatrix<T, D, D>,
    /// The slope of what violates bounds from the place on.
    pub violation: SVector<T, D>,
}

/// δu = k + K δ + G δν
pub(super) struct Policy<T, const D: usize, const U: usize> {
    pub shift: SVector<T, U>,
    pub gain: SMatrix<T, U, D>,
    pub by_multiplier: SMatrix<T, U, D>,
    /// The number of negative eigenvalues of Q_uu.
    pub negative: usize,
    pub fall: Option<Fall<T, U>>,
    /// g·Q_uu⁻¹g with the slope g of what violates bounds.
    pub yielding: T,
}

impl<T: Real, const D: usize> Value<T, D> {
    /// φ + ν·(Eδ − e) + ½ (Eδ − e)·R(Eδ − e)
    pub fn of_end(
        endpoint: &EndpointExpansion<T, D>,
        end: &super::end::PlanEnd<T, D>,
        multipliers: &SVector<T, D>,
        weight: &SMatrix<T, D, D>,
    ) -> Self {
        let force = multipliers - weight * end.lack;
        Self {
            costate: endpoint.slope + end.slope.tr_mul(&force),
            hessian: endpoint.curvature + end.slope.tr_mul(&(weight * end.slope)),
            by_multiplier: end.slope.transpose(),
            violation: SVector::from_element(T::zero()),
        }
    }
}

impl<T: Real, const D: usize> Value<T, D> {
    /// φ + ½ w d² with the squared distance d² to the target, for configurations and for momenta.
    pub fn of_priced_end(
        endpoint: &EndpointExpansion<T, D>,
        end: &super::end::PlanEnd<T, D>,
        motions: usize,
        [by_motion, by_momentum]: [T; 2],
    ) -> Self {
        let price = |i: usize| if i < motions { by_motion } else { by_momentum };
        Self {
            costate: SVector::from_fn(|i, _| endpoint.slope[i] - price(i) * end.pull[i]),
            hessian: endpoint.curvature + SMatrix::from_fn(|i, j| price(i) * end.metric[(i, j)]),
            by_multiplier: end.slope.transpose(),
            violation: SVector::from_element(T::zero()),
        }
    }
}

impl<T: Real, const D: usize, const U: usize> Quadratic<T, D, U> {
    /// Of one step, before the value of what follows.
    #[inline]
    pub fn of_step<X>(step: &Expansion<X, T, D, U>) -> Self {
        Self {
            by_place: step.price_by_place,
            by_input: step.price_by_input,
            place: step.place_curvature,
            mixed: step.mixed_curvature,
            input: step.input_curvature,
            own: step.input_curvature,
            unbounded: None,
            place_multiplier: SMatrix::from_element(T::zero()),
            input_multiplier: SMatrix::from_element(T::zero()),
            violation_by_place: SVector::from_element(T::zero()),
            violation_by_input: SVector::from_element(T::zero()),
        }
    }

    /// Adds ζ·a + ½ Σ (aδ)² with the curvature of z·a: `force` is ζ and `stiffness` the diagonal Σ. What violates bounds has these `weights`.
    #[inline]
    pub fn add_bounds<const C: usize>(
        &mut self,
        bounds: &BoundsExpansion<T, D, U, C>,
        force: &SVector<T, C>,
        stiffness: &SVector<T, C>,
        weights: &SVector<T, C>,
    ) {
        self.unbounded = Some(self.input.diagonal());
        let by_place = SMatrix::<T, C, D>::from_fn(|i, j| stiffness[i] * bounds.by_place[(i, j)]);
        let by_input = SMatrix::<T, C, U>::from_fn(|i, j| stiffness[i] * bounds.by_input[(i, j)]);
        self.by_place += bounds.by_place.tr_mul(force);
        self.by_input += bounds.by_input.tr_mul(force);
        self.violation_by_place = bounds.by_place.tr_mul(weights);
        self.violation_by_input = bounds.by_input.tr_mul(weights);
        self.place += bounds.place_curvature + bounds.by_place.tr_mul(&by_place);
        self.mixed += bounds.mixed_curvature + bounds.by_input.tr_mul(&by_place);
        self.input += bounds.input_curvature + bounds.by_input.tr_mul(&by_input);
    }

    /// Adds the value of what follows at A δ + B δu.
    #[inline]
    pub fn add_value<X>(&mut self, step: &Expansion<X, T, D, U>, next: &Value<T, D>) {
        let (a, b) = (&step.by_place, &step.by_input);
        self.by_place += a.tr_mul(&next.costate);
        self.by_input += b.tr_mul(&next.costate);
        self.violation_by_place += a.tr_mul(&next.violation);
        self.violation_by_input += b.tr_mul(&next.violation);
        self.own = self.input;
        let (along, across) = (next.hessian * a, next.hessian * b);
        self.place += a.tr_mul(&along);
        self.mixed += b.tr_mul(&along);
        self.input += b.tr_mul(&across);
        self.place_multiplier = a.tr_mul(&next.by_multiplier);
        self.input_multiplier = b.tr_mul(&next.by_multiplier);
    }

    /// How deep the price curves down in a direction, relative to the curvature of the step alone.
    pub fn depth(&self, fall: &Fall<T, U>) -> T {
        -fall.curvature / fall.direction.dot(&(self.own * fall.direction))
    }

    /// How much the price curves along each input, of which steadiness is a part.
    ///
    /// Bounds that are reached, of this step and, through P, of later places, stiffen Q_uu by Σ = z²/μ, up to 10¹² times what the price
    /// does. A part √ε of that would hold what is free beside them: each correction would make a part 10⁻⁴ of the way to a bound that is
    /// reached with the multiplier 0. Hence, where there are bounds, the step alone tells, as interior point methods shift the Hessian of
    /// the Lagrangian by what has nothing to do with Σ. Inputs that the step does not price are left as they are.
    #[inline]
    fn natural(&self) -> SVector<T, U> {
        self.unbounded.unwrap_or_else(|| self.input.diagonal())
    }

    /// The input that makes the model least, and the value that is left.
    #[inline]
    pub fn eliminate(&self, curvature: Curvature<T>) -> (Policy<T, D, U>, Value<T, D>) {
        let pivot = Pivot::of(&self.input, &self.natural(), curvature);
        let shift = pivot.against(&self.by_input);
        let gain = pivot.against(&self.mixed);
        let by_multiplier = pivot.against(&self.input_multiplier);
        let yielding = -self.violation_by_input.dot(&pivot.against(&self.violation_by_input));
        let half = T::from_ratio(1, 2);
        let hessian = self.place + self.mixed.tr_mul(&gain);
        let value = Value {
            costate: self.by_place + self.mixed.tr_mul(&shift),
            hessian: SMatrix::from_fn(|i, j| (hessian[(i, j)] + hessian[(j, i)]) * half),
            by_multiplier: self.place_multiplier + gain.tr_mul(&self.input_multiplier),
            violation: self.violation_by_place + gain.tr_mul(&self.violation_by_input),
        };
        (Policy { shift, gain, by_multiplier, negative: pivot.negative, fall: pivot.fall, yielding }, value)
    }
}
