//! The scenes: declarations, equations of motion, and the conserved quantities of each.

pub mod body4;
pub mod free_body;
pub mod heavy_top;
pub mod orbit;
pub mod pendulum;
mod rotation;
pub mod satellite;
