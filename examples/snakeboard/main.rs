//! A snakeboard: a rider turns a rotor and the wheels to and fro, and the board drives, turns or parks.

mod figure;
mod gait;
mod rider;
mod watch;

use clap::Parser;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::Convergence;
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Order, Run, Scene, finite, parse, positive};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use gait::{GAITS, Gait};
use nalgebra::{Matrix3, Vector1, Vector2, Vector5};
use std::f64::consts::TAU;
use std::process::ExitCode;
use watch::{Sample, Watch};

/// A board with a rotor, and wheels at both ends that turn by opposite angles. The velocity is (ω, v along, v across) in the board.
///
/// The rider decides how the rotor and the wheels turn: these are constraints too, and move with the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(F, a, b): (SE<2>, Translation<1>, Translation<1>), (q, rotor, wheel): (SE<2>, Vector1, Vector1)| (q * F, rotor + a, wheel + b),
    lagrangian = |(xi, r, w)| {
        let board = self.mass * (xi.y.powi(2) + xi.z.powi(2)) + self.inertia * xi.x.powi(2);
        (board + self.rotor * (r.x.powi(2) + 2 * r.x * xi.x)) / 2 + self.wheels * w.x.powi(2)
    },
    constraint = |t, wheel, (xi, r, w)| [
        (xi.z + self.length * xi.x) * wheel.x.cos() == xi.y * wheel.x.sin(),
        (xi.z - self.length * xi.x) * wheel.x.cos() == -xi.y * wheel.x.sin(),
        r.x == self.swings.x * self.rates.x * (self.rates.x * t).cos(),
        w.x == self.swings.y * self.rates.y * (self.rates.y * t).cos(),
    ],
)]
pub struct Snakeboard {
    /// All of it, kilograms.
    pub mass: f64,
    /// Half of the length of the board, metres.
    pub length: f64,
    /// Moment of inertia of all of it, kg·m².
    pub inertia: f64,
    /// Moment of inertia of the rotor, kg·m².
    pub rotor: f64,
    /// Moment of inertia of the wheels of one end, kg·m².
    pub wheels: f64,
    /// Largest angles of rotor and wheels, radians.
    pub swings: Vector2<f64>,
    /// How fast they swing, rad/s.
    pub rates: Vector2<f64>,
}

/// The same board, whose rotor and wheels the rider turns by torques.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(F, a, b): (SE<2>, Translation<1>, Translation<1>), (q, rotor, wheel): (SE<2>, Vector1, Vector1)| (q * F, rotor + a, wheel + b),
    lagrangian = |(xi, r, w)| {
        let board = self.mass * (xi.y.powi(2) + xi.z.powi(2)) + self.inertia * xi.x.powi(2);
        (board + self.rotor * (r.x.powi(2) + 2 * r.x * xi.x)) / 2 + self.wheels * w.x.powi(2)
    },
    force      = |torque: Vector2| (Vector3::zeros(), Vector1::new(torque.x), Vector1::new(torque.y)),
    constraint = |wheel, (xi, r, w)| [
        (xi.z + self.length * xi.x) * wheel.x.cos() == xi.y * wheel.x.sin(),
        (xi.z - self.length * xi.x) * wheel.x.cos() == -xi.y * wheel.x.sin(),
    ],
)]
pub struct Pushed {
    mass: f64,
    length: f64,
    inertia: f64,
    rotor: f64,
    wheels: f64,
}

const SCENE: Scene = Scene {
    name: "snakeboard",
    step_size: "0.005",
    time_unit: "seconds",
    steps: "800",
    order: "2",
    order_note: "steps with a constraint have order 2",
    columns_note: "of the drive: place x,y (m), heading (rad), angles of rotor and wheel (rad), speed along the board (m/s)",
};

/// A snakeboard: gaits that drive, rotate and park, without a push off the ground
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Largest angle of the rotor, rad
    #[arg(long, value_name = "ANGLE", value_parser = finite, allow_hyphen_values = true, default_value = "0.7")]
    rotor: f64,
    /// Largest angle of the wheels, rad; below a quarter of a turn
    #[arg(long, value_name = "ANGLE", value_parser = finite, allow_hyphen_values = true, default_value = "0.3")]
    wheels: f64,
    /// How long a cycle takes, s
    #[arg(long, value_name = "TIME", value_parser = positive, allow_hyphen_values = true, default_value = "1")]
    cycle: f64,
    #[command(flatten)]
    run: Run,
}

