//! The laws of every declaration, seen in a few steps: derived integrators are compared with the oracle, with their
//! declarations and with each other.
//!
//! These are many systems which step little, so their tests take the time of their compilation. It is without
//! optimisation, which makes a third of it. Tests that step long are those of `clebsch-tests`.
