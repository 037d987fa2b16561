//! What the README and the book promise: a derivation that is printed, links that lead somewhere, plain sentences.

mod language;
mod links;
mod pages;
mod readme;
