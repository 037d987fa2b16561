//! The quadratic model of one step in the backward sweep, and its elimination.

use super::end::PlanEnd;
use super::sweep::Settings;
use crate::linear::rows;
use crate::newton::{Curvature, Equilibrated, Ldl, UNITS};
use crate::space::larger;
use crate::{EndpointExpansion, Expansion, Real};
use nalgebra::{SMatrix, SVector};

/// The price of a step and of all that follow, to second order in δ and δu: gradient and Hessian.
pub(super) struct Quadratic<T, const D: usize, const U: usize> {
    pub by_place: SVector<T, D>,
    pub by_input: SVector<T, U>,
    place: SMatrix<T, D, D>,
    mixed: SMatrix<T, U, D>,
    input: SMatrix<T, U, U>,
    /// The part of it that is of this step alone.
    pub own: SMatrix<T, U, U>,
    /// How much the price curves along each input, of which steadiness is a part.
    ///
    /// Bounds that are reached, of this step and, through P, of later places, stiffen Q_uu by Σ = z²/μ, up to 10¹² times what the price
    /// does. A part √ε of that would hold what is free beside them: each correction would make a part 10⁻⁴ of the way to a bound that is
    /// reached with the multiplier 0. Hence, where there are bounds, the step alone tells, as interior point methods shift the Hessian of
    /// the Lagrangian by what has nothing to do with Σ. Inputs that the step does not price are left as they are.
    natural: SVector<T, U>,
    /// Q_xν, Q_uν
    place_multiplier: SMatrix<T, D, D>,
    pub input_multiplier: SMatrix<T, U, D>,
    /// The slopes of what violates bounds, by place and by input.
    violation: Slopes<T, D, U>,
}

/// Those of a function of place and input.
pub(super) type Slopes<T, const D: usize, const U: usize> = (SVector<T, D>, SVector<T, U>);

/// The least price from a place on, to second order in δ and δν.
pub(super) struct Value<T, const D: usize> {
    /// p = ∂V/∂x
    pub costate: SVector<T, D>,
    /// P = ∂²V/∂x²
    pub hessian: SMatrix<T, D, D>,
    /// Ψ = ∂²V/∂x∂ν
    pub by_multiplier: SMatrix<T, D, D>,
    /// The slope of what violates bounds from the place on.
    violation: SVector<T, D>,
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
    /// φ + ν·(Eδ − e) + ½ (Eδ − e)·R(Eδ − e), or φ + ½ w d² where the squared distance d² to the target has the price w.
    pub fn of_end(endpoint: &EndpointExpansion<T, D>, end: &PlanEnd<T, D>, settings: &Settings<T, D>) -> Self {
        let (force, stiffness) = match settings.gap_price {
            Some(price) => (-price.component_mul(&end.pull), SMatrix::from_fn(|i, j| price[i] * end.metric[(i, j)])),
            None => {
                let force = settings.multipliers - settings.weight * end.lack;
                (end.slope.tr_mul(&force), end.slope.tr_mul(&(settings.weight * end.slope)))
            }
        };
        Self {
            costate: endpoint.slope + force,
            hessian: endpoint.curvature + stiffness,
            by_multiplier: end.slope.transpose(),
            violation: SVector::from_element(T::zero()),
        }
    }
}

impl<T: Real, const D: usize, const U: usize> Quadratic<T, D, U> {
    /// Of a step with its bounds, and the value of what follows at A δ + B δu.
    #[inline]
    pub fn of<X>(
        step: &Expansion<X, T, D, U>,
        natural: Option<SVector<T, U>>,
        violation: &Slopes<T, D, U>,
        next: &Value<T, D>,
    ) -> Self {
        let (a, b) = (&step.by_place, &step.by_input);
        let along = next.hessian * a;
        let across = next.hessian * b;
        let input = step.input_curvature + b.tr_mul(&across);
        Self {
            by_place: step.price_by_place + a.tr_mul(&next.costate),
            by_input: step.price_by_input + b.tr_mul(&next.costate),
            place: step.place_curvature + a.tr_mul(&along),
            mixed: step.mixed_curvature + b.tr_mul(&along),
            input,
            own: step.input_curvature,
            natural: natural.unwrap_or_else(|| input.diagonal()),
            place_multiplier: a.tr_mul(&next.by_multiplier),
            input_multiplier: b.tr_mul(&next.by_multiplier),
            violation: (violation.0 + a.tr_mul(&next.violation), violation.1 + b.tr_mul(&next.violation)),
        }
    }

