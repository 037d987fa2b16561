//! The work of an expansion, counted. A computation that would take too much of it is given up, before it takes minutes
//! or the memory of the machine.
//!
//! It is counted and never timed, so that the same declaration comes to the same end everywhere. One unit is about the
//! work of one term of a sum: some hundred bytes, or some hundred instructions. The count belongs to the thread, for
//! terms and numbers know no graph that they could ask.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// The count, and the limit.
#[derive(Copy, Clone)]
struct Account {
    spent: u64,
    limit: u64,
}

thread_local! {
    static ACCOUNT: Cell<Account> = const { Cell::new(Account { spent: 0, limit: u64::MAX }) };
}

/// The work was not done within its limit.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub struct Exhausted;

/// Counts work. Beyond the limit of [`within`] it does not return.
pub fn spend(units: usize) {
    let is_exhausted = ACCOUNT.with(|account| {
        let Account { spent, limit } = account.get();
        let spent = spent.saturating_add(units as u64);
        account.set(Account { spent, limit });
        spent > limit
    });
    if is_exhausted {
        give_up();
    }
}

/// Ends the work around it as one that takes more than its limit.
pub fn give_up() -> ! {
    // an end that is expected: no panic hook runs, and nothing is printed
    resume_unwind(Box::new(Exhausted));
}

/// The units that are left on this thread.
pub fn left() -> u64 {
    let Account { spent, limit } = ACCOUNT.get();
    limit.saturating_sub(spent)
}

/// The count on this thread.
pub fn spent() -> u64 {
    ACCOUNT.get().spent
}

/// Does work of this many units at most. Within another limit, its remaining units are a limit too. After an error, the
/// objects of the work are in any state.
///
/// # Errors
/// Where it takes more.
pub fn within<T>(units: u64, work: impl FnOnce() -> T) -> Result<T, Exhausted> {
    let Account { spent, limit: outer } = ACCOUNT.get();
    ACCOUNT.set(Account { spent, limit: spent.saturating_add(units).min(outer) });
    let result = catch_unwind(AssertUnwindSafe(work));
    ACCOUNT.set(Account { limit: outer, ..ACCOUNT.get() });
    ended(result)
}

/// Does work of this many units at most, which is not counted with the work around it. It is for results that may be left out: longer
/// texts, and shorter code.
///
/// # Errors
/// Where it takes more.
pub fn apart<T>(mut units: u64, work: impl FnOnce() -> T) -> Result<T, Exhausted> {
    on(&mut units, work)
}

/// As [`apart`], on an allowance for several such works, from which it takes its units.
///
/// # Errors
/// Where it takes more.
pub fn on<T>(allowance: &mut u64, work: impl FnOnce() -> T) -> Result<T, Exhausted> {
    let around = ACCOUNT.replace(Account { spent: 0, limit: *allowance });
    let result = catch_unwind(AssertUnwindSafe(work));
    *allowance = left();
    ACCOUNT.set(around);
    ended(result)
}

/// The end of some work; a panic goes on.
fn ended<T>(result: Result<T, Box<dyn Any + Send>>) -> Result<T, Exhausted> {
    result.map_err(|payload| if payload.is::<Exhausted>() { Exhausted } else { resume_unwind(payload) })
}
