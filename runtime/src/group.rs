//! The groups that declarations can name, with the conventions of their momenta.
//!
//! These types hold nothing: `F: SO<3>` in a declaration is a 3×3 matrix. An editor shows this page, with the components of a momentum.
//!
//! | group | of | page |
//! |---|---|---|
//! | turns | rotations of space; of space and time; of complex vectors; unit quaternions | [`SO`], [`U`], [`SU`] |
//! | motions | of points by adding, turning, scaling and shearing | [`Translation`], [`SE`], [`Sim`], [`Aff`], [`Heisenberg`] |
//! | linear maps | all of them; those that keep the volume; those that keep a symplectic form | [`GL`], [`SL`], [`Sp`] |
//!
//! A group of one's own is declared by its equation or by a basis of its Lie algebra, and needs no type.
//!
//! # Conventions
//! * The pairing of matrices is ⟨A, B⟩ = tr(AᵀB), the sum of the products of their entries; for vectors the dot product.
//! * E_ij has a one in row i and column j, counted from 1. x^ is the skew matrix with x^ y = x × y.
//! * A momentum is given by its components m_i = ⟨M, E_i⟩ in the basis E_i of the group's page. For a product of groups
//!   the blocks follow one after the other. Its representing matrix is M = Σ G^{ij} m_j E_i, returned by
//!   [`momentum_matrix`](crate::Clebsch::momentum_matrix). Here G^{ij} is the inverse of the Gram matrix G_ij = ⟨E_i,
//!   E_j⟩.
//! * Components are those of the declared Lagrangian: a cost that is doubled doubles them. Where the basis is dimensionless they
//!   have the unit of a discrete Lagrangian, J·s; those along a translation have J·s per unit of length.
//! * An action is *left* if Φ_gh = Φ_g Φ_h, as in `F * q`; then momenta are spatial. It is *right* if Φ_gh = Φ_h Φ_g, as in
//!   `q * F`; then momenta are those of the body frame. Ad*_F is (Ad_F)*, without an inverse inside.
//! * A velocity ξ, the argument of a `lagrangian`, has the coordinates of ξ = Σ ξ_i E_i. If the Lagrangian is quadratic
//!   in ξ, m·ξ = ⟨M, ξ⟩ is twice its kinetic energy.

use core::convert::Infallible;

/// The rotations of P-dimensional space, `SO<P>`. With a second number: the maps of P + Q dimensions that preserve
/// x₁² + … + x_P² − x_{P+1}² − … − x_{P+Q}². The Lorentz group is `SO<1, 3>` or `SO<3, 1>`.
///
/// Matrices F with FᵀηF = η and det F = 1, η = diag(1, …, 1, −1, …, −1); η = I for `SO<N>`. For Q > 0 these are two
/// components, and steps stay in that of the identity. In the Lorentz group it is the one that preserves the direction
/// of time.
///
/// | group | matrices | basis, in order | component for a physical Lagrangian |
/// |---|---|---|---|
/// | `SO<3>` | 3×3 | e₁^, e₂^, e₃^ | the angular momentum π₁, π₂, π₃ |
/// | `SO<N>` | N×N | E_ji − E_ij for i < j, in the order (12), (13), …, (N−1 N): axis i turns to axis j | x_i p_j − x_j p_i |
/// | `SO<P, Q>` | (P+Q)×(P+Q) | E_ji − η_i η_j E_ij for i < j, in the same order | `SO<1, 3>`: boosts (12), (13), (14), then rotations |
///
/// All of these bases have the Gram matrix 2I: M = ½ Σ m_i E_i. For `SO<3>`, M = ½ π^; else m_(ij) = 2 M_ji. `SO<2>` has the component (12).
///
/// ```text
///        ⎡  0  −x₃  x₂ ⎤
///   x^ = ⎢  x₃  0  −x₁ ⎥
///        ⎣ −x₂  x₁  0  ⎦
/// ```
///
/// Momenta have the unit of a discrete Lagrangian, J·s, for an angle has none.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Matrix3, Vector3};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: SO<3>, q: SO<3>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h))]
/// struct System;
///
/// let half_of_hat = Matrix3::new(0.0, -1.5, 1.0, 1.5, 0.0, -0.5, -1.0, 0.5, 0.0);
/// assert_eq!(System::momentum_matrix(&Vector3::new(1.0, 2.0, 3.0)), half_of_hat);
/// ```
#[derive(Debug)]
pub struct SO<const P: usize, const Q: usize = 0>(Infallible);

