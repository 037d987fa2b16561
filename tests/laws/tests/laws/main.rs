//! Laws of a few systems each, in one program: each program is linked, and has arithmetic of matrices of its own.

#![allow(missing_docs)]

mod agreement;
mod composition;
mod double_double;
mod energies;
mod equivalence;
mod groups;
mod language;
mod momentum;
mod orders;
mod overflow;
mod quotients;
mod representations;
mod spaces;
mod staggered;
mod structure;
mod symplectic;
