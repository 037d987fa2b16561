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

use plans::place;

/// The number of random plans: an eighth without the feature `heavy`, and one at least.
const fn long(plans: usize) -> usize {
    if cfg!(feature = "heavy") { plans } else { plans.div_ceil(8) }
}

/// Few of so many plans: the test `control` of `clebsch-tests` makes all of them, optimised.
const fn few(plans: usize) -> usize {
    plans.div_ceil(20)
}
