//! The work of an expansion, counted: what would take too much of it is given up, before it takes minutes or the memory of the machine.
//!
//! It is counted and never timed, so that the same declaration comes to the same end everywhere. One unit is about what it takes to
//! make one term of a sum: some hundred bytes, or some hundred instructions. The count belongs to the thread, for terms and
//! numbers know no graph that they could ask.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

thread_local! {
    static SPENT: Cell<u64> = const { Cell::new(0) };
    static LIMIT: Cell<u64> = const { Cell::new(u64::MAX) };
}

/// The work was not done within its limit.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub struct Exhausted;

/// Counts work. Beyond the limit of [`within`] it does not return.
pub fn spend(units: usize) {
    let spent = SPENT.get().saturating_add(units as u64);
    SPENT.set(spent);
    if spent > LIMIT.get() {
        // an end that is expected: no panic hook runs, and nothing is printed
        resume_unwind(Box::new(Exhausted));
    }
}

/// What has been counted on this thread.
pub fn spent() -> u64 {
    SPENT.get()
}

/// Does what may take this much work at most, and no more than what is left where this stands within another limit. After an error
/// what it worked on is in any state.
///
/// # Errors
/// Where it takes more.
pub fn within<T>(units: u64, work: impl FnOnce() -> T) -> Result<T, Exhausted> {
    let outer = LIMIT.get();
    LIMIT.set(SPENT.get().saturating_add(units).min(outer));
    let result = catch_unwind(AssertUnwindSafe(work));
    LIMIT.set(outer);
    result.map_err(|payload| if payload.is::<Exhausted>() { Exhausted } else { resume_unwind(payload) })
}
