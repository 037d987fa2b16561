//! The start of a plan: a given place, or one that is found as the inputs are, near a prior place.
//!
//! Let the start have the price φ₀. With the value V of all steps, the least price over the start has this model.
//! ```text
//! φ₀(δ) + V(δ, δν),    δ₀ = k + Gδν = −(∂²φ₀ + P)⁻¹ (∂φ₀ + p + Ψδν)
//! ```
//! So δ₀ is a further input before the first step. Its pivot belongs to the inertia, and to Γ = Σ Q_uνᵀ Q_uu⁻¹ Q_uν.
//!
//! Sources: Rao, Rawlings and Mayne, *Constrained state estimation for nonlinear discrete-time systems* (2003), for arrival costs.
//! Bryson and Ho, *Applied Optimal Control* (1975), chapter 13, for smoothing.

use super::end::sizes;
use super::lift::Gap;
use super::quadratic::{Pivot, Value, rounding};
use super::sweep::{PlanSummary, Settings, positive};
use crate::fields::getters;
use crate::linear::rows;
use crate::newton::{Ldl, Spectrum};
use crate::parameters::{check_finite, check_symmetric};
use crate::space::larger;
use crate::{Controlled, Error, Real, Scalar, Space};
use core::fmt::Debug;
use nalgebra::{SMatrix, SVector};

/// The start of the plans of a [`Control`](crate::Control): [`Known`], or unknown with a [`Prior`].
///
/// ```
/// use clebsch::{Control, Controlled, Real, Start};
///
/// /// The step size, wherever plans start.
/// fn pace<S: Controlled<2, 1, 0, Scalar: Real>, B: Start<S, 2, 1, 0>>(control: &Control<S, 2, 1, 0, B>) -> S::Scalar {
///     control.step_size()
/// }
/// ```
pub trait Start<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize>:
    Beginning<S, D, U, C>
{
}

/// The functions of a start that sweeps and roll-outs call.
pub trait Beginning<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize>:
    Clone + Debug
{
    /// The correction of the start: k and G.
    type Correction: Copy + Debug;

    /// No correction.
    fn none() -> Self::Correction;

    /// φ₀
    fn price(&self, system: &S, x: &S::Place) -> S::Scalar;

    /// Eliminates the start, after all steps, for changes of these lengths.
    fn eliminate(
        &self,
        system: &S,
        lengths: &SVector<S::Scalar, D>,
        x: &S::Place,
        value: &Value<S::Scalar, D>,
        settings: &Settings<S::Scalar, D>,
        summary: &mut PlanSummary<S::Scalar, D, U>,
    ) -> Self::Correction;

    /// δ₀ for a change δν of the multipliers of the target; `None` where the start is given.
    fn change(correction: &Self::Correction, multipliers: &SVector<S::Scalar, D>) -> Option<SVector<S::Scalar, D>>;
}

/// Plans start at the place that [`Control::solve`](crate::Control::solve) is given.
///
/// ```
/// use clebsch::{Control, Known};
/// # use clebsch::{Clebsch, Controlled};
/// # use nalgebra::Vector2;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
/// #     cost     = |h, u| h * u.norm_squared() / 2,
/// # )]
/// # struct Cart {}
/// let control: Control<Cart, 2, 1, 0, Known> = Cart {}.control(0.1)?;
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Known;

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Start<S, D, U, C> for Known {}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Beginning<S, D, U, C>
    for Known
{
    type Correction = ();

    #[inline(always)]
    fn none() {}

    #[inline(always)]
    fn price(&self, _: &S, _: &S::Place) -> S::Scalar {
        S::Scalar::from_f64(0.0)
    }

    #[inline(always)]
    fn eliminate(
        &self,
        _: &S,
        _: &SVector<S::Scalar, D>,
        _: &S::Place,
        _: &Value<S::Scalar, D>,
        _: &Settings<S::Scalar, D>,
        _: &mut PlanSummary<S::Scalar, D, U>,
    ) {
    }

    #[inline(always)]
    fn change((): &(), _: &SVector<S::Scalar, D>) -> Option<SVector<S::Scalar, D>> {
        None
    }
}