    /// The input that makes the model least, and the value that is left.
    #[inline]
    pub fn eliminate(&self, curvature: Curvature<T>) -> (Policy<T, D, U>, Value<T, D>) {
        let pivot = Pivot::of(&self.input, &self.natural, curvature);
        let shift = pivot.against(&self.by_input);
        let gain = pivot.against(&self.mixed);
        let by_multiplier = pivot.against(&self.input_multiplier);
        let yielding = -self.violation.1.dot(&pivot.against(&self.violation.1));
        let half = T::from_ratio(1, 2);
        let hessian = self.place + self.mixed.tr_mul(&gain);
        let value = Value {
            costate: self.by_place + self.mixed.tr_mul(&shift),
            hessian: SMatrix::from_fn(|i, j| (hessian[(i, j)] + hessian[(j, i)]) * half),
            by_multiplier: self.place_multiplier + gain.tr_mul(&self.input_multiplier),
            violation: self.violation.0 + gain.tr_mul(&self.violation.1),
        };
        (Policy { shift, gain, by_multiplier, negative: pivot.negative, fall: pivot.fall, yielding }, value)
    }
}

/// The inverse of a Hessian.
struct Pivot<T, const U: usize> {
    factors: Factors<T, U>,
    /// The number of negative eigenvalues.
    negative: usize,
    /// The direction of the most negative one.
    fall: Option<Fall<T, U>>,
}

/// A direction δu of an input in which the price curves down.
#[derive(Clone, Copy)]
pub(super) struct Fall<T, const U: usize> {
    pub stage: usize,
    pub direction: SVector<T, U>,
    /// δuᵀ Q_uu δu < 0
    pub curvature: T,
    /// How deep it is, relative to the curvature of all steps alone. Along a symmetry it is no deeper than what a correction changes.
    pub depth: T,
}

enum Factors<T, const U: usize> {
    Triangular(Ldl<T, U>),
    /// The inverse itself.
    Spectral(SMatrix<T, U, U>),
}

impl<T: Real, const U: usize> Pivot<T, U> {
    /// Of a symmetric matrix, of which only the lower triangle is read, where the price itself curves by `natural` along each input.
    #[inline]
    pub fn of(h: &SMatrix<T, U, U>, natural: &SVector<T, U>, curvature: Curvature<T>) -> Self {
        let mut h = *h;
        let Curvature { damping, steadiness, .. } = curvature;
        if larger(damping, steadiness) > T::zero() {
            for i in 0..U {
                let entry = h[(i, i)];
                h[(i, i)] = entry + larger(damping * entry.abs(), steadiness * natural[i].abs());
            }
        }
        match Ldl::positive(&rows(&h)) {
            Some(factors) => Self { factors: Factors::Triangular(factors), negative: 0, fall: None },
            None => spectral(&h, curvature),
        }
    }

    /// −H⁻¹B
    #[inline]
    pub fn against<const K: usize>(&self, b: &SMatrix<T, U, K>) -> SMatrix<T, U, K> {
        match &self.factors {
            Factors::Triangular(factors) => {
                let mut w = rows(&-b);
                factors.forward(&mut w);
                let mut x = factors.divided(&w);
                factors.backward(&mut x);
                SMatrix::from_fn(|i, j| x[i][j])
            }
            Factors::Spectral(inverse) => -(inverse * b),
        }
    }
}

/// From the eigenvalues of the matrix with its diagonal scaled to ±1. Directions without any curvature are left alone.
#[cold]
fn spectral<T: Real, const U: usize>(h: &SMatrix<T, U, U>, curvature: Curvature<T>) -> Pivot<T, U> {
    let scaled = Equilibrated::of(h);
    let Equilibrated { spectrum, scale } = &scaled;
    let largest = spectrum.largest();
    let noise = T::from_f64(UNITS) * T::EPSILON * largest;
    let inverse = scaled.map(|value| {
        // Written so that NaN stays NaN.
        if value.abs() <= noise && !curvature.is_mirrored || largest == T::zero() {
            T::zero()
        } else if !curvature.is_mirrored || value > noise {
            value.recip()
        } else {
            spectrum.turned_over(value).recip()
        }
    });
    let wrong = -T::EPSILON.sqrt() * largest;
    let negative = spectrum.values.iter().filter(|&&value| value < wrong).count();
    let least = (0..U).fold(0, |least, i| if spectrum.values[i] < spectrum.values[least] { i } else { least });
    let fall = (negative > 0).then(|| Fall {
        stage: 0,
        direction: SVector::from_fn(|i, _| scale[i] * spectrum.vectors[(i, least)]),
        curvature: spectrum.values[least],
        depth: T::zero(),
    });
    Pivot { factors: Factors::Spectral(inverse), negative, fall }
}
