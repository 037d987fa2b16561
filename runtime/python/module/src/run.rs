//! Runs that can be interrupted.

use crate::engine::{Driven, Point};
use crate::failure::Failure;
use clebsch::{Clebsch, Method, Real, Scalar, State, Time};
use std::sync::Arc;

/// Whether the run may go on. Called often: it answers fast.
pub type Watch<'a> = &'a dyn Fn() -> bool;

/// Steps between two looks at the user's interrupt.
const PART: u32 = 4096;

/// So many steps: those of `Drive::advance_watched` with a look after every [`PART`] of them.
pub(crate) fn advance<S, M>(
    driven: &Driven<S, M>,
    start: &State<S, M>,
    steps: u64,
    watch: Watch<'_>,
) -> Result<Point, Failure>
where
    S: Clebsch<Scalar: Real> + 'static,
    M: Method<S> + 'static,
    State<S, M>: Send + Sync,
{
    let (mut state, mut left) = (*start, steps);
    while left > 0 {
        let part = left.min(u64::from(PART)) as usize;
        state = driven.stepper.advance_or_stop(&state, part).map_err(|stopped| Failure::Stopped {
            error: stopped.error,
            point: Arc::new(stopped.state),
            done: steps - left + stopped.steps as u64,
            unit: "steps",
        })?;
        left -= part as u64;
        if !watch() {
            return Err(Failure::Interrupted);
        }
    }
    Ok(Arc::new(state))
}

/// The rows at these times, and the state at the last one.
///
/// Long ways between two times have times between, which are not written: they change no bit, as the steps stay the same.
pub(crate) fn run<S, M>(
    driven: &Driven<S, M>,
    start: &State<S, M>,
    times: &[f64],
    rows: &mut [f64],
    watch: Watch<'_>,
) -> Result<Point, Failure>
where
    S: Clebsch<Scalar: Real> + 'static,
    M: Method<S> + 'static,
    State<S, M>: Send + Sync,
{
    let all = with_looks(start.clock().now().to_f64(), driven.stepper.step_size().to_f64(), times);
    let mut states = driven.stepper.trajectory(*start).at(all.clone().map(|(time, _)| S::Scalar::from_f64(time)));
    let mut rows = rows.chunks_exact_mut(driven.row_width());
    let (mut last, mut done) = (*start, 0);
    for (time, is_asked_for) in all {
        match states.next() {
            Some(Ok(state)) => last = state,
            Some(Err(error)) => {
                return Err(Failure::Stopped { error, point: Arc::new(*states.state()), done, unit: "times" });
            }
            None => break,
        }
        if let Some(row) = rows.next_if(is_asked_for) {
            driven.write(time, &last, row);
            done += 1;
        }
        if !watch() {
            return Err(Failure::Interrupted);
        }
    }
    Ok(Arc::new(last))
}

/// The times, each with `true`, and the times between them at which a long run looks for an interrupt.
fn with_looks(start: f64, step: f64, times: &[f64]) -> impl Iterator<Item = (f64, bool)> + Clone + '_ {
    let part = f64::from(PART) * step;
    let before = [start].into_iter().chain(times.iter().copied());
    before.zip(times).flat_map(move |(from, &to)| {
        // a count that is NaN or negative is 0
        let looks = ((to - from) / part).ceil() as u64;
        let between = (1..looks).map(move |k| from + k as f64 * part);
        between.filter(move |time| (to - time) * part > 0.0).map(|time| (time, false)).chain([(to, true)])
    })
}

/// The next item, where one is wanted.
trait NextIf: Iterator {
    fn next_if(&mut self, wanted: bool) -> Option<Self::Item>;
}

impl<I: Iterator> NextIf for I {
    fn next_if(&mut self, wanted: bool) -> Option<I::Item> {
        if wanted { self.next() } else { None }
    }
}