/// The price of the place at which a plan starts, where that place is unknown.
/// ```text
/// φ₀(x) = g·δ + ½ δ·Λδ    with the small change δ that moves the prior place x̄ to x
/// ```
/// Λ is the information matrix: where prices are −ln of probability densities, Λ⁻¹ is the covariance of the start. Small changes are
/// those of [`Controlled`], and δ is [`Controlled::displacement`].
///
/// ```
/// # use clebsch::{Clebsch, Controlled, Prior, Target};
/// # use nalgebra::{Matrix2, Vector1, Vector2};
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     dynamics = |h, x: Vector2, push: Vector1| x + h * vector![x.y, push.x],
///     cost     = |x, push, seen: Vector1| (x.x - seen.x).powi(2) / 2 + self.calm * push.norm_squared() / 2,
/// )]
/// struct Cart { calm: f64 }
///
/// // a cart is somewhere near 0, with a speed that nobody knows, and is seen at 1 m and 1.1 m
/// let control = Cart { calm: 1.0 }.control(0.1)?;
/// let control = control.with_prior(Prior::new(Vector2::zeros(), Matrix2::new(1e-6, 0.0, 0.0, 0.0)))?;
/// let mut plan = [control.stage(&Vector2::zeros()); 2];
/// control.refer(&mut plan, |k, _| Vector1::new([1.0, 1.1][k]));
/// let estimate = control.solve(&Vector2::zeros(), Target::Free, &mut plan)?;
/// let start = estimate.stages()[0].place();
/// assert!((start - Vector2::new(1.0, 1.0)).norm() < 1e-3);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior<X, T, const D: usize> {
    pub(super) place: X,
    pub(super) slope: SVector<T, D>,
    pub(super) information: SMatrix<T, D, D>,
}

impl<X: Copy, T: Real, const D: usize> Prior<X, T, D> {
    /// A start near `place`, with this information Λ in 1/δ². It is symmetric, and has no negative eigenvalue.
    pub fn new(place: X, information: SMatrix<T, D, D>) -> Self {
        Self { place, slope: SVector::from_element(T::zero()), information }
    }

    /// A start at any place: Λ = 0.
    pub fn unknown(place: X) -> Self {
        Self::new(place, SMatrix::from_element(T::zero()))
    }

    /// The same with the slope g of the price at the prior place.
    #[must_use]
    pub fn with_slope(self, slope: SVector<T, D>) -> Self {
        Self { slope, ..self }
    }

    getters! {
        /// The prior place x̄.
        ref place: X;
        /// g
        ref slope: SVector<T, D>;
        /// Λ
        ref information: SMatrix<T, D, D>;
    }

    /// Λ⁻¹; `None` where nothing is known of some change.
    pub fn covariance(&self) -> Option<SMatrix<T, D, D>> {
        inverse(&self.information)
    }

    /// Finite, symmetric, and without a negative eigenvalue but for round-off.
    pub(super) fn check(&self) -> Result<(), Error> {
        let name = "the information of the prior";
        check_finite(name, &self.information)?;
        check_finite("the slope of the prior", &self.slope)?;
        check_symmetric(name, &self.information)?;
        let spectrum = Spectrum::of(&self.information);
        let least = spectrum.values.iter().fold(T::zero(), |least, value| if *value < least { *value } else { least });
        if least < -T::from_f64(1024.0) * T::EPSILON * spectrum.largest() {
            return Err(Error::NegativeInformation { eigenvalue: least.to_f64() });
        }
        Ok(())
    }
}

