//! The quadratic model of one step in the backward sweep, and its elimination.

use super::Stage;
use super::end::PlanEnd;
use super::lift::Gap;
use super::sweep::Settings;
use crate::linear::rows;
use crate::newton::{Curvature, Equilibrated, Ldl, UNITS};
use crate::space::larger;
use crate::{Controlled, EndpointExpansion, Expansion, Real, Space};
use nalgebra::{SMatrix, SVector};

/// Units in the last place that rounding leaves of a residual.
const ROUNDING: f64 = 1024.0;

/// The round-off of a residual as a part of |H| |x|, by √ε, as residuals are compared with √ε of their terms.
pub(super) fn rounding<T: Real>() -> T {
    T::from_f64(ROUNDING) * T::EPSILON.sqrt()
}

/// The slopes of a function of place and input.
pub(super) type Slopes<T, const D: usize, const U: usize> = (SVector<T, D>, SVector<T, U>);

/// The bounds of a step in its quadratic model.
pub(super) struct Bounded<T, const D: usize, const U: usize> {
    /// The curvature of the price of the step alone, along each input.
    pub natural: SVector<T, U>,
    /// The slopes of the violation of bounds.
    pub slopes: Slopes<T, D, U>,
    /// Σ a/s of the bounds that are violated.
    pub violated: T,
}

/// The least price from a place on, to second order in δ and δν.
pub struct Value<T, const D: usize> {
    /// p = ∂V/∂x
    pub costate: SVector<T, D>,
    /// P = ∂²V/∂x²
    pub hessian: SMatrix<T, D, D>,
    /// Ψ = ∂²V/∂x∂ν
    pub by_multiplier: SMatrix<T, D, D>,
    /// The slope of the violation of bounds, along the place.
    pub violation: SVector<T, D>,
}

/// δu = k + K δ + G δν, which makes the quadratic model of a step and of all that follow least.
pub(super) struct Policy<T, const D: usize, const U: usize> {
    pub shift: SVector<T, U>,
    pub gain: SMatrix<T, U, D>,
    pub by_multiplier: SMatrix<T, U, D>,
    /// Q_x and Q_u
    pub gradient: Slopes<T, D, U>,
    /// Q_uν
    pub input_multiplier: SMatrix<T, U, D>,
    /// The number of negative eigenvalues of Q_uu.
    pub negative: usize,
    pub fall: Option<Fall<T, U>>,
    /// g·Q_uu⁻¹g with the slope g of the violation of bounds.
    pub yielding: T,
}

