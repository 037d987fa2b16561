//! Waves of unit vectors on a sheet, the nonlinear sigma model in two directions of space.
//!
//! Source: Shatah and Struwe, *Geometric Wave Equations* (1998), for the equation q_tt − Δq ∥ q.

mod dispersion;
mod figure;
mod sheet;
mod small;
mod watch;

use clap::Parser;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Run, Scene, count_within, finite, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use std::process::ExitCode;
use std::time::Instant;
use watch::Watch;

const SCENE: Scene = Scene {
    name: "wave_map",
    step_size: "0.05",
    time_unit: "seconds",
    steps: "72",
    order: "2",
    order_note: "steps of fields have order 2 or more",
    columns_note: "energy, total momentum L1,L2,L3 and the vector q1,q2,q3 in the middle of the sheet",
};

/// Sites in each direction of the grids that are timed, and their steps.
const TIMED: [(usize, u64); 3] = [(16, 2000), (128, 40), (1024, 3)];

/// Waves of unit vectors on a sheet: frequencies of the grid, momenta, and a picture of the field in time
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Sites in each direction
    #[arg(long, value_name = "N", value_parser = sizes, default_value = "64")]
    sites: usize,
    /// Side of the sheet, m; waves have the speed 1 m/s
    #[arg(long, value_name = "L", value_parser = positive, allow_hyphen_values = true, default_value = "8")]
    length: f64,
    /// By how much two lumps of the sheet are turned at the start, degrees
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_hyphen_values = true, default_value = "150")]
    turn: f64,
    /// How fast they spin about the third axis at the start, rad/s
    #[arg(long, value_name = "RATE", value_parser = finite, allow_hyphen_values = true, default_value = "1")]
    spin: f64,
    /// Print the time of a step for some sizes
    #[arg(long)]
    time: bool,
    #[command(flatten)]
    run: Run,
}

/// A number of sites that is no surprise for the memory.
fn sizes(text: &str) -> Result<usize, String> {
    count_within(text, 4..=4096)
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let Run { step_size, steps, .. } = flags.run;
    let spacing = [flags.length / flags.sites as f64; 2];
    let limit = spacing[0] / std::f64::consts::SQRT_2;
    if step_size > limit {
        let text = format!("--step-size: {step_size} s is longer than dx/√2 = {limit:.4} s, the longest stable step");
        return Err(Failure::Flags(text));
    }
    let start = sheet::lumps(flags.sites, flags.turn.to_radians(), flags.spin);
    let middle = flags.sites / 2 * (flags.sites + 1);
    let mut csv = Csv::create(&flags.run, &["energy", "L1", "L2", "L3", "q1", "q2", "q3"])?;
    let stepper = sheet::steps([flags.sites; 2], spacing, step_size)?;
    let watch = Watch::of(&flags.run, &stepper, start.clone(), |step, time, energy, total, q| {
        csv.row(step, time, [energy].into_iter().chain(total.iter().copied()).chain(q[middle].iter().copied()))
    })?;
    say(format_args!("a sheet of {} by {} unit vectors: {steps} steps of {step_size} s\n", flags.sites, flags.sites));
    say(&watch.table);
    if flags.time {
        say(times()?);
    }
    csv.finish()?;
    figure::draw(flags, &watch)?;

    let mut claims = Claims::new();
    say("frequencies on 16 by 12 sites, 0.5 m and 0.6 m apart, in steps of 0.2 s, 1/s\n");
    say(dispersion::compare(&mut claims)?);
    Watch::claim_local(&flags.run, &stepper, start.clone(), &mut claims)?;
    let stepper = sheet::steps([flags.sites; 2], spacing, step_size / 2.0)?;
    let halved = Watch::of(&flags.run.refined(2), &stepper, start, |_, _, _, _, _| Ok(()))?;
    watch.claim(&halved, &mut claims);
    small::claim(spacing, step_size, &mut claims)?;
    Ok(claims)
}

/// The time of a step of one site, for some sizes, on one core and on all of them.
fn times() -> Result<Table<4>, Failure> {
    let mut table = Table::new(["sites", "steps", "one core / ns", "all cores / ns"]);
    for (n, steps) in TIMED {
        let stepper = sheet::steps([n; 2], [0.125; 2], 0.05)?;
        let (q, mu) = sheet::lumps(n, 2.0, 1.0);
        let mut state = stepper.state(q, mu)?;
        let mut timed = |all: bool| -> Result<String, Failure> {
            let mut least = f64::INFINITY;
            for _ in 0..3 {
                let clock = Instant::now();
                let moved =
                    if all { stepper.par_advance(&mut state, steps) } else { stepper.advance(&mut state, steps) };
                moved.map_err(Failure::step(1))?;
                least = least.min(clock.elapsed().as_nanos() as f64);
            }
            Ok(format!("{:.1}", least / (steps as f64 * (n * n) as f64)))
        };
        table.row([(n * n).to_string(), steps.to_string(), timed(false)?, timed(true)?]);
    }
    Ok(table)
}
