//! The generalised Euler equations in n dimensions, which know nothing of the step.

use nalgebra::{SMatrix, SVector};

/// R and M in one vector of U = 2N² numbers, column by column.
pub fn pack<const N: usize, const U: usize>(r: &SMatrix<f64, N, N>, m: &SMatrix<f64, N, N>) -> SVector<f64, U> {
    SVector::from_iterator(r.iter().chain(m.iter()).copied())
}

/// Ṙ = R Ω, Ṁ = [M, Ω] with M = J_d Ω + Ω J_d.
pub fn field<const N: usize, const U: usize>(j_d: SVector<f64, N>) -> impl Fn(&SVector<f64, U>) -> SVector<f64, U> {
    move |unknowns| {
        let (attitude, momentum) = unknowns.as_slice().split_at(N * N);
        let attitude = SMatrix::<f64, N, N>::from_column_slice(attitude);
        let m = SMatrix::<f64, N, N>::from_column_slice(momentum);
        let omega = velocity(&m, &j_d);
        pack(&(attitude * omega), &(m * omega - omega * m))
    }
}

/// The velocity Ω of a momentum: Ω_ij = M_ij / (j_i + j_j).
pub fn velocity<const N: usize>(m: &SMatrix<f64, N, N>, j_d: &SVector<f64, N>) -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| if i == j { 0.0 } else { m[(i, j)] / (j_d[i] + j_d[j]) })
}

/// The momentum M = J_d Ω + Ω J_d of a velocity.
pub fn momentum<const N: usize>(omega: &SMatrix<f64, N, N>, j_d: &SVector<f64, N>) -> SMatrix<f64, N, N> {
    omega.map_with_location(|i, j, rate| rate * (j_d[i] + j_d[j]))
}
