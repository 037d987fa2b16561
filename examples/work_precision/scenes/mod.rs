//! The scenes: declarations, equations of motion, and what each keeps.

pub mod body4;
pub mod free_body;
pub mod heavy_top;
pub mod pendulum;
mod rotation;
