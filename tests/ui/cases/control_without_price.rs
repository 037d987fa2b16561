//! Inputs are chosen where they have a price.

use clebsch::{Clebsch, Controlled};

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| x.norm_squared() / 2,
)]
struct Spring;

/// Works for every system of this size whose inputs are chosen.
fn steer<S: Controlled<1, 1, 0>>(_: S) {}

fn main() {
    steer(Spring);
}
