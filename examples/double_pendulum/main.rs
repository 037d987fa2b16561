//! Two bodies on ball joints, and four bars that close a loop: places are constrained, and joints stay closed.

mod figure;
mod four_bar;
mod linkages;
mod pendulum;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, Error, State};
use clebsch_examples::claims::Claims;
use clebsch_examples::conserved::Conserved;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, finite, finite_list, parse, positive, positive_list};
use clebsch_examples::integrate::integrate;
use clebsch_examples::motion;
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use clebsch_plot::{Motion, PlotError, Shape};
use four_bar::Angles;
use linkages::{FourBar, Pendulum};
use nalgebra::{Rotation3, Vector3};
use pendulum::Turning;
use std::path::PathBuf;
use std::process::ExitCode;
use watch::{Moment, Watch};

const SCENE: Scene = Scene {
    name: "double_pendulum",
    step_size: "0.001",
    time_unit: "seconds",
    steps: "2000",
    order: "2",
    order_note: "steps with a constraint have order 2",
    columns_note: "of the double pendulum: centres of mass x1,y1,z1,x2,y2,z2 (m), angular velocities a1,a2,a3 and b1,b2,b3 of the upper and the lower body (body frame, rad/s)",
};

/// Rows of the table.
const ROWS: usize = 10;

/// A double pendulum of two bodies on ball joints, and a loop of four bars: joints stay closed
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Angular velocity of the upper body at the start, body frame, rad/s
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true, default_value = "0.5,0,2")]
    upper: [f64; 3],
    /// Angular velocity of the lower body at the start, body frame, rad/s
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true, default_value = "0,1,3")]
    lower: [f64; 3],
    /// Lengths of crank, coupler and rocker, m
    #[arg(long, value_name = "A,B,C", value_parser = positive_list::<3>, allow_hyphen_values = true, default_value = "0.2,0.5,0.4")]
    bars: [f64; 3],
    /// Distance of the pins on the ground, m
    #[arg(long, value_name = "D", value_parser = positive, allow_hyphen_values = true, default_value = "0.45")]
    ground: f64,
    /// Angular velocity of the crank at the start, rad/s
    #[arg(long, value_name = "RATE", value_parser = finite, allow_hyphen_values = true, default_value = "14")]
    crank: f64,
    /// g, m/s²
    #[arg(long, value_name = "G", value_parser = finite, allow_hyphen_values = true, default_value = "9.81")]
    gravity: f64,
    /// Write a page that plays the double pendulum to FILE, as HTML
    #[arg(long, value_name = "FILE")]
    motion: Option<PathBuf>,
    #[command(flatten)]
    run: Run,
}

/// The angle of the crank at the start, rad.
const CRANK: f64 = 0.3;

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let pendulum = Pendulum::new(flags.gravity);
    let turn = |axis: Vector3<f64>| *Rotation3::new(axis).matrix();
    let start = Turning {
        attitudes: [turn(Vector3::new(0.6, 0.3, 0.1)), turn(Vector3::new(-0.4, 0.7, 0.2))],
        omegas: [flags.upper.into(), flags.lower.into()],
    };
    let bars = FourBar::new(flags.bars, flags.ground, flags.gravity);
    let angles = bars.closed(CRANK, flags.crank).ok_or_else(|| {
        Failure::Flags(format!("--bars {:?} --ground {}: the loop cannot be closed", flags.bars, flags.ground))
    })?;

    let mut csv = Csv::create(&flags.run, &["x1", "y1", "z1", "x2", "y2", "z2", "a1", "a2", "a3", "b1", "b2", "b3"])?;
    let mut heights = Vec::new();
    let speed = start.omegas.iter().map(|omega| omega.norm()).fold(1.0 + flags.gravity.abs(), f64::max);
    let mut vertical = Conserved::new("double pendulum: the vertical momentum is constant", speed);
    let swinging = swing(&pendulum, &flags.run, start, |step, time, [upper, lower], turning, momentum| {
        let omegas = by_rows(&turning.omegas[0]).chain(by_rows(&turning.omegas[1]));
        csv.row(step, time, by_rows(&upper).chain(by_rows(&lower)).chain(omegas))?;
        if flags.run.samples(step, 400) {
            heights.push((time, [upper.z, lower.z]));
        }
        vertical.observe(momentum);
        Ok(())
    })?;
    let turning = drive(&bars, &flags.run, &angles)?;
    say(format_args!("double pendulum and four-bar loop: {} steps of {} s\n", flags.run.steps, flags.run.step_size));
    say(table(&swinging, &turning));
    csv.finish()?;
    figure::draw(flags, &bars, &swinging, &turning, &heights)?;
    motion::save(flags.motion.as_deref(), || play(&pendulum, &flags.run, start))?;

    let mut claims = Claims::new();
    swinging.claim_joints("double pendulum", 1.0, speed, &mut claims);
    vertical.claim(flags.run.steps, &mut claims);
    turning.claim_joints("four-bar", 1.0, flags.bars.iter().sum::<f64>() * (1.0 + flags.crank.abs()), &mut claims);
    let part = |part: u64| Run {
        step_size: flags.run.step_size / part as f64,
        steps: flags.run.steps * part,
        ..flags.run.clone()
    };
    let again = |i: u64| swing(&pendulum, &part(i), start, |_, _, _, _, _| Ok(()));
    Watch::claim_order(&[swinging, again(2)?, again(4)?], "double pendulum", 10.0, &mut claims);
    let again = |i: u64| drive(&bars, &part(i), &angles);
    Watch::claim_order(&[turning, again(2)?, again(4)?], "four-bar", 1.0, &mut claims);
    let refused = flat(flags.gravity, flags.run.step_size)?;
    let expected = Error::DependentConstraints { rank: 7, rows: 8 };
    claims.holds("a flat parallelogram is refused", refused == Some(expected), "7 of its 8 equations are independent");
    Ok(claims)
}

