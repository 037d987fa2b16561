//! The flying rod of Simo and Vu-Quoc: a Cosserat rod as a field of rigid sections.
//!
//! Source: Simo and Vu-Quoc, *On the dynamics of flexible beams under large overall motions: the plane case*, Journal of Applied Mechanics 53 (1986) 849–863.

mod beam;
mod continuous;
mod declaration;
mod figure;
mod flight;
mod implicit;
mod modes;
mod plane;
mod statics;

use beam::FLYING;
use clap::Parser;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::convergence::Convergence;
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Order, Run, Scene, count, finite_list, parse};
use clebsch_examples::reference::solve;
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use declaration::centre;
use flight::{Flight, LOADED};
use nalgebra::{SVector, Vector2};
use std::process::ExitCode;

const SCENE: Scene = Scene {
    name: "rod",
    step_size: "0.0025",
    time_unit: "seconds",
    steps: "4000",
    order: "2",
    order_note: "steps of fields have order 2 or more",
    columns_note: "lower end x1,y1,z1 and upper end x2,y2,z2 (m), energy (J), momentum p1,p2,p3 (kg m/s), angular momentum L1,L2,L3 about the origin (kg m2/s)",
};

/// Rows of the table.
const ROWS: usize = 10;
/// Edges from which on the ends are compared.
const FEWEST: usize = 16;
/// Time of the comparison with the other integrator, s.
const TIME: f64 = 0.5;
/// Above the fastest rate of its rod, 1/s.
const RATE: f64 = 400.0;

/// A flexible rod that is pushed at one end and flies: momenta, energy, and frequencies of a thin rod
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Edges of the rod; tips are compared with those of half and of twice as many
    #[arg(long, value_name = "N", value_parser = edges, default_value = "20")]
    edges: usize,
    /// Force on the lower end for 2.5 s, N
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true, default_value = "8,0,0")]
    push: [f64; 3],
    /// Moment on the lower end for 2.5 s, N·m
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true, default_value = "0,0,-80")]
    moment: [f64; 3],
    /// Rods at rest instead: rolled up, a cantilever, and a bend of 45 degrees
    #[arg(long)]
    statics: bool,
    #[command(flatten)]
    run: Run,
}

/// An even number of edges.
fn edges(text: &str) -> Result<usize, String> {
    match count(text)? {
        number if number % 2 == 0 && number <= 10_000 => Ok(number as usize),
        number => Err(format!("`{number}` is not an even number up to 10000")),
    }
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    if flags.statics {
        let mut claims = Claims::new();
        say("ends of rods at rest, the clamp at the origin and the rod along z there\n");
        let (table, shapes) = statics::compare(&mut claims)?;
        say(table);
        figure::draw_shapes(flags, &shapes)?;
        return Ok(claims);
    }
    let limit = FLYING.stable_step(flags.edges)?;
    if flags.run.step_size > limit {
        let text =
            format!("--step-size: {} s is longer than {limit:.5} s, the longest stable step", flags.run.step_size);
        return Err(Failure::Flags(text));
    }
    let columns = ["x1", "y1", "z1", "x2", "y2", "z2", "energy", "p1", "p2", "p3", "L1", "L2", "L3"];
    let mut csv = Csv::create(&flags.run, &columns)?;
    let flight = Flight::of(flags, &flags.run, flags.edges, |step, sample| {
        let ends = [sample.places.first(), sample.places.last()].into_iter().flatten();
        let places = ends.flat_map(|place| place.iter().copied());
        let momenta = sample.momenta.iter().flat_map(|momentum| momentum.iter().copied());
        csv.row(step, sample.time, places.chain([sample.energy]).chain(momenta))
    })?;
    let Run { steps, step_size, .. } = flags.run;
    say(format_args!("a rod of {} edges: {steps} steps of {step_size} s, loaded for {LOADED} s\n", flags.edges));
    say(table(&flight));
    csv.finish()?;
    figure::draw(flags, &flight)?;

    let mut claims = Claims::new();
    flight.claim(&mut claims);
    let silent = |_, _: &_| Ok(());
    let halved = Flight::of(flags, &flags.run.refined(2), flags.edges, silent)?;
    flight.claim_band(&halved, &mut claims);
    let coarse = Run { step_size: step_size * 2.0, steps: steps.div_ceil(2), ..flags.run.clone() };
    let coarse = Flight::of(flags, &coarse, flags.edges / 2, silent)?;
    let fine = Flight::of(flags, &flags.run.refined(2), flags.edges * 2, silent)?;
    say(tips(flags.edges, [&coarse, &flight, &fine], &mut claims));
    by_angles(flags, &mut claims)?;
    say("a straight rod of 1 m, 2 mm thick, with free ends: frequency over that of Euler and Bernoulli, less 1\n");
    say(modes::compare(&mut claims)?);
    say("implicit steps of this rod, bent to its first mode: one period\n");
    say(implicit::compare(steps, &mut claims)?);
    Ok(claims)
}

