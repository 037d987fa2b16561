//! The attitudes of bodies in rapier by clebsch: the glue, and scenes that measure it.

pub mod double;
pub mod single;
pub mod theory;
