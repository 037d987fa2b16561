//! Promises of the README, the book and the reference: a derivation that is printed, links that lead somewhere, plain sentences, examples,
//! errors with their cures.

mod errors;
mod examples;
mod language;
mod links;
mod pages;
mod readme;
