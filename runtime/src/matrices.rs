//! Operations that nalgebra does not have, for generated code that works on matrices. They are straight loops over constant bounds, on the
//! stack, without a panic, for lanes and numbers with derivatives as well.

use crate::linear::rows;
use crate::{Real, Scalar, Space};
use core::array::from_fn;
use nalgebra::{ArrayStorage, SMatrix, SVector};

/// A matrix from its columns.
#[inline]
fn columns<T: Scalar, const R: usize, const C: usize>(columns: [[T; R]; C]) -> SMatrix<T, R, C> {
    SMatrix::from_array_storage(ArrayStorage(columns))
}

/// Column j of a matrix that has it: where the optimiser does not see that it does, no panic is left.
#[inline(always)]
fn column<T: Scalar, const R: usize, const C: usize>(a: &SMatrix<T, R, C>, j: usize) -> [T; R] {
    a.data.0.get(j).copied().unwrap_or([T::zero(); R])
}

/// A + s I
#[inline]
pub fn shifted<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>, s: T) -> SMatrix<T, N, N> {
    let mut sum = *a;
    for (i, column) in sum.data.0.iter_mut().enumerate() {
        if let Some(entry) = column.get_mut(i) {
            *entry += s;
        }
    }
    sum
}

/// Σ a_i b_i in eight sums: no entry waits for all those before it.
#[inline]
fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    let (mut a, mut b, mut sums) = (a.chunks_exact(8), b.chunks_exact(8), [T::zero(); 8]);
    for (a, b) in (&mut a).zip(&mut b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += *a * *b;
        }
    }
    for (sum, (a, b)) in sums.iter_mut().zip(a.remainder().iter().zip(b.remainder())) {
        *sum += *a * *b;
    }
    total(sums)
}

/// The sum of eight.
#[inline]
pub(crate) fn total<T: Scalar>([a, b, c, d, e, f, g, h]: [T; 8]) -> T {
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

/// det A, by elimination with partial pivoting; 0 where a pivot is.
pub fn determinant<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>) -> T {
    T::from_lanes(|lane| determinant_of_one(rows(&a.lane(lane))))
}

