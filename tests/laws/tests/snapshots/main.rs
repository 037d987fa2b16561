//! The results of the compiler for every fixture, stage by stage, and its messages about every mistake.
//!
//! Adding a file to `fixtures/accept` or `fixtures/reject` adds its snapshots. `INSTA_UPDATE=always` writes them, the diff is
//! the review; with `CI=true` a difference fails and writes nothing.

mod accepted;
mod costs;
mod determinism;
mod fixture;
mod place;
mod rejected;
mod specialised;
