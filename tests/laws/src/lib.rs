//! What holds of every declaration, seen in a few steps: derived integrators are held against the oracle, against their declarations and
//! against each other.
//!
//! These are many systems which step little, so that their compilation is what their tests take: it is without optimisation, which makes a
//! third of it. Tests that step long are those of `clebsch-tests`.
