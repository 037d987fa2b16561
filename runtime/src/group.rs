//! The groups that declarations can name, with the conventions of their momenta.
//!
//! These types hold nothing: `F: SO<3>` in a declaration is a 3×3 matrix. They exist so that an editor shows this page, and
//! to say in one place what the components of a momentum are.
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
//! * A momentum is given by its components m_i = ⟨M, E_i⟩ in the basis E_i of the group's page, one block after the other for a
//!   product of groups. Its representing matrix M = Σ G^{ij} m_j E_i, with the Gram matrix G_ij = ⟨E_i, E_j⟩ and its inverse G^{ij},
//!   is what [`momentum_matrix`](crate::Clebsch::momentum_matrix) returns.
//! * Components are those of the declared Lagrangian: a cost that is doubled doubles them. Where the basis is dimensionless they
//!   have the unit of a discrete Lagrangian, J·s; those along a translation have J·s per unit of length.
//! * An action is *left* if Φ_gh = Φ_g Φ_h, as in `F * q`; then momenta are spatial. It is *right* if Φ_gh = Φ_h Φ_g, as in
//!   `q * F`; then momenta are those of the body frame. Ad*_F is (Ad_F)*, without an inverse inside.
//! * A velocity ξ, the argument of a `lagrangian`, has the coordinates of ξ = Σ ξ_i E_i; so m·ξ = ⟨M, ξ⟩ is twice the kinetic
//!   energy of a Lagrangian that is quadratic in ξ.

mod linear;
mod motion;
mod turn;

pub use linear::{GL, SL, Sp};
pub use motion::{Aff, Heisenberg, SE, Sim, Translation};
pub use turn::{SO, SU, U};
