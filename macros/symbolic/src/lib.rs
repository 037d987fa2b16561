//! Matrix expressions and their calculus: the mathematics of the compiler of `clebsch`, free of tokens and spans.
//!
//! | symbol | role | meaning |
//! |---|---|---|
//! | F | [`Role::Element`] | group element that a step finds |
//! | q | [`Role::Configuration`] | configuration, q⁺ = Φ_F(q) |
//! | p | [`Role::Covector`] | covector at q, paired by ⟨A, B⟩ = tr(AᵀB) |
//! | ξ | [`Role::Algebra`] | element of the Lie algebra in the basis E_1 … E_m |
//! | μ | [`Role::Momentum`] | momentum, components μ_i = ⟨M, E_i⟩ |
//! | x | [`Role::Chart`] | coordinates of F in a [`Chart`] |
//! | h | [`Role::StepSize`] | step |
//!
//! x^ y = x × y. Left actions have Φ_gh = Φ_g Φ_h, right actions Φ_gh = Φ_h Φ_g. T*L_F pairs with F·η, T*R_F with η·F.

mod algebra;
mod blocks;
mod construct;
mod each;
mod evaluate;
mod expr;
mod gradient;
mod graph;
mod group;
pub mod identity;
mod memory;
mod natural;
mod node;
mod powers;
mod print;
mod rational;
mod rebuild;
mod shape;
mod symbol;
mod table;
mod terms;
#[cfg(test)]
mod tests;
pub mod work;

pub use algebra::{Algebra, Basis, Sparse};
pub use each::{Elements, IntoElements, IntoList, both, indexed};
pub use evaluate::{Matrix, Number};
pub use expr::Expr;
pub use graph::Graph;
pub use group::{Block, Chart, Declared, Group, Span, conjugate, quaternion_product, reduce};
pub use node::{Analytic, Function, NodeOf, Operation, TermOf, View, WordTerm};
pub use print::{Notation, Product, joined};
pub use rational::{Fraction, Rational, integer, product, rational};
pub use shape::Shape;
pub use symbol::{Property, Role, Symbol};
pub use table::{Interner, Table};
