//! The symmetric U×U Hessian of one input, and what is done where it is not positive.

use crate::Real;
use crate::eigen::Spectrum;
use crate::space::larger;
use nalgebra::{SMatrix, SVector};

/// What is made of a Hessian that is not positive.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Curvature<T> {
    /// As it is, but for this small part of the price's curvature: the critical point of the quadratic model.
    Kept { steadiness: T },
    /// With negative eigenvalues turned over, so that the price goes down, and with a multiple of its own diagonal or a small part of the
    /// price's curvature added, whichever is more.
    Mirrored { damping: T, steadiness: T },
}

impl<T: Real> Curvature<T> {
    /// The curvature as it is.
    pub fn kept() -> Self {
        Self::Kept { steadiness: T::zero() }
    }

    /// The multiples of the diagonal and of the price's curvature.
    fn added(&self) -> (T, T) {
        match *self {
            Self::Kept { steadiness } => (T::zero(), steadiness),
            Self::Mirrored { damping, steadiness } => (damping, steadiness),
        }
    }

    /// Whether the price goes down.
    pub fn is_mirrored(&self) -> bool {
        matches!(self, Self::Mirrored { .. })
    }
}

/// The inverse of a Hessian.
pub(super) struct Pivot<T, const U: usize> {
    factors: Factors<T, U>,
    /// The number of negative eigenvalues.
    pub negative: usize,
    /// The direction of the most negative one.
    pub fall: Option<Fall<T, U>>,
}

/// A direction δu of an input in which the price curves down.
#[derive(Clone, Copy)]
pub(super) struct Fall<T, const U: usize> {
    pub direction: SVector<T, U>,
    /// δuᵀ Q_uu δu < 0
    pub curvature: T,
}

enum Factors<T, const U: usize> {
    /// L without its diagonal of ones, and Δ⁻¹, of L Δ Lᵀ.
    Triangular(SMatrix<T, U, U>, SVector<T, U>),
    /// The inverse itself.
    Spectral(SMatrix<T, U, U>),
}

/// Pivots below so many units in the last place of their diagonal are not trusted.
const UNITS: f64 = 16.0;
/// What a mirrored eigenvalue is at least, relative to the largest: steps along a direction without curvature end somewhere.
const MIRRORED: f64 = 1e-4;

impl<T: Real, const U: usize> Pivot<T, U> {
    /// Of a symmetric matrix, of which only the lower triangle is read, where the price itself curves by `natural` along each input.
    #[inline]
    pub fn of(h: &SMatrix<T, U, U>, natural: &SVector<T, U>, curvature: Curvature<T>) -> Self {
        let mut h = *h;
        let (damping, steadiness) = curvature.added();
        if larger(damping, steadiness) > T::zero() {
            for i in 0..U {
                let entry = h[(i, i)];
                h[(i, i)] = entry + larger(damping * entry.abs(), steadiness * natural[i].abs());
            }
        }
        match triangular(&h) {
            Some(factors) => Self { factors, negative: 0, fall: None },
            None => spectral(&h, curvature),
        }
    }

    /// −H⁻¹B
    #[inline]
    pub fn against<const K: usize>(&self, b: &SMatrix<T, U, K>) -> SMatrix<T, U, K> {
        match &self.factors {
            Factors::Triangular(l, reciprocals) => {
                let mut x = -*b;
                for j in 0..K {
                    for i in 0..U {
                        for k in 0..i {
                            let known = l[(i, k)] * x[(k, j)];
                            x[(i, j)] -= known;
                        }
                    }
                    for i in (0..U).rev() {
                        x[(i, j)] *= reciprocals[i];
                        for k in i + 1..U {
                            let known = l[(k, i)] * x[(k, j)];
                            x[(i, j)] -= known;
                        }
                    }
                }
                x
            }
            Factors::Spectral(inverse) => -(inverse * b),
        }
    }
}

/// L Δ Lᵀ where all pivots are positive.
#[inline]
fn triangular<T: Real, const U: usize>(h: &SMatrix<T, U, U>) -> Option<Factors<T, U>> {
    let mut l = *h;
    let mut reciprocals = SVector::<T, U>::from_element(T::zero());
    for k in 0..U {
        let pivot = l[(k, k)];
        let least = T::from_f64(UNITS) * T::EPSILON * h[(k, k)];
        // Written so that NaN is refused.
        if !(pivot > least && pivot > T::zero() && pivot.is_finite()) {
            return None;
        }
        reciprocals[k] = pivot.recip();
        for i in k + 1..U {
            let factor = l[(i, k)] * reciprocals[k];
            for j in k + 1..=i {
                // column k still holds L Δ below row i, and L above
                let known = if j == i { factor * l[(i, k)] } else { l[(i, k)] * l[(j, k)] };
                l[(i, j)] -= known;
            }
            l[(i, k)] = factor;
        }
    }
    Some(Factors::Triangular(l, reciprocals))
}

/// From the eigenvalues of the matrix with its diagonal scaled to ±1. Directions without any curvature are left alone.
#[cold]
fn spectral<T: Real, const U: usize>(h: &SMatrix<T, U, U>, curvature: Curvature<T>) -> Pivot<T, U> {
    let (spectrum, scale) = equilibrated(h);
    let largest = spectrum.largest();
    let noise = T::from_f64(UNITS) * T::EPSILON * largest;
    let inverse = spectrum.map(|value| match curvature {
        // Written so that NaN stays NaN.
        _ if value.abs() <= noise && !curvature.is_mirrored() || largest == T::zero() => T::zero(),
        Curvature::Kept { .. } => value.recip(),
        Curvature::Mirrored { .. } if value > noise => value.recip(),
        Curvature::Mirrored { .. } => larger(value.abs(), T::from_f64(MIRRORED) * largest).recip(),
    });
    let inverse = SMatrix::from_fn(|i, j| scale[i] * inverse[(i, j)] * scale[j]);
    let wrong = -T::EPSILON.sqrt() * largest;
    let negative = spectrum.values.iter().filter(|&&value| value < wrong).count();
    let least = (0..U).fold(0, |least, i| if spectrum.values[i] < spectrum.values[least] { i } else { least });
    let fall = (negative > 0).then(|| Fall {
        curvature: spectrum.values[least],
        direction: SVector::from_fn(|i, _| scale[i] * spectrum.vectors[(i, least)]),
    });
    Pivot { factors: Factors::Spectral(inverse), negative, fall }
}

/// The eigenvalues of S A S with S = diag |A|^(−1/2), and the diagonal of S; rows that are nothing beside the others count as 0.
///
/// The choice of units of the rows changes neither.
pub(super) fn equilibrated<T: Real, const M: usize>(a: &SMatrix<T, M, M>) -> (Spectrum<T, M>, SVector<T, M>) {
    let largest = (0..M).fold(T::zero(), |max, i| larger(max, a[(i, i)].abs()));
    let nothing = T::EPSILON * T::EPSILON.sqrt() * largest;
    let scale = SVector::<T, M>::from_fn(|i, _| {
        let entry = a[(i, i)].abs();
        if entry <= nothing { T::zero() } else { entry.sqrt().recip() }
    });
    (Spectrum::of(&SMatrix::from_fn(|i, j| scale[i] * a[(i, j)] * scale[j])), scale)
}
