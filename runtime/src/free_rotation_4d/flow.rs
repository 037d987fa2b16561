//! Skew matrices of four dimensions, and free motions by the Taylor series in time.

use crate::linear::rows;
use crate::{Real, Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// The entries (i, j) above the diagonal, in the order of the components.
pub(crate) const PLANES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// A matrix by rows.
pub(crate) type Matrix<T> = [[T; 4]; 4];

/// One number for each of the [`PLANES`].
pub(crate) type Vector<T> = SVector<T, 6>;

/// F − I of a motion, and the momentum after it.
pub(crate) type Moved<T> = (Matrix<T>, Vector<T>);

/// The skew matrix with these entries above the diagonal.
pub(crate) fn skew<T: Scalar>(v: &Vector<T>) -> Matrix<T> {
    let ([[a, b, c, d, e, f]], zero) = (v.data.0, T::zero());
    [[zero, a, b, c], [-a, zero, d, e], [-b, -d, zero, f], [-c, -e, -f, zero]]
}

/// The entries above the diagonal.
#[inline]
pub(crate) fn above<T: Scalar>([[_, a, b, c], [_, _, d, e], [_, _, _, f], _]: &Matrix<T>) -> Vector<T> {
    SVector::from([*a, *b, *c, *d, *e, *f])
}

/// One of four numbers: indices are below 4, and no panic is left where the optimiser does not see that.
#[inline(always)]
pub(crate) fn at<T: Copy>(numbers: &[T; 4], axis: usize) -> T {
    numbers[axis % 4]
}

/// An entry of a matrix, as [`at`] is of a vector.
#[inline(always)]
pub(crate) fn entry<T: Copy>(matrix: &Matrix<T>, row: usize, column: usize) -> T {
    matrix[row % 4][column % 4]
}

/// Its place.
#[inline(always)]
pub(crate) fn place<T>(matrix: &mut Matrix<T>, row: usize, column: usize) -> &mut T {
    &mut matrix[row % 4][column % 4]
}

/// ⋆v, the planes perpendicular to those of v.
#[inline]
pub(crate) fn dual<T: Scalar>(v: &Vector<T>) -> Vector<T> {
    SVector::from([v[5], -v[4], v[3], v[2], -v[1], v[0]])
}

/// The entries of v² above the diagonal.
#[inline(always)]
pub(crate) fn above_of_square<T: Scalar>(v: &Vector<T>) -> Vector<T> {
    let [[a, b, c, d, e, f]] = v.data.0;
    SVector::from([-(b * d + c * e), a * d - c * f, a * e + b * f, -(a * b + e * f), d * f - a * c, -(b * c + d * e)])
}

/// Pf v
#[inline]
pub(crate) fn pfaffian<T: Scalar>(v: &Vector<T>) -> T {
    v[0] * v[5] - v[1] * v[4] + v[2] * v[3]
}

#[inline]
pub(crate) fn dot<'a, T: Scalar>(a: impl IntoIterator<Item = &'a T>, b: impl IntoIterator<Item = &'a T>) -> T {
    a.into_iter().zip(b).fold(T::zero(), |sum, (a, b)| sum + *a * *b)
}

/// A B
#[inline]
pub(crate) fn product<T: Scalar>(a: &Matrix<T>, b: &Matrix<T>) -> Matrix<T> {
    let term = |i: usize, k: usize, j: usize| entry(a, i, k) * entry(b, k, j);
    core::array::from_fn(|i| {
        core::array::from_fn(|j| (term(i, 0, j) + term(i, 1, j)) + (term(i, 2, j) + term(i, 3, j)))
    })
}

/// The most terms of a series. Motions of a radian take some twenty.
const TERMS: usize = 36;

/// F − I and the momentum after the free motion from I in the time 1, Ω = `velocity`(M); `None` where the series has not ended.
#[cold]
pub(crate) fn flow<T: Real>(velocity: impl Fn(&Vector<T>) -> Vector<T>, m: &Vector<T>) -> Option<Moved<T>> {
    let zero = T::zero();
    let nothing = SVector::from_element(zero);
    let (mut rotations, mut momenta, mut velocities) = ([[[zero; 4]; 4]; TERMS], [nothing; TERMS], [nothing; TERMS]);
    rotations[0] = rows(&SMatrix::identity());
    (momenta[0], velocities[0]) = (*m, velocity(m));
    let small = T::from_ratio(1, 32) * T::EPSILON;
    let (mut whole, mut ends, mut derivatives) = (([[zero; 4]; 4], *m), 0, T::DERIVATIVES);
    for n in 0..TERMS - 1 {
        let factor = T::from_ratio(1, n as i64 + 1);
        let (mut rotation, mut momentum) = ([[zero; 4]; 4], nothing);
        let backward = velocities.iter().take(n + 1).rev();
        for ((turn, body), speed) in rotations.iter().zip(&momenta).zip(backward) {
            let (body, speed) = (skew(body), skew(speed));
            for (row, of_row) in rotation.iter_mut().zip(turn) {
                for (j, sum) in row.iter_mut().enumerate() {
                    *sum += of_row.iter().zip(&speed).fold(zero, |sum, (turned, row)| sum + *turned * at(row, j));
                }
            }
            for (sum, &(i, j)) in momentum.iter_mut().zip(&PLANES) {
                *sum += (0..4).fold(zero, |sum, k| {
                    sum + entry(&body, i, k) * entry(&speed, k, j) - entry(&speed, i, k) * entry(&body, k, j)
                });
            }
        }
        let rotation = rotation.map(|row| row.map(|entry| entry * factor));
        momentum *= factor;
        (rotations[n + 1], momenta[n + 1], velocities[n + 1]) = (rotation, momentum, velocity(&momentum));
        whole.0.iter_mut().flatten().zip(rotation.iter().flatten()).for_each(|(sum, term)| *sum += *term);
        whole.1 += momentum;
        let is_small = rotation.max_abs() < small && momentum.max_abs() <= small * m.max_abs();
        ends = if is_small { ends + 1 } else { 0 };
        // two terms in a row, as one may vanish
        if ends >= 2 {
            if derivatives == 0 {
                return Some(whole);
            }
            derivatives -= 1;
        }
    }
    None
}
