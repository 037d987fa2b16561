//! The choice of inputs, through the macro: derivatives against differences, and short plans against others and closed forms.
//!
//! Plans that take long are in the test `control` of `clebsch-tests`, with optimisation.

#![allow(missing_docs)]

mod closed_forms;
mod constraints;
mod derivatives;
mod equations;
mod estimates;
mod kinks;
mod paths;
mod phases;
mod phases_of_forces;
mod references;
mod right_hand_sides;
mod targets;
mod velocities;

use nalgebra::Matrix3;

/// The number of random plans: a quarter without the feature `heavy`, and one at least.
const fn long(plans: usize) -> usize {
    if cfg!(feature = "heavy") { plans } else { plans.div_ceil(4) }
}

/// An element of SE(2).
fn place(angle: f64, x: f64, y: f64) -> Matrix3<f64> {
    let (sin, cos) = angle.sin_cos();
    Matrix3::new(cos, -sin, x, sin, cos, y, 0.0, 0.0, 1.0)
}
