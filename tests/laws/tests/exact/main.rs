//! Exact drifts: the free motion of bodies without an error in h, and its splittings. Orders are measured on nonlinear
//! problems, against equations of motion integrated in tiny steps. The laws of every step are tested too.

#![allow(missing_docs)]

mod four;
mod laws;
mod orders;
mod systems;

use nalgebra::SVector;

/// Numbers in one vector.
fn flat<const N: usize>(parts: &[&[f64]]) -> SVector<f64, N> {
    SVector::from_iterator(parts.iter().flat_map(|part| part.iter().copied()))
}
