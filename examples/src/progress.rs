//! A progress bar for whoever waits longer than a second.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::{Duration, Instant};

/// How often the clock is looked at, in steps.
const INTERVAL: u64 = 4096;

/// Silent for a second, then a bar on standard error, if that is a terminal.
pub struct Progress {
    steps: u64,
    began: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// For a run of so many steps.
    pub fn new(steps: u64) -> Self {
        Self { steps, began: Instant::now(), bar: None }
    }

    /// Takes the number of the step that has been made.
    pub fn reached(&mut self, step: u64) {
        if !step.is_multiple_of(INTERVAL) {
            return;
        }
        if self.bar.is_none() && self.began.elapsed() > Duration::from_secs(1) {
            self.bar = Some(bar(self.steps));
        }
        if let Some(bar) = &self.bar {
            bar.set_position(step);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn bar(steps: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {human_pos} of {human_len} steps, {eta} left");
    ProgressBar::new(steps).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
