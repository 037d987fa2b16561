//! Fields: steps against integrations in 60 digits and against closed forms, grids and their sides, orders, conserved momenta, and slabs.
//! Implicit steps, rest, stable steps, threads, and the errors of wrong ones are here too.
//!
//! Large grids at rest are in `tests/tests/fields`, which is optimised.

#![allow(missing_docs)]

mod connections;
mod cycles;
mod elements;
mod grids;
mod meshes;
mod midpoint;
mod multisymplectic;
mod reference;
mod refused;
mod relaxation;
mod residuals;
mod slabs;
mod squares;
mod stability;
mod threads;
mod waves;

/// Sites along a side of the squares, films and crystals of `cycles`.
const SQUARES: [usize; 2] = [8, 16];
const FILMS: [usize; 1] = [10];
const CRYSTALS: [usize; 1] = [9];
