//! The functions that JavaScript calls. They pass numbers alone, so that neither side reads the memory of the other.
#![expect(
    unsafe_code,
    reason = "`no_mangle` counts as unsafe, as two functions with one name would clash; there is no unsafe block"
)]

use crate::refusal::Refusal;
use crate::run::Shown;
use crate::scenes::{body, pendulum, top};
use std::cell::Cell;

/// A run of any scene.
type AnyRun = Box<dyn Shown>;

thread_local! {
    /// The run of the page, if one has begun.
    static RUN: Cell<Option<AnyRun>> = const { Cell::new(None) };
}

/// A call of [`advance`] makes at most this number of steps, so that a page cannot block itself for long.
const MOST_STEPS: u32 = 1_000_000;

/// Begins a run of the [heavy top](top); see [`top::start`].
#[unsafe(no_mangle)]
pub extern "C" fn start_top(spin: f64, tilt: f64, step_size: f64, order: u32) -> u32 {
    begin(top::start(spin, tilt, step_size, order))
}

/// Begins a run of the [free body](body); see [`body::start`].
#[unsafe(no_mangle)]
pub extern "C" fn start_body(first: f64, second: f64, third: f64, step_size: f64) -> u32 {
    begin(body::start([first, second, third], step_size))
}

/// Begins a run of the [spherical pendulum](pendulum); see [`pendulum::start`].
#[unsafe(no_mangle)]
pub extern "C" fn start_pendulum(amplitude: f64, push: f64, length: f64, step_size: f64) -> u32 {
    begin(pendulum::start(amplitude, push, length, step_size))
}

/// Makes steps, at most a million in one call. Returns 0, or the number of a [`Refusal`]: the run is then at the last state that was reached.
#[unsafe(no_mangle)]
pub extern "C" fn advance(steps: u32) -> u32 {
    with_run(|run| run.advance(steps.min(MOST_STEPS)))
        .unwrap_or(Err(Refusal::NoRun))
        .map_or_else(Refusal::number, |()| 0)
}

/// One of the numbers of the run, by its place in the table of [`Shown::number`]. NaN where there is none.
#[unsafe(no_mangle)]
pub extern "C" fn number(place: u32) -> f64 {
    with_run(|run| run.number(place)).flatten().unwrap_or(f64::NAN)
}

/// Puts a run in place of the one before. Returns 0, or the number of a [`Refusal`]: there is no run then.
fn begin(run: Result<AnyRun, Refusal>) -> u32 {
    let (run, result) = match run {
        Ok(run) => (Some(run), 0),
        Err(refusal) => (None, refusal.number()),
    };
    RUN.set(run);
    result
}

/// Does something with the run. `None` where there is no run.
fn with_run<T>(act: impl FnOnce(&mut dyn Shown) -> T) -> Option<T> {
    let mut run = RUN.take()?;
    let result = act(&mut *run);
    RUN.set(Some(run));
    Some(result)
}
