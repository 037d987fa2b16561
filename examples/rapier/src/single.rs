//! With rapier3d, in `f32`.

pub use rapier3d as rapier;

#[path = "attitudes.rs"]
pub mod attitudes;
#[path = "scenes.rs"]
pub mod scenes;
#[path = "tables.rs"]
pub mod tables;
