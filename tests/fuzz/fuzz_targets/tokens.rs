//! Any bytes, read as text: of an item, and of a declaration in an item.

#![no_main]

#[path = "../../../macros/compiler/tests/fuzz/verdict.rs"]
mod verdict;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    for text in [&*text, &format!("#[clebsch({text})] pub struct P {{ pub a: f64, pub b: Vector3<f64> }}")] {
        if let Err(failure) = verdict::verdict(text) {
            panic!("{failure}");
        }
    }
    // by construction: no token of this text is left
    proc_macro2::extra::invalidate_current_thread_spans();
});
