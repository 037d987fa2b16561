//! Any bytes, read as text.

#![no_main]

#[path = "../../tests/fuzz/verdict.rs"]
mod verdict;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(failure) = verdict::verdict(&String::from_utf8_lossy(bytes)) {
        panic!("{failure}");
    }
    // by construction: no token of this text is left
    proc_macro2::extra::invalidate_current_thread_spans();
});
