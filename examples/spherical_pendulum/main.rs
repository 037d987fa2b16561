//! The paper's pendulum: a point on S², moved by SO(3) from the left, at the paper's start and step.
//!
//! Source: Nordkvist, Crouch and Bloch, *Discrete Clebsch Optimal Control*, figures 1 and 2.

mod figure;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, Declared, Method};
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, finite, finite_list, parse};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use std::process::ExitCode;
use watch::{Sample, Watch};

/// Steps of first order, those of the paper: drift, then kick.
pub struct Kicked;

/// A spherical pendulum: its momentum is the angular momentum m l² q × q̇.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.mass * self.length.powi(2) * (F - I).norm_squared() / (4 * h),
    potential = |q| self.mass * self.gravity * self.length * q.z,
    method Kicked = (order = 1),
)]
pub struct SphericalPendulum {
    /// Mass of the bob, kg.
    pub mass: f64,
    /// Length of the rod, m.
    pub length: f64,
    /// g, m/s².
    pub gravity: f64,
}

const SCENE: Scene = Scene {
    name: "spherical_pendulum",
    step_size: "0.01",
    time_unit: "seconds",
    steps: "10000",
    order: "1",
    order_note: "1 drifts, then kicks, as in the paper; 2 kicks by half at both ends",
    columns_note: "position q1,q2,q3, angular momentum N1,N2,N3 (per unit mass; at order 1 after the kick, as in the paper)",
};

/// A spherical pendulum of unit mass and length: the example of "Discrete Clebsch Optimal Control" with its two figures
#[derive(Parser, Debug)]
struct Flags {
    /// Gravity, m/s², downwards along the third axis; the paper does not print it, 9.81 fits its figures
    #[arg(long, value_name = "G", value_parser = finite, allow_hyphen_values = true, default_value = "9.81")]
    gravity: f64,
    /// Position at the start, a unit vector
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "0,1,0")]
    position: [f64; 3],
    /// Angular momentum N = q x dq/dt at the start, 1/s; perpendicular to the position
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "1,0,0.5")]
    momentum: [f64; 3],
    #[command(flatten)]
    run: Run,
}

impl Flags {
    /// Whether the figures are the paper's; a longer run is not.
    fn is_the_papers(&self) -> bool {
        let start = (self.gravity, self.position, self.momentum);
        let run = (self.run.order, self.run.step_size, self.run.steps);
        start == (9.81, [0.0, 1.0, 0.0], [1.0, 0.0, 0.5]) && run == (Order::First, 0.01, 10_000)
    }
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    let pendulum = SphericalPendulum { mass: 1.0, length: 1.0, gravity: flags.gravity };
    conclude(match flags.run.order {
        Order::First => run::<Kicked>(&pendulum, &flags),
        Order::Second => run::<Declared>(&pendulum, &flags),
    })
}

fn run<M: Method<SphericalPendulum>>(pendulum: &SphericalPendulum, flags: &Flags) -> Result<Claims, Failure> {
    let stepper = pendulum.stepper_by::<M>(flags.run.step_size)?;
    let start = stepper.state(flags.position.into(), flags.momentum.into())?;

    let mut csv = Csv::create(&flags.run, &["q1", "q2", "q3", "N1", "N2", "N3"])?;
    let mut watch = Watch::new(flags);
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let (q, n) = (state.configuration(), state.momentum());
        csv.row(step, time, by_rows(q).chain(by_rows(&n)))?;
        let (energy, potential) = (stepper.energy(state), stepper.potential_at(0.0, q));
        watch.observe(step, Sample { time, q: *q, n, energy, potential }, stepper.system().orbit_defect(q));
        Ok(())
    })?;

    say(format_args!(
        "spherical pendulum over {} s: {} steps of {} s, order {}\n",
        flags.run.duration(),
        flags.run.steps,
        flags.run.step_size,
        M::ORDER
    ));
    say(&watch.table);
    csv.finish()?;
    figure::draw(flags, &watch)?;

    let mut claims = Claims::new();
    watch.claim(flags, &mut claims);
    Ok(claims)
}
