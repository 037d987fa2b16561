//! The explicit formulas of discrete mechanics, written by hand on nalgebra: derived integrators are compared with
//! them.
//!
//! Nothing here is derived and nothing is shared with the compiler. Spheres step in closed form, rigid bodies by
//! Newton's method on a Cayley vector, SO(4) by a Riccati equation. Exact motions come from the equations of motion by
//! a classical method. [`precise`] solves the unsimplified equations of any problem to 30 digits.

pub mod bits;
pub mod body;
pub mod dual;
pub mod flat;
pub mod motion;
pub mod near;
pub mod precise;
pub mod random;
pub mod riccati;
pub mod rotation;
pub mod sphere;