/// The unitary maps of N complex dimensions, in real form: A + iB is the 2N×2N matrix with the blocks A, −B; B, A.
///
/// Matrices: 2N×2N, FᵀF = I, FᵀΩF = Ω. Basis: A = E_ji − E_ij for i < j; B = E_ji + E_ij for i < j; B = E_ii; the other blocks are 0.
///
/// A vector of N complex numbers is its real parts followed by its imaginary parts. Pairs i < j are in the order (12),
/// …, (N−1 N). Every entry stands twice in the real form. So the Gram matrix is 4 for pairs and 2 for B = E_ii. M is ¼
/// Σ m E over the pairs + ½ Σ m E over the others.
///
/// `U<1>` is the circle. The component along B = E_ii is the momentum of the phase of number i.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Matrix2, Vector1};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: U<1>, q: U<1>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h))]
/// struct System;
///
/// assert_eq!(System::momentum_matrix(&Vector1::new(4.0)), Matrix2::new(0.0, -2.0, 2.0, 0.0));
/// ```
#[derive(Debug)]
pub struct U<const N: usize>(Infallible);

/// The special unitary maps of N complex dimensions; `SU<2>` is the unit quaternions.
///
/// | group | elements | basis, in order |
/// |---|---|---|
/// | `SU<2>` | `nalgebra::Quaternion`, coordinates i, j, k, w | i/2, j/2, k/2 |
/// | `SU<N>` | 2N×2N as of [`U`], with determinant 1 in complex form | as of [`U`], with B = E_ii − E_{i+1,i+1} for i < N at the end |
///
/// * `SU<2>`: `Q * v` turns v as its rotation does, and components are those of `SO<3>`: the angular momentum π₁, π₂,
///   π₃. Quaternions pair by the dot product of their four coordinates. The Gram matrix is ¼ I, and the representing
///   quaternion is 2(π₁ i + π₂ j + π₃ k). Q and −Q are the same rotation and two configurations.
/// * `SU<N>`: the Gram matrix is 4 for pairs. For the last N − 1 it is twice the Cartan matrix: 4 on the diagonal and
///   −2 next to it.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Quaternion, Vector3};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: SU<2>, q: SU<2>| q * F, cost = |h, F| F.imag().norm_squared() / h)]
/// struct System;
///
/// // `Quaternion::new` takes the scalar part first
/// assert_eq!(System::momentum_matrix(&Vector3::new(1.0, 2.0, 3.0)), Quaternion::new(0.0, 2.0, 4.0, 6.0));
/// ```
#[derive(Debug)]
pub struct SU<const N: usize>(Infallible);

/// The translations of N-dimensional space: vectors under addition.
///
/// An element is a vector with N entries, the identity is 0. Basis: e₁, …, e_N. Components for a physical Lagrangian: the linear momentum p.
///
/// The Gram matrix is I and M = m. Ad and Ad* are the identity. Every action is left and right: it takes the side of the other factors, else left.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::Vector3;
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: Translation<3>, x: Vector3| x + F, cost = |h, F| F.norm_squared() / (2 * h))]
/// struct System;
///
/// assert_eq!(System.act(&Vector3::x(), &Vector3::y()), Vector3::new(1.0, 1.0, 0.0));
/// ```
#[derive(Debug)]
pub struct Translation<const N: usize>(Infallible);

/// The rigid motions of N-dimensional space: x ↦ R x + a, `F.rotation() * x + F.translation()`.
///
/// Matrices: (N+1)×(N+1), R and a above (0 … 0 1). Basis: that of [`SO`] in the upper left, for the angular momentum; E_{i,N+1}, for the linear one.
///
/// The Gram matrix is 2 for the turns and 1 for the shifts. For N = 3, M has ½ π^ in the upper left and p in the last
/// column, and its last row is 0. A group that is not closed under transposition: Ad*_F M is the part of FᵀMF⁻ᵀ in the
/// Lie algebra.
///
/// For a right action, `q * F`, both momenta are in the body frame, about the body's origin; for a left action spatial, about that of space.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Matrix3, Vector3};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: SE<2>, q: SE<2>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h))]
/// struct System;
///
/// // angular momentum 4, linear momentum (1, 2)
/// let momentum = Matrix3::new(0.0, -2.0, 1.0, 2.0, 0.0, 2.0, 0.0, 0.0, 0.0);
/// assert_eq!(System::momentum_matrix(&Vector3::new(4.0, 1.0, 2.0)), momentum);
/// ```
#[derive(Debug)]
pub struct SE<const N: usize>(Infallible);

/// The similarities of N-dimensional space: x ↦ s R x + a with s > 0, for N > 1.
///
/// Matrices: (N+1)×(N+1), s R and a above (0 … 0 1). Basis, in order: that of [`SO`] in the upper left; diag(I, 0); then E_{i,N+1}.
/// Components for a physical Lagrangian: angular momentum, x·p of the dilation, linear momentum.
///
/// The Gram matrix is 2 for the turns, N for the dilation and 1 for the shifts.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Matrix3, Vector4};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: Sim<2>, q: Sim<2>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h))]
/// struct System;
///
/// // angular momentum 4, dilation 6, linear momentum (1, 2)
/// let momentum = Matrix3::new(3.0, -2.0, 1.0, 2.0, 3.0, 2.0, 0.0, 0.0, 0.0);
/// assert_eq!(System::momentum_matrix(&Vector4::new(4.0, 6.0, 1.0, 2.0)), momentum);
/// ```
#[derive(Debug)]
pub struct Sim<const N: usize>(Infallible);

