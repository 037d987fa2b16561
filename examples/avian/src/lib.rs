//! The attitudes of bodies in avian by clebsch: the plugin, and motions that use neither.

pub mod attitudes;
#[path = "../../rapier/src/theory.rs"]
pub mod theory;
