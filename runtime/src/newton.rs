//! What Newton's method on a path of least action and on a plan of least price have in common.
//!
//! Both eliminate a block tridiagonal Hessian from the end, one symmetric pivot after the other, and both leave the way of Newton's method where
//! pivots are not definite or corrections do not contract.
//!
//! | file | what it does |
//! |---|---|
//! | `curvature` | what is made of a Hessian that is not definite, and its damping |
//! | `ldl` | L Δ Lᵀ of a definite pivot |
//! | `spectrum` | eigenvalues of a pivot that is not definite |
//! | `gap` | what separates an end from its target |
//! | `free_time` | the step size at which the action or the price is critical |

mod curvature;
mod free_time;
mod gap;
mod ldl;
mod spectrum;
#[cfg(test)]
mod tests;

pub(crate) use curvature::{Curvature, adapted};
pub(crate) use free_time::{Bracket, Sample, Trial};
pub(crate) use gap::{arc_per_chord, is_reached, shortest};
pub(crate) use ldl::{Ldl, UNITS};
pub(crate) use spectrum::{Equilibrated, Spectrum};
