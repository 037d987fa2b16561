//! Eigenvalues of small symmetric matrices, where a pivot is not positive or a metric has a kernel.

use crate::Real;
use crate::space::larger;
use nalgebra::{SMatrix, SVector};

/// A = V Λ Vᵀ of a symmetric matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spectrum<T, const M: usize> {
    /// The diagonal of Λ, in no order.
    pub values: SVector<T, M>,
    /// V: its columns are orthonormal.
    pub vectors: SMatrix<T, M, M>,
}

/// The least mirrored eigenvalue, relative to the largest: it bounds steps along a direction without curvature.
const MIRRORED: f64 = 1e-4;
/// Sweeps over all pairs of rows. Convergence is quadratic: six do for M = 3, ten for M = 64.
const SWEEPS: usize = 24;

impl<T: Real, const M: usize> Spectrum<T, M> {
    /// By Jacobi rotations; only the lower triangle of `a` is read. NaN stay NaN. Accuracy: ε‖A‖ for each eigenvalue.
    /// Cost: about 3M³ multiplications a sweep.
    ///
    /// Source: Golub and Van Loan, *Matrix Computations*, section 8.5.
    #[cold]
    pub fn of(a: &SMatrix<T, M, M>) -> Self {
        let mut a = SMatrix::<T, M, M>::from_fn(|i, j| if i >= j { a[(i, j)] } else { a[(j, i)] });
        let vectors = SMatrix::from_fn(|i, j| if i == j { T::one() } else { T::zero() });
        let mut spectrum = Self { values: SVector::zeros(), vectors };
        for _ in 0..SWEEPS {
            let mut rotated = false;
            for q in 1..M {
                for p in 0..q {
                    rotated |= spectrum.annihilate(&mut a, p, q);
                }
            }
            if !rotated {
                break;
            }
        }
        Self { values: a.diagonal(), ..spectrum }
    }

    /// The rotation of rows and columns p and q that makes a_pq vanish; `false` if a_pq is negligible relative to the
    /// diagonal.
    fn annihilate(&mut self, a: &mut SMatrix<T, M, M>, p: usize, q: usize) -> bool {
        let off = a[(p, q)];
        let tiny = T::EPSILON * T::from_ratio(1, 4);
        if off.abs() <= tiny * (a[(p, p)].abs() + a[(q, q)].abs()) {
            return false;
        }
        let two = T::from_f64(2.0);
        let ratio = (a[(q, q)] - a[(p, p)]) / (two * off);
        let size = ratio.abs() + (T::one() + ratio * ratio).sqrt();
        let tangent = if ratio < T::zero() { -size.recip() } else { size.recip() };
        let cosine = (T::one() + tangent * tangent).sqrt().recip();
        let sine = tangent * cosine;
        let turned = |x: T, y: T| (cosine * x - sine * y, sine * x + cosine * y);
        for k in 0..M {
            (a[(k, p)], a[(k, q)]) = turned(a[(k, p)], a[(k, q)]);
        }
        for k in 0..M {
            (a[(p, k)], a[(q, k)]) = turned(a[(p, k)], a[(q, k)]);
            (self.vectors[(k, p)], self.vectors[(k, q)]) = turned(self.vectors[(k, p)], self.vectors[(k, q)]);
        }
        (a[(p, q)], a[(q, p)]) = (T::zero(), T::zero());
        true
    }

    /// V f(Λ) Vᵀ
    pub fn map(&self, f: impl Fn(T) -> T) -> SMatrix<T, M, M> {
        let values = SVector::<T, M>::from_fn(|i, _| f(self.values[i]));
        let v = &self.vectors;
        SMatrix::from_fn(|i, j| (0..M).fold(T::zero(), |sum, k| sum + v[(i, k)] * values[k] * v[(j, k)]))
    }

    /// The largest |λ|.
    pub fn largest(&self) -> T {
        self.values.iter().fold(T::zero(), |max, x| larger(max, x.abs()))
    }

    /// The size of an eigenvalue of the wrong sign once it is turned over.
    pub fn turned_over(&self, value: T) -> T {
        larger(value.abs(), T::from_f64(MIRRORED) * self.largest())
    }
}

/// S A S = V Λ Vᵀ with S = diag |A|^(−1/2): the choice of units of the rows changes neither V nor Λ.
pub(crate) struct Equilibrated<T, const M: usize> {
    pub spectrum: Spectrum<T, M>,
    /// The diagonal of S; rows that are negligible relative to the others count as 0.
    pub scale: SVector<T, M>,
}

impl<T: Real, const M: usize> Equilibrated<T, M> {
    #[cold]
    pub fn of(a: &SMatrix<T, M, M>) -> Self {
        let largest = (0..M).fold(T::zero(), |max, i| larger(max, a[(i, i)].abs()));
        let nothing = T::EPSILON * T::EPSILON.sqrt() * largest;
        let scale = SVector::<T, M>::from_fn(|i, _| {
            let entry = a[(i, i)].abs();
            if entry <= nothing { T::zero() } else { entry.sqrt().recip() }
        });
        Self { spectrum: Spectrum::of(&SMatrix::from_fn(|i, j| scale[i] * a[(i, j)] * scale[j])), scale }
    }

    /// S V f(Λ) Vᵀ S, which is A⁻¹ where f is the reciprocal.
    pub fn map(&self, f: impl Fn(T) -> T) -> SMatrix<T, M, M> {
        let inner = self.spectrum.map(f);
        SMatrix::from_fn(|i, j| self.scale[i] * inner[(i, j)] * self.scale[j])
    }

    /// The number of eigenvalues above this part of the largest.
    pub fn count_above(&self, part: T) -> usize {
        let least = part * self.spectrum.largest();
        self.spectrum.values.iter().filter(|&&value| value > least).count()
    }
}
