//! A skyrmion at rest: the harmonic map of degree one, by over-relaxation and by multigrid.
//!
//! Source: Belavin and Polyakov, *Metastable states of two-dimensional isotropic ferromagnets*, JETP Letters 22 (1975).

mod figure;
mod map;

use clap::Parser;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Run, Scene, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use map::{Map, Square, instanton, smooth};
use nalgebra::Vector3;
use std::process::ExitCode;

const SCENE: Scene = Scene {
    name: "skyrmion",
    step_size: "0.0625",
    time_unit: "metres between sites",
    steps: "64",
    order: "2",
    order_note: "energies of edges have order 2",
    columns_note: "the vector q1,q2,q3 on the line through the middle, the instanton e1,e2,e3; `time` is the place in metres",
};

/// Finer and coarser grids, in parts of the cells of the middle one.
const PARTS: [(usize, usize); 3] = [(1, 2), (1, 1), (2, 1)];
/// The most sweeps and cycles.
const SWEEPS: u64 = 100_000;
const CYCLES: u64 = 400;
/// The least size of a skyrmion, in cells of the coarsest grid.
const CELLS: f64 = 4.0;
/// Sweeps of one cycle over the finest grid.
const OF_CYCLE: u64 = 4;

/// A skyrmion at rest in a square: energy and degree, and the sweeps that over-relaxation and multigrid take
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Size of the instanton on the sides, m
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_hyphen_values = true, default_value = "0.7")]
    size: f64,
    #[command(flatten)]
    run: Run,
}

/// A map at rest on one grid.
struct Solved {
    square: Square,
    q: Vec<Vector3<f64>>,
    residual: f64,
    cycles: u64,
    sweeps: u64,
    /// Between the configurations of both solvers.
    apart: f64,
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let cells = flags.run.steps as usize;
    if !(8..=1024).contains(&cells) || !cells.is_multiple_of(2) {
        return Err(Failure::Flags(format!("--steps: {cells} cells are not an even number from 8 to 1024")));
    }
    let side = flags.run.duration();
    let width = flags.size / (2.0 * flags.run.step_size);
    if width < CELLS {
        let text = format!(
            "--size: {} m are {width:.1} cells of the coarsest grid, and a skyrmion of less than {CELLS} falls through it",
            flags.size
        );
        return Err(Failure::Flags(text));
    }
    let solve = |map: Map<'_>| -> Result<Vec<Solved>, Failure> {
        PARTS.iter().map(|(part, of)| solve(Square { cells: cells * part / of, side }, map)).collect()
    };
    let exact = instanton(flags.size);
    let (skyrmions, maps) = (solve(&exact)?, solve(&smooth)?);
    let mut claims = Claims::new();
    say(format_args!(
        "a skyrmion of size {} m in a square of {side} m: its sides are those of the instanton\n",
        flags.size
    ));
    say(energies(&skyrmions, &exact, &mut claims)?);
    say("sweeps over the grid until all corrections are below 1e-10: cycles of multigrid have four\n");
    say(sweeps(&skyrmions, &maps));
    claim_sweeps(&skyrmions, &maps, &mut claims);
    write(flags, &skyrmions[1], &exact)?;
    figure::draw(flags, &skyrmions, &maps)?;
    Ok(claims)
}

/// A map at rest from its values at all sites, by both solvers.
fn solve(square: Square, map: Map<'_>) -> Result<Solved, Failure> {
    let field = square.field();
    let (mut q, mut other) = (square.values(map), square.values(map));
    let found = field.relax().multigrid().cycles(CYCLES).solve(&mut q)?;
    let sweeps = field.relax().sweeps(SWEEPS).solve(&mut other)?.sweeps();
    let apart = largest(q.iter().zip(&other).map(|(q, other)| (q - other).amax()));
    Ok(Solved { square, q, residual: found.residual(), cycles: found.sweeps() / OF_CYCLE, sweeps, apart })
}

