//! Linear systems of three and six unknowns by cofactors: one division for every three unknowns, and nothing that waits for pivots.
//!
//! A x = b has x = adj A b/det A. Of six unknowns the first three are eliminated together. Where digits cancel, or numbers are near the
//! ends of the exponent range, there is no answer, and elimination with pivoting takes over.
//!
//! All of it is inlined where it is called: a Jacobian that goes through memory costs more than the solution.

use crate::orientation::Orientation;
use crate::{Mask, Scalar};
use nalgebra::{SMatrix, SVector};

type Columns<T> = [[T; 3]; 3];

/// Whether [`solve`] knows systems of so many unknowns.
pub(crate) const fn are_for(unknowns: usize) -> bool {
    unknowns == 3 || unknowns == 6
}

/// x of A x = b and the sign of det A, and in which lanes they are so: not where A is singular, not finite, or not safely solved like this.
///
/// Accuracy: the relative error of x in the norm in which the columns of A have the length 1 is below 2¹⁶ ε.
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
            let schur =
                [minus(&corner[0], &carried[0]), minus(&corner[1], &carried[1]), minus(&corner[2], &carried[2])];
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
    [
        [a[(i, j)], a[(i + 1, j)], a[(i + 2, j)]],
        [a[(i, j + 1)], a[(i + 1, j + 1)], a[(i + 2, j + 1)]],
        [a[(i, j + 2)], a[(i + 1, j + 2)], a[(i + 2, j + 2)]],
    ]
}

/// Three entries of a vector.
#[inline(always)]
fn part<T: Scalar, const M: usize>(b: &SVector<T, M>, i: usize) -> [T; 3] {
    [b[i], b[i + 1], b[i + 2]]
}

/// Whether a difference has more than a few digits of what it was made of.
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
        // comparisons with NaN are false
        let is_safe = |product: T| least.at_most(product) & (product * least).at_most(T::one());
        let is_regular = (cancelled::<T>() * (la * (lb * lc))).at_most(determinant.abs());
        // neither is below the normal numbers where four times the other does not overflow
        let four = T::from_ratio(4, 1);
        let is_normal = (four * determinant).finite() & (four * reciprocal).finite();
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
mod tests {
    use crate::linear::solve_dense;
    use crate::orientation::Orientation;
    use nalgebra::{Matrix3, Matrix6, SMatrix, SVector, Vector3, Vector6};
    use proptest::prelude::*;

    fn solve<const M: usize>(a: &SMatrix<f64, M, M>, b: &SVector<f64, M>) -> Option<(SVector<f64, M>, Orientation)> {
        let (x, orientation, known) = super::solve(a, b);
        known.then_some((x, orientation))
    }

    #[test]
    fn six_unknowns_in_two_halves() {
        let a = Matrix6::from_fn(|i, j| if i == j { -4.0 } else { 1.0 / (1 + i + 2 * j) as f64 });
        let x = Vector6::new(1.0, -2.0, 3.0, -4.0, 5.0, -6.0);
        let (solution, orientation) = solve(&a, &(a * x)).expect("a regular matrix");
        assert!((solution - x).amax() < 1e-14 && orientation == Orientation::POSITIVE);
        let (_, mirrored) = solve(&Matrix6::from_rows(&[5, 1, 2, 3, 4, 0].map(|i| a.row(i))), &x).unzip();
        assert!(mirrored.is_none_or(|orientation| orientation == Orientation::NEGATIVE));
    }

    /// Singular, nearly so, not finite, and near the ends of the exponent range.
    #[test]
    fn what_is_not_safe_is_left_to_elimination() {
        let regular = Matrix3::new(2.0, 1.0, 0.0, 1.0, 3.0, 1.0, 0.0, 1.0, 4.0);
        let b = Vector3::new(1.0, 2.0, 3.0);
        assert!(solve(&regular, &b).is_some());
        let nearly = Matrix3::from_columns(&[b, b * 2.0, b]) + Matrix3::identity() * 1e-6;
        for unsafe_one in [Matrix3::zeros(), nearly, regular * f64::NAN, regular * f64::INFINITY] {
            assert_eq!(solve(&unsafe_one, &b), None);
        }
        for scale in [2.0_f64.powi(-1000), 2.0_f64.powi(-350), 2.0_f64.powi(350), 2.0_f64.powi(1000)] {
            assert_eq!(solve(&(regular * scale), &b), None);
            let (x, orientation) = solve_dense(&(regular * scale), &(b * scale)).expect("a regular matrix");
            assert!((regular * x - b).amax() < 1e-14 && orientation == Orientation::POSITIVE);
        }
    }

    fn agrees<const M: usize>(a: SMatrix<f64, M, M>, b: SVector<f64, M>) -> Result<(), TestCaseError> {
        let Some((x, orientation)) = solve(&a, &b) else { return Ok(()) };
        let rows: [[f64; M]; M] = core::array::from_fn(|i| core::array::from_fn(|j| a[(i, j)]));
        prop_assert_eq!(Some(orientation), Orientation::of(rows));
        let size: f64 = (0..M).map(|j| a.column(j).amax() * x[j].abs()).sum();
        prop_assert!((a * x - b).amax() <= 65536.0 * f64::EPSILON * (size + b.amax()));
        Ok(())
    }

    proptest! {
        /// Of any matrix, with columns of very different size too.
        #[test]
        fn three_unknowns_as_by_elimination(
            a in prop::array::uniform9(-1.0_f64..1.0),
            b in prop::array::uniform3(-1.0_f64..1.0),
            sizes in prop::array::uniform3(-9..9_i32),
        ) {
            let columns = Matrix3::from_diagonal(&Vector3::from(sizes.map(|size| 10.0_f64.powi(size))));
            agrees(Matrix3::from_iterator(a) * columns, b.into())?;
        }

        #[test]
        fn six_unknowns_as_by_elimination(
            a in prop::array::uniform32(-1.0_f64..1.0),
            b in prop::array::uniform6(-1.0_f64..1.0),
            shift in -4.0_f64..4.0,
        ) {
            let a = Matrix6::from_fn(|i, j| a[(7 * i + j) % 32]) + Matrix6::identity() * shift;
            agrees(a, b.into())?;
        }
    }
}
