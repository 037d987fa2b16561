//! The symmetric M×M pivot of a vertex, and its results: gain and shift.

use crate::Real;
use crate::linear::{matrix, rows};
use crate::newton::{Curvature, Ldl, Spectrum};
use crate::space::larger;
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// The equations D K = C and D s = g of a vertex. Matrices are by rows, and only the lower triangle of the symmetric D is read.
pub(super) struct Pivot<T, const M: usize> {
    pub d: [[T; M]; M],
    pub c: [[T; M]; M],
    pub g: SVector<T, M>,
    /// The sign of D at a minimum.
    pub sign: T,
}

/// K = D⁻¹C and s = D⁻¹g, written to where they stay: on the way there copies would wait for one another.
#[derive(Clone, Copy)]
pub(super) struct Feedback<T, const M: usize> {
    /// K
    pub gain: SMatrix<T, M, M>,
    /// s
    pub shift: SVector<T, M>,
}

/// The data of D that the next vertex needs, and its inertia.
#[derive(Clone, Copy)]
pub(super) struct Solution<T, const M: usize> {
    /// CᵀD⁻¹C: the lower triangle by rows. Entries above are ignored.
    pub hessian: [[T; M]; M],
    /// CᵀD⁻¹g
    pub gradient: SVector<T, M>,
    /// s·g
    pub decrement: T,
    /// The number of eigenvalues of the wrong sign: those of directions in which the action is no minimum.
    pub negative: usize,
}

impl<T: Real, const M: usize> Pivot<T, M> {
    /// D = L Δ Lᵀ without pivoting where D is definite: M³/6 + M²(M + 1) multiplications, M divisions. For M = 3 by cofactors, else by eigenvalues.
    #[inline(always)]
    pub fn solve(&self, curvature: Curvature<T>, feedback: &mut Feedback<T, M>) -> Solution<T, M> {
        let solution = if M == 3 { self.by_cofactors(feedback) } else { self.by_elimination(feedback) };
        solution.unwrap_or_else(|| {
            let cold = self.by_eigenvalues(curvature, feedback);
            // Entry by entry, so that those of the other way stay in registers.
            Solution {
                hessian: from_fn(|i| from_fn(|j| cold.hessian[i][j])),
                gradient: SVector::from_fn(|i, _| cold.gradient[i]),
                ..cold
            }
        })
    }

    /// [`solve`](Self::solve) of three dimensions for a definite D, from D⁻¹ = adj D / det D. It takes one division;
    /// elimination takes three, and each waits for the one before. `None` too where det D is too large or small to be
    /// known in full. Errors of D⁻¹C relative to it are those of elimination, ε times the condition number of D.
    #[inline(always)]
    fn by_cofactors(&self, feedback: &mut Feedback<T, M>) -> Option<Solution<T, M>> {
        let Self { d, c, g, sign } = self;
        let [a, b, e] = [d[0][0], d[1][1], d[2][2]];
        let [x, y, z] = [d[2][1], d[2][0], d[1][0]];
        let [aa, bb, ee] = [b * e - x * x, a * e - y * y, a * b - z * z];
        let [xx, yy, zz] = [y * z - a * x, z * x - b * y, x * y - e * z];
        let determinant = a * aa + (z * zz + y * yy);
        let reciprocal = determinant.recip();
        let adjugate = [[aa, zz, yy], [zz, bb, xx], [yy, xx, ee]];
        let in_range = |x: T| x * *sign * (T::EPSILON * T::EPSILON) > T::zero();
        // Written so that NaN is not definite.
        if !(a * *sign > T::zero() && ee > T::zero() && in_range(determinant) && in_range(reciprocal)) {
            return None;
        }
        let gain: [[T; M]; M] = from_fn(|i| from_fn(|j| sum::<T, M>(|k| adjugate[i][k] * c[k][j])));
        let shift: [T; M] = from_fn(|i| sum::<T, M>(|k| adjugate[i][k] * g[k]));
        let hessian = lower_triangle(|i, j| sum::<T, M>(|k| c[k][i] * gain[k][j]) * reciprocal);
        let gradient = SVector::from_fn(|i, _| sum::<T, M>(|k| c[k][i] * shift[k]) * reciprocal);
        feedback.gain = SMatrix::from_fn(|i, j| gain[i][j] * reciprocal);
        feedback.shift = SVector::from_fn(|i, _| shift[i] * reciprocal);
        let decrement = sum::<T, M>(|i| feedback.shift[i] * g[i]);
        Some(Solution { hessian, gradient, decrement, negative: 0 })
    }

