//! The precise oracle against a 60-digit reference computation, and against the laws of any such integrator.

mod comparison;
mod continuum;
mod excerpts;
mod groups;
mod numbers;
mod reference;
mod structure;
mod systems;
