//! Fields: steps against integrations in 60 digits and against closed forms, grids and their sides, orders, conserved momenta, slabs,
//! and the errors of wrong ones.
//!
//! Those of many steps are in `tests/tests/fields`, which is optimised.

#![allow(missing_docs)]

mod connections;
mod elements;
mod grids;
mod meshes;
mod multisymplectic;
mod reference;
mod refused;
mod residuals;
mod slabs;
mod waves;
