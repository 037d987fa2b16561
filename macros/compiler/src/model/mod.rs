//! The second stage: the declaration as mathematics, with names resolved, shapes checked and the action's laws verified.

mod structure;
mod types;

pub use structure::Structure;
pub use types::*;
