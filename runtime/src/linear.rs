//! Small linear systems: Gaussian elimination with partial pivoting in straight loops over constant bounds.
//!
//! For M = 3 the loops unroll and the matrix stays in registers. Only signs of pivots are used, never the determinant, which
//! overflows long before its factors do.

use crate::cofactors;
use crate::orientation::Orientation;
use crate::space::larger;
use crate::{Mask, Scalar, Space};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// Runs `$body` for `$k` from 0 to `$n` − 1, or backwards; each of the first four times is code of its own, in which indices are constants.
///
/// Without that, a loop over loops whose bounds depend on it stays a loop for lanes, with the matrix in memory: a step of eight free bodies
/// took half as long again.
macro_rules! unrolled {
    ($k:ident in 0..$n:ident $body:block) => {
        unrolled!(@ $k $n $body 0 1 2 3);
        for $k in 4..$n $body
    };
    ($k:ident in (0..$n:ident).rev() $body:block) => {
        for $k in (4..$n).rev() $body
        unrolled!(@ $k $n $body 3 2 1 0);
    };
    (@ $k:ident $n:ident $body:block $($number:literal)*) => {$(
        if $number < $n {
            let $k: usize = $number;
            $body
        }
    )*};
}

/// Solves A X = B in place of `b`: Gaussian elimination with partial pivoting, X of shape M×K.
///
/// Returns the sign of det A. Where a pivot is zero or not finite `b` is spoilt; `None` where that is so in all lanes.
/// Cost: M³/3 + M²/2 + M²K multiplications to leading orders and M divisions.
#[inline]
#[allow(clippy::needless_range_loop)] // Indices show the algorithm and, below constant bounds, cost no checks.
pub(crate) fn eliminate<T: Scalar, const M: usize, const K: usize>(
    mut a: [[T; M]; M],
    b: &mut [[T; K]; M],
) -> Option<Orientation> {
    let (mut regular, mut negative) = (T::Mask::everywhere(), T::Mask::nowhere());
    let mut reciprocals = [T::zero(); M];
    unrolled!(k in 0..M {
        // Exchanging at every larger row, instead of once with the largest, keeps all indices constant after unrolling.
        for i in k + 1..M {
            let is_larger = a[k][k].abs().below(a[i][k].abs());
            if is_larger.any() {
                exchange(is_larger, &mut a, i, k);
                exchange(is_larger, b, i, k);
                negative = negative ^ is_larger;
            }
        }
        let pivot = a[k][k];
        regular = regular & !pivot.equals(T::zero()) & pivot.finite();
        if !regular.any() {
            return None;
        }
        negative = negative ^ pivot.below(T::zero());
        // divisions that wait for each other are most of the time of small systems
        reciprocals[k] = T::one() / pivot;
        for i in k + 1..M {
            let factor = a[i][k] * reciprocals[k];
            for j in k + 1..M {
                a[i][j] -= factor * a[k][j];
            }
            for j in 0..K {
                b[i][j] -= factor * b[k][j];
            }
        }
    });
    unrolled!(k in (0..M).rev() {
        for j in 0..K {
            let mut sum = b[k][j];
            for i in k + 1..M {
                sum -= a[k][i] * b[i][j];
            }
            b[k][j] = sum * reciprocals[k];
        }
    });
    Some(Orientation::new(regular, negative))
}

impl Orientation {
    /// The sign of the determinant of `rows`, `None` where it is singular or not finite in some lane.
    #[inline]
    pub fn of<T: Scalar, const M: usize>(rows: [[T; M]; M]) -> Option<Self> {
        eliminate::<T, M, 0>(rows, &mut [[]; M]).filter(|orientation| orientation.lanes::<T>().all())
    }
}

/// Exchanges two rows in the lanes of `mask`.
#[inline]
#[allow(clippy::needless_range_loop)] // as above
fn exchange<T: Scalar, const M: usize, const K: usize>(mask: T::Mask, rows: &mut [[T; K]; M], i: usize, k: usize) {
    for j in 0..K {
        let (x, y) = (rows[i][j], rows[k][j]);
        (rows[i][j], rows[k][j]) = (T::select(mask, y, x), T::select(mask, x, y));
    }
}

/// x of A x = b; `None` where A is singular or not finite in some lane.
#[inline]
pub fn solve_linear<T: Scalar, const M: usize>(a: &SMatrix<T, M, M>, b: &SVector<T, M>) -> Option<SVector<T, M>> {
    let (x, orientation) = solve_dense(a, b)?;
    orientation.lanes::<T>().all().then_some(x)
}