impl Flags {
    fn board(&self, gait: Gait) -> Snakeboard {
        Snakeboard {
            mass: 6.0,
            length: 0.2,
            inertia: 0.09,
            rotor: 0.072,
            wheels: 0.0013,
            swings: Vector2::new(self.rotor, self.wheels),
            rates: Vector2::from(gait.swings) * (TAU / self.cycle),
        }
    }
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    if flags.wheels.abs() >= TAU / 4.0 {
        return Err(Failure::Flags(format!(
            "--wheels {}: at a quarter of a turn the wheels stand across",
            flags.wheels
        )));
    }
    let mut csv = Csv::create(&flags.run, &["x", "y", "heading", "rotor", "wheel", "speed"])?;
    let [drive, rotate, park] = GAITS;
    let watches = [
        ride(flags, &flags.run, drive, |step, sample| {
            let [rotor, wheel] = sample.shape;
            let numbers = [sample.at.0, sample.at.1, sample.heading, rotor, wheel, sample.velocity[1]];
            csv.row(step, sample.time, numbers)
        })?,
        ride(flags, &flags.run, rotate, |_, _| Ok(()))?,
        ride(flags, &flags.run, park, |_, _| Ok(()))?,
    ];
    say(format_args!(
        "snakeboard from rest: {} steps of {} s, a cycle of {} s\n",
        flags.run.steps, flags.run.step_size, flags.cycle
    ));
    say(table(&watches));
    csv.finish()?;
    figure::draw(flags, &watches)?;

    let mut claims = Claims::new();
    for watch in &watches {
        watch.claim(&mut claims);
        let error = |part: u64| -> Result<f64, Failure> {
            let (step_size, steps) = (flags.run.step_size / part as f64, flags.run.steps * part);
            let run = Run { step_size, steps, ..flags.run.clone() };
            Ok(ride(flags, &run, watch.gait, |_, _| Ok(()))?.error())
        };
        let (errors, reference) = ([watch.error(), error(2)?, error(4)?], watch.reference());
        let name = format!("{}: place and heading at the end", watch.gait.name);
        Convergence { errors, reference, steps: flags.run.steps }.claim(Order::Second, &name, &mut claims);

        let pushed = |part: u64| -> Result<(f64, Vector2<f64>), Failure> {
            let (step_size, steps) = (flags.run.step_size / part as f64, flags.run.steps * part);
            let (end, torques) = rider::pushed(flags, &Run { step_size, steps, ..flags.run.clone() }, watch.gait)?;
            let (q, ..) = end.configuration();
            Ok((watch.error_of((q[(0, 2)], q[(1, 2)]), q[(1, 0)].atan2(q[(0, 0)])), torques))
        };
        let [(coarse, torques), (middle, _), (fine, _)] = [pushed(1)?, pushed(2)?, pushed(4)?];
        say(format_args!(
            "{}: torques of up to {:.3} N m on the rotor and {:.4} N m on the wheels",
            watch.gait.name, torques.x, torques.y
        ));
        let name = format!("{}: the end by these torques as inputs", watch.gait.name);
        let errors = [coarse, middle, fine];
        Convergence { errors, reference, steps: flags.run.steps }.claim(Order::Second, &name, &mut claims);
    }
    Ok(claims)
}

/// The places after cycles.
fn table(watches: &[Watch; 3]) -> Table<7> {
    let mut table =
        Table::new(["gait", "time / s", "x / m", "y / m", "heading / °", "momentum", "integrated: x, y, heading"]);
    for watch in watches {
        for (sample, exact) in &watch.cycles {
            let time = format!("{:.2}", sample.time);
            let [x, y, momentum] = [sample.at.0, sample.at.1, sample.momentum].map(|number| plain(number, 5));
            let heading = plain(sample.heading.to_degrees(), 3);
            let integrated = [plain(exact[0], 5), plain(exact[1], 5), plain(exact[2].to_degrees(), 3)].join(" ");
            table.row([watch.gait.name.to_owned(), time, x, y, heading, momentum, integrated]);
        }
    }
    table
}

/// A number with so many digits, without the sign of −0.
fn plain(number: f64, digits: i32) -> String {
    let unit = 10.0_f64.powi(digits);
    format!("{:.*}", digits.unsigned_abs() as usize, (number * unit).round() / unit + 0.0)
}

/// One gait, from rest but for the rotor and the wheels.
fn ride(
    flags: &Flags,
    run: &Run,
    gait: Gait,
    mut record: impl FnMut(u64, &Sample) -> Result<(), Failure>,
) -> Result<Watch, Failure> {
    let board = flags.board(gait);
    let stepper = board.stepper(run.step_size)?;
    let [rotor, wheels] = board.rates_at(0.0);
    let place = (Matrix3::identity(), Vector1::zeros(), Vector1::zeros());
    let start = stepper.state_moving(place, Vector5::new(0.0, 0.0, 0.0, rotor, wheels))?;
    let mut watch = Watch::new(run, &board, gait, flags.cycle);
    integrate(run, &stepper, start, |step, time, state| {
        let ((q, rotor, wheel), n) = (state.configuration(), state.momentum());
        // N = Σ ξ, by hand
        let omega = (n[0] - n[3]) / (board.inertia - board.rotor);
        let turning = n[3] / board.rotor - omega;
        let velocity = Vector5::new(omega, n[1] / board.mass, n[2] / board.mass, turning, n[4] / (2.0 * board.wheels));
        let (sin, cos) = wheel.x.sin_cos();
        let sample = Sample {
            time,
            at: (q[(0, 2)], q[(1, 2)]),
            heading: q[(1, 0)].atan2(q[(0, 0)]),
            shape: [rotor.x, wheel.x],
            velocity,
            momentum: n[0] * sin + n[1] * board.length * cos,
        };
        record(step, &sample)?;
        watch.observe(step, sample);
        Ok(())
    })?;
    Ok(watch)
}