/// The affine maps of N-dimensional space: x ↦ A x + a with det A > 0. `Aff<1>` scales and shifts a line.
///
/// Matrices: (N+1)×(N+1), A and a above (0 … 0 1). Basis, in order: E_ij of the upper left by rows; then E_{i,N+1}. Components for a
/// physical Lagrangian: p_i x_j, then linear momentum (left action).
///
/// The Gram matrix is I: the entries of M are the components.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Matrix2, Vector2};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: Aff<1>, q: Aff<1>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h))]
/// struct System;
///
/// assert_eq!(System::momentum_matrix(&Vector2::new(4.0, 1.0)), Matrix2::new(4.0, 1.0, 0.0, 0.0));
/// ```
#[derive(Debug)]
pub struct Aff<const N: usize>(Infallible);

/// The Heisenberg group of 2N + 1 dimensions: N positions x, N positions y and one z that commutes with all.
///
/// Matrices: (N+2)×(N+2), rows (1 xᵀ z), (0 I y), (0 0 1). Basis: X_i = E_{1,1+i}; Y_i = E_{1+i,N+2}; Z = E_{1,N+2}. Components: p_x, p_y, p_z.
///
/// The bracket is \[X_i, Y_i\] = Z, and all others vanish. The Gram matrix is I: the entries of M are the components. The corner of
/// exp(Σ x_i X_i + Σ y_i Y_i + z Z) is z + ½ x·y. A free motion keeps p_z, which acts on the other two as a magnetic field does.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Matrix3, Vector3};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: Heisenberg<1>, q: Heisenberg<1>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h))]
/// struct System;
///
/// let momentum = Matrix3::new(0.0, 1.0, 3.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0);
/// assert_eq!(System::momentum_matrix(&Vector3::new(1.0, 2.0, 3.0)), momentum);
/// ```
#[derive(Debug)]
pub struct Heisenberg<const N: usize>(Infallible);

/// The invertible linear maps of N-dimensional space. `GL<1>` is the scalings, a positive number where it starts at one.
///
/// Matrices: N×N with det F ≠ 0. Basis, in order: E_ij by rows, (11), (12), …, (NN).
///
/// The Gram matrix is I: m are the entries of M by rows. Steps never leave the component det F > 0 of the identity.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Matrix2, Vector4};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: GL<2>, q: GL<2>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h))]
/// struct System;
///
/// assert_eq!(System::momentum_matrix(&Vector4::new(1.0, 2.0, 3.0, 4.0)), Matrix2::new(1.0, 2.0, 3.0, 4.0));
/// ```
#[derive(Debug)]
pub struct GL<const N: usize>(Infallible);

/// The linear maps of N-dimensional space that keep the volume.
///
/// Matrices: N×N with det F = 1. Basis, in order: E_ii − E_{i+1,i+1} for i < N; then E_ij for i ≠ j by rows.
///
/// For `SL<2>` these are H = diag(1, −1), E = E₁₂ and F = E₂₁. The Gram matrix is the Cartan matrix for the first N − 1
/// (2 on the diagonal, −1 next to it) and I for the others. For `SL<2>`, M = ½ m_H H + m_E E + m_F F.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Matrix2, Vector3};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: SL<2>, q: SL<2>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h))]
/// struct System;
///
/// assert_eq!(System::momentum_matrix(&Vector3::new(2.0, 3.0, 4.0)), Matrix2::new(1.0, 3.0, 4.0, -1.0));
/// ```
#[derive(Debug)]
pub struct SL<const N: usize>(Infallible);

/// The linear maps that keep the symplectic form of a phase space of `DIMENSION` = 2n dimensions: `Sp<2>` is `SL<2>`.
///
/// Matrices: 2n×2n, FᵀΩF = Ω, Ω = (0 I; −I 0). Basis: E_ij − E_{n+j,n+i} by rows; E_{i,n+j} + E_{j,n+i}, j ≤ i (E_{i,n+i} for i = j); their transposes.
///
/// Pairs j ≤ i are (11), (21), (22), (31), …. The Gram matrix is 2, and 1 for E_{i,n+i} and its transpose. Vectors are n positions, then n momenta.
///
/// ```
/// # use clebsch::Clebsch;
/// # use nalgebra::{Matrix2, Vector3};
/// #[derive(Clebsch)]
/// #[clebsch(action = |F: Sp<2>, q: Sp<2>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h))]
/// struct System;
///
/// assert_eq!(System::momentum_matrix(&Vector3::new(2.0, 3.0, 4.0)), Matrix2::new(1.0, 3.0, 4.0, -1.0));
/// ```
#[derive(Debug)]
pub struct Sp<const DIMENSION: usize>(Infallible);
