//! Constraints on the velocity: steps against 60-digit integrations of their equations, and against the continuous
//! equations. Constraints and energies over many steps, and the errors of states that violate them.

#![allow(missing_docs)]

mod chains;
mod conserved;
mod coordinates;
mod derived;
mod ends;
mod invariants;
mod joined;
mod loops;
mod moving;
mod numbered;
mod order;
mod places;
mod reactions;
mod reference;
mod refused;
mod repaired;
mod trees;
mod variants;

/// The steps of a long run: a quarter of them without the feature `heavy`.
const fn long(steps: usize) -> usize {
    if cfg!(feature = "heavy") { steps } else { steps / 4 }
}
