//! Groups of linear maps that keep less than a distance.

use core::convert::Infallible;

/// The invertible linear maps of N-dimensional space. `GL<1>` is the scalings, a positive number where it starts at one.
///
/// | matrices | basis, in order |
/// |---|---|
/// | N×N, det F ≠ 0 | E_ij by rows: (11), (12), …, (NN) |
///
/// The Gram matrix is I: m are the entries of M by rows. Steps never leave the component det F > 0 of the identity.
#[derive(Debug)]
pub struct GL<const N: usize>(Infallible);

/// The linear maps of N-dimensional space that keep the volume.
///
/// | matrices | basis, in order |
/// |---|---|
/// | N×N, det F = 1 | E_ii − E_{i+1,i+1} for i < N; then E_ij for i ≠ j by rows |
///
/// For `SL<2>` these are H = diag(1, −1), E = E₁₂ and F = E₂₁. The Gram matrix is the Cartan matrix for the first N − 1 (2 on
/// the diagonal, −1 beside it) and I for the others: for `SL<2>`, M = ½ m_H H + m_E E + m_F F.
#[derive(Debug)]
pub struct SL<const N: usize>(Infallible);

/// The linear maps that keep the symplectic form of a phase space of `DIMENSION` = 2n dimensions: `Sp<2>` is `SL<2>`.
///
/// | matrices | basis, in order |
/// |---|---|
/// | 2n×2n, FᵀΩF = Ω with Ω = (0 I; −I 0) | E_ij − E_{n+j,n+i} by rows; then E_{i,n+j} + E_{j,n+i} for j ≤ i (E_{i,n+i} for i = j); then their transposes |
///
/// Pairs j ≤ i are in the order (11), (21), (22), (31), …. The Gram matrix is 2, and 1 for E_{i,n+i} and its transpose. A vector of
/// phase space is its n positions followed by its n momenta.
#[derive(Debug)]
pub struct Sp<const DIMENSION: usize>(Infallible);
