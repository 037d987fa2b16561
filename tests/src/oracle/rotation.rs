//! Skew matrices, their components and rotations.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// x^, with x^ y = x × y.
pub fn hat(x: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -x.z, x.y, x.z, 0.0, -x.x, -x.y, x.x, 0.0)
}

/// The vector of the skew part: x for x^.
pub fn vee(a: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(a[(2, 1)] - a[(1, 2)], a[(0, 2)] - a[(2, 0)], a[(1, 0)] - a[(0, 1)]) / 2.0
}

/// The components ⟨A, E_i⟩ of a matrix in the documented basis of so(N).
pub fn components<const N: usize, const M: usize>(a: &SMatrix<f64, N, N>) -> SVector<f64, M> {
    let component = |(i, j): (usize, usize)| a[(j, i)] - a[(i, j)];
    SVector::from_iterator(planes::<N>().into_iter().map(component))
}

/// Σ x_i E_i in the documented basis of so(N).
pub fn skew<const N: usize, const M: usize>(x: &SVector<f64, M>) -> SMatrix<f64, N, N> {
    let mut matrix = SMatrix::zeros();
    for ((i, j), value) in planes::<N>().into_iter().zip(x.iter()) {
        matrix[(j, i)] = *value;
        matrix[(i, j)] = -*value;
    }
    matrix
}

/// The planes (i, j) in which the basis turns, axis i to axis j.
fn planes<const N: usize>() -> Vec<(usize, usize)> {
    match N {
        3 => vec![(1, 2), (2, 0), (0, 1)],
        _ => (0..N).flat_map(|i| (i + 1..N).map(move |j| (i, j))).collect(),
    }
}

/// (I − Z)⁻¹(I + Z) for a skew matrix Z, by Gauss–Jordan elimination: I − Z needs no pivoting, as its symmetric part is I.
pub fn cayley<const N: usize>(z: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    solve(&(SMatrix::identity() - z), &(SMatrix::identity() + z))
}

/// A⁻¹B, for a matrix A whose symmetric part is definite.
pub fn solve<const N: usize, const C: usize>(a: &SMatrix<f64, N, N>, b: &SMatrix<f64, N, C>) -> SMatrix<f64, N, C> {
    let (mut left, mut right) = (*a, *b);
    for k in 0..N {
        let head = left[(k, k)];
        (0..N).for_each(|j| left[(k, j)] /= head);
        (0..C).for_each(|j| right[(k, j)] /= head);
        for i in (0..N).filter(|&i| i != k) {
            let factor = left[(i, k)];
            (0..N).for_each(|j| left[(i, j)] -= factor * left[(k, j)]);
            (0..C).for_each(|j| right[(i, j)] -= factor * right[(k, j)]);
        }
    }
    right
}
