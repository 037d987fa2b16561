//! Step after step.

use crate::flags::Run;
use crate::progress::Progress;
use crate::scene::Failure;
use clebsch::{Clebsch, Method, State, Stepper};

/// Hands the states 0, 1, …, `run.steps` to `observe`, with their number and time; nothing is stored.
///
/// # Errors
/// [`Failure::Step`] with the first step that could not be made, and the errors of `observe`.
pub fn integrate<S: Clebsch<Scalar = f64>, M: Method<S>>(
    run: &Run,
    stepper: &Stepper<S, M>,
    start: State<S, M>,
    mut observe: impl FnMut(u64, f64, &State<S, M>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut progress = Progress::new(run.steps);
    for (step, state) in (0..=run.steps).zip(stepper.trajectory(start)) {
        let state = state.map_err(|error| Failure::Step { step, error })?;
        observe(step, run.time(step), &state)?;
        progress.reached(step);
    }
    Ok(())
}
