//! The steppers of the live pages of the book, compiled to WebAssembly.
//!
//! A page calls one of the functions `start_…`, and then [`advance`](exports::advance) and [`number`](exports::number) as often as it needs them.
//! There is one run at a time. No argument makes a function trap: [`Refusal`](refusal::Refusal) lists the reasons for which a call does nothing.
//!
//! `docs/book/build` compiles this crate, and `docs/book/check` tries the pages in a browser.

pub mod exports;
pub mod refusal;
pub mod run;
pub mod scenes;

#[cfg(test)]
mod tests;
