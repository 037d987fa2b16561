//! Groups that move points of N-dimensional space.

use core::convert::Infallible;

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

/// The rigid motions of N-dimensional space: x ↦ R x + a, `F.rotation() * x + F.translation()`.
///
/// | matrices | basis, in order | component for a physical Lagrangian |
/// |---|---|---|
/// | (N+1)×(N+1), R and a above (0 … 0 1) | that of [`SO`](super::SO) in the upper left; then E_{i,N+1} | angular momentum, then linear momentum |
///
/// The Gram matrix is 2 for the turns and 1 for the shifts: M has ½ π^ (N = 3) in the upper left and p in the last column, and its
/// last row is 0. A group that is not closed under transposition: Ad*_F M is the part of FᵀMF⁻ᵀ in the Lie algebra.
///
/// For a right action, `q * F`, both momenta are in the body frame, the angular one about the body's origin. For a left action
/// they are spatial, the angular one about the origin of space.
#[derive(Debug)]
pub struct SE<const N: usize>(Infallible);

/// The similarities of N-dimensional space: x ↦ s R x + a with s > 0. `Sim<1>` scales and shifts a line.
///
/// | matrices | basis, in order | component for a physical Lagrangian |
/// |---|---|---|
/// | (N+1)×(N+1), s R and a above (0 … 0 1) | that of [`SO`](super::SO) in the upper left; diag(I, 0); then E_{i,N+1} | angular momentum, x·p of the dilation, linear momentum |
///
/// The Gram matrix is 2 for the turns, N for the dilation and 1 for the shifts.
#[derive(Debug)]
pub struct Sim<const N: usize>(Infallible);

/// The affine maps of N-dimensional space: x ↦ A x + a with det A > 0.
///
/// | matrices | basis, in order | component for a physical Lagrangian |
/// |---|---|---|
/// | (N+1)×(N+1), A and a above (0 … 0 1) | E_ij of the upper left by rows; then E_{i,N+1} | p_i x_j, then linear momentum (left action) |
///
/// The Gram matrix is I: the entries of M are the components.
#[derive(Debug)]
pub struct Aff<const N: usize>(Infallible);

/// The Heisenberg group of 2N + 1 dimensions: N positions x, N positions y and one z that commutes with all.
///
/// | matrices | basis, in order | component for a physical Lagrangian |
/// |---|---|---|
/// | (N+2)×(N+2), rows (1 xᵀ z), (0 I y), (0 0 1) | X_i = E_{1,1+i}; then Y_i = E_{1+i,N+2}; then Z = E_{1,N+2} | the momenta p_x, p_y, p_z |
///
/// The bracket is \[X_i, Y_i\] = Z, and all others vanish. The Gram matrix is I: the entries of M are the components.
/// exp(Σ x_i X_i + Σ y_i Y_i + z Z) has the corner z + ½ x·y. The momentum p_z is constant in a free motion, and is what a
/// magnetic field is to the other two.
#[derive(Debug)]
pub struct Heisenberg<const N: usize>(Infallible);
