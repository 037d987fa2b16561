//! The groups that declarations can name, with the conventions of their momenta.
//!
//! These types hold nothing: `F: SO<3>` in a declaration is a 3×3 matrix. They exist so that an editor shows this page, and
//! to say in one place what the components of a momentum are.
//!
//! # Conventions
//! * The pairing of matrices is ⟨A, B⟩ = tr(AᵀB), the sum of the products of their entries; for vectors the dot product.
//! * A momentum is given by its components m_i = ⟨M, E_i⟩ in the basis E_i below, one block after the other for a product of
//!   groups. Its representing matrix M = Σ G^{ij} m_j E_i, with G_ij = ⟨E_i, E_j⟩, is what
//!   [`momentum_matrix`](crate::Clebsch::momentum_matrix) returns.
//! * x^ is the skew matrix with x^ y = x × y.
//! * An action is *left* if Φ_gh = Φ_g Φ_h, as in `F * q`; then momenta are spatial. It is *right* if Φ_gh = Φ_h Φ_g, as in
//!   `q * F`; then momenta are those of the body frame. Ad*_F is (Ad_F)*, without an inverse inside.

use core::convert::Infallible;

/// The rotations of N-dimensional space: matrices with FᵀF = I and det F = 1.
///
/// | N | matrices | basis, in order | component for a physical Lagrangian |
/// |---|---|---|---|
/// | 3 | 3×3 | e₁^, e₂^, e₃^ | the angular momentum π₁, π₂, π₃ |
/// | other | N×N | E_ji − E_ij for i < j, in the order (12), (13), …, (N−1 N): axis i turns to axis j | x_i p_j − x_j p_i |
///
/// E_ij has a one in row i and column j, counted from 1. Both bases have Gram matrix 2I, so that M = ½ Σ m_i E_i:
/// for N = 3, M = ½ π^; else m_(ij) = −2 M_ij.
///
/// ```text
///        ⎡  0  −x₃  x₂ ⎤
///   x^ = ⎢  x₃  0  −x₁ ⎥
///        ⎣ −x₂  x₁  0  ⎦
/// ```
///
/// Momenta have the unit of a discrete Lagrangian, J·s, for an angle has none.
#[derive(Debug)]
pub struct SO<const N: usize>(Infallible);

/// The translations of N-dimensional space: vectors under addition.
///
/// | matrices | basis, in order | component for a physical Lagrangian |
/// |---|---|---|
/// | none: an element is a vector with N entries, the identity is 0 | e₁, …, e_N | the linear momentum p₁, …, p_N |
///
/// The Gram matrix is I and M = m. Ad and Ad* are the identity; every action is left and right at once, and takes the side of
/// the other factors, else left.
#[derive(Debug)]
pub struct Translation<const N: usize>(Infallible);
