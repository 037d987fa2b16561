//! Every group of the language, and groups that are declared: one line each, and everything that has to hold of a derived integrator.
//!
//! A group acts on itself from the right with a quadratic cost or a quadratic Lagrangian and a cubic potential. The
//! derived steps are compared with the oracle, which shares no code with the compiler, and with each other.

#![allow(missing_docs)]

#[macro_use]
mod table;

mod algebra;
mod built_in;
mod checks;
mod declared;
mod shapes;