impl<T: Real, const D: usize> Value<T, D> {
    /// φ + ν·(Eδ − e) + ½ (Eδ − e)·R(Eδ − e), or φ + ½ w d² where the squared distance d² to the target has the price w.
    pub(super) fn of_end(endpoint: &EndpointExpansion<T, D>, end: &PlanEnd<T, D>, settings: &Settings<T, D>) -> Self {
        let (force, stiffness) = match settings.gap_price {
            Some(price) => (-price.component_mul(&end.pull), SMatrix::from_fn(|i, j| price[i] * end.metric[(i, j)])),
            None => {
                let force = settings.multipliers - settings.weight * end.lack;
                (end.all_slopes.tr_mul(&force), end.slope.tr_mul(&(settings.weight * end.slope)))
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

impl<T: Real, const D: usize> Value<T, D> {
    /// ½ δ·Pδ
    pub(super) fn of_hessian(hessian: &SMatrix<T, D, D>) -> Self {
        let (zero, zeros) = (SVector::from_element(T::zero()), SMatrix::from_element(T::zero()));
        Self { costate: zero, hessian: *hessian, by_multiplier: zeros, violation: zero }
    }

    /// The value at c + M δ becomes that at δ. Returns Ψᵀc, the part of c in V_ν.
    pub(super) fn cross(&mut self, Gap { change, transport }: &Gap<T, D>) -> SVector<T, D> {
        let lack = self.by_multiplier.tr_mul(change);
        self.costate = transport.tr_mul(&(self.costate + self.hessian * change));
        self.hessian = transport.tr_mul(&(self.hessian * transport));
        self.by_multiplier = transport.tr_mul(&self.by_multiplier);
        self.violation = transport.tr_mul(&self.violation);
        lack
    }

    /// Leaves out the curvature along changes that a constraint forbids: no plan makes them, and convex it need not be there.
    #[cold]
    pub(super) fn restrict(&mut self, tangent: &SMatrix<T, D, D>) {
        self.hessian = tangent.tr_mul(&(self.hessian * tangent));
    }

    /// Whether P is positive semidefinite, but for parts √ε of its diagonal, for changes of these lengths.
    pub fn is_convex(&self, lengths: &SVector<T, D>) -> bool {
        let squares = lengths.component_mul(lengths);
        let largest = self.hessian.diagonal().component_div(&squares).max_abs();
        let mut shifted = self.hessian;
        for i in 0..D {
            let entry = shifted[(i, i)];
            shifted[(i, i)] = entry + T::EPSILON.sqrt() * entry.abs() + T::EPSILON * largest * squares[i];
        }
        largest == T::zero() || Ldl::positive(&rows(&shifted)).is_some()
    }
}

impl<T: Real, const D: usize, const U: usize> Policy<T, D, U> {
    /// For a step with its bounds and the value at A δ + B δu of all later steps; with the value before the step. If
    /// there are bounds, `bounded` has their part in it.
    #[inline]
    pub fn of<X>(
        step: &Expansion<X, T, D, U>,
        bounded: Option<Bounded<T, D, U>>,
        next: &Value<T, D>,
        curvature: Curvature<T>,
    ) -> (Self, Value<T, D>) {
        let (a, b) = (&step.by_place, &step.by_input);
        let by_place = step.price_by_place + a.tr_mul(&next.costate);
        let by_input = step.price_by_input + b.tr_mul(&next.costate);
        let along = next.hessian * a;
        let across = next.hessian * b;
        let place = step.place_curvature + a.tr_mul(&along);
        let mixed = step.mixed_curvature + b.tr_mul(&along);
        let input = step.input_curvature + b.tr_mul(&across);
        let input_multiplier = b.tr_mul(&next.by_multiplier);
        // How much the price curves along each input; the steadiness is a part of this. Bounds that are reached, of
        // this step and, through P, of later places, stiffen Q_uu by Σ = z²/μ. This is up to 10¹² times the stiffness
        // of the price. A part √ε of that would stop the free inputs too. Each correction would go a part 10⁻⁴ of the
        // way to a bound that is reached with the multiplier 0. So, where there are bounds, the step alone tells, as
        // interior point methods shift the Hessian of the Lagrangian without Σ. Inputs that the step does not price are
        // left as they are.
        let (natural, slopes) = match bounded {
            Some(Bounded { natural, slopes, .. }) => (natural, slopes),
            None => (input.diagonal(), (SVector::zeros(), SVector::zeros())),
        };
        let violation = slopes.1 + b.tr_mul(&next.violation);
        let pivot = Pivot::of(&input, &natural, curvature);
        let (negative, fall) = (pivot.negative(), pivot.fall());
        let shift = pivot.against(&by_input);
        let gain = pivot.against(&mixed);
        let hessian = place + mixed.tr_mul(&gain);
        let value = Value {
            costate: by_place + mixed.tr_mul(&shift),
            hessian: SMatrix::from_fn(|i, j| (hessian[(i, j)] + hessian[(j, i)]) * T::from_ratio(1, 2)),
            by_multiplier: a.tr_mul(&next.by_multiplier) + gain.tr_mul(&input_multiplier),
            violation: slopes.0 + a.tr_mul(&next.violation) + gain.tr_mul(&violation),
        };
        let depth = |fall: &Fall<T, U>| -fall.curvature / fall.direction.dot(&(step.input_curvature * fall.direction));
        let policy = Self {
            shift,
            gain,
            by_multiplier: pivot.against(&input_multiplier),
            gradient: (by_place, by_input),
            input_multiplier,
            negative,
            fall: fall.map(|fall| Fall { depth: depth(&fall), ..fall }),
            yielding: -violation.dot(&pivot.against(&violation)),
        };
        (policy, value)
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Stage<S, D, U, C> {
    /// The sizes of the terms of Q_u: |∂ℓ/∂u| + |B|ᵀ|p| + Σ z |∂a/∂u|. Where all of them vanish, as for a plan at rest,
    /// round-off of inputs and places makes a residual. So a part of |Q_uu| |u| + |Q_ux| |x| counts as well.
    #[cold]
    pub(super) fn terms(
        &self,
        step: &Expansion<S::Place, T, D, U>,
        costate: &SVector<T, D>,
        sizes: &SVector<T, D>,
        pushed: Option<SVector<T, U>>,
    ) -> SVector<T, U> {
        let part = rounding::<T>();
        SVector::from_fn(|i, _| {
            let carried = |sum, j: usize| sum + (step.by_input[(j, i)] * costate[j]).abs();
            let by_place = |sum, j: usize| sum + step.mixed_curvature[(i, j)].abs() * sizes[j];
            let by_input = |sum, j: usize| sum + (step.input_curvature[(i, j)] * self.input[j]).abs();
            let forces = (0..D).fold(step.price_by_input[i].abs(), carried);
            let moved = (0..U).fold((0..D).fold(T::zero(), by_place), by_input);
            forces + pushed.map_or(T::zero(), |pushed| pushed[i]) + part * moved
        })
    }
}

/// A direction δu of an input in which the price curves down.
#[derive(Clone, Copy)]
pub(super) struct Fall<T, const U: usize> {
    pub stage: usize,
    pub direction: SVector<T, U>,
    /// δuᵀ Q_uu δu < 0
    pub curvature: T,
    /// How deep it is, relative to the curvature of all steps alone. Along a symmetry it is no deeper than the change
    /// by a correction.
    pub depth: T,
}

/// A Hessian, ready to be inverted.
pub(super) enum Pivot<T, const U: usize> {
    Triangular(Ldl<T, U>),
    /// The inverse itself, with the number of negative eigenvalues and the direction of the most negative one.
    Spectral(SMatrix<T, U, U>, usize, Option<Fall<T, U>>),
}

impl<T: Real, const U: usize> Pivot<T, U> {
    /// Of a symmetric matrix; only its lower triangle is read. The price itself curves by `natural` along each input.
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
        Ldl::positive(&rows(&h)).map_or_else(|| Self::spectral(&h, curvature), Self::Triangular)
    }

    /// The number of negative eigenvalues.
    pub fn negative(&self) -> usize {
        match self {
            Self::Triangular(_) => 0,
            Self::Spectral(_, negative, _) => *negative,
        }
    }

    /// The direction of the most negative one.
    fn fall(&self) -> Option<Fall<T, U>> {
        match self {
            Self::Triangular(_) => None,
            Self::Spectral(_, _, fall) => *fall,
        }
    }

    /// −H⁻¹B
    #[inline]
    pub fn against<const K: usize>(&self, b: &SMatrix<T, U, K>) -> SMatrix<T, U, K> {
        match self {
            Self::Triangular(factors) => {
                let mut w = rows(&-b);
                factors.forward(&mut w);
                let mut x = factors.divided(&w);
                factors.backward(&mut x);
                SMatrix::from_fn(|i, j| x[i][j])
            }
            Self::Spectral(inverse, ..) => -(inverse * b),
        }
    }

    /// From the eigenvalues of the matrix with its diagonal scaled to ±1. Directions without any curvature are left alone.
    #[cold]
    fn spectral(h: &SMatrix<T, U, U>, curvature: Curvature<T>) -> Self {
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
        Self::Spectral(inverse, negative, fall)
    }
}
