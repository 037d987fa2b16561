//! Step after step.

use crate::flags::Run;
use crate::progress::Progress;
use crate::scene::Failure;
use clebsch::{Clebsch, FieldSite, FieldState, FieldStepper, Lattice, Method, Population, State, Stepper};

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

/// The sites of a field in vectors.
pub type FieldOf<S> =
    FieldState<Vec<<S as Clebsch>::Configuration>, Vec<<S as Clebsch>::Momentum>, <S as Clebsch>::Time>;

/// Steps a field to the end of the run, and hands over the states at the steps that `is_seen` names.
///
/// # Errors
/// [`Failure::Step`] with the first step that could not be made, and the errors of `observe`.
pub fn integrate_field<S, G, P>(
    run: &Run,
    stepper: &FieldStepper<S, G, P>,
    state: &mut FieldOf<S>,
    is_seen: impl Fn(u64) -> bool,
    mut observe: impl FnMut(u64, f64, &FieldOf<S>) -> Result<(), Failure>,
) -> Result<(), Failure>
where
    S: FieldSite + Clebsch<Scalar = f64> + Clone,
    G: Lattice<S>,
    P: Population,
{
    let mut progress = Progress::of(run.steps, "steps");
    for step in (0..=run.steps).filter(|&step| step == run.steps || is_seen(step)) {
        stepper
            .advance(state, step - state.steps())
            .map_err(|failure| Failure::Step { step: state.steps() + 1, error: failure.error })?;
        observe(step, run.time(step), state)?;
        progress.reached(step);
    }
    Ok(())
}
