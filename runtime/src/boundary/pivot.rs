//! The symmetric M×M pivot of a vertex, and what is made of it: gain and shift.

use crate::Real;
use crate::linear::rows;
use crate::newton::{Curvature, Ldl, Spectrum, turned_over};
use crate::space::larger;
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// K = D⁻¹C and s = D⁻¹g, written to where they stay: on the way there copies would wait for one another.
pub(super) struct Feedback<'a, T, const M: usize> {
    /// K
    pub gain: &'a mut SMatrix<T, M, M>,
    /// s
    pub shift: &'a mut SVector<T, M>,
}

/// What the next vertex needs of D, and what is known of D.
#[derive(Clone, Copy)]
pub(super) struct Solution<T, const M: usize> {
    /// CᵀD⁻¹C: the lower triangle by rows. What is above counts for nothing.
    pub hessian: [[T; M]; M],
    /// CᵀD⁻¹g
    pub gradient: SVector<T, M>,
    /// s·g
    pub decrement: T,
    /// The number of eigenvalues of the wrong sign: those of directions in which the action is no minimum.
    pub negative: usize,
}

/// D⁻¹C and D⁻¹g of a symmetric D, both by rows, of which only the lower triangle is read; `sign` is that of a minimum.
///
/// D = L Δ Lᵀ without pivoting where D is definite: M³/6 + M²(M + 1) multiplications, M divisions; for M = 3 from cofactors. Else from
/// eigenvalues. Inlined, for what it answers is taken apart at once.
#[inline(always)]
pub(super) fn solve<T: Real, const M: usize>(
    d: &[[T; M]; M],
    c: &[[T; M]; M],
    g: &SVector<T, M>,
    sign: T,
    curvature: Curvature<T>,
    feedback: Feedback<'_, T, M>,
) -> Solution<T, M> {
    let Feedback { gain, shift } = feedback;
    let feedback = Feedback { gain: &mut *gain, shift: &mut *shift };
    let solution = if M == 3 { cofactors(d, c, g, sign, feedback) } else { definite(d, c, g, sign, feedback) };
    match solution {
        Some(solution) => solution,
        None => {
            let cold = indefinite(d, c, g, sign, curvature, Feedback { gain, shift });
            // Entry by entry, so that those of the other way stay in registers.
            Solution {
                hessian: from_fn(|i| from_fn(|j| cold.hessian[i][j])),
                gradient: SVector::from_fn(|i, _| cold.gradient[i]),
                ..cold
            }
        }
    }
}

/// [`solve`] of three dimensions where D is definite, from D⁻¹ = adj D / det D: one division where an elimination has three, each of which
/// waits for the one before. `None` too where det D is too large or small to be known in full.
///
/// Errors of D⁻¹C relative to it are those of elimination, ε times the condition number of D.
#[inline(always)]
#[allow(clippy::needless_range_loop)] // Indices show the algorithm and, below constant bounds, cost no checks.
fn cofactors<T: Real, const M: usize>(
    d: &[[T; M]; M],
    c: &[[T; M]; M],
    g: &SVector<T, M>,
    sign: T,
    feedback: Feedback<'_, T, M>,
) -> Option<Solution<T, M>> {
    let (a, b, e) = (d[0][0], d[1][1], d[2][2]);
    let (x, y, z) = (d[2][1], d[2][0], d[1][0]);
    let (aa, bb, ee) = (b * e - x * x, a * e - y * y, a * b - z * z);
    let (xx, yy, zz) = (y * z - a * x, z * x - b * y, x * y - e * z);
    let determinant = a * aa + (z * zz + y * yy);
    let reciprocal = determinant.recip();
    let adjugate = [[aa, zz, yy], [zz, bb, xx], [yy, xx, ee]];
    let tiny = T::EPSILON * T::EPSILON;
    let in_range = |x: T| x * sign * tiny > T::zero();
    // Written so that NaN is not definite.
    if !(a * sign > T::zero() && ee > T::zero() && in_range(determinant) && in_range(reciprocal)) {
        return None;
    }
    let mut gain = [[T::zero(); M]; M];
    for i in 0..M {
        for j in 0..M {
            gain[i][j] = sum::<T, M>(|k| adjugate[i][k] * c[k][j]);
        }
    }
    let mut shift = [T::zero(); M];
    for i in 0..M {
        shift[i] = sum::<T, M>(|k| adjugate[i][k] * g[k]);
    }
    let (mut hessian, mut gradient) = ([[T::zero(); M]; M], [T::zero(); M]);
    for i in 0..M {
        for j in 0..=i {
            hessian[i][j] = sum::<T, M>(|k| c[k][i] * gain[k][j]) * reciprocal;
        }
    }
    for i in 0..M {
        gradient[i] = sum::<T, M>(|k| c[k][i] * shift[k]) * reciprocal;
    }
    for i in 0..M {
        for j in 0..M {
            gain[i][j] *= reciprocal;
        }
        shift[i] *= reciprocal;
    }
    Some(feedback.filled(&gain, &shift, g, hessian, gradient))
}

