//! The code of the README and of the book, compiled and run.
//!
//! Every Markdown file in `docs/book/src` is a module here. Its `rust` blocks are tests: `cargo test -p clebsch-book --doc`.

#[cfg(doctest)]
include!(concat!(env!("OUT_DIR"), "/pages.rs"));
