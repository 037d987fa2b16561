//! Every accepted fixture and every scene, in both scalar types, by functions that C could call, in a library that has no allocator.
//!
//! | file | its operations |
//! |---|---|
//! | `build.rs` | writes the systems, each in `f64` and in `f32` |
//! | `roots` | the exported functions of a system: one for each thing that can be asked of it |
//! | `planted` | faults that the check has to find, so that it cannot become empty |
//!
//! Unsafe code is not forbidden here, because the attribute that exports a name counts as unsafe; there is no other.

#![no_std]
#![deny(unsafe_op_in_unsafe_fn)]
// the functions are there to be linked: their arguments have the layout of Rust, and nobody calls them from C
#![allow(improper_ctypes_definitions)]

#[cfg(feature = "heap")]
extern crate alloc;

mod planted;
mod roots;

/// The systems, and a call of a macro of `roots` for the operations of each of them.
#[cfg(not(feature = "heap"))]
mod systems {
    // no code names the imports of fixtures for their declarations, nor their other items
    #![allow(unused_imports, dead_code)]

    include!(concat!(env!("OUT_DIR"), "/systems.rs"));
}

/// The target of a panic. The linked program has to be without it.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
