//! Powers with a const generic beside the same declaration with a number in its place, which is written out: two ways through the compiler, one
//! integrator.

#![allow(missing_docs)]

mod checks;
mod declared;
mod inside;
mod published;
