//! A declaration made by a macro: the error is in the macro, and its invocation is named.

use clebsch::Clebsch;

macro_rules! pendulum {
    ($name:ident, $group:ty, $potential:expr) => {
        #[derive(Clebsch)]
        #[clebsch(
            action    = |F: $group, q: Unit<Vector3>| F * q,
            cost      = |h, F| (F - I).norm_squared() / (4 * h),
            potential = |q| $potential,
            scalar    = f64,
        )]
        struct $name;
    };
}

pendulum!(Good, SO<3>, 2);
pendulum!(Bad, SO<4>, 2);

fn main() {
    let _ = (Good, Bad);
}
