//! A ball on a turning table: a circle that is no circle of the table, and a cycloid where the table is tilted.

mod cycloid;
mod figure;
mod watch;

use clap::Parser;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, finite, finite_list, parse};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::{Vector2, Vector5};
use std::process::ExitCode;
use watch::{Sample, Watch};

/// A ball that rolls on a turning table. The attitude is not asked for: W moves nothing, and its energy needs no side.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |(a, W): (Translation<2>, SO<3>), x: Vector2| x + a,
    cost           = |h, (a, W)| self.mass * a.norm_squared() / (2 * h) + self.inertia * (W - I).norm_squared() / (4 * h),
    potential      = |x| self.pull * x.y,
    constraint     = |x, (v, w)| [
        v.x - self.radius * w.y == -self.table_rate * x.y,
        v.y + self.radius * w.x == self.table_rate * x.x,
    ],
    discretization = projection,
)]
pub struct Ball {
    /// Kilograms.
    pub mass: f64,
    /// Moment of inertia, kg·m².
    pub inertia: f64,
    /// Metres.
    pub radius: f64,
    /// Angular velocity of the table, rad/s.
    pub table_rate: f64,
    /// Weight along the tilted table, N; uphill is along the second axis.
    pub pull: f64,
}

/// Of the ball, metres. The path does not depend on it, nor on the mass.
const RADIUS: f64 = 0.03;
/// Of the ball, kilograms.
const MASS: f64 = 0.1;
/// m/s²
const GRAVITY: f64 = 9.81;

const SCENE: Scene = Scene {
    name: "rolling_ball",
    step_size: "0.005",
    time_unit: "seconds",
    steps: "4000",
    order: "2",
    order_note: "steps with a constraint have order 2",
    columns_note: "place x,y of the contact (m), velocity vx,vy (m/s), angular velocity w1,w2,w3 (rad/s); all seen from the room",
};

/// A ball rolls on a turning table: two sevenths of a circle in a turn, and no fall down a tilted table
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Angular velocity of the table, rad/s; a record turns at 3.49
    #[arg(long, value_name = "RATE", value_parser = turning, allow_hyphen_values = true, default_value = "3.49")]
    table: f64,
    /// Angle of the table against the horizontal, degrees; uphill is along y
    #[arg(long, value_name = "ANGLE", value_parser = finite, allow_hyphen_values = true, default_value = "0")]
    tilt: f64,
    /// Take a hollow ball, as for table tennis, in place of a solid one
    #[arg(long)]
    hollow: bool,
    /// Place at the start, m; the table turns about the origin
    #[arg(long, value_name = "X,Y", value_parser = finite_list::<2>, allow_hyphen_values = true, default_value = "0.1,0")]
    position: [f64; 2],
    /// Velocity at the start, seen from the room, m/s
    #[arg(long, value_name = "X,Y", value_parser = finite_list::<2>, allow_hyphen_values = true, default_value = "0,0.15")]
    velocity: [f64; 2],
    /// Angular velocity about the vertical at the start, rad/s; it does nothing
    #[arg(long, value_name = "RATE", value_parser = finite, allow_hyphen_values = true, default_value = "1")]
    spin: f64,
    #[command(flatten)]
    run: Run,
}

impl Flags {
    /// I/(m r²)
    fn roundness(&self) -> f64 {
        if self.hollow { 2.0 / 3.0 } else { 2.0 / 5.0 }
    }
}

/// An angular velocity that is not zero.
fn turning(text: &str) -> Result<f64, String> {
    let rate = finite(text)?;
    if rate == 0.0 { Err("the table has to turn".to_owned()) } else { Ok(rate) }
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let ball = Ball {
        mass: MASS,
        inertia: flags.roundness() * MASS * RADIUS * RADIUS,
        radius: RADIUS,
        table_rate: flags.table,
        pull: MASS * GRAVITY * flags.tilt.to_radians().sin(),
    };
    let stepper = ball.stepper(flags.run.step_size)?;
    let (x, v) = (Vector2::from(flags.position), Vector2::from(flags.velocity));
    let rolling = Vector2::new(flags.table * x.x - v.y, v.x + flags.table * x.y) / RADIUS;
    let start = stepper.state_moving(x, Vector5::new(v.x, v.y, rolling.x, rolling.y, flags.spin))?;

    let mut csv = Csv::create(&flags.run, &["x", "y", "vx", "vy", "w1", "w2", "w3"])?;
    let mut watch = Watch::new(flags);
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let (x, n) = (*state.configuration(), state.momentum());
        let v = Vector2::new(n[0], n[1]) / ball.mass;
        let w = n.fixed_rows::<3>(2) / ball.inertia;
        csv.row(step, time, by_rows(&x).chain(by_rows(&v)).chain(by_rows(&w)))?;
        watch.observe(step, Sample { time, x, v, w });
        Ok(())
    })?;

    let kind = if flags.hollow { "hollow" } else { "solid" };
    say(format_args!("{kind} ball on a table at {} rad/s, tilted {}°\n", flags.table, flags.tilt));
    let period = std::f64::consts::TAU / watch.exact.rate.abs();
    let drift = watch.exact.drift.x;
    say(format_args!("  period {period:.4} s, radius {:.4} m, drift {drift:.4} m/s along x\n", watch.exact.radius));
    say(&watch.table);
    csv.finish()?;
    figure::draw(flags, &watch)?;

    let mut claims = Claims::new();
    watch.claim(&mut claims);
    Ok(claims)
}
