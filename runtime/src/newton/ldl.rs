//! L Δ Lᵀ of a symmetric matrix without pivoting, which is stable where the matrix is definite.
//!
//! Source: Higham, *Accuracy and Stability of Numerical Algorithms*, theorem 10.3.

use crate::Real;
use core::array::from_fn;

/// The factors of a symmetric matrix, of which only the lower triangle was read.
pub(crate) struct Ldl<T, const M: usize> {
    /// L below its diagonal of ones. What is above counts for nothing.
    l: [[T; M]; M],
    /// Δ⁻¹
    reciprocals: [T; M],
}

/// Pivots below so many units in the last place of their diagonal are not trusted.
pub(crate) const UNITS: f64 = 16.0;

#[allow(clippy::needless_range_loop)] // Indices show the algorithm and, below constant bounds, cost no checks.
impl<T: Real, const M: usize> Ldl<T, M> {
    /// Where all of Δ has the sign of `sign`.
    ///
    /// Nothing leaves the loop, which is then unrolled.
    #[inline]
    pub fn definite(a: &[[T; M]; M], sign: T) -> Option<Self> {
        let mut l = *a;
        let mut reciprocals = [T::zero(); M];
        let mut is_definite = true;
        for k in 0..M {
            let pivot = l[k][k];
            // Written so that NaN is not definite.
            is_definite &= pivot * sign > T::zero() && pivot.is_finite();
            reciprocals[k] = pivot.recip();
            let column: [T; M] = from_fn(|i| l[i][k]);
            for i in k + 1..M {
                l[i][k] = column[i] * reciprocals[k];
                for j in k + 1..=i {
                    l[i][j] -= l[i][k] * column[j];
                }
            }
        }
        is_definite.then_some(Self { l, reciprocals })
    }

    /// Where all of Δ is positive, and more than round-off of the diagonal.
    ///
    /// The product of a column and its multiple is rounded as (column)·(multiple), not the other way round as by [`definite`](Self::definite).
    #[inline]
    pub fn positive(a: &[[T; M]; M]) -> Option<Self> {
        let mut l = *a;
        let mut reciprocals = [T::zero(); M];
        for k in 0..M {
            let pivot = l[k][k];
            let least = T::from_f64(UNITS) * T::EPSILON * a[k][k];
            // Written so that NaN is refused.
            if !(pivot > least && pivot > T::zero() && pivot.is_finite()) {
                return None;
            }
            reciprocals[k] = pivot.recip();
            for i in k + 1..M {
                let entry = l[i][k];
                l[i][k] = entry * reciprocals[k];
                for j in k + 1..=i {
                    l[i][j] -= entry * l[j][k];
                }
            }
        }
        Some(Self { l, reciprocals })
    }

    /// B ↦ L⁻¹B
    #[inline]
    pub fn forward<const K: usize>(&self, b: &mut [[T; K]; M]) {
        for i in 0..M {
            for k in 0..i {
                for j in 0..K {
                    b[i][j] -= self.l[i][k] * b[k][j];
                }
            }
        }
    }

    /// W ↦ Δ⁻¹W
    #[inline]
    pub fn divided<const K: usize>(&self, w: &[[T; K]; M]) -> [[T; K]; M] {
        from_fn(|i| from_fn(|j| w[i][j] * self.reciprocals[i]))
    }

    /// W ↦ L⁻ᵀW
    #[inline]
    pub fn backward<const K: usize>(&self, w: &mut [[T; K]; M]) {
        for i in (0..M).rev() {
            for k in i + 1..M {
                for j in 0..K {
                    w[i][j] -= self.l[k][i] * w[k][j];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Ldl;

    const A: [[f64; 4]; 4] =
        [[4.0, 1.0, 0.5, -1.0], [1.0, 5.0, 0.25, 0.5], [0.5, 0.25, 3.0, 0.75], [-1.0, 0.5, 0.75, 6.0]];

    #[test]
    fn definite_matrices_are_inverted() {
        let negative = A.map(|row| row.map(|entry| -entry));
        let [positive, other] = [Ldl::definite(&A, 1.0), Ldl::positive(&A)].map(|factors| factors.expect("definite"));
        for (a, factors) in [(A, positive), (A, other), (negative, Ldl::definite(&negative, -1.0).expect("definite"))] {
            let b = [[1.0], [-2.0], [0.5], [3.0]];
            let mut w = b;
            factors.forward(&mut w);
            let mut x = factors.divided(&w);
            factors.backward(&mut x);
            for (row, [b]) in a.iter().zip(b) {
                let product: f64 = row.iter().zip(x).map(|(entry, [x])| entry * x).sum();
                assert!((product - b).abs() < 1e-14, "{product} for {b}");
            }
        }
    }

    #[test]
    fn others_are_refused() {
        let mut indefinite = A;
        indefinite[2][2] = -3.0;
        assert!(Ldl::definite(&indefinite, 1.0).is_none() && Ldl::positive(&indefinite).is_none());
        assert!(Ldl::definite(&A, -1.0).is_none());
        assert!(Ldl::positive(&[[f64::NAN]]).is_none() && Ldl::definite(&[[f64::NAN]], 1.0).is_none());
        assert!(Ldl::positive(&[[1.0, 1.0], [1.0, 1.0 + f64::EPSILON]]).is_none(), "round-off");
    }
}
