//! Many runs on all cores.

use crate::classes::{LOOK, PyState, PyStepper, bytes, numbers};
use crate::engine::{Engine, Point};
use crate::failure::Failure;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, mpsc};
use std::thread;

/// One run: its stepper and its start.
type Job<'a> = (&'a dyn Engine, &'a Point);

/// The rows of all runs, one run after the other, and their last states.
///
/// Each run is made by one thread, with the bits that it has alone. The first run that fails, by its number, is the error.
#[pyfunction]
pub(crate) fn run_all<'py>(
    py: Python<'py>,
    steppers: Vec<Py<PyStepper>>,
    states: Vec<Py<PyState>>,
    times: &[u8],
    threads: usize,
) -> PyResult<(Bound<'py, PyByteArray>, Vec<PyState>)> {
    let times = numbers(times);
    let jobs: Vec<Job<'_>> =
        steppers.iter().zip(&states).map(|(stepper, state)| (&*stepper.get().engine, &state.get().point)).collect();
    let width = steppers.first().map_or(0, |stepper| stepper.get().engine.width());
    let mut rows = vec![0.0; jobs.len() * times.len() * width];
    let ends = py.detach(|| on_threads(&jobs, &times, &mut rows, times.len() * width, threads));
    let mut points = Vec::with_capacity(ends.len());
    for (body, end) in ends.into_iter().enumerate() {
        match end {
            Ok(point) => points.push(PyState::new(point)),
            Err(failure) => {
                let error = failure.raise(py);
                error.value(py).setattr("body", body)?;
                return Err(error);
            }
        }
    }
    Ok((bytes(py, &rows)?, points))
}

/// A lock that no panic spoils: what it guards is an iterator or a place of a result.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes the runs, while this thread looks for an interrupt.
fn on_threads(
    jobs: &[Job<'_>],
    times: &[f64],
    rows: &mut [f64],
    of_one: usize,
    threads: usize,
) -> Vec<Result<Point, Failure>> {
    let mut ends: Vec<Option<Result<Point, Failure>>> = jobs.iter().map(|_| None).collect();
    let goes_on = AtomicBool::new(true);
    let tasks = jobs.iter().zip(rows.chunks_mut(of_one.max(1))).zip(&mut ends);
    let tasks = Mutex::new(tasks);
    let (done, finished) = mpsc::channel::<()>();
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, jobs.len().max(1)) {
            let (done, tasks, goes_on) = (done.clone(), &tasks, &goes_on);
            scope.spawn(move || {
                let watch = || goes_on.load(Ordering::Relaxed);
                loop {
                    let Some((((engine, point), rows), end)) = locked(tasks).next() else { break };
                    *end =
                        Some(if watch() { engine.run(point, times, rows, &watch) } else { Err(Failure::Interrupted) });
                }
                drop(done);
            });
        }
        drop(done);
        // ends when the last thread has dropped its sender
        while finished.recv_timeout(LOOK) == Err(mpsc::RecvTimeoutError::Timeout) {
            if goes_on.load(Ordering::Relaxed)
                && Python::attach(|py| py.check_signals().map_err(|e| e.restore(py)).is_err())
            {
                goes_on.store(false, Ordering::Relaxed);
            }
        }
    });
    ends.into_iter().map(|end| end.unwrap_or(Err(Failure::Interrupted))).collect()
}
