//! Linear systems of three and six unknowns by cofactors: one division for every three unknowns, and nothing that waits for pivots.
//!
//! A x = b has x = adj A b/det A. Of six unknowns the first three are eliminated together. Where digits cancel, or numbers are near the
//! ends of the exponent range, there is no answer, and elimination with pivoting takes over.
//!
//! All of it is inlined where it is called: a Jacobian that goes through memory costs more than the solution.

use crate::orientation::Orientation;
use crate::{Mask, Scalar};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

type Columns<T> = [[T; 3]; 3];

/// x of A x = b with 3 or 6 unknowns, the sign of det A, and the lanes in which both are safe. A lane is safe if A is
/// regular, finite, and not too ill-conditioned. Accuracy: the relative error of x in the norm in which the columns of
/// A have the length 1 is below 2¹⁶ ε.
#[inline(always)]
pub(crate) fn solve<T: Scalar, const M: usize>(
    a: &SMatrix<T, M, M>,
    b: &SVector<T, M>,
) -> (SVector<T, M>, Orientation, T::Mask) {
    match M {
        3 => {
            let inverse = Inverse::of(&block(a, 0, 0));
            let x = inverse.times(&part(b, 0));
            (SVector::from_fn(|i, _| x[i]), Orientation::new(inverse.known, inverse.is_negative()), inverse.known)
        }
        6 => {
            // (A B; C D)(x; y) = (r; s): (D − C A⁻¹B) y = s − C A⁻¹r
            let ([lower, right], corner) = ([block(a, 3, 0), block(a, 0, 3)], block(a, 3, 3));
            let first = Inverse::of(&block(a, 0, 0));
            let (ab, ar) = (first.times_columns(&right), first.times(&part(b, 0)));
            let carried = columns_times(&lower, &ab);
            let schur: Columns<T> = from_fn(|k| minus(&corner[k], &carried[k]));
            let keeps = keeps_digits(&schur[0], &corner[0], &carried[0])
                & keeps_digits(&schur[1], &corner[1], &carried[1])
                & keeps_digits(&schur[2], &corner[2], &carried[2]);
            let second = Inverse::of(&schur);
            let y = second.times(&minus(&part(b, 3), &times(&lower, &ar)));
            let x = minus(&ar, &times(&ab, &y));
            let known = first.known & second.known & keeps;
            let negative = first.is_negative() ^ second.is_negative();
            (SVector::from_fn(|i, _| if i < 3 { x[i] } else { y[i - 3] }), Orientation::new(known, negative), known)
        }
        // by construction: no others are asked for
        _ => (*b, Orientation::new(T::Mask::nowhere(), T::Mask::nowhere()), T::Mask::nowhere()),
    }
}

/// Three columns of a matrix, from an entry on.
#[inline(always)]
fn block<T: Scalar, const M: usize>(a: &SMatrix<T, M, M>, i: usize, j: usize) -> Columns<T> {
    from_fn(|l| from_fn(|k| a[(i + k, j + l)]))
}

/// Three entries of a vector.
#[inline(always)]
fn part<T: Scalar, const M: usize>(b: &SVector<T, M>, i: usize) -> [T; 3] {
    [b[i], b[i + 1], b[i + 2]]
}

/// Whether a difference has more than a few digits of its operands.
#[inline(always)]
fn keeps_digits<T: Scalar>(difference: &[T; 3], a: &[T; 3], b: &[T; 3]) -> T::Mask {
    (cancelled::<T>() * (norm(a) + norm(b))).at_most(norm(difference))
}

/// The digits of a sum that may cancel: a factor of 2¹².
#[inline(always)]
fn cancelled<T: Scalar>() -> T {
    T::from_ratio(1, 1 << 12)
}

/// An inverse matrix.
struct Inverse<T: Scalar> {
    /// The rows of adj A.
    adjugate: [[T; 3]; 3],
    /// 1/det A
    reciprocal: T,
    /// Where A is regular, and no digits are lost.
    known: T::Mask,
}

impl<T: Scalar> Inverse<T> {
    #[inline(always)]
    fn of([a, b, c]: &Columns<T>) -> Self {
        let adjugate = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant = dot(a, &adjugate[0]);
        let reciprocal = T::one() / determinant;
        let [la, lb, lc] = [norm(a), norm(b), norm(c)];
        let least = T::EPSILON * T::EPSILON * T::EPSILON * T::EPSILON;
        let most = T::one() / least;
        // comparisons with NaN are false
        let is_safe = |product: T| least.at_most(product) & product.at_most(most);
        let is_regular = (cancelled::<T>() * (la * (lb * lc))).at_most(determinant.abs());
        // Neither is below the normal numbers where four times the other does not overflow. Their sum is the larger one, where that is so large.
        let is_normal = (T::from_ratio(4, 1) * (determinant + reciprocal)).finite();
        let known = is_regular & is_safe(la * lb) & is_safe(lb * lc) & is_safe(lc * la) & is_normal;
        Self { adjugate, reciprocal, known }
    }

    #[inline(always)]
    fn times(&self, x: &[T; 3]) -> [T; 3] {
        let ([a, b, c], reciprocal) = (&self.adjugate, self.reciprocal);
        [dot(a, x) * reciprocal, dot(b, x) * reciprocal, dot(c, x) * reciprocal]
    }

    #[inline(always)]
    fn times_columns(&self, [a, b, c]: &Columns<T>) -> Columns<T> {
        [self.times(a), self.times(b), self.times(c)]
    }

    #[inline(always)]
    fn is_negative(&self) -> T::Mask {
        self.reciprocal.below(T::zero())
    }
}

/// A x of a matrix by columns.
#[inline(always)]
fn times<T: Scalar>([a, b, c]: &Columns<T>, [x, y, z]: &[T; 3]) -> [T; 3] {
    let [x, y, z] = [*x, *y, *z];
    [a[0] * x + b[0] * y + c[0] * z, a[1] * x + b[1] * y + c[1] * z, a[2] * x + b[2] * y + c[2] * z]
}

#[inline(always)]
fn columns_times<T: Scalar>(a: &Columns<T>, [x, y, z]: &Columns<T>) -> Columns<T> {
    [times(a, x), times(a, y), times(a, z)]
}

#[inline(always)]
fn minus<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The sum of all |x_i|.
#[inline(always)]
fn norm<T: Scalar>(x: &[T; 3]) -> T {
    x[0].abs() + x[1].abs() + x[2].abs()
}

#[cfg(test)]
mod tests;
