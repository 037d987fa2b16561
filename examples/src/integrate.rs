//! Step after step.

use crate::flags::Run;
use crate::progress::Progress;
use crate::scene::Failure;
use clebsch::{Clebsch, State, Stepper};

/// Hands the states 0, 1, …, `run.steps` to `observe`, with their number and time; nothing is kept.
///
/// # Errors
/// [`Failure::Step`] with the first step that could not be made, and what `observe` returns.
pub fn integrate<S: Clebsch<Scalar = f64>>(
    run: &Run,
    stepper: &Stepper<S>,
    start: State<S>,
    mut observe: impl FnMut(u64, f64, &State<S>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut progress = Progress::new(run.steps);
    for (step, state) in (0..=run.steps).zip(stepper.trajectory(start)) {
        let state = state.map_err(|error| Failure::Step { step, error })?;
        observe(step, run.time(step), &state)?;
        progress.reached(step);
    }
    Ok(())
}