fn determinant_of_one<T: Real, const N: usize>(mut a: [[T; N]; N]) -> T {
    let mut determinant = T::one();
    for k in 0..N {
        for i in k + 1..N {
            if a[k][k].abs() < a[i][k].abs() {
                (a[k], a[i]) = (a[i], a[k].map(|entry| -entry));
            }
        }
        let pivot = a[k][k];
        determinant *= pivot;
        if determinant == T::zero() {
            return determinant;
        }
        for i in k + 1..N {
            let factor = a[i][k] / pivot;
            for j in k + 1..N {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    determinant
}

/// Blocks of matrices.
pub trait Blocks<T> {
    /// The block from row i and column j on; entries outside are zero.
    fn block<const R: usize, const C: usize>(&self, i: usize, j: usize) -> SMatrix<T, R, C>;
}

impl<T: Scalar, const P: usize, const Q: usize> Blocks<T> for SMatrix<T, P, Q> {
    #[inline]
    fn block<const R: usize, const C: usize>(&self, i: usize, j: usize) -> SMatrix<T, R, C> {
        columns(from_fn(|l| {
            let column = column(self, j + l);
            from_fn(|k| column.get(i + k).copied().unwrap_or_else(T::zero))
        }))
    }
}

/// A in a zero matrix, from row i and column j on.
#[inline]
pub fn embedded<T: Scalar, const P: usize, const Q: usize, const R: usize, const C: usize>(
    a: &SMatrix<T, P, Q>,
    i: usize,
    j: usize,
) -> SMatrix<T, R, C> {
    columns(from_fn(|l| {
        let column = l.checked_sub(j).map_or([T::zero(); P], |l| column(a, l));
        from_fn(|k| k.checked_sub(i).and_then(|k| column.get(k)).copied().unwrap_or_else(T::zero))
    }))
}

/// The matrix of a linear map, column after column from its values at the unit vectors.
#[inline]
pub fn matrix_of<T: Scalar, const R: usize, const C: usize>(
    map: impl Fn(&SVector<T, C>) -> SVector<T, R>,
) -> SMatrix<T, R, C> {
    columns(from_fn(|j| {
        let unit = columns([from_fn(|i| if i == j { T::one() } else { T::zero() })]);
        column(&map(&unit), 0)
    }))
}

/// x^, the matrix with x^ v = x × v: Σ x_k E_k in the basis of so(3).
#[inline]
pub fn hat<T: Scalar>(x: &SVector<T, 3>) -> SMatrix<T, 3, 3> {
    let [[x, y, z]] = x.data.0;
    let zero = T::zero();
    columns([[zero, z, -y], [-z, zero, x], [y, -x, zero]])
}

/// The components ⟨A, E_k⟩ in that basis: (A₃₂ − A₂₃, A₁₃ − A₃₁, A₂₁ − A₁₂).
#[inline]
pub fn axial<T: Scalar>(a: &SMatrix<T, 3, 3>) -> SVector<T, 3> {
    let [[_, a21, a31], [a12, _, a32], [a13, a23, _]] = a.data.0;
    columns([[a32 - a23, a13 - a31, a21 - a12]])
}

/// Σ x_k E_k in the basis E_ji − E_ij of so(n): the rotation of axis i towards axis j. The order of i < j is (12) (13)
/// … (n−1 n).
#[inline]
pub fn skew<T: Scalar, const M: usize, const N: usize>(x: &SVector<T, M>) -> SMatrix<T, N, N> {
    let mut z = [[T::zero(); N]; N];
    let mut coordinates = x.data.0.iter().flatten();
    for i in 0..N {
        for j in i + 1..N {
            let x = coordinates.next().copied().unwrap_or_else(T::zero);
            z[i][j] = x;
            z[j][i] = -x;
        }
    }
    columns(z)
}

/// The components ⟨A, E_k⟩ = A_ji − A_ij in that basis.
#[inline]
pub fn skew_components<T: Scalar, const N: usize, const M: usize>(a: &SMatrix<T, N, N>) -> SVector<T, M> {
    let mut components = [T::zero(); M];
    let mut next = components.iter_mut();
    for i in 0..N {
        for j in i + 1..N {
            if let Some(component) = next.next() {
                *component = a.data.0[i][j] - a.data.0[j][i];
            }
        }
    }
    columns([components])
}

/// Z v with Z = Σ x_k E_k, without the matrix: n(n − 1) multiplications.
#[inline]
pub fn skew_times<T: Scalar, const M: usize, const N: usize>(x: &SVector<T, M>, v: &SVector<T, N>) -> SVector<T, N> {
    let (v, mut turned) = (column(v, 0), [T::zero(); N]);
    let mut rest = &x.data.0[0][..];
    for i in 0..N {
        let Some((row, others)) = rest.split_at_checked(N - 1 - i) else { break };
        let (before, after) = turned.split_at_mut(i + 1);
        for (x, turned) in row.iter().zip(after) {
            *turned += *x * v[i];
        }
        if let (Some(turned), Some(later)) = (before.last_mut(), v.get(i + 1..)) {
            *turned -= dot(row, later);
        }
        rest = others;
    }
    columns([turned])
}

/// The components of a bᵀ, a_j b_i − a_i b_j, without the matrix.
#[inline]
pub fn skew_outer<T: Scalar, const N: usize, const M: usize>(a: &SVector<T, N>, b: &SVector<T, N>) -> SVector<T, M> {
    let (a, b, mut components) = (column(a, 0), column(b, 0), [T::zero(); M]);
    let mut rest = &mut components[..];
    for i in 0..N {
        let Some((row, others)) = rest.split_at_mut_checked(N - 1 - i) else { break };
        for (component, (later_a, later_b)) in row.iter_mut().zip(a.iter().zip(&b).skip(i + 1)) {
            *component = *later_a * b[i] - a[i] * *later_b;
        }
        rest = others;
    }
    columns([components])
}
