//! A block of many unit vectors: time of a step and memory, on one core and on all of them.

mod block;
mod figure;

use block::Cube;
use clap::Parser;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Run, Scene, count_within, parse};
use clebsch_examples::integrate::integrate_field;
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use std::num::NonZero;
use std::process::ExitCode;
use std::thread;
use std::time::Instant;

const SCENE: Scene = Scene {
    name: "lattice",
    step_size: "0.5",
    time_unit: "the time of a wave from site to site",
    steps: "20",
    order: "2",
    order_note: "steps of fields have order 2 or more",
    columns_note: "energy of a site, momentum L3 of a site",
};

/// Sides of the blocks, in parts of the largest one.
const PARTS: [usize; 3] = [4, 2, 1];
/// The shortest time of so many runs is shown, for the largest and for the smallest blocks.
const RUNS: usize = 3;
const MOST: usize = 30;
/// Steps of single sites that are timed in all runs together.
const TIMED: usize = 100_000;

/// A block of unit vectors on a cubic grid: every site against its closed form, and the time of a step of one site
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Sites along each side: 216 are ten million in all, and take 1.5 GB
    #[arg(long, value_name = "N", value_parser = side, default_value = "40")]
    side: usize,
    #[command(flatten)]
    run: Run,
}

/// A number of sites for the memory of today.
fn side(text: &str) -> Result<usize, String> {
    count_within(text, 24..=1024)
}

/// Times of a block.
#[derive(Clone, Copy, Debug)]
struct Timed {
    sites: usize,
    bytes: usize,
    /// Of one site, on one core and on all.
    nanoseconds: [f64; 2],
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let Run { step_size, steps, .. } = flags.run;
    let limit = 1.0 / 3.0_f64.sqrt();
    if step_size > limit {
        let text = format!("--step-size: {step_size} is longer than 1/√3 = {limit:.4}, the longest stable step");
        return Err(Failure::Flags(text));
    }
    let mut claims = Claims::new();
    let sites = flags.side.pow(3);
    say(format_args!("{sites} unit vectors: {steps} steps, each {step_size} of the time from site to site\n"));
    say(follow(flags, &mut claims)?);
    let timed = PARTS.map(|part| time(flags, flags.side / part, &mut claims, part == 1));
    let timed = timed.into_iter().collect::<Result<Vec<Timed>, Failure>>()?;
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    say(format_args!("times of a step of one site, with {cores} cores: they differ from run to run"));
    say(table(&timed));
    Ok(claims)
}

/// One run with claims about every site.
fn follow(flags: &Flags, claims: &mut Claims) -> Result<Table<5>, Failure> {
    let run = &flags.run;
    let Cube { stepper, mut state, side } = Cube::spiral(flags.side, run.step_size)?;
    let sites = state.configuration().len() as f64;
    let mut csv = Csv::create(run, &["energy", "L3"])?;
    let mut table = Table::new(["steps", "energy of a site", "its change", "momentum L3 of a site", "off the spiral"]);
    let (mut first, mut defects) = (None, [0.0; 3]);
    let is_seen = |step: u64| run.writes(step) || run.samples(step, 4);
    integrate_field(run, &stepper, &mut state, is_seen, |step, time, state| {
        let energy = stepper.energy(state).map_err(Failure::step(step))? / sites;
        let momentum = stepper.conserved(state).map_err(Failure::step(step))?[2] / sites;
        csv.row(step, time, [energy, momentum])?;
        let off = block::off(side, &stepper, state);
        let (energy_at_start, momentum_at_start) = *first.get_or_insert((energy, momentum));
        let moved = [off, (energy / energy_at_start - 1.0).abs(), (momentum / momentum_at_start - 1.0).abs()];
        for (defect, moved) in defects.iter_mut().zip(moved) {
            *defect = largest([*defect, moved]);
        }
        if run.samples(step, 4) {
            let change = energy / energy_at_start - 1.0;
            table.row([
                step.to_string(),
                format!("{energy:.9}"),
                format!("{change:.1e}"),
                format!("{momentum:.9}"),
                format!("{off:.1e}"),
            ]);
        }
        Ok(())
    })?;
    csv.finish()?;
    figure::draw(flags, state.configuration())?;
    for (name, defect) in ["every site is on its spiral", "the energy stays, relative", "the momentum stays, relative"]
        .into_iter()
        .zip(defects)
    {
        // sums of all sites round more often
        let sums = if name.starts_with("every") { 0 } else { state.configuration().len() as u64 / 256 };
        claims.round_off(name, defect, run.steps + sums, 1.0);
    }
    Ok(table)
}

/// Times the steps of a block, and claims that threads have the same bits.
fn time(flags: &Flags, side: usize, claims: &mut Claims, is_claimed: bool) -> Result<Timed, Failure> {
    let Run { step_size, steps, .. } = flags.run;
    let mut one = Cube::spiral(side, step_size)?;
    let mut all = one.clone();
    let sites = side.pow(3);
    let mut nanoseconds = [f64::INFINITY; 2];
    for number in 0..(TIMED / (sites * steps as usize)).clamp(RUNS, MOST) {
        if number > 0 {
            one = Cube::spiral(side, step_size)?;
            all.state.clone_from(&one.state);
        }
        let clock = Instant::now();
        one.stepper.advance(&mut one.state, steps).map_err(Failure::step(1))?;
        let between = Instant::now();
        all.stepper.par_advance(&mut all.state, steps).map_err(Failure::step(1))?;
        for (least, time) in nanoseconds.iter_mut().zip([between - clock, between.elapsed()]) {
            *least = least.min(time.as_nanos() as f64 / (steps as f64 * sites as f64));
        }
    }
    if is_claimed {
        let name = "threads have the bits of one";
        claims.holds(name, one.state == all.state, &format!("{sites} configurations and momenta are compared"));
    }
    Ok(Timed { sites, bytes: one.bytes(), nanoseconds })
}

fn table(timed: &[Timed]) -> Table<5> {
    let mut table = Table::new(["sites", "memory / MB", "one core / ns", "all cores / ns", "faster"]);
    for Timed { sites, bytes, nanoseconds: [one, all] } in timed {
        table.row([
            sites.to_string(),
            format!("{:.2}", *bytes as f64 / 1e6),
            format!("{one:.1}"),
            format!("{all:.1}"),
            format!("{:.2}", one / all),
        ]);
    }
    table
}
