//! Small linear systems: Gaussian elimination with partial pivoting in straight loops over constant bounds.
//!
//! For M = 3 the loops unroll and the matrix stays in registers. Only signs of pivots are used: the determinant overflows long before they do.

use crate::cofactors;
use crate::orientation::Orientation;
use crate::space::larger;
use crate::{Mask, Scalar, Space};
use core::array::from_fn;
use nalgebra::{ArrayStorage, SMatrix, SVector};
use num_traits::Zero;

/// x of A x = b, and the sign of det A in the lanes in which A is regular. `None` if there is no such lane.
pub type Solution<T, const M: usize> = Option<(SVector<T, M>, Orientation)>;

/// Runs `$body` for `$k` from 0 to `$n` − 1, or backwards. Each of the first four times is code of its own, in which
/// indices are constants.
///
/// Otherwise a loop with bounds that depend on it stays a loop for lanes, with the matrix in memory. Eight free bodies
/// then took half as long again.
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

/// Solves A X = B in place of `b`: Gaussian elimination with partial pivoting, X of shape M×K. Returns the sign of det A. `b` is spoilt
/// where a pivot is zero or not finite; `None` if in all lanes. Cost: M³/3 + M²/2 + M²K multiplications.
#[inline]
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

/// x of A x = b and the sign of det A, by cofactors or by elimination with pivoting. `None` if A is singular or not
/// finite in all lanes.
#[inline(always)]
pub fn solve_dense<T: Scalar, const M: usize>(a: &SMatrix<T, M, M>, b: &SVector<T, M>) -> Solution<T, M> {
    if !matches!(M, 3 | 6) {
        return eliminated(rows(a), b);
    }
    let (x, orientation, safe) = cofactors::solve(a, b);
    if safe.all() {
        return Some((x, orientation));
    }
    // Copies on the cold path only: a value that is passed by reference lies in memory in every solve. So does a result
    // that is returned in one piece.
    let (a, b, own) = (*a, *b, x);
    let (x, orientation) = eliminated_at_last((&a, &b), &own, orientation, safe)?;
    Some((x, orientation))
}

/// The same where cofactors do not serve in all lanes: in other units near the ends of the exponent range, elsewhere by elimination.
#[cold]
#[inline(never)]
fn eliminated_at_last<T: Scalar, const M: usize>(
    (a, b): (&SMatrix<T, M, M>, &SVector<T, M>),
    x: &SVector<T, M>,
    mut orientation: Orientation,
    mut safe: T::Mask,
) -> Solution<T, M> {
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
    match eliminated(rows(a), b) {
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

/// The same of a matrix by rows, by elimination with pivoting.
#[inline]
pub(crate) fn eliminated<T: Scalar, const M: usize>(rows: [[T; M]; M], b: &SVector<T, M>) -> Solution<T, M> {
    let mut unknowns: [[T; 1]; M] = from_fn(|i| [b[i]]);
    let orientation = eliminate(rows, &mut unknowns)?;
    Some((SVector::from_fn(|i, _| unknowns[i][0]), orientation))
}

/// x of A x = b and the sign of det A for a symmetric matrix. Where A is definite, A = L D Lᵀ needs no pivoting. This
/// is stable (Higham, *Accuracy and Stability of Numerical Algorithms*, theorem 10.3). To leading orders it takes
/// M³/6 + 3M²/2 multiplications and M divisions. For large M this is about half the work of [`solve_dense`], and rows
/// are not exchanged. Where the pivots differ in sign, [`solve_dense`] takes over.
#[inline]
pub fn solve_symmetric<T: Scalar, const M: usize>(a: &SMatrix<T, M, M>, b: &SVector<T, M>) -> Solution<T, M> {
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

/// A matrix from its rows.
#[inline]
pub fn matrix<T: Scalar, const R: usize, const C: usize>(rows: [[T; C]; R]) -> SMatrix<T, R, C> {
    SMatrix::from_array_storage(ArrayStorage(from_fn(|j| from_fn(|i| entry(&rows, i, j)))))
}

/// Entry (i, j) of rows that have it: where the optimiser does not see that they do, no panic is left.
#[inline(always)]
pub(crate) fn entry<T: Scalar, const R: usize, const C: usize>(rows: &[[T; C]; R], i: usize, j: usize) -> T {
    rows.get(i).and_then(|row| row.get(j)).copied().unwrap_or_else(T::zero)
}

/// A⁻¹B, by elimination with partial pivoting; `None` where A is singular or not finite in all lanes.
#[inline]
pub(crate) fn divided<T: Scalar, const M: usize, const K: usize>(
    a: &SMatrix<T, M, M>,
    b: &SMatrix<T, M, K>,
) -> Option<SMatrix<T, M, K>> {
    let mut quotient = rows(b);
    eliminate(rows(a), &mut quotient).map(|_| matrix(quotient))
}

/// A B, each entry summed from the first term; B may be a vector.
#[inline]
pub(crate) fn product<T: Scalar, const N: usize, const M: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    let mut product = SMatrix::from_element(T::zero());
    for (column, factors) in product.data.0.iter_mut().zip(&b.data.0) {
        for (factor, terms) in factors.iter().zip(&a.data.0) {
            column.iter_mut().zip(terms).for_each(|(sum, term)| *sum += *term * *factor);
        }
    }
    product
}

/// The largest Σ_j |A_ij| of a row i: a norm with |AB| ≤ |A||B|, of vectors too. NaN are passed over.
#[inline]
pub(crate) fn norm<T: Scalar, const N: usize, const M: usize>(a: &SMatrix<T, N, M>) -> T {
    let mut sums = [T::zero(); N];
    a.data.0.iter().for_each(|column| sums.iter_mut().zip(column).for_each(|(sum, x)| *sum += x.abs()));
    sums.into_iter().fold(T::zero(), larger)
}

/// f(A), lane by lane; NaN where A is not finite or f has no value.
pub(crate) fn function<T: Scalar, const N: usize>(
    a: &SMatrix<T, N, N>,
    f: impl Fn(&SMatrix<T::Lane, N, N>) -> Option<SMatrix<T::Lane, N, N>>,
) -> SMatrix<T, N, N> {
    Space::<T>::side_by_side(|lane| {
        let a = a.lane(lane);
        let value = if Space::<T::Lane>::all_finite(&a) { f(&a) } else { None };
        value.unwrap_or_else(|| SMatrix::from_element(T::Lane::zero() / T::Lane::zero()))
    })
}

#[cfg(test)]
mod tests;