/// The bodies with their joints, and the path of the lower end.
fn play(pendulum: &Pendulum, run: &Run, start: Turning) -> Result<Motion<State<Pendulum>>, PlotError> {
    let at_start = |error| PlotError::Step { index: 0, error };
    let stepper = pendulum.stepper(run.step_size).map_err(at_start)?;
    let (places, velocity) = pendulum.start(&start);
    let states = motion::states(run, &stepper, stepper.state_moving(places, velocity).map_err(at_start)?);
    let [near, far] = [pendulum.near, [pendulum.far, -pendulum.near[1]]];
    // a point of body i in space
    let point = |state: &State<Pendulum>, i: usize, at: Vector3<f64>| {
        state.configuration()[i].transform_point(&at.into()).coords
    };
    let shape = |i: usize| Shape::cuboid([0.1, 0.1, 1.6 * near[i].norm()]);
    Motion::new(states)?
        .body("upper body", shape(0), |state| state.configuration()[0])?
        .body("lower body", shape(1), |state| state.configuration()[1])?
        .link("upper joints", |state| [0, 1].map(|k| point(state, 0, [near[0], far[0]][k])))?
        .link("lower joint and end", |state| [0, 1].map(|k| point(state, 1, [near[1], far[1]][k])))?
        .point("path of the end", |state| point(state, 1, far[1]))
        .map(|motion| motion.title("A double pendulum").time_unit("s"))
}

/// One run of the double pendulum. It records places, velocities, and the momentum about the vertical.
fn swing<'a>(
    pendulum: &'a Pendulum,
    run: &Run,
    start: Turning,
    mut record: impl FnMut(u64, f64, [Vector3<f64>; 2], &Turning, f64) -> Result<(), Failure>,
) -> Result<Watch<'a, 24, Pendulum>, Failure> {
    let stepper = pendulum.stepper(run.step_size)?;
    let mut watch = Watch::new(run, pendulum, start.vector());
    let (places, velocity) = pendulum.start(&start);
    integrate(run, &stepper, stepper.state_moving(places, velocity)?, |step, time, state| {
        let turning = pendulum.turning(state);
        let (gap, opening) = pendulum.gaps(state);
        let centres = state.configuration().map(|place| place.fixed_view::<3, 1>(0, 3).into_owned());
        record(step, time, centres, &turning, pendulum.vertical(state))?;
        watch.observe(step, &Moment { motion: turning.vector(), energy: stepper.energy(state), gap, opening });
        Ok(())
    })?;
    Ok(watch)
}

/// One run of the four-bar loop.
fn drive<'a>(bars: &'a FourBar, run: &Run, start: &Angles) -> Result<Watch<'a, 6, FourBar>, Failure> {
    let stepper = bars.stepper(run.step_size)?;
    let mut watch = Watch::new(run, bars, *start);
    let (places, velocity) = bars.start(start);
    integrate(run, &stepper, stepper.state_moving(places, velocity)?, |step, _, state| {
        let (gap, opening) = bars.gaps(state);
        watch.observe(step, &Moment { motion: bars.angles(state), energy: stepper.energy(state), gap, opening });
        Ok(())
    })?;
    Ok(watch)
}

/// The answer to a parallelogram whose bars all lie on one line: there it may go on as a parallelogram, or fold.
fn flat(gravity: f64, h: f64) -> Result<Option<Error>, Failure> {
    let bars = FourBar::new([0.2, 0.45, 0.2], 0.45, gravity);
    let (places, velocity) = bars.start(&Angles::zeros());
    Ok(bars.stepper(h)?.state_moving(places, velocity).err())
}

fn table(pendulum: &Watch<'_, 24, Pendulum>, bars: &Watch<'_, 6, FourBar>) -> Table<7> {
    let headings = ["time / s", "upper ω₃", "lower ω₃", "off by / rad", "crank / °", "rocker / °", "off by / rad"];
    let mut table = Table::new(headings);
    let interval = pendulum.samples.len().saturating_sub(1).div_ceil(ROWS).max(1);
    for (one, other) in pendulum.samples.iter().zip(&bars.samples).step_by(interval) {
        let degrees = |i: usize| format!("{:.2}", other.motion[i].to_degrees());
        let [upper, lower] = [20, 23].map(|i| format!("{:.4}", one.motion[i]));
        let [off, loose] = [one.off, other.off].map(|off| format!("{off:.1e}"));
        table.row([format!("{:.2}", one.time), upper, lower, off, degrees(0), degrees(2), loose]);
    }
    table
}
