//! Every accepted fixture and every scene, in one scalar type, by functions that C could call.
//!
//! | file | its operations |
//! |---|---|
//! | `build.rs` | writes the systems in the scalar type of the crate, and a call of a macro of `roots` for the operations of each |
//! | `roots` | the exported functions of a system: one for each thing that can be asked of it |
//!
//! Unsafe code is not forbidden here, because the attribute that exports a name counts as unsafe; there is no other.

#![no_std]
#![deny(unsafe_op_in_unsafe_fn)]
// the functions are there to be linked: their arguments have the layout of Rust, and nobody calls them from C
#![allow(improper_ctypes_definitions)]
// no code names the imports of fixtures for their declarations, nor their other items
#![allow(unused_imports, dead_code)]

mod roots;

include!(concat!(env!("OUT_DIR"), "/systems.rs"));