fn table(flight: &Flight) -> Table<7> {
    let headings = ["time / s", "lower end x / m", "y / m", "upper end x / m", "y / m", "energy / J", "L3 / kg·m²/s"];
    let mut table = Table::new(headings);
    for sample in flight.samples.iter().step_by(flight.samples.len().saturating_sub(1).div_ceil(ROWS).max(1)) {
        let ends = [sample.places.first(), sample.places.last()].into_iter().flatten();
        let numbers: Vec<String> = ends.flat_map(|place| [place.x, place.y]).map(|x| format!("{x:.4}")).collect();
        let [a, b, c, d] = std::array::from_fn(|i| numbers.get(i).cloned().unwrap_or_default());
        let momentum = format!("{:.4}", sample.momenta[1].z);
        table.row([format!("{:.2}", sample.time), a, b, c, d, format!("{:.4}", sample.energy), momentum]);
    }
    table
}

/// Ends of the rod at the end, on three grids with steps to match.
fn tips(edges: usize, flights: [&Flight; 3], claims: &mut Claims) -> Table<6> {
    let headings = ["edges", "lower end x / m", "y / m", "upper end x / m", "y / m", "energy band / J"];
    let mut table = Table::new(headings);
    for (flight, edges) in flights.into_iter().zip([edges / 2, edges, edges * 2]) {
        let [lower, upper] = flight.tips();
        let [a, b, c, d] = [lower.x, lower.y, upper.x, upper.y].map(|number| format!("{number:.5}"));
        table.row([edges.to_string(), a, b, c, d, format!("{:.2e}", flight.band())]);
    }
    let [coarse, middle, fine] = flights.map(Flight::tips);
    let far = |one: [nalgebra::Vector3<f64>; 2], other: [nalgebra::Vector3<f64>; 2]| {
        (one[0] - other[0]).norm().hypot((one[1] - other[1]).norm())
    };
    let (large, small) = (far(coarse, middle), far(middle, fine));
    let name = "ends of the rod: order in spacing and step together";
    if edges >= FEWEST && large < 2.0 && small > 1e-6 {
        claims.within(name, (large / small).log2(), 1.6..=2.4, 3, "from three grids; they are not yet fine");
    } else {
        claims.skip(name, "too little motion, or too much for these grids");
    }
    table
}

/// Claims the order of the steps for the motion in the plane, by another integrator.
fn by_angles(flags: &Flags, claims: &mut Claims) -> Result<(), Failure> {
    let (push, moment) = (Vector2::new(flags.push[0], flags.push[1]), flags.moment[2]);
    let start = plane::start(&FLYING);
    let exact = solve(|y| plane::law(&FLYING, push, moment, y), start, TIME, RATE);
    let mut inputs = vec![SVector::<f64, 6>::zeros(); plane::FEW + 1];
    inputs[0] = SVector::from([0.0, 0.0, moment, push.x, push.y, 0.0]);
    let mut errors = [0.0; 3];
    for (error, steps) in errors.iter_mut().zip([250, 500, 1000]) {
        let stepper = FLYING.steps(plane::FEW, TIME / steps as f64)?;
        let mut state = stepper.state(FLYING.straight(plane::FEW), vec![SVector::zeros(); plane::FEW + 1])?;
        for step in 1..=steps {
            stepper.step_with(&mut state, &inputs).map_err(Failure::step(step))?;
        }
        let off = |(i, q)| (centre(q).xy() - plane::place(&exact.end, i)).norm();
        *error = largest(state.configuration().iter().enumerate().map(off)) / FLYING.length;
    }
    let convergence = Convergence { errors, reference: exact.error, steps: 250 };
    convergence.claim(
        Order::Second,
        "eight edges in the plane, by places and angles alone: order of the steps",
        claims,
    );
    Ok(())
}
