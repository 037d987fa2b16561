//! One step of a motion whose constants are known: no iteration, one division.

use super::flow::{Matrix, Moved, PLANES, Vector, above_of_square, at, dot, dual, entry, pfaffian, place};
use super::setup::{Constants, integrals};
use crate::{Mask, Scalar};

/// The largest error of these formulas that is accepted, in units of ε. If moments differ by a factor r, it is some r²/5.
///
/// The correction of [`orthogonal`] then leaves a rotation, in single precision too.
pub(super) const LARGEST_LOSS: i64 = 1 << 12;

/// F − I and the next m of a motion, from m = h̃M. `None` if rounding has taken F off the rotations in some lane, by more
/// than [`LARGEST_LOSS`].
#[inline]
pub(super) fn turn<T: Scalar>(constants: &Constants<T>, m: &Vector<T>) -> Option<Moved<T>> {
    let Powers { squares, square, pf, of_square } = Powers::of(m);
    let j = &constants.moments;
    let k = j.map(|j| j * j);
    let here = integrals(&k, &squares, pf);
    let e: [T; 3] = core::array::from_fn(|i| constants.origin[i] + dot(&constants.slopes[i], &here));
    let (n, g) = equation(j, &k, &e, m, (&of_square, square, pf));
    let adjugate = adjugate(&n);
    let determinant =
        (n[0][0] * adjugate[0][0] + n[0][1] * adjugate[1][0]) + (n[0][2] * adjugate[2][0] + n[0][3] * adjugate[3][0]);
    let inverse = determinant.recip();
    let mut motion = super::flow::product(&adjugate, &g).map(|row| row.map(|entry| entry * inverse));
    let next = PLANES
        .map(|(row, column)| at(j, row) * entry(&motion, row, column) - entry(&motion, column, row) * at(j, column));
    let next = on_level(constants, &next.into(), square, pf);
    let turn = of_casimirs(&constants.turn, m, &of_square, square);
    (0..4).for_each(|i| motion[i][i] -= T::one());
    Some((orthogonal(&composed(&turn, &motion))?, next))
}

/// m², and the other quadratic terms in m.
pub(crate) struct Powers<T> {
    pub squares: Vector<T>,
    /// |m|²
    pub square: T,
    pub pf: T,
    /// m²: above the diagonal, and on it.
    pub of_square: (Vector<T>, [T; 4]),
}

impl<T: Scalar> Powers<T> {
    #[inline]
    pub fn of(m: &Vector<T>) -> Self {
        let squares = m.component_mul(m);
        let [[aa, bb, cc, dd, ee, ff]] = squares.data.0;
        let diagonal = [-(aa + bb + cc), -(aa + dd + ee), -(bb + dd + ff), -(cc + ee + ff)];
        let square = (aa + bb + cc) + (dd + ee + ff);
        Self { squares, square, pf: pfaffian(m), of_square: (above_of_square(m), diagonal) }
    }
}

/// N = m³ + Km + mK + e₂m − e₁(m² + K) − e₃ and G = −(m² + K − e₁m + e₂ + e₄K⁻¹)J̃, with m³ = −|m|²m + Pf(m)⋆m.
#[inline]
pub(crate) fn equation<T: Scalar>(
    j: &[T; 4],
    k: &[T; 4],
    e: &[T; 3],
    m: &Vector<T>,
    ((above, diagonal), square, pf): (&(Vector<T>, [T; 4]), T, T),
) -> (Matrix<T>, Matrix<T>) {
    let zero = [[T::zero(); 4]; 4];
    let (mut n, mut g) = (zero, zero);
    let (perpendicular, rest) = (dual(m), e[1] - square);
    for ((&(row, column), m), (perpendicular, above)) in
        PLANES.iter().zip(m.iter()).zip(perpendicular.iter().zip(above.iter()))
    {
        let skew = (rest + (at(k, row) + at(k, column))) * *m + pf * *perpendicular;
        let symmetric = e[0] * *above;
        (*place(&mut n, row, column), *place(&mut n, column, row)) = (skew - symmetric, -skew - symmetric);
        let along = e[0] * *m;
        *place(&mut g, row, column) = (along - *above) * at(j, column);
        *place(&mut g, column, row) = -(along + *above) * at(j, row);
    }
    // e₄/J̃
    let (first, second) = (j[0] * j[1], j[2] * j[3]);
    let others = [j[1] * second, j[0] * second, first * j[3], first * j[2]];
    for i in 0..4 {
        let sum = diagonal[i] + k[i];
        n[i][i] = -(e[0] * sum + e[2]);
        g[i][i] = -((sum + e[1]) * j[i] + others[i]);
    }
    (n, g)
}

