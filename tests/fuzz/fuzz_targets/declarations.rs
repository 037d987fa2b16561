//! Texts that are changed as declarations are: token by token, with words of the language and parts of the fixtures.

#![no_main]

#[path = "../../../macros/compiler/tests/fuzz/mutation.rs"]
mod mutation;
#[path = "../../../macros/compiler/tests/fuzz/seeds.rs"]
mod seeds;
#[path = "../../../macros/compiler/tests/fuzz/verdict.rs"]
mod verdict;

use std::sync::LazyLock;

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use mutation::Choices;

static SEEDS: LazyLock<Vec<String>> = LazyLock::new(|| seeds::all().into_iter().map(|(_, text)| text).collect());

fuzz_target!(|bytes: &[u8]| {
    if let Err(failure) = verdict::verdict(&String::from_utf8_lossy(bytes)) {
        panic!("{failure}");
    }
    // by construction: no token of this text is left
    proc_macro2::extra::invalidate_current_thread_spans();
});

fuzz_mutator!(|bytes: &mut [u8], size: usize, most: usize, seed: u32| {
    let choices = &mut Choices::new(u64::from(seed));
    let donor = &SEEDS[choices.pick(SEEDS.len())];
    let text = mutation::mutated(&String::from_utf8_lossy(&bytes[..size]), donor, choices);
    proc_macro2::extra::invalidate_current_thread_spans();
    let text = if text.len() > most { donor } else { &text };
    let length = text.len().min(most);
    bytes[..length].copy_from_slice(&text.as_bytes()[..length]);
    length
});
