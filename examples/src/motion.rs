//! Pages that play the motion of a scene, by its flag `--motion`.

use crate::flags::Run;
use crate::scene::{Failure, say};
use clebsch::{Clebsch, Error, Method, State, Stepper};
use clebsch_plot::{Motion, PlotError};
use std::path::Path;

/// The most intervals of a page.
const INTERVALS: u64 = 1000;

/// The states of a run with their times, about a thousand.
pub fn states<'a, S: Clebsch<Scalar = f64>, M: Method<S>>(
    run: &'a Run,
    stepper: &'a Stepper<S, M>,
    start: State<S, M>,
) -> impl Iterator<Item = Result<(f64, State<S, M>), Error>> + 'a {
    let pace = usize::try_from(run.steps.div_ceil(INTERVALS)).unwrap_or(usize::MAX);
    let states = (0..=run.steps).zip(stepper.trajectory(start)).step_by(pace);
    states.map(|(step, state)| Ok((run.time(step), state?)))
}

/// Writes the page where there is a path for it, and says where it is.
///
/// # Errors
/// [`Failure::Page`]
pub fn save<A>(path: Option<&Path>, motion: impl FnOnce() -> Result<Motion<A>, PlotError>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    motion()?.save(path)?;
    say(format_args!("motion      {}", path.display()));
    Ok(())
}