/// The adjugate, by minors of the upper and the lower two rows.
#[inline]
pub(crate) fn adjugate<T: Scalar>(a: &Matrix<T>) -> Matrix<T> {
    let minor = |p: &[T; 4], q: &[T; 4], (r, s): (usize, usize)| at(p, r) * at(q, s) - at(q, r) * at(p, s);
    let [s0, s1, s2, s3, s4, s5] = PLANES.map(|columns| minor(&a[0], &a[1], columns));
    let [c0, c1, c2, c3, c4, c5] = PLANES.map(|columns| minor(&a[2], &a[3], columns));
    [
        [
            a[1][1] * c5 - a[1][2] * c4 + a[1][3] * c3,
            -a[0][1] * c5 + a[0][2] * c4 - a[0][3] * c3,
            a[3][1] * s5 - a[3][2] * s4 + a[3][3] * s3,
            -a[2][1] * s5 + a[2][2] * s4 - a[2][3] * s3,
        ],
        [
            -a[1][0] * c5 + a[1][2] * c2 - a[1][3] * c1,
            a[0][0] * c5 - a[0][2] * c2 + a[0][3] * c1,
            -a[3][0] * s5 + a[3][2] * s2 - a[3][3] * s1,
            a[2][0] * s5 - a[2][2] * s2 + a[2][3] * s1,
        ],
        [
            a[1][0] * c4 - a[1][1] * c2 + a[1][3] * c0,
            -a[0][0] * c4 + a[0][1] * c2 - a[0][3] * c0,
            a[3][0] * s4 - a[3][1] * s2 + a[3][3] * s0,
            -a[2][0] * s4 + a[2][1] * s2 - a[2][3] * s0,
        ],
        [
            -a[1][0] * c3 + a[1][1] * c1 - a[1][2] * c0,
            a[0][0] * c3 - a[0][1] * c1 + a[0][2] * c0,
            -a[3][0] * s3 + a[3][1] * s1 - a[3][2] * s0,
            a[2][0] * s3 - a[2][1] * s1 + a[2][2] * s0,
        ],
    ]
}

/// The momentum with |m|² and Pf m of the motion, from their errors before the step: off the critical path of the step.
#[inline]
fn on_level<T: Scalar>(constants: &Constants<T>, next: &Vector<T>, square: T, pf: T) -> Vector<T> {
    let (quarter, twice) = (T::from_ratio(1, 4), pf + pf);
    let lost = |size: T, reciprocal: T| {
        let lost = quarter * (size * reciprocal - T::one());
        T::select(reciprocal.equals(T::zero()), T::zero(), lost)
    };
    let [left, right] = constants.casimirs;
    let (left, right) = (lost(square + twice, left), lost(square - twice, right));
    let (along, across) = (T::one() - (left + right), right - left);
    next * along + dual(next) * across
}

/// exp(δM + κ⋆M) − I
#[inline]
fn of_casimirs<T: Scalar>(
    [a, b, c, d]: &[T; 4],
    m: &Vector<T>,
    (above, diagonal): &(Vector<T>, [T; 4]),
    square: T,
) -> Matrix<T> {
    let mut turn = [[T::zero(); 4]; 4];
    let (perpendicular, mean) = (dual(m), *a + *d * (T::from_ratio(1, 2) * square));
    for ((&(row, column), m), (perpendicular, above)) in
        PLANES.iter().zip(m.iter()).zip(perpendicular.iter().zip(above.iter()))
    {
        let (skew, symmetric) = (*b * *m + *c * *perpendicular, *d * *above);
        (*place(&mut turn, row, column), *place(&mut turn, column, row)) = (symmetric + skew, symmetric - skew);
    }
    (0..4).for_each(|i| turn[i][i] = mean + *d * diagonal[i]);
    turn
}

/// A + B + AB of the increments of two rotations, that of the product.
#[inline]
pub(super) fn composed<T: Scalar>(a: &Matrix<T>, b: &Matrix<T>) -> Matrix<T> {
    let both = super::flow::product(a, b);
    core::array::from_fn(|i| core::array::from_fn(|j| entry(&both, i, j) + (entry(a, i, j) + entry(b, i, j))))
}

/// D − ½(I + D)S with S = D + Dᵀ + DᵀD: the correction of I + D to an orthogonal matrix, after rounding. `None` if the
/// entries of ½S on the diagonal add up to [`LARGEST_LOSS`] ε or more.
#[inline]
fn orthogonal<T: Scalar>(d: &Matrix<T>) -> Option<Matrix<T>> {
    let half = T::from_ratio(1, 2);
    let mut defect = [[T::zero(); 4]; 4];
    for i in 0..4 {
        for j in i..4 {
            let product = (d[0][i] * d[0][j] + d[1][i] * d[1][j]) + (d[2][i] * d[2][j] + d[3][i] * d[3][j]);
            let entry = half * ((d[i][j] + d[j][i]) + product);
            (defect[i][j], defect[j][i]) = (entry, entry);
        }
    }
    let lost = (0..4).fold(T::zero(), |sum, i| sum + defect[i][i].abs());
    if !lost.below(T::from_ratio(LARGEST_LOSS, 1) * T::EPSILON).all() {
        return None;
    }
    let carried = super::flow::product(d, &defect);
    let corrected = |i: usize, j: usize| entry(d, i, j) - (entry(&carried, i, j) + entry(&defect, i, j));
    Some(core::array::from_fn(|i| core::array::from_fn(|j| corrected(i, j))))
}
