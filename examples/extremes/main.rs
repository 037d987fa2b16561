//! The map of the edge: the outcome of extreme step sizes, bodies, units, starts and potentials, in both number types.
//!
//! Each section runs scenes with their dials over one quantity and prints a table. The scene claims that certain
//! outcomes never occur. These are a result that is not finite, work beyond its bound, a momentum or a constraint that
//! leaves rounding, and a false bound.

mod declarations;
mod inertia;
mod long_runs;
mod magnitudes;
mod map;
mod motion;
mod potentials;
mod probe;
mod random;
mod random_states;
mod setup;
mod starts;
mod step_sizes;

use clap::{Parser, ValueEnum};
use clebsch_examples::claims::Claims;
use clebsch_examples::flags::count;
use clebsch_examples::scene::{Failure, conclude, say};
use map::Map;
use std::path::PathBuf;
use std::process::ExitCode;

/// The map of the edge: extreme steps, bodies, units, starts, potentials and durations
#[derive(Parser, Debug)]
#[command(name = "extremes")]
struct Flags {
    /// A thousand million random states of each scene and steps of each long run: hours
    #[arg(long)]
    full: bool,
    /// A tenth of the work, and less: seconds
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// One section alone
    #[arg(long, value_name = "NAME")]
    section: Option<Section>,
    /// Steps of each long run [default: 100000000]
    #[arg(long, value_name = "N", value_parser = count)]
    steps: Option<u64>,
    /// Random states of each scene, shared by its dials and types [default: 100000000]
    #[arg(long, value_name = "N", value_parser = count)]
    states: Option<u64>,
    /// Random bodies whose longest step is looked for [default: 300]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    bodies: Option<u32>,
    /// Write all cells to FILE: section, scene, dial, scalar, value, outcome, steps, iterations, residual, energy, momentum, constraint, error
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draw the figures to FOLDER, as SVG [default: `figures` under cargo's target folder]
    #[arg(long, value_name = "FOLDER")]
    figures: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Section {
    StepSizes,
    Inertia,
    Magnitudes,
    Starts,
    Potentials,
    RandomStates,
    LongRuns,
}

impl Flags {
    fn includes(&self, section: Section) -> bool {
        self.section.is_none_or(|chosen| chosen == section)
    }

    fn steps(&self) -> u64 {
        self.steps.unwrap_or(self.chosen([100_000, 100_000_000, 1_000_000_000]))
    }

    fn states(&self) -> u64 {
        self.states.unwrap_or(self.chosen([100_000, 100_000_000, 1_000_000_000]))
    }

    /// The number for `quick`, for neither, for `full`.
    fn chosen(&self, of: [u64; 3]) -> u64 {
        of[if self.quick { 0 } else { 1 + usize::from(self.full) }]
    }

    /// Random bodies whose bound is looked for.
    fn bodies(&self) -> u32 {
        self.bodies.unwrap_or(self.chosen([5, 300, 10_000]) as u32)
    }
}

fn main() -> ExitCode {
    conclude(run(&Flags::parse()))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let mut map = Map::new(flags.csv.as_deref())?;
    let mut claims = Claims::new();
    let folder = flags.figures.as_deref();
    if flags.includes(Section::StepSizes) {
        step_sizes::explore(&mut map, &mut claims, folder, (flags.chosen([10, 200, 200]), flags.bodies()))?;
    }
    if flags.includes(Section::Inertia) {
        inertia::explore(&mut map, &mut claims, flags.chosen([5, 1000, 1000]))?;
    }
    if flags.includes(Section::Magnitudes) {
        magnitudes::explore(&mut map, &mut claims, flags.chosen([2, 50, 50]))?;
    }
    if flags.includes(Section::Starts) {
        starts::explore(&mut map, &mut claims, flags.chosen([100, 20_000, 20_000]))?;
    }
    if flags.includes(Section::Potentials) {
        potentials::explore(&mut map, &mut claims)?;
    }
    if flags.includes(Section::RandomStates) {
        random_states::explore(&mut map, &mut claims, flags.states())?;
    }
    if flags.includes(Section::LongRuns) {
        long_runs::explore(&mut map, &mut claims, flags.steps(), folder)?;
    }
    say(format_args!(
        "{} runs, {} to their end, the others refused with an error that says why\n",
        map.cells, map.ended
    ));
    claims.at_most("results that are not finite", map.hidden as f64, 0.0, "of all runs");
    if let Some(path) = map.finish()? {
        say(format_args!("cells       {}", path.display()));
    }
    Ok(claims)
}
