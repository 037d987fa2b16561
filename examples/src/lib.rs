//! The code that the scenes share. A scene is a folder next to this one: a declaration, its flags, its claims and its
//! figure.
//!
//! ```text
//! cargo run --release --example toutatis -- --help
//! ```
//!
//! | module | its job |
//! |---|---|
//! | [`flags`] | flags that every scene takes on the command line, and number parsers with clear errors |
//! | [`integrate`], [`progress`] | step after step, with progress and with errors that name the step |
//! | [`csv`], [`table`], [`figure`], [`motion`] | the trajectory as a file, as a short table, as a drawing, as a page that plays it |
//! | [`claims`] | claims of a scene: each with its measured number and its bound |
//! | [`round_off`], [`conserved`], [`energy_band`] | the bounds: worst cases of rounding, and the modified energy of a symplectic step |
//! | [`elliptic`], [`jacobi`] | elliptic integrals and functions, for closed forms to compare with |
//! | [`reference`](mod@reference), [`convergence`] | an integrator without geometry, and the order of the steps against it |
//! | [`extremal`] | continuous problems with bounded inputs, by Pontryagin's conditions and shooting |
//! | [`counted`] | numbers that count iterations |
//! | [`noise`] | normal random numbers from a seed |
//! | [`scene`] | the frame of a `main`: failures, exit codes, output |

pub mod claims;
pub mod conserved;
pub mod convergence;
pub mod counted;
pub mod csv;
pub mod elliptic;
pub mod energy_band;
pub mod extremal;
pub mod figure;
pub mod flags;
pub mod integrate;
pub mod jacobi;
pub mod motion;
pub mod noise;
pub mod progress;
pub mod reference;
pub mod round_off;
pub mod scene;
pub mod table;
