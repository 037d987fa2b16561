//! A whip: links on ball joints that hang from a hand. The hand moves, then rests, and a wave runs down the chain.

mod figure;
mod long;
mod newton_euler;
mod watch;
mod whip;

use clap::Parser;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Run, Scene, finite, finite_list, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use newton_euler::FEW;
use std::process::ExitCode;
use std::time::Instant;
use watch::Watch;
use whip::Whip;

const SCENE: Scene = Scene {
    name: "chain",
    step_size: "0.001",
    time_unit: "seconds",
    steps: "2400",
    order: "2",
    order_note: "steps with a constraint have order 2",
    columns_note: "place x,y,z (m) and speed (m/s) of the tip, height of the centre of mass (m), tension of the first joint (N)",
};

/// Rows of the table.
const ROWS: usize = 12;
/// Steps that are timed.
const TIMED: usize = 400;

/// A chain of links on ball joints, which hangs from a hand that moves
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Links of a chain of 2 m and 1 kg
    #[arg(long, value_name = "N", value_parser = ["5", "10", "20", "40"], default_value = "20")]
    links: String,
    /// How far the hand moves and comes back, m; y is up
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true, default_value = "0.4,0,0")]
    hand: [f64; 3],
    /// The hand moves like exp(-(t/WIDTH)^2), from 6 widths before its farthest point on, s
    #[arg(long, value_name = "WIDTH", value_parser = positive, allow_hyphen_values = true, default_value = "0.12")]
    width: f64,
    /// By how much the chain leans to the side (z) at the start, degrees
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_hyphen_values = true, default_value = "10")]
    lean: f64,
    /// g, m/s²
    #[arg(long, value_name = "G", value_parser = finite, allow_hyphen_values = true, default_value = "9.81")]
    gravity: f64,
    /// Print the time of a step for each number of links
    #[arg(long)]
    time: bool,
    /// Steps with a hand that rests, whose laws are printed and claimed; 1000000 is a million
    #[arg(long, value_name = "STEPS", default_value = "0")]
    long: u64,
    #[command(flatten)]
    run: Run,
}

impl Flags {
    fn whip<const N: usize>(&self) -> Whip<N> {
        Whip::new(self.gravity, self.hand, self.width)
    }

    fn lean(&self) -> f64 {
        self.lean.to_radians()
    }
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(match flags.links.as_str() {
        "5" => run::<5>(&flags),
        "10" => run::<10>(&flags),
        "20" => run::<20>(&flags),
        _ => run::<40>(&flags),
    })
}

fn run<const N: usize>(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    if flags.time {
        say(times(flags)?);
    }
    let whip = flags.whip::<N>();
    let mut csv = Csv::create(&flags.run, &["x", "y", "z", "speed", "height", "tension"])?;
    let watch = Watch::of(&whip, &flags.run, 1, flags.lean(), |step, time, look, tension| {
        let tip = look.joints[N];
        csv.row(step, time, [tip.x, tip.y, tip.z, look.speed, look.height, tension])
    })?;
    let Run { steps, step_size, .. } = flags.run;
    say(format_args!(
        "a chain of {N} links: {steps} steps of {step_size} s; the hand is back at {:.2} s\n",
        whip.still()
    ));
    say(table(&watch));
    let hand = (0..=steps).map(|step| whip.hand(flags.run.time(step))[1].norm()).fold(0.0, f64::max);
    say(format_args!("largest speed of the hand {hand:.2} m/s, of the tip {:.2} m/s\n", watch.speed));
    csv.finish()?;
    figure::draw(flags, &watch)?;

    let mut claims = Claims::new();
    if flags.long > 0 {
        long::run(&whip, (flags.lean(), step_size, flags.long), &mut claims)?;
    }
    watch.claim(&mut claims);
    let silent = |_, _, _: &_, _| Ok(());
    let few = flags.whip::<FEW>();
    let part = |part: u64| Watch::of(&few, &flags.run, part, flags.lean(), silent);
    let refined = [part(1)?, part(2)?, part(4)?];
    let times = refined[0].samples.iter().map(|sample| sample.time);
    let exact = newton_euler::motion(&few, flags.lean(), times);
    let error = Watch::claim_order(&refined, &exact, &mut claims);
    refined[0].claim_band(&refined[1], &mut claims);
    refined[0].claim_back(&few, flags.lean(), error, &mut claims)?;
    Ok(claims)
}

fn table<const N: usize>(watch: &Watch<N>) -> Table<7> {
    let headings = ["time / s", "tip x / m", "y / m", "z / m", "its speed / m/s", "mean height / m", "tension / N"];
    let mut table = Table::new(headings);
    let interval = watch.samples.len().saturating_sub(1).div_ceil(ROWS).max(1);
    for sample in watch.samples.iter().step_by(interval) {
        let tip = sample.look.joints[N];
        // without the sign of −0
        let [x, y, z] = [tip.x, tip.y, tip.z].map(|number| format!("{:.4}", (number * 1e4).round() / 1e4 + 0.0));
        let [speed, tension] = [sample.look.speed, sample.force.norm()].map(|number| format!("{number:.3}"));
        table.row([format!("{:.2}", sample.time), x, y, z, speed, format!("{:.4}", sample.look.height), tension]);
    }
    table
}

/// The time of a step, for each number of links.
fn times(flags: &Flags) -> Result<Table<3>, Failure> {
    let mut table = Table::new(["links", "step / µs", "of a link / ns"]);
    for (links, nanoseconds) in
        [(5, timed::<5>(flags)?), (10, timed::<10>(flags)?), (20, timed::<20>(flags)?), (40, timed::<40>(flags)?)]
    {
        table.row([
            links.to_string(),
            format!("{:.1}", nanoseconds / 1e3),
            format!("{:.0}", nanoseconds / f64::from(links)),
        ]);
    }
    Ok(table)
}

/// The least time of a step in five runs, ns.
fn timed<const N: usize>(flags: &Flags) -> Result<f64, Failure> {
    let whip = flags.whip::<N>();
    let stepper = whip.stepper(flags.run.step_size)?;
    let (places, velocities) = whip.start(flags.lean());
    let start = stepper.state_moving(places, velocities)?;
    let mut least = f64::INFINITY;
    for _ in 0..5 {
        let (clock, mut state) = (Instant::now(), start);
        for step in 1..=TIMED as u64 {
            state = stepper.step(&state).map_err(|error| Failure::Step { step, error })?;
        }
        least = least.min(clock.elapsed().as_nanos() as f64 / TIMED as f64);
    }
    Ok(least)
}
