//! Eigenvalues of small symmetric matrices, where a pivot is not positive or a metric has a kernel.

use crate::Real;
use nalgebra::{SMatrix, SVector};

/// A = V Λ Vᵀ of a symmetric matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spectrum<T, const M: usize> {
    /// The diagonal of Λ, in no order.
    pub values: SVector<T, M>,
    /// V: its columns are orthonormal.
    pub vectors: SMatrix<T, M, M>,
}

/// Sweeps over all pairs of rows. Convergence is quadratic: six do for M = 3, ten for M = 64.
const SWEEPS: usize = 24;

impl<T: Real, const M: usize> Spectrum<T, M> {
    /// By Jacobi rotations, of which only the lower triangle of `a` is read. NaN stay NaN.
    ///
    /// Accuracy: ε‖A‖ for each eigenvalue. Cost: about 3M³ multiplications a sweep.
    ///
    /// Source: Golub and Van Loan, *Matrix Computations*, section 8.5.
    #[cold]
    pub fn of(a: &SMatrix<T, M, M>) -> Self {
        let mut a = SMatrix::<T, M, M>::from_fn(|i, j| if i >= j { a[(i, j)] } else { a[(j, i)] });
        let mut vectors = SMatrix::from_fn(|i, j| if i == j { T::one() } else { T::zero() });
        for _ in 0..SWEEPS {
            let mut rotated = false;
            for q in 1..M {
                for p in 0..q {
                    rotated |= annihilate(&mut a, &mut vectors, p, q);
                }
            }
            if !rotated {
                break;
            }
        }
        Self { values: SVector::from_fn(|i, _| a[(i, i)]), vectors }
    }

    /// V f(Λ) Vᵀ
    pub fn map(&self, f: impl Fn(T) -> T) -> SMatrix<T, M, M> {
        let values = SVector::<T, M>::from_fn(|i, _| f(self.values[i]));
        let v = &self.vectors;
        SMatrix::from_fn(|i, j| (0..M).fold(T::zero(), |sum, k| sum + v[(i, k)] * values[k] * v[(j, k)]))
    }

    /// The largest |λ|.
    pub fn largest(&self) -> T {
        self.values.iter().fold(T::zero(), |max, x| crate::space::larger(max, x.abs()))
    }
}

/// The rotation of rows and columns p and q that makes a_pq vanish; `false` where it is nothing beside the diagonal.
fn annihilate<T: Real, const M: usize>(
    a: &mut SMatrix<T, M, M>,
    vectors: &mut SMatrix<T, M, M>,
    p: usize,
    q: usize,
) -> bool {
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
    for k in 0..M {
        let (x, y) = (a[(k, p)], a[(k, q)]);
        (a[(k, p)], a[(k, q)]) = (cosine * x - sine * y, sine * x + cosine * y);
    }
    for k in 0..M {
        let (x, y) = (a[(p, k)], a[(q, k)]);
        (a[(p, k)], a[(q, k)]) = (cosine * x - sine * y, sine * x + cosine * y);
        let (x, y) = (vectors[(k, p)], vectors[(k, q)]);
        (vectors[(k, p)], vectors[(k, q)]) = (cosine * x - sine * y, sine * x + cosine * y);
    }
    (a[(p, q)], a[(q, p)]) = (T::zero(), T::zero());
    true
}

#[cfg(test)]
mod tests {
    use super::Spectrum;
    use nalgebra::{Matrix3, Matrix4, SMatrix};
    use proptest::prelude::*;

    #[test]
    fn a_diagonal_matrix_is_left_alone() {
        let spectrum = Spectrum::of(&SMatrix::<f64, 3, 3>::from_diagonal(&[3.0, -1.0, 0.0].into()));
        assert_eq!(spectrum.values.as_slice(), [3.0, -1.0, 0.0]);
        assert_eq!(spectrum.vectors, Matrix3::identity());
        assert_eq!(spectrum.largest(), 3.0);
    }

    proptest! {
        #[test]
        fn a_symmetric_matrix_is_composed_of_its_spectrum(a in prop::array::uniform4(prop::array::uniform4(-1.0_f64..1.0))) {
            let a = Matrix4::from(a);
            let a = a + a.transpose();
            let spectrum = Spectrum::of(&a);
            let v = spectrum.vectors;
            prop_assert!((v.transpose() * v - Matrix4::identity()).amax() < 1e-14);
            prop_assert!((spectrum.map(|x| x) - a).amax() < 1e-14);
            prop_assert!((spectrum.map(|x| x * x) - a * a).amax() < 1e-13);
        }
    }
}
