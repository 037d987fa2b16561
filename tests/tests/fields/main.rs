//! Fields in many steps or sweeps: implicit steps, rest, slabs, threads, and the longest stable step.
//!
//! Those of a few steps are in `tests/laws/tests/fields`.

#![allow(missing_docs)]

mod midpoint;
mod relaxation;
mod slabs;
mod stability;
mod threads;
