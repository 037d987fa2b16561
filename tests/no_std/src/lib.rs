//! Every accepted fixture and every scene, in both scalar types, in a library that has no allocator.
//!
//! | file | its operations |
//! |---|---|
//! | `f64`, `f32` | crates of the systems in these scalar types, both made of `systems.rs`: two, for two cores |
//! | `planted` | faults that the check has to find, so that it cannot become empty |
//!
//! Unsafe code is not forbidden here, because the attribute that exports a name counts as unsafe; there is no other.

#![no_std]
#![deny(unsafe_op_in_unsafe_fn)]

#[cfg(feature = "heap")]
extern crate alloc;
#[cfg(feature = "f32")]
extern crate clebsch_no_std_f32 as _;
extern crate clebsch_no_std_f64 as _;

mod planted;

/// The target of a panic. The linked program has to be without it.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