/// x of A x = b and the sign of det A, by cofactors or by elimination with pivoting; `None` where A is singular or not finite in all lanes.
#[inline(always)]
pub fn solve_dense<T: Scalar, const M: usize>(
    a: &SMatrix<T, M, M>,
    b: &SVector<T, M>,
) -> Option<(SVector<T, M>, Orientation)> {
    if !cofactors::are_for(M) {
        return eliminated(a, b);
    }
    let (x, orientation, safe) = cofactors::solve(a, b);
    if safe.all() {
        return Some((x, orientation));
    }
    // Copies on the cold path only: what is passed by reference lies in memory in every solve, and what is returned whole does too.
    let (a, b, own) = (*a, *b, x);
    let (x, orientation) = eliminated_at_last((&a, &b), &own, orientation, safe)?;
    Some((x, orientation))
}

/// The same where cofactors do not serve in all lanes: near the ends of the exponent range in other units, in which the digits are those of numbers
/// of ordinary size, and elsewhere by elimination.
#[cold]
#[inline(never)]
fn eliminated_at_last<T: Scalar, const M: usize>(
    (a, b): (&SMatrix<T, M, M>, &SVector<T, M>),
    x: &SVector<T, M>,
    mut orientation: Orientation,
    mut safe: T::Mask,
) -> Option<(SVector<T, M>, Orientation)> {
    let mut x = *x;
    let unit = power_of_two_near(a.max_abs());
    let (other, turned, other_safe) = cofactors::solve(&a.map(|entry| entry * unit), &b.map(|entry| entry * unit));
    if (!safe & other_safe).any() {
        x = x.zip_map(&other, |own, other| T::select(safe, own, other));
        (orientation, safe) = (orientation.or(safe.bits(), Some(turned)), safe | other_safe);
    }
    if safe.all() {
        return Some((x, orientation));
    }
    match eliminated(a, b) {
        Some((other, turned)) => {
            let x = x.zip_map(&other, |own, other| T::select(safe, own, other));
            Some((x, orientation.or(safe.bits(), Some(turned))))
        }
        None => safe.any().then(|| (x, orientation.or(safe.bits(), None))),
    }
}

/// 2¹⁶ᵏ, times which `size` is between 2⁻¹⁶ and 2¹⁶; where it is zero or not finite any power.
pub(crate) fn power_of_two_near<T: Scalar>(size: T) -> T {
    /// For the range of `f64` in steps of 2¹⁶.
    const STEPS: usize = 64;
    let (large, small) = (T::from_ratio(1 << 16, 1), T::from_ratio(1, 1 << 16));
    let mut power = T::one();
    for _ in 0..STEPS {
        let (is_small, is_large) = ((size * power).below(small), large.below(size * power));
        if !(is_small | is_large).any() {
            break;
        }
        power = T::select(is_small, power * large, T::select(is_large, power * small, power));
    }
    power
}

#[inline]
fn eliminated<T: Scalar, const M: usize>(
    a: &SMatrix<T, M, M>,
    b: &SVector<T, M>,
) -> Option<(SVector<T, M>, Orientation)> {
    let mut unknowns: [[T; 1]; M] = from_fn(|i| [b[i]]);
    let orientation = eliminate(rows(a), &mut unknowns)?;
    Some((SVector::from_fn(|i, _| unknowns[i][0]), orientation))
}

/// x of A x = b and the sign of det A for a symmetric matrix.
///
/// A = L D Lᵀ without pivoting where A is definite, which is stable (Higham, *Accuracy and Stability of Numerical Algorithms*,
/// theorem 10.3): M³/6 + 3M²/2 multiplications to leading orders and M divisions, about half the work of [`solve_dense`] for large M, and
/// no exchanges of rows. Where the pivots differ in sign, [`solve_dense`] takes over.
#[inline]
#[allow(clippy::needless_range_loop)] // Indices show the algorithm and, below constant bounds, cost no checks.
pub fn solve_symmetric<T: Scalar, const M: usize>(
    a: &SMatrix<T, M, M>,
    b: &SVector<T, M>,
) -> Option<(SVector<T, M>, Orientation)> {
    let mut l = rows(a);
    let mut x: [T; M] = from_fn(|i| b[i]);
    let mut reciprocals = [T::zero(); M];
    let (first, mut is_definite) = (T::zero().below(a[(0, 0)]), T::Mask::everywhere());
    for k in 0..M {
        let pivot = l[k][k];
        let agrees = !(T::zero().below(pivot) ^ first);
        is_definite = is_definite & agrees & !pivot.equals(T::zero()) & pivot.finite();
        if !is_definite.any() {
            return solve_dense(a, b);
        }
        reciprocals[k] = T::one() / pivot;
        for i in k + 1..M {
            let factor = l[i][k] * reciprocals[k];
            for j in k + 1..=i {
                l[i][j] -= factor * l[j][k];
            }
            x[i] -= factor * x[k];
        }
    }
    // row k of D Lᵀ stands in column k below the diagonal
    for k in (0..M).rev() {
        for i in k + 1..M {
            x[k] -= l[i][k] * x[i];
        }
        x[k] *= reciprocals[k];
    }
    let (x, negative) = (SVector::from_fn(|i, _| x[i]), if M % 2 == 1 { !first } else { T::Mask::nowhere() });
    let orientation = Orientation::new(is_definite, negative);
    if is_definite.all() {
        return Some((x, orientation));
    }
    let (others, signs) = solve_dense(a, b).unzip();
    let others = others.unwrap_or(x);
    Some((x.zip_map(&others, |x, other| T::select(is_definite, x, other)), orientation.or(is_definite.bits(), signs)))
}

