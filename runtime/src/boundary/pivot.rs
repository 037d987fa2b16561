//! The symmetric M×M pivot of a vertex, and what is made of it: gain and shift.

use crate::Scalar;
use crate::eigen::Spectrum;
use crate::space::larger;
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// D⁻¹C and D⁻¹g, and what is known of D.
#[derive(Clone, Copy)]
pub(super) struct Solution<T, const M: usize> {
    /// K = D⁻¹C
    pub gain: SMatrix<T, M, M>,
    /// s = D⁻¹g
    pub shift: SVector<T, M>,
    /// The number of eigenvalues of the wrong sign: those of directions in which the action is no minimum.
    pub negative: usize,
}

/// How to solve where D is not definite.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Curvature {
    /// As it is: the critical point of the quadratic model.
    Kept,
    /// With the eigenvalues of the wrong sign turned over, so that the action goes down.
    Mirrored,
}

/// D⁻¹C and D⁻¹g of a symmetric D, of which only the lower triangle is read; `sign` is that of a minimum.
///
/// D = L Δ Lᵀ without pivoting where D is definite: M³/6 + M²(M + 1) multiplications, M divisions. Else from eigenvalues.
#[inline]
pub(super) fn solve<T: Scalar, const M: usize>(
    d: &SMatrix<T, M, M>,
    c: &SMatrix<T, M, M>,
    g: &SVector<T, M>,
    sign: T,
    curvature: Curvature,
) -> Solution<T, M> {
    match definite(d, c, g, sign) {
        Some((gain, shift)) => Solution { gain, shift, negative: 0 },
        None => indefinite(d, c, g, sign, curvature),
    }
}

/// [`solve`] where all pivots have the sign of `sign`.
#[inline]
#[allow(clippy::needless_range_loop)] // Indices show the algorithm and, below constant bounds, cost no checks.
fn definite<T: Scalar, const M: usize>(
    d: &SMatrix<T, M, M>,
    c: &SMatrix<T, M, M>,
    g: &SVector<T, M>,
    sign: T,
) -> Option<(SMatrix<T, M, M>, SVector<T, M>)> {
    let mut l: [[T; M]; M] = from_fn(|i| from_fn(|j| d[(i, j)]));
    let mut x: [[T; M]; M] = from_fn(|i| from_fn(|j| c[(i, j)]));
    let mut y: [T; M] = from_fn(|i| g[i]);
    let mut reciprocals = [T::zero(); M];
    for k in 0..M {
        let pivot = l[k][k];
        if pivot * sign <= T::zero() || !pivot.is_finite() {
            return None;
        }
        reciprocals[k] = pivot.recip();
        for i in k + 1..M {
            let factor = l[i][k] * reciprocals[k];
            for j in k + 1..=i {
                l[i][j] -= factor * l[j][k];
            }
            for j in 0..M {
                x[i][j] -= factor * x[k][j];
            }
            y[i] -= factor * y[k];
        }
    }
    // row k of Δ Lᵀ stands in column k below the diagonal
    for k in (0..M).rev() {
        for i in k + 1..M {
            for j in 0..M {
                x[k][j] -= l[i][k] * x[i][j];
            }
            y[k] -= l[i][k] * y[i];
        }
        for j in 0..M {
            x[k][j] *= reciprocals[k];
        }
        y[k] *= reciprocals[k];
    }
    Some((SMatrix::from_fn(|i, j| x[i][j]), SVector::from_fn(|i, _| y[i])))
}

/// What a mirrored eigenvalue is at least, relative to the largest: steps along a direction without curvature end somewhere.
const MIRRORED: f64 = 1e-4;

/// [`solve`] from eigenvalues. Those that are nothing beside the largest are treated as that round-off, not as zero.
#[cold]
fn indefinite<T: Scalar, const M: usize>(
    d: &SMatrix<T, M, M>,
    c: &SMatrix<T, M, M>,
    g: &SVector<T, M>,
    sign: T,
    curvature: Curvature,
) -> Solution<T, M> {
    let spectrum = Spectrum::of(d);
    let is_wrong = |value: T| value * sign < T::zero();
    let inverse = spectrum.map(|value| match curvature {
        Curvature::Kept if is_wrong(value) => -sign / larger(value.abs(), T::EPSILON * spectrum.largest()),
        Curvature::Kept => sign / larger(value.abs(), T::EPSILON * spectrum.largest()),
        Curvature::Mirrored if value * sign > T::zero() => value.recip(),
        Curvature::Mirrored => sign / larger(value.abs(), T::from_f64(MIRRORED) * spectrum.largest()),
    });
    let negative = spectrum.values.iter().filter(|&&value| is_wrong(value)).count();
    Solution { gain: inverse * c, shift: inverse * g, negative }
}

#[cfg(test)]
mod tests {
    use super::{Curvature, solve};
    use nalgebra::{Matrix3, Vector3};

    const C: Matrix3<f64> = Matrix3::new(1.0, 2.0, 0.5, -1.0, 0.3, 0.2, 0.7, 0.1, -2.0);

    #[test]
    fn definite_and_indefinite_pivots_are_solved_and_counted() {
        let g = Vector3::new(0.3, -0.2, 0.9);
        for (diagonal, negative) in
            [([4.0, 5.0, 6.0], 0), ([4.0, -5.0, 6.0], 1), ([-4.0, -5.0, -6.0], 3), ([0.0, 5.0, 0.0], 1)]
        {
            let d =
                Matrix3::from_diagonal(&diagonal.into()) + Matrix3::new(0.0, 1.0, 0.2, 1.0, 0.0, -0.5, 0.2, -0.5, 0.0);
            let solution = solve(&d, &C, &g, 1.0, Curvature::Kept);
            assert!((d * solution.gain - C).amax() < 1e-13, "{diagonal:?}");
            assert!((d * solution.shift - g).amax() < 1e-13, "{diagonal:?}");
            let backward = solve(&-d, &C, &g, -1.0, Curvature::Kept);
            assert_eq!((solution.negative, backward.negative), (negative, negative), "{diagonal:?}");
            assert!((backward.shift + solution.shift).amax() < 1e-13);
            let downhill = solve(&d, &C, &g, 1.0, Curvature::Mirrored);
            assert!(downhill.shift.dot(&g) > 0.0);
            assert_eq!(downhill.negative, negative);
        }
    }

    #[test]
    fn a_singular_pivot_gives_finite_directions() {
        let solution =
            solve(&Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 1.0)), &C, &Vector3::x(), 1.0, Curvature::Mirrored);
        assert!(solution.gain.amax() < 1e5 && solution.negative == 0);
    }
}
