//! The generalised Euler equations, which know nothing of the step.

use nalgebra::{Matrix5, SVector};

/// R, then M, column by column.
pub type Unknowns = SVector<f64, 50>;

/// R and M in one vector.
pub fn pack(attitude: &Matrix5<f64>, m: &Matrix5<f64>) -> Unknowns {
    Unknowns::from_iterator(attitude.iter().chain(m.iter()).copied())
}

/// Ṙ = R Ω, Ṁ = [M, Ω] with M = J_d Ω + Ω J_d, so that Ω_ij = M_ij / (j_i + j_j).
pub fn field(j_d: [f64; 5]) -> impl Fn(&Unknowns) -> Unknowns {
    move |unknowns| {
        let attitude = Matrix5::from_column_slice(&unknowns.as_slice()[..25]);
        let m = Matrix5::from_column_slice(&unknowns.as_slice()[25..]);
        let omega = velocity(&m, &j_d);
        pack(&(attitude * omega), &(m * omega - omega * m))
    }
}

/// The velocity Ω of a momentum.
pub fn velocity(m: &Matrix5<f64>, j_d: &[f64; 5]) -> Matrix5<f64> {
    Matrix5::from_fn(|i, j| if i == j { 0.0 } else { m[(i, j)] / (j_d[i] + j_d[j]) })
}
