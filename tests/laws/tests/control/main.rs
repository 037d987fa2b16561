//! The choice of inputs, through the macro: derivatives against differences, and short plans against others and closed forms.
//!
//! The test `control` of `clebsch-tests` makes more of the plans of `bounds`, `extremes` and `plans`, with optimisation.

#![allow(missing_docs)]

mod bounds;
mod closed_forms;
mod constraints;
mod derivatives;
mod equations;
mod estimates;
mod extremes;
mod kinks;
mod paths;
mod phases;
mod phases_of_forces;
mod plans;
mod references;
mod right_hand_sides;
mod targets;
mod units;
mod velocities;

use nalgebra::Matrix3;

/// The number of random plans: an eighth without the feature `heavy`, and one at least.
const fn long(plans: usize) -> usize {
    if cfg!(feature = "heavy") { plans } else { plans.div_ceil(8) }
}

/// An element of SE(2).
fn place(angle: f64, x: f64, y: f64) -> Matrix3<f64> {
    let (sin, cos) = angle.sin_cos();
    Matrix3::new(cos, -sin, x, sin, cos, y, 0.0, 0.0, 1.0)
}

/// Few of so many plans: the test `control` of `clebsch-tests` makes all of them, optimised.
const fn few(plans: usize) -> usize {
    plans.div_ceil(20)
}