/// [`solve`] where all pivots have the sign of `sign`.
///
/// With W = L⁻¹C, CᵀD⁻¹C = WᵀΔ⁻¹W is known before K = L⁻ᵀΔ⁻¹W is: the next vertex, which waits for it, can be begun. One loop for each
/// matrix, for such loops are unrolled where M is small, and matrices stay in registers.
#[inline]
#[allow(clippy::needless_range_loop)] // As above.
fn definite<T: Real, const M: usize>(
    d: &[[T; M]; M],
    c: &[[T; M]; M],
    g: &SVector<T, M>,
    sign: T,
    feedback: Feedback<'_, T, M>,
) -> Option<Solution<T, M>> {
    let factors = Ldl::definite(d, sign)?;
    let mut w = *c;
    let mut v: [[T; 1]; M] = from_fn(|i| [g[i]]);
    factors.forward(&mut w);
    factors.forward(&mut v);
    let mut gain = factors.divided(&w);
    let mut shift = factors.divided(&v);
    let mut hessian = [[T::zero(); M]; M];
    for i in 0..M {
        for j in 0..=i {
            hessian[i][j] = sum::<T, M>(|k| w[k][i] * gain[k][j]);
        }
    }
    let gradient = from_fn(|i| sum::<T, M>(|k| w[k][i] * shift[k][0]));
    factors.backward(&mut gain);
    factors.backward(&mut shift);
    Some(feedback.filled(&gain, &shift.map(|[entry]| entry), g, hessian, gradient))
}

impl<T: Real, const M: usize> Feedback<'_, T, M> {
    /// Of a definite pivot.
    #[inline(always)]
    fn filled(
        self,
        gain: &[[T; M]; M],
        shift: &[T; M],
        g: &SVector<T, M>,
        hessian: [[T; M]; M],
        gradient: [T; M],
    ) -> Solution<T, M> {
        *self.gain = matrix(gain);
        *self.shift = SVector::from(*shift);
        let decrement = sum::<T, M>(|i| shift[i] * g[i]);
        Solution { hessian, gradient: SVector::from(gradient), decrement, negative: 0 }
    }
}

/// Σ_k
#[inline]
fn sum<T: Real, const M: usize>(term: impl Fn(usize) -> T) -> T {
    (1..M).fold(term(0), |sum, k| sum + term(k))
}

/// The matrix of these rows.
#[inline]
fn matrix<T: Real, const M: usize>(rows: &[[T; M]; M]) -> SMatrix<T, M, M> {
    SMatrix::from_fn(|i, j| rows[i][j])
}

/// [`solve`] from eigenvalues. Those that are nothing beside the largest are treated as that round-off, not as zero.
#[cold]
fn indefinite<T: Real, const M: usize>(
    d: &[[T; M]; M],
    c: &[[T; M]; M],
    g: &SVector<T, M>,
    sign: T,
    curvature: Curvature<T>,
    feedback: Feedback<'_, T, M>,
) -> Solution<T, M> {
    let (d, c) = (matrix(d), matrix(c));
    let spectrum = Spectrum::of(&d);
    let is_wrong = |value: T| value * sign < T::zero();
    let inverse = spectrum.map(|value| match curvature {
        Curvature::Kept { .. } => {
            let size = larger(value.abs(), T::EPSILON * spectrum.largest());
            if is_wrong(value) { -sign / size } else { sign / size }
        }
        Curvature::Mirrored { .. } if value * sign > T::zero() => value.recip(),
        Curvature::Mirrored { .. } => sign / turned_over(value, &spectrum),
    });
    let negative = spectrum.values.iter().filter(|&&value| is_wrong(value)).count();
    let (gain, shift) = (inverse * c, inverse * g);
    (*feedback.gain, *feedback.shift) = (gain, shift);
    Solution { hessian: rows(&c.tr_mul(&gain)), gradient: c.tr_mul(&shift), decrement: shift.dot(g), negative }
}

