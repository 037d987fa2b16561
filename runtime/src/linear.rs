//! Small linear systems: Gaussian elimination with partial pivoting in straight loops over constant bounds.
//!
//! For M = 3 the loops unroll and the matrix stays in registers. Only signs of pivots are used, never the determinant, which
//! overflows long before its factors do.

use crate::Scalar;

/// The sign of the determinant of a regular matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// det > 0
    Positive,
    /// det < 0
    Negative,
}

impl Orientation {
    /// The sign of the determinant of `rows`, `None` where it is singular or not finite.
    #[inline]
    pub fn of<T: Scalar, const M: usize>(rows: [[T; M]; M]) -> Option<Self> {
        eliminate::<T, M, 0>(rows, &mut [[]; M])
    }
}

/// Solves A X = B in place of `b`: Gaussian elimination with partial pivoting, X of shape M×K.
///
/// Returns the sign of det A. `None` where a pivot is zero or not finite; `b` is spoilt then.
/// Cost: M³/3 + M²K multiplications, M(M+1)/2 + MK divisions less M.
#[inline]
#[allow(clippy::needless_range_loop)] // Indices show the algorithm and, below constant bounds, cost no checks.
pub(crate) fn eliminate<T: Scalar, const M: usize, const K: usize>(
    mut a: [[T; M]; M],
    b: &mut [[T; K]; M],
) -> Option<Orientation> {
    let mut negative = false;
    for k in 0..M {
        // Exchanging at every larger row, instead of once with the largest, keeps all indices constant after unrolling.
        for i in k + 1..M {
            if a[i][k].abs() > a[k][k].abs() {
                a.swap(i, k);
                b.swap(i, k);
                negative = !negative;
            }
        }
        let pivot = a[k][k];
        if pivot == T::zero() || !pivot.is_finite() {
            return None;
        }
        negative ^= pivot < T::zero();
        for i in k + 1..M {
            let factor = a[i][k] / pivot;
            for j in k + 1..M {
                a[i][j] -= factor * a[k][j];
            }
            for j in 0..K {
                b[i][j] -= factor * b[k][j];
            }
        }
    }
    for k in (0..M).rev() {
        for j in 0..K {
            let mut sum = b[k][j];
            for i in k + 1..M {
                sum -= a[k][i] * b[i][j];
            }
            b[k][j] = sum / a[k][k];
        }
    }
    Some(if negative { Orientation::Negative } else { Orientation::Positive })
}

#[cfg(test)]
mod tests {
    use super::{Orientation, eliminate};
    use proptest::prelude::*;

    #[test]
    fn pivots_away_from_zero() {
        let mut b = [[2.0], [1.0]];
        assert_eq!(eliminate([[0.0, 1.0], [1.0, 0.0]], &mut b), Some(Orientation::Negative));
        assert_eq!(b, [[1.0], [2.0]]);
    }

    #[test]
    fn singular_and_broken_matrices_are_refused() {
        assert_eq!(Orientation::of([[1.0, 2.0], [2.0, 4.0]]), None);
        assert_eq!(Orientation::of([[0.0; 3]; 3]), None);
        assert_eq!(Orientation::of([[f64::NAN, 1.0], [1.0, 0.0]]), None);
        assert_eq!(Orientation::of([[f64::INFINITY, 1.0], [1.0, 0.0]]), None);
    }

    #[test]
    fn determinants_beyond_the_exponent_range_keep_their_sign() {
        for scale in [1e-300, 1e300] {
            let rows = [[0.0, scale, 0.0], [scale, 0.0, 0.0], [0.0, 0.0, scale]];
            let mut b = [[scale], [2.0 * scale], [3.0 * scale]];
            assert_eq!(eliminate(rows, &mut b), Some(Orientation::Negative));
            assert_eq!(b, [[2.0], [1.0], [3.0]]);
        }
    }

    proptest! {
        #[test]
        fn solutions_are_backward_stable(
            a in prop::array::uniform4(prop::array::uniform4(-1.0_f64..1.0)),
            b in prop::array::uniform4(-1.0_f64..1.0),
        ) {
            let mut x = b.map(|entry| [entry]);
            prop_assume!(eliminate(a, &mut x).is_some());
            for (row, entry) in a.iter().zip(b) {
                let size: f64 = row.iter().zip(x).map(|(r, [x])| (r * x).abs()).sum();
                let residual: f64 = row.iter().zip(x).map(|(r, [x])| r * x).sum::<f64>() - entry;
                let largest = x.iter().fold(0.0_f64, |m, [x]| m.max(x.abs()));
                prop_assert!(residual.abs() <= 64.0 * f64::EPSILON * (size + largest + entry.abs()));
            }
        }

        #[test]
        fn the_sign_is_that_of_the_determinant(a in prop::array::uniform3(prop::array::uniform3(-1.0_f64..1.0))) {
            let det = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
                + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
            prop_assume!(det.abs() > 1e-12);
            let sign = if det > 0.0 { Orientation::Positive } else { Orientation::Negative };
            prop_assert_eq!(Orientation::of(a), Some(sign));
        }
    }
}