/// The inverse of a positive definite matrix.
pub(super) fn inverse<T: Real, const D: usize>(matrix: &SMatrix<T, D, D>) -> Option<SMatrix<T, D, D>> {
    let root = Ldl::positive(&rows(matrix))?.inverse_root();
    let root = SMatrix::<T, D, D>::from_fn(|i, j| root[i][j]);
    Some(root.tr_mul(&root))
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Start<S, D, U, C>
    for Prior<S::Place, T, D>
{
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Beginning<S, D, U, C>
    for Prior<S::Place, T, D>
{
    type Correction = (SVector<T, D>, SMatrix<T, D, D>);

    fn none() -> Self::Correction {
        (SVector::from_element(T::zero()), SMatrix::from_element(T::zero()))
    }

    fn price(&self, system: &S, x: &S::Place) -> T {
        let change = system.displacement(&self.place, x);
        change.dot(&(self.slope + self.information * change * T::from_ratio(1, 2)))
    }

    fn eliminate(
        &self,
        system: &S,
        lengths: &SVector<T, D>,
        x: &S::Place,
        value: &Value<T, D>,
        settings: &Settings<T, D>,
        summary: &mut PlanSummary<T, D, U>,
    ) -> Self::Correction {
        let price = self.price(system, x);
        let [force, slope] = self.slopes(system, x);
        let straight = value.hessian + self.curvature(system, x);
        let pivot = |hessian: &SMatrix<T, D, D>| Pivot::of(hessian, &hessian.diagonal(), settings.curvature);
        let mut at = match settings.is_straight {
            true => pivot(&straight),
            false => pivot(&(straight + self.bend(system, x, &force))),
        };
        if settings.is_guarded() && at.negative() > 0 {
            at = pivot(&straight);
            summary.straightened += 1;
        }
        if settings.is_guarded() && at.negative() > 0 {
            at = pivot(&positive(&straight, lengths));
        }
        let gradient = slope + value.costate;
        let (shift, by_multiplier) = (at.against(&gradient), at.against(&value.by_multiplier));
        summary.price += price;
        summary.magnitude += price.abs();
        summary.descent -= gradient.dot(&shift);
        summary.residual = larger(summary.residual, gradient.max_abs());
        summary.lack += value.by_multiplier.tr_mul(&shift);
        summary.gramian -= value.by_multiplier.tr_mul(&by_multiplier);
        summary.negative += at.negative();
        summary.yielding -= value.violation.dot(&at.against(&value.violation));
        if settings.is_last {
            let sizes = sizes::<S, D, U, C>(x, lengths);
            let terms = |i: usize| {
                let moved = (0..D).fold(T::zero(), |sum, j| sum + value.hessian[(i, j)].abs() * sizes[j]);
                slope[i].abs() + value.costate[i].abs() + rounding::<T>() * moved
            };
            summary.terms = (0..D).fold(summary.terms, |most, i| larger(most, terms(i)));
        }
        (shift, by_multiplier)
    }

    #[inline]
    fn change((shift, by_multiplier): &Self::Correction, multipliers: &SVector<T, D>) -> Option<SVector<T, D>> {
        Some(shift + by_multiplier * multipliers)
    }
}

impl<X: Space<T>, T: Real, const D: usize> Prior<X, T, D> {
    /// g + Λδ, and the slope of φ₀ at x.
    fn slopes<S, const U: usize, const C: usize>(&self, system: &S, x: &X) -> [SVector<T, D>; 2]
    where
        S: Controlled<D, U, C, Scalar = T, Place = X>,
    {
        let Gap { change, transport } = Gap::of(system, &self.place, x);
        let force = self.slope + self.information * change;
        [force, transport.tr_mul(&force)]
    }

    /// The curvature of φ₀ at x, without that of δ.
    pub(super) fn curvature<S, const U: usize, const C: usize>(&self, system: &S, x: &X) -> SMatrix<T, D, D>
    where
        S: Controlled<D, U, C, Scalar = T, Place = X>,
    {
        let Gap { transport, .. } = Gap::of(system, &self.place, x);
        transport.tr_mul(&(self.information * transport))
    }

    /// The curvature of f·δ at x, by central differences of its slope. It counts for how fast corrections shrink, not for where they end.
    fn bend<S, const U: usize, const C: usize>(&self, system: &S, x: &X, force: &SVector<T, D>) -> SMatrix<T, D, D>
    where
        S: Controlled<D, U, C, Scalar = T, Place = X>,
    {
        let part = T::EPSILON.powf(T::from_ratio(1, 3));
        let slope = |size: T, i: usize| {
            let motion = SVector::<T, D>::from_fn(|j, _| if i == j { size } else { T::zero() });
            Gap::of(system, &self.place, &system.moved(x, &motion)).transport.tr_mul(force)
        };
        let mut bend = SMatrix::<T, D, D>::from_element(T::zero());
        for (i, mut column) in bend.column_iter_mut().enumerate() {
            column.copy_from(&((slope(part, i) - slope(-part, i)) / (part + part)));
        }
        let bend: SMatrix<T, D, D> = (bend + bend.transpose()) * T::from_ratio(1, 2);
        if bend.all_finite() { bend } else { SMatrix::from_element(T::zero()) }
    }
}
