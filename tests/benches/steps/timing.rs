//! Nanoseconds a step: blocks of steps of all contestants in turn, so that a slow spell of the machine meets them all.

use std::time::Instant;

/// How many blocks of each contestant are timed.
const REPETITIONS: usize = 21;
/// The length of a block, seconds.
const BLOCK: f64 = 0.004;
/// The least number of steps in a block. The first one has a kick that later steps share, and the last one checks the state.
const STEPS: u64 = 16;

/// The time of a step, ns.
#[derive(Copy, Clone, Debug)]
pub struct Time {
    /// The fastest block's.
    pub least: f64,
    /// The median block's.
    pub median: f64,
}

/// Runs a number of steps from the start.
pub type Run<'a> = Box<dyn Fn(u64) + 'a>;

/// The times of some contestants.
pub fn interleaved(contestants: &[Run<'_>]) -> Vec<Time> {
    let lengths: Vec<u64> = contestants.iter().map(block).collect();
    let mut times = vec![Vec::with_capacity(REPETITIONS); contestants.len()];
    for _ in 0..REPETITIONS {
        for ((run, &steps), times) in contestants.iter().zip(&lengths).zip(&mut times) {
            times.push(seconds(run, steps) / steps as f64 * 1e9);
        }
    }
    times.into_iter().map(Time::of).collect()
}

/// The number of steps in a block.
fn block(run: &Run<'_>) -> u64 {
    let mut steps = 1;
    loop {
        let taken = seconds(run, steps);
        if taken > BLOCK / 2.0 {
            return ((steps as f64 * BLOCK / taken) as u64 + 1).max(STEPS);
        }
        steps *= 2;
    }
}

fn seconds(run: &Run<'_>, steps: u64) -> f64 {
    let start = Instant::now();
    run(steps);
    start.elapsed().as_secs_f64()
}

impl Time {
    fn of(mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        Self { least: times[0], median: times[times.len() / 2] }
    }
}
