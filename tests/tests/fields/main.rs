//! Fields: steps against integrations in 60 digits and against closed forms, grids and their sides, orders, conserved momenta, and
//! the errors of wrong ones.

#![allow(missing_docs)]

mod elements;
mod grids;
mod meshes;
mod reference;
mod refused;
mod relaxation;
mod residuals;
mod stability;
mod threads;
mod waves;
