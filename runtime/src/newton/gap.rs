//! The difference between an end and its target, and the shortest motion that closes it.

use super::Spectrum;
use crate::Real;
use crate::linear::rows;
use crate::space::larger;
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// Whether a gap is none to a person: below √ε of the numbers that it is compared with.
pub(crate) fn is_reached<T: Real>(distance: T, scale: T) -> bool {
    distance <= T::EPSILON.sqrt() * (scale + distance)
}

/// How many times longer the arc over a gap is than the part `along` the tangent of its chord, with so much `across`.
/// This is θ/sin θ: on a circle of any radius the chord makes the angle θ/2 with the tangent. `None` where it is no
/// longer.
#[inline]
pub(crate) fn arc_per_chord<T: Real>(along: T, across: T) -> Option<T> {
    let angle = T::from_f64(2.0) * (across / along).atan();
    let factor = angle / angle.sin();
    (factor > T::one() && factor.is_finite()).then_some(factor)
}

/// A⁻¹b by L Δ Lᵀ; `None` where a pivot is below √ε of its diagonal.
#[inline]
pub fn regular<T: Real, const M: usize>(a: &SMatrix<T, M, M>, b: &SVector<T, M>) -> Option<SVector<T, M>> {
    let mut l = rows(a);
    let largest = (0..M).fold(T::zero(), |max, i| larger(max, a[(i, i)]));
    let mut x: [T; M] = from_fn(|i| b[i]);
    for k in 0..M {
        // NaN goes on and is found in the result.
        if l[k][k] <= T::EPSILON.sqrt() * largest {
            return None;
        }
        for i in k + 1..M {
            let factor = l[i][k] / l[k][k];
            for j in k + 1..=i {
                l[i][j] -= factor * l[j][k];
            }
            x[i] -= factor * x[k];
        }
    }
    for k in (0..M).rev() {
        for i in k + 1..M {
            x[k] -= l[i][k] * x[i];
        }
        x[k] /= l[k][k];
    }
    Some(SVector::from_fn(|i, _| x[i]))
}

/// x, and the projector to the motions that change nothing.
pub(crate) type Closing<T, const M: usize> = (SVector<T, M>, Option<SMatrix<T, M, M>>);

/// The smallest x with A x = b, for a symmetric A with no negative eigenvalue, and the orthogonal projector to its
/// kernel. Eigenvalues below √ε of the largest belong to the kernel.
#[inline]
pub(crate) fn shortest<T: Real, const M: usize>(a: &SMatrix<T, M, M>, b: &SVector<T, M>) -> Closing<T, M> {
    regular(a, b).map_or_else(|| singular(a, b), |x| (x, None))
}

/// A⁺b and the projector to the kernel of A.
#[cold]
pub fn singular<T: Real, const M: usize>(a: &SMatrix<T, M, M>, b: &SVector<T, M>) -> Closing<T, M> {
    let spectrum = Spectrum::of(a);
    let tolerance = T::EPSILON.sqrt() * spectrum.largest();
    let inverse = spectrum.map(|value| if value > tolerance { value.recip() } else { T::zero() });
    let kernel = spectrum.map(|value| if value > tolerance { T::zero() } else { T::one() });
    (inverse * b, Some(kernel))
}
