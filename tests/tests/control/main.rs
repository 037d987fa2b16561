//! Many plans of `clebsch-laws`, whose test `control` has few of each and all other tests of plans.

#[path = "../../laws/tests/control/bounds.rs"]
mod bounds;
#[path = "../../laws/tests/control/extremes.rs"]
mod extremes;
#[path = "../../laws/tests/control/plans.rs"]
mod plans;

/// All of so many plans.
const fn few(plans: usize) -> usize {
    plans
}
