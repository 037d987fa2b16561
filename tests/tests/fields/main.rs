//! Fields: steps against integrations in 60 digits and against closed forms, grids and their sides, orders, conserved momenta, and
//! the errors of wrong ones.

#![allow(missing_docs)]

mod connections;
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
mod stability;
mod threads;
mod waves;
