//! Optimal control of systems written by hand, against closed forms and independent solutions.

mod bounded;
mod geodesics;
mod group;
mod jet;
mod linear;
mod pendulum;
mod quadratic;
mod refused;
mod single;
mod unpriced;

use clebsch::BoundsExpansion;
use nalgebra::{SMatrix, SVector};

/// Of a system without bounds.
pub fn no_bounds<const D: usize, const U: usize, const C: usize>() -> BoundsExpansion<f64, D, U, C> {
    BoundsExpansion {
        values: SVector::zeros(),
        by_place: SMatrix::zeros(),
        by_input: SMatrix::zeros(),
        place_curvature: SMatrix::zeros(),
        mixed_curvature: SMatrix::zeros(),
        input_curvature: SMatrix::zeros(),
    }
}

/// |a − b| in the largest entry.
macro_rules! assert_near {
    ($a:expr, $b:expr, $tolerance:expr) => {{
        let (a, b) = ($a, $b);
        let error = (a - b).amax();
        assert!(error <= $tolerance, "{a} and {b} differ by {error:e}");
    }};
}
pub(crate) use assert_near;
