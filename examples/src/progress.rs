//! A progress bar for whoever waits longer than a second.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::{Duration, Instant};

/// How often the clock is looked at, in steps.
const INTERVAL: u64 = 4096;

/// Silent for a second, then a bar on standard error, if that is a terminal.
pub struct Progress {
    work: u64,
    unit: &'static str,
    interval: u64,
    began: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// For a run of so many steps.
    pub fn new(steps: u64) -> Self {
        Self { work: steps, unit: "steps", interval: INTERVAL, began: Instant::now(), bar: None }
    }

    /// For so many pieces of work that take long enough to look at the clock after each.
    pub fn of(work: u64, unit: &'static str) -> Self {
        Self { work, unit, interval: 1, began: Instant::now(), bar: None }
    }

    /// Takes the number of the step or the piece that has been made.
    pub fn reached(&mut self, step: u64) {
        if !step.is_multiple_of(self.interval) {
            return;
        }
        if self.bar.is_none() && self.began.elapsed() > Duration::from_secs(1) {
            self.bar = Some(bar(self.work, self.unit));
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

fn bar(work: u64, unit: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(&format!(
        "{{bar:40}} {{percent:>3}} %  {{human_pos}} of {{human_len}} {unit}, {{eta}} left"
    ));
    ProgressBar::new(work).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
