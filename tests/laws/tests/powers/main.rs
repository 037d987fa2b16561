//! Powers with a const generic next to the same declaration with a number in its place, which is unrolled. They are two
//! ways through the compiler to one integrator.

#![allow(missing_docs)]

mod chains;
mod checks;
mod declared;
mod forced;
mod inside;
mod published;
