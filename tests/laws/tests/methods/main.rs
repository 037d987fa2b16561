//! Several methods of one declaration: each steps as a struct does that is declared with its dials.

#![allow(missing_docs)]

mod derivatives;
mod equal;
mod states;
mod systems;
