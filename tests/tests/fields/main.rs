//! Fields in many steps or sweeps: implicit steps, rest, threads, and the longest stable step.
//!
//! Those of a few steps are in `tests/laws/tests/fields`.

#![allow(missing_docs)]

mod midpoint;
mod relaxation;
mod stability;
mod threads;
