//! The scenes of the live pages, one file each.

pub mod body;
pub mod pendulum;
pub mod top;
