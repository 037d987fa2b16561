//! Groups that keep a form: rotations, and what is like them.

use core::convert::Infallible;

/// The rotations of P-dimensional space, `SO<P>`; with a second number the maps of P + Q dimensions that keep
/// x₁² + … + x_P² − x_{P+1}² − … − x_{P+Q}², such as the Lorentz group `SO<1, 3>` or `SO<3, 1>`.
///
/// Matrices F with FᵀηF = η and det F = 1, η = diag(1, …, 1, −1, …, −1); η = I for `SO<N>`. Where Q > 0 these are two components,
/// and steps stay in that of the identity: for the Lorentz group, the one that keeps the direction of time.
///
/// | group | matrices | basis, in order | component for a physical Lagrangian |
/// |---|---|---|---|
/// | `SO<3>` | 3×3 | e₁^, e₂^, e₃^ | the angular momentum π₁, π₂, π₃ |
/// | `SO<N>` | N×N | E_ji − E_ij for i < j, in the order (12), (13), …, (N−1 N): axis i turns to axis j | x_i p_j − x_j p_i |
/// | `SO<P, Q>` | (P+Q)×(P+Q) | E_ji − η_i η_j E_ij for i < j, in the same order | `SO<1, 3>`: boosts (12), (13), (14), then rotations |
///
/// All of these bases have the Gram matrix 2I, so that M = ½ Σ m_i E_i: for `SO<3>`, M = ½ π^; else m_(ij) = 2 M_ji.
/// `SO<2>` has the one component (12), the angular momentum in the plane.
///
/// ```text
///        ⎡  0  −x₃  x₂ ⎤
///   x^ = ⎢  x₃  0  −x₁ ⎥
///        ⎣ −x₂  x₁  0  ⎦
/// ```
///
/// Momenta have the unit of a discrete Lagrangian, J·s, for an angle has none.
#[derive(Debug)]
pub struct SO<const P: usize, const Q: usize = 0>(Infallible);

/// The unitary maps of N complex dimensions, in real form: A + iB is the 2N×2N matrix with the blocks A, −B; B, A.
///
/// | matrices | basis, in order (the blocks that are not given are 0) |
/// |---|---|
/// | 2N×2N, FᵀF = I, FᵀΩF = Ω | A = E_ji − E_ij for i < j; then B = E_ji + E_ij for i < j; then B = E_ii |
///
/// A vector of N complex numbers is its real parts followed by its imaginary parts. Pairs i < j are in the order (12), (13), …,
/// (N−1 N). Every entry stands twice in the real form, so that the Gram matrix is 4 for pairs and 2 for B = E_ii:
/// M = ¼ Σ m E over the pairs + ½ Σ m E over the others.
///
/// `U<1>` is the circle. The component along B = E_ii is the momentum of the phase of number i.
#[derive(Debug)]
pub struct U<const N: usize>(Infallible);

/// The special unitary maps of N complex dimensions; `SU<2>` is the unit quaternions.
///
/// | group | elements | basis, in order |
/// |---|---|---|
/// | `SU<2>` | `nalgebra::Quaternion`, coordinates i, j, k, w | i/2, j/2, k/2 |
/// | `SU<N>` | 2N×2N as of [`U`], with determinant 1 in complex form | as of [`U`], with B = E_ii − E_{i+1,i+1} for i < N at the end |
///
/// * `SU<2>`: `Q * v` turns v as its rotation does, and components are those of `SO<3>`: the angular momentum π₁, π₂, π₃.
///   Quaternions pair by the dot product of their four coordinates; the Gram matrix is ¼ I and the representing quaternion is
///   2(π₁ i + π₂ j + π₃ k). Q and −Q are the same rotation and two configurations.
/// * `SU<N>`: the Gram matrix is 4 for pairs; for the last N − 1 it has 4 on the diagonal and −2 beside it, twice the Cartan matrix.
#[derive(Debug)]
pub struct SU<const N: usize>(Infallible);
