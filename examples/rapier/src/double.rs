//! With rapier3d-f64.

pub use rapier3d_f64 as rapier;

#[path = "attitudes.rs"]
pub mod attitudes;
#[path = "scenes.rs"]
pub mod scenes;
#[path = "tables.rs"]
pub mod tables;