/// A matrix by rows.
#[inline]
pub(crate) fn rows<T: Scalar, const R: usize, const C: usize>(matrix: &SMatrix<T, R, C>) -> [[T; C]; R] {
    from_fn(|i| from_fn(|j| matrix.get((i, j)).copied().unwrap_or_else(T::zero)))
}

/// Entry (i, j) of rows that have it: where the optimiser does not see that they do, no panic is left.
#[inline(always)]
pub(crate) fn entry<T: Scalar, const R: usize, const C: usize>(rows: &[[T; C]; R], i: usize, j: usize) -> T {
    rows.get(i).and_then(|row| row.get(j)).copied().unwrap_or_else(T::zero)
}

/// A B of square matrices by rows.
#[inline]
pub(crate) fn product<T: Scalar, const N: usize>(a: &[[T; N]; N], b: &[[T; N]; N]) -> [[T; N]; N] {
    from_fn(|i| from_fn(|j| (0..N).fold(T::zero(), |sum, k| sum + entry(a, i, k) * entry(b, k, j))))
}

/// c I
#[inline]
pub(crate) fn multiple_of_identity<T: Scalar, const N: usize>(c: T) -> [[T; N]; N] {
    from_fn(|i| from_fn(|j| if i == j { c } else { T::zero() }))
}

/// A + c I
#[inline]
pub(crate) fn shifted<T: Scalar, const N: usize>(a: &[[T; N]; N], c: T) -> [[T; N]; N] {
    from_fn(|i| from_fn(|j| if i == j { entry(a, i, j) + c } else { entry(a, i, j) }))
}

/// The largest Σ_j |A_ij| of a row i: a norm with |AB| ≤ |A||B|. NaN are passed over.
#[inline]
pub(crate) fn norm<T: Scalar, const N: usize>(a: &[[T; N]; N]) -> T {
    a.iter().fold(T::zero(), |max, row| larger(max, row.iter().fold(T::zero(), |sum, x| sum + x.abs())))
}

/// The matrix of NaN: what a function of a matrix is where it has no value.
pub(crate) fn undefined<T: Scalar, const N: usize>() -> SMatrix<T, N, N> {
    SMatrix::from_element(T::zero() / T::zero())
}

#[cfg(test)]
mod tests {
    use super::{Orientation, eliminate, norm, product, solve_dense, solve_linear, solve_symmetric};
    use nalgebra::{Matrix2, Matrix3, Matrix4, Vector2, Vector3, Vector4};
    use proptest::prelude::*;

    #[test]
    fn pivots_away_from_zero() {
        let mut b = [[2.0], [1.0]];
        assert_eq!(eliminate([[0.0, 1.0], [1.0, 0.0]], &mut b), Some(Orientation::NEGATIVE));
        assert_eq!(b, [[1.0], [2.0]]);
    }

    #[test]
    fn systems_are_solved_by_rows_and_products_made() {
        let solution = solve_linear(&Matrix2::new(0.0, 2.0, 4.0, 8.0), &Vector2::new(2.0, 0.0));
        assert_eq!(solution, Some(Vector2::new(-2.0, 1.0)));
        assert_eq!(solve_linear(&Matrix2::new(1.0, 2.0, 2.0, 4.0), &Vector2::x()), None);
        assert_eq!(product(&[[1.0, 2.0], [3.0, 4.0]], &[[0.0, 1.0], [-1.0, 5.0]]), [[-2.0, 11.0], [-4.0, 23.0]]);
        assert_eq!(norm(&[[1.0, -2.0], [-3.0, -4.0]]), 7.0);
    }