/// Energies and distances from the instanton, with claims about their orders.
fn energies(skyrmions: &[Solved], exact: Map<'_>, claims: &mut Claims) -> Result<Table<5>, Failure> {
    let mut table = Table::new(["sites", "energy", "degree", "energy − 4π |degree|", "off the instanton"]);
    let mut errors = Vec::new();
    for Solved { square, q, .. } in skyrmions {
        let (energy, degree, above) = square.above_degree(q)?;
        let off = largest(q.iter().zip(square.values(exact)).map(|(q, exact)| (q - exact).amax()));
        let sites = square.sites();
        table.row([
            format!("{sites} × {sites}"),
            format!("{energy:.6}"),
            format!("{degree:.6}"),
            format!("{above:.5}"),
            format!("{off:.5}"),
        ]);
        errors.push((above, off));
    }
    claims.holds(
        "the energy is below 4π |degree|",
        errors.iter().all(|(above, _)| *above < 0.0),
        "chords are shorter than arcs",
    );
    for (number, pair) in errors.windows(2).enumerate() {
        let name = |what: &str| format!("{what}, grids {} and {}", number + 1, number + 2);
        let order = |coarse: f64, fine: f64| (coarse / fine).log2();
        claims.within(&name("order of the energy"), order(pair[0].0, pair[1].0), 1.7..=2.3, 2, "edges have order 2");
        claims.within(&name("order of the map"), order(pair[0].1, pair[1].1), 1.7..=2.4, 2, "edges have order 2");
    }
    Ok(table)
}

/// The sweeps of all grids.
fn sweeps(skyrmions: &[Solved], maps: &[Solved]) -> Table<5> {
    let mut table = Table::new(["sites", "skyrmion: cycles", "over-relaxation", "degree 0: cycles", "over-relaxation"]);
    for (skyrmion, map) in skyrmions.iter().zip(maps) {
        let sites = skyrmion.square.sites();
        let counts = [skyrmion.cycles, skyrmion.sweeps, map.cycles, map.sweeps].map(|count| count.to_string());
        let [cycles, sweeps, cycles_of_map, sweeps_of_map] = counts;
        table.row([format!("{sites} × {sites}"), cycles, sweeps, cycles_of_map, sweeps_of_map]);
    }
    table
}

fn claim_sweeps(skyrmions: &[Solved], maps: &[Solved], claims: &mut Claims) {
    let all = || skyrmions.iter().chain(maps);
    claims.at_most(
        "largest force on a site",
        largest(all().map(|solved| solved.residual)),
        1e-9,
        "corrections are below 1e-10",
    );
    // a correction of 1e-10 of the slowest mode is so many times further from rest
    let farthest = skyrmions.iter().map(|solved| solved.square.sites()).max().unwrap_or(1) as f64;
    claims.at_most(
        "both solvers, apart",
        largest(all().map(|solved| solved.apart)),
        1e-10 * farthest.powi(2),
        "1e-10 n² of slow modes",
    );
    let cycles = || maps.iter().map(|solved| solved.cycles);
    let (least, most) = (cycles().min().unwrap_or(0), cycles().max().unwrap_or(0));
    claims.at_most("degree 0: cycles, at most", most as f64, 12.0, "whatever the size");
    claims.at_most("degree 0: cycles of all grids, difference", (most - least) as f64, 3.0, "whatever the size");
    let growth = maps.windows(2).map(|pair| pair[1].sweeps as f64 / pair[0].sweeps as f64);
    claims.at_most("degree 0: over-relaxation, growth for twice the sites", largest(growth), 3.0, "as n, not as n²");
}

/// The line through the middle.
fn write(flags: &Flags, Solved { square, q, .. }: &Solved, exact: Map<'_>) -> Result<(), Failure> {
    let mut csv = Csv::create(&flags.run, &["q1", "q2", "q3", "e1", "e2", "e3"])?;
    let n = square.sites();
    for i in 0..n {
        let site = i * n + n / 2;
        let [x, y] = square.place(site);
        csv.row(i as u64, x, q[site].iter().chain(exact(x, y).iter()).copied())?;
    }
    csv.finish()
}