#[cfg(test)]
mod tests {
    use super::{Curvature, Feedback};
    use crate::linear::rows;
    use nalgebra::{Matrix3, Vector3};

    struct Solution {
        gain: Matrix3<f64>,
        shift: Vector3<f64>,
        hessian: [[f64; 3]; 3],
        gradient: Vector3<f64>,
        decrement: f64,
        negative: usize,
    }

    fn solve(d: &Matrix3<f64>, g: &Vector3<f64>, sign: f64, curvature: Curvature<f64>) -> Solution {
        let (mut gain, mut shift) = (Matrix3::zeros(), Vector3::zeros());
        let feedback = Feedback { gain: &mut gain, shift: &mut shift };
        let super::Solution { hessian, gradient, decrement, negative } =
            super::solve(&rows(d), &rows(&C), g, sign, curvature, feedback);
        Solution { gain, shift, hessian, gradient, decrement, negative }
    }

    const C: Matrix3<f64> = Matrix3::new(1.0, 2.0, 0.5, -1.0, 0.3, 0.2, 0.7, 0.1, -2.0);

    #[test]
    fn definite_and_indefinite_pivots_are_solved_and_counted() {
        let g = Vector3::new(0.3, -0.2, 0.9);
        for (diagonal, negative) in
            [([4.0, 5.0, 6.0], 0), ([4.0, -5.0, 6.0], 1), ([-4.0, -5.0, -6.0], 3), ([0.0, 5.0, 0.0], 1)]
        {
            let d =
                Matrix3::from_diagonal(&diagonal.into()) + Matrix3::new(0.0, 1.0, 0.2, 1.0, 0.0, -0.5, 0.2, -0.5, 0.0);
            let solution = solve(&d, &g, 1.0, Curvature::kept());
            assert!((d * solution.gain - C).amax() < 1e-13, "{diagonal:?}");
            assert!((d * solution.shift - g).amax() < 1e-13, "{diagonal:?}");
            assert!((C.tr_mul(&solution.shift) - solution.gradient).amax() < 1e-13, "{diagonal:?}");
            assert!((solution.shift.dot(&g) - solution.decrement).abs() < 1e-13, "{diagonal:?}");
            let hessian = C.tr_mul(&solution.gain);
            assert!((0..3).all(|i| (0..=i).all(|j| (hessian[(i, j)] - solution.hessian[i][j]).abs() < 1e-13)));
            let backward = solve(&-d, &g, -1.0, Curvature::kept());
            assert_eq!((solution.negative, backward.negative), (negative, negative), "{diagonal:?}");
            assert!((backward.shift + solution.shift).amax() < 1e-13);
            let downhill = solve(&d, &g, 1.0, Curvature::mirrored(0.0));
            assert!(downhill.shift.dot(&g) > 0.0);
            assert_eq!(downhill.negative, negative);
        }
    }

    /// The determinant of a matrix of numbers is beyond their range long before they are.
    #[test]
    fn pivots_of_any_size_are_solved() {
        let d = Matrix3::new(4.0, 1.0, 0.2, 1.0, 5.0, -0.5, 0.2, -0.5, 6.0);
        for scale in [1e-120, 1e-90, 1e90, 1e120] {
            let solution = solve(&(d * scale), &(Vector3::x() * scale), 1.0, Curvature::kept());
            assert!((d * solution.gain * scale - C).amax() < 1e-14, "{scale:e}");
            assert!((d * solution.shift - Vector3::x()).amax() < 1e-15, "{scale:e}");
            assert_eq!(solution.negative, 0);
        }
    }

    #[test]
    fn a_singular_pivot_gives_finite_directions() {
        let solution =
            solve(&Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 1.0)), &Vector3::x(), 1.0, Curvature::mirrored(0.0));
        assert!(solution.gain.amax() < 1e5 && solution.negative == 0);
    }
}