    /// Units of powers of two change no digit, up to the ends of the exponent range, where determinants leave it.
    #[test]
    fn solutions_have_no_units() {
        let (a, b) = (Matrix3::new(4.0, 1.0, -0.5, 1.25, 3.0, 0.75, -0.5, 0.25, 2.0), Vector3::new(1.0, -2.0, 0.5));
        let expected = solve_dense(&a, &b);
        let stride = if cfg!(miri) { 100 } else { 1 };
        for k in (-1000..1000).step_by(stride) {
            let unit = 2.0_f64.powi(k);
            assert_eq!(solve_dense(&(a * unit), &(b * unit)), expected, "2^{k}");
        }
        let (a, b) = (a.map(|x| x as f32), b.map(|x| x as f32));
        let expected = solve_dense(&a, &b);
        for k in (-115..120).step_by(stride) {
            let unit = 2.0_f32.powi(k);
            assert_eq!(solve_dense(&(a * unit), &(b * unit)), expected, "2^{k} in single precision");
        }
    }

    /// A definite matrix, an indefinite one, one whose leading minors vanish, and a singular one.
    #[test]
    fn symmetric_systems() {
        let b = Vector2::new(3.0, -1.0);
        let of = |a: f64, c: f64, d: f64| solve_symmetric(&Matrix2::new(a, f64::NAN, c, d), &b);
        assert_eq!(of(2.0, 1.0, 1.0), Some((Vector2::new(4.0, -5.0), Orientation::POSITIVE)));
        assert_eq!(of(-2.0, -1.0, -1.0), Some((Vector2::new(-4.0, 5.0), Orientation::POSITIVE)));
        let solved = |a: f64, c: f64, d: f64| solve_symmetric(&Matrix2::new(a, c, c, d), &b);
        assert_eq!(solved(1.0, 2.0, 2.0), Some((Vector2::new(-4.0, 3.5), Orientation::NEGATIVE)));
        assert_eq!(solved(0.0, 1.0, 0.0), Some((Vector2::new(-1.0, 3.0), Orientation::NEGATIVE)));
        assert_eq!(solved(1.0, 1.0, 1.0), None);
        assert_eq!(solved(f64::NAN, 1.0, 1.0), None);
        assert_eq!(solved(f64::INFINITY, 1.0, 1.0), None);
        let cubic = solve_symmetric(&-Matrix3::<f64>::identity(), &Vector3::x());
        assert_eq!(cubic, Some((-Vector3::x(), Orientation::NEGATIVE)));
    }

    #[test]
    fn signs_of_determinants_multiply() {
        let (plus, minus) = (Orientation::POSITIVE, Orientation::NEGATIVE);
        assert_eq!([plus * plus, plus * minus, minus * plus, minus * minus], [plus, minus, minus, plus]);
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
        // powers of two, whose reciprocals are exact
        for scale in [2.0_f64.powi(-1000), 2.0_f64.powi(1000)] {
            let rows = [[0.0, scale, 0.0], [scale, 0.0, 0.0], [0.0, 0.0, scale]];
            let mut b = [[scale], [2.0 * scale], [3.0 * scale]];
            assert_eq!(eliminate(rows, &mut b), Some(Orientation::NEGATIVE));
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

        /// Definite, indefinite and nearly singular ones, against elimination with pivoting.
        #[test]
        fn symmetric_solutions_are_those_of_elimination(
            a in prop::array::uniform4(prop::array::uniform4(-1.0_f64..1.0)),
            b in prop::array::uniform4(-1.0_f64..1.0),
            shift in -3.0_f64..3.0,
        ) {
            let a = Matrix4::from(a);
            let (a, b) = (a + a.transpose() + Matrix4::identity() * shift, Vector4::from(b));
            let (dense, symmetric) = (solve_dense(&a, &b), solve_symmetric(&a, &b));
            prop_assume!(dense.is_some());
            let ((x, sign), (y, other)) = (dense.unwrap(), symmetric.unwrap());
            prop_assert_eq!(sign, other);
            prop_assert!((a * y - b).amax() <= 64.0 * f64::EPSILON * (a.amax() * (y.amax() + x.amax()) + b.amax()));
        }

        #[test]
        fn the_sign_is_that_of_the_determinant(a in prop::array::uniform3(prop::array::uniform3(-1.0_f64..1.0))) {
            let det = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
                + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
            prop_assume!(det.abs() > 1e-12);
            let sign = if det > 0.0 { Orientation::POSITIVE } else { Orientation::NEGATIVE };
            prop_assert_eq!(Orientation::of(a), Some(sign));
        }
    }
}