    /// [`solve`](Self::solve) where all pivots have the right sign. With W = L⁻¹C, CᵀD⁻¹C = WᵀΔ⁻¹W is known before K = L⁻ᵀΔ⁻¹W: the next
    /// vertex can begin. One loop for each matrix, unrolled where M is small.
    #[inline]
    fn by_elimination(&self, feedback: &mut Feedback<T, M>) -> Option<Solution<T, M>> {
        let Self { d, c, g, sign } = self;
        let factors = Ldl::definite(d, *sign)?;
        let mut w = *c;
        let mut v: [[T; 1]; M] = from_fn(|i| [g[i]]);
        factors.forward(&mut w);
        factors.forward(&mut v);
        let mut gain = factors.divided(&w);
        let mut shift = factors.divided(&v);
        let hessian = lower_triangle(|i, j| sum::<T, M>(|k| w[k][i] * gain[k][j]));
        let gradient = SVector::from_fn(|i, _| sum::<T, M>(|k| w[k][i] * shift[k][0]));
        factors.backward(&mut gain);
        factors.backward(&mut shift);
        feedback.gain = matrix(gain);
        feedback.shift = SVector::from_fn(|i, _| shift[i][0]);
        let decrement = sum::<T, M>(|i| feedback.shift[i] * g[i]);
        Some(Solution { hessian, gradient, decrement, negative: 0 })
    }

    /// [`solve`](Self::solve) from eigenvalues. Eigenvalues that are negligible relative to the largest are treated as
    /// round-off of it, not as zero.
    #[cold]
    fn by_eigenvalues(&self, curvature: Curvature<T>, feedback: &mut Feedback<T, M>) -> Solution<T, M> {
        let sign = self.sign;
        let c = matrix(self.c);
        let spectrum = Spectrum::of(&matrix(self.d));
        let is_wrong = |value: T| value * sign < T::zero();
        let inverse = spectrum.map(|value| {
            if !curvature.is_mirrored {
                let size = larger(value.abs(), T::EPSILON * spectrum.largest());
                if is_wrong(value) { -sign / size } else { sign / size }
            } else if value * sign > T::zero() {
                value.recip()
            } else {
                sign / spectrum.turned_over(value)
            }
        });
        *feedback = Feedback { gain: inverse * c, shift: inverse * self.g };
        Solution {
            hessian: rows(&c.tr_mul(&feedback.gain)),
            gradient: c.tr_mul(&feedback.shift),
            decrement: feedback.shift.dot(&self.g),
            negative: spectrum.values.iter().filter(|&&value| is_wrong(value)).count(),
        }
    }
}

/// Σ_k
#[inline]
fn sum<T: Real, const M: usize>(term: impl Fn(usize) -> T) -> T {
    (1..M).fold(term(0), |sum, k| sum + term(k))
}

/// The rows of these entries, with 0 above the diagonal.
#[inline]
pub(super) fn lower_triangle<T: Real, const M: usize>(entry: impl Fn(usize, usize) -> T) -> [[T; M]; M] {
    let mut lower = [[T::zero(); M]; M];
    for (i, row) in lower.iter_mut().enumerate() {
        row.iter_mut().take(i + 1).enumerate().for_each(|(j, place)| *place = entry(i, j));
    }
    lower
}
