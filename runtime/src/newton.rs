//! The common part of Newton's method for a path of least action and for a plan of least price.
//!
//! Both eliminate a block tridiagonal Hessian from the end, pivot by pivot. Both leave Newton's method where pivots are not definite or it stalls.

mod free_time;
mod gap;
mod ldl;
mod spectrum;
#[cfg(test)]
mod tests;

pub(crate) use free_time::{Bracket, Trial};
pub(crate) use gap::{arc_per_chord, is_reached, shortest};
pub(crate) use ldl::{Ldl, UNITS};
pub(crate) use spectrum::{Equilibrated, Spectrum};

use crate::Real;
use crate::space::larger;

/// How a sweep takes the Hessian, and the shift of its diagonal. The shift is a multiple of a stiffness that the path
/// or plan itself has.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Curvature<T> {
    /// Whether eigenvalues of the wrong sign are turned over, so that steps go downhill. Else steps go to the critical point of the model.
    pub is_mirrored: bool,
    pub damping: T,
    /// A small one keeps directions without curvature from being left to round-off.
    pub steadiness: T,
}

impl<T: Real> Curvature<T> {
    /// As it is, but for this steadiness.
    pub fn exact(steadiness: T) -> Self {
        Self { is_mirrored: false, damping: T::zero(), steadiness }
    }

    /// Downhill.
    pub fn mirrored(damping: T, steadiness: T) -> Self {
        Self { is_mirrored: true, damping, steadiness }
    }
}

/// The damping after so many halvings: an eighth of it after none, eight times as much after three or more. Below `least` it is none.
pub(crate) fn adapted<T: Real>(damping: T, least: T, halvings: usize) -> T {
    let factor = T::from_f64(8.0);
    match halvings {
        0 if damping > least => damping / factor,
        0 => T::zero(),
        1 | 2 => damping,
        _ => larger(damping, least) * factor,
    }
}
