//! L Δ Lᵀ of a symmetric matrix without pivoting, which is stable where the matrix is definite.
//!
//! Source: Higham, *Accuracy and Stability of Numerical Algorithms*, theorem 10.3.

use crate::Real;
use core::array::from_fn;

/// The factors of a symmetric matrix; only its lower triangle was read.
pub(crate) struct Ldl<T, const M: usize> {
    /// L below its diagonal of ones. Entries above it are ignored.
    l: [[T; M]; M],
    /// Δ⁻¹
    reciprocals: [T; M],
}

/// Pivots below so many units in the last place of their diagonal are not trusted.
pub(crate) const UNITS: f64 = 16.0;

impl<T: Real, const M: usize> Ldl<T, M> {
    /// Where all of Δ has the sign of `sign`.
    #[inline]
    pub fn definite(a: &[[T; M]; M], sign: T) -> Option<Self> {
        Self::factored(a, false, |pivot, _| pivot * sign > T::zero())
    }

    /// Where all of Δ is positive, and more than round-off of the diagonal.
    #[inline]
    pub fn positive(a: &[[T; M]; M]) -> Option<Self> {
        let unit = T::from_f64(UNITS) * T::EPSILON;
        Self::factored(a, true, |pivot, entry| pivot > unit * entry && pivot > T::zero())
    }

    /// Where `is_regular(Δ_kk, A_kk)` of all pivots. A column times its multiple is rounded as (multiple)·(column), or else with the column
    /// first. Nothing leaves the loop, which is then unrolled.
    #[inline(always)]
    fn factored(a: &[[T; M]; M], column_first: bool, is_regular: impl Fn(T, T) -> bool) -> Option<Self> {
        let mut l = *a;
        let mut reciprocals = [T::zero(); M];
        let mut is_definite = true;
        for k in 0..M {
            let pivot = l[k][k];
            // Written so that NaN is not definite.
            is_definite &= is_regular(pivot, a[k][k]) && pivot.is_finite();
            reciprocals[k] = pivot.recip();
            let column: [T; M] = from_fn(|i| l[i][k]);
            for i in k + 1..M {
                l[i][k] = column[i] * reciprocals[k];
                for j in k + 1..=i {
                    l[i][j] -= if column_first { column[i] * l[j][k] } else { l[i][k] * column[j] };
                }
            }
        }
        is_definite.then_some(Self { l, reciprocals })
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

    /// E = Δ^(−1/2)L⁻¹, with E A Eᵀ = 1.
    pub fn inverse_root(&self) -> [[T; M]; M] {
        let mut e: [[T; M]; M] = from_fn(|i| from_fn(|j| if i == j { T::one() } else { T::zero() }));
        self.forward(&mut e);
        from_fn(|i| from_fn(|j| e[i][j] * self.reciprocals[i].sqrt()))
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
