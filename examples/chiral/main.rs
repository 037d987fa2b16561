//! The chiral model by its connection: elements of edges that move without configurations.
//!
//! Source: Leok, Marsden and Weinstein, *A discrete theory of connections on principal bundles* (2005).

mod annulus;
mod figure;
mod sheet;

use clap::Parser;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Run, Scene, count_within, finite, parse, positive};
use clebsch_examples::round_off;
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use nalgebra::Matrix3;
use sheet::{Seen, Sheet};
use std::process::ExitCode;

const SCENE: Scene = Scene {
    name: "chiral",
    step_size: "0.02",
    time_unit: "seconds",
    steps: "400",
    order: "2",
    order_note: "steps of fields have order 2 or more",
    columns_note: "energy, curvature − I, elements less those of the configuration",
};

/// Rows of the table, and points of the curves.
const ROWS: u64 = 8;
const POINTS: u64 = 100;

/// The chiral model on a sheet by the elements of edges, against the same by configurations, and a hole with a holonomy
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Sites in each direction
    #[arg(long, value_name = "N", value_parser = sizes, default_value = "24")]
    sites: usize,
    /// Side of the sheet, m; waves have the speed 1 m/s
    #[arg(long, value_name = "L", value_parser = positive, allow_hyphen_values = true, default_value = "2")]
    length: f64,
    /// By how much the waves turn at the start, degrees
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_hyphen_values = true, default_value = "60")]
    turn: f64,
    #[command(flatten)]
    run: Run,
}

/// A number of sites that is no surprise for the memory.
fn sizes(text: &str) -> Result<usize, String> {
    count_within(text, 4..=512)
}

/// One run.
struct Watched {
    seen: Vec<(f64, Seen)>,
    q: Vec<Matrix3<f64>>,
    /// Between the configuration from the elements and the one that moved.
    off: f64,
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let (spacing, h) = (flags.length / flags.sites as f64, flags.run.step_size);
    let limit = spacing / std::f64::consts::SQRT_2;
    if h > limit {
        let text = format!("--step-size: {h} s is longer than dx/√2 = {limit:.4} s, the longest stable step");
        return Err(Failure::Flags(text));
    }
    let mut csv = Csv::create(&flags.run, &["energy", "curvature", "apart"])?;
    let watched =
        watch(flags, &flags.run, |step, time, seen| csv.row(step, time, [seen.energy, seen.flatness, seen.apart]))?;
    csv.finish()?;
    let mut claims = Claims::new();
    say(format_args!("{0} by {0} rotations, by the elements of {1} edges\n", flags.sites, 2 * flags.sites.pow(2)));
    say(table(&watched));
    let halved = watch(flags, &flags.run.refined(2), |_, _, _| Ok(()))?;
    claim(flags, (&watched, &halved), &mut claims);
    say("an annulus of triangles, whose elements turn around the hole\n");
    say(annulus::around(&mut claims)?);
    figure::draw(flags, &watched)?;
    Ok(claims)
}

fn watch(
    flags: &Flags,
    run: &Run,
    mut record: impl FnMut(u64, f64, &Seen) -> Result<(), Failure>,
) -> Result<Watched, Failure> {
    let mut sheet = Sheet::of(flags.sites, flags.length / flags.sites as f64, run.step_size, flags.turn.to_radians())?;
    let (mut seen, mut made) = (Vec::new(), 0);
    for step in (0..=run.steps).filter(|&step| run.writes(step) || run.samples(step, POINTS)) {
        sheet.advance(step - made)?;
        made = step;
        let now = sheet.seen()?;
        record(step, run.time(step), &now)?;
        seen.push((run.time(step), now));
    }
    let (q, off) = sheet.reconstructed()?;
    Ok(Watched { seen, q, off })
}

fn table(watched: &Watched) -> Table<5> {
    let mut table = Table::new(["time / s", "energy", "its change / 1e-3", "curvature", "apart"]);
    let first = watched.seen.first().map_or(1.0, |(_, seen)| seen.energy);
    for (time, seen) in watched.seen.iter().step_by(watched.seen.len().div_ceil(ROWS as usize + 1).max(1)) {
        table.row([
            format!("{time:.2}"),
            format!("{:.6}", seen.energy),
            format!("{:.4}", (seen.energy / first - 1.0) * 1e3),
            format!("{:.1e}", seen.flatness),
            format!("{:.1e}", seen.apart),
        ]);
    }
    table
}

/// By how much the energy changes, over the energy.
fn change(watched: &Watched) -> f64 {
    let first = watched.seen.first().map_or(1.0, |(_, seen)| seen.energy);
    largest(watched.seen.iter().map(|(_, seen)| (seen.energy / first - 1.0).abs()))
}

fn claim(flags: &Flags, (watched, halved): (&Watched, &Watched), claims: &mut Claims) {
    let steps = flags.run.steps;
    let most = |number: fn(&Seen) -> f64| largest(watched.seen.iter().map(|(_, seen)| number(seen)));
    let sites = flags.sites as f64;
    claims.round_off("elements are those of the configuration", most(|seen| seen.apart), steps, 4.0);
    claims.round_off("curvature of all squares", most(|seen| seen.flatness), steps, 4.0);
    claims.round_off("elements stay rotations", most(|seen| seen.orthogonality), steps, 1.0);
    claims.round_off("total momentum in space", most(|seen| seen.momentum.amax()), steps, sites * sites);
    let far = steps + 2 * flags.sites as u64;
    claims.round_off("the configuration along a tree of edges", watched.off, far, 4.0);
    let (one, half) = (change(watched), change(halved));
    let name = "half the step, a quarter of the change of the energy";
    if half > 10.0 * round_off::worst_case(2 * steps, 1.0) {
        claims.within(name, one / half, 3.5..=4.5, 3, &format!("the change with h is {one:.1e} of the energy"));
    } else {
        claims.skip(name, "too little motion for the order to show");
    }
}
