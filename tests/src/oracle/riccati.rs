//! The Moser–Veselov equation hM = F J_d − J_d Fᵀ for any N, by its Riccati equation.

use nalgebra::SMatrix;

use super::rotation::solve;

/// F, from the symmetric S = F J_d − h/2 M with S² = J_d² + h²/4 M² − h/2 [S, M], by iterating S ↦ √(right side).
///
/// It contracts like h|M|/|J_d|; M is the matrix of the momentum, J_d positive.
pub fn drift<const N: usize>(j_d: &SMatrix<f64, N, N>, h: f64, m: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let half = m * (h / 2.0);
    let constant = j_d * j_d + half * half;
    let mut s = *j_d;
    for _ in 0..200 {
        let next = square_root(&(constant - s * half + half * s), &s);
        let change = (next - s).norm();
        s = next;
        if change < 1e-16 {
            break;
        }
    }
    // F J_d = S + h/2 M, so J_d Fᵀ = S − h/2 M
    solve(j_d, &(s - half)).transpose()
}

/// The symmetric positive root of a symmetric positive matrix, by Newton's method from the root of a matrix nearby.
fn square_root<const N: usize>(a: &SMatrix<f64, N, N>, nearby: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let mut root = SMatrix::identity() * nearby.trace() / N as f64;
    for _ in 0..60 {
        // X ← (X + X⁻¹A)/2 keeps X a function of A when it starts as a multiple of the identity
        let next = (root + solve(&root, a)) * 0.5;
        let next = (next + next.transpose()) * 0.5;
        let change = (next - root).norm();
        root = next;
        if change < 1e-16 * root.norm() {
            break;
        }
    }
    root
}
