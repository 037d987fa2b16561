//! Steps that are composed of others: their measured orders, their invariants, and the step size that gives a wished
//! error.

#![allow(missing_docs)]

mod orders;
mod step_size;
mod systems;

use nalgebra::SVector;

/// The numbers of several vectors and matrices in one vector.
pub fn flat<const N: usize>(parts: &[&[f64]]) -> SVector<f64, N> {
    SVector::from_iterator(parts.iter().flat_map(|part| part.iter().copied()))
}
