//! A rattleback: spun one way it rocks and comes back the other way round, spun the other way it goes on for long.

mod figure;
mod rolling;
mod watch;

use clap::Parser;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, finite, parse, positive};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, Matrix4, Rotation3, SVector, Vector3};
use rolling::Rolling;
use std::process::ExitCode;
use watch::{Moment, Watch};

/// Half an ellipsoid that rolls on a plane, with its axes of inertia turned against those of the ellipsoid.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<3>, q: SE<3>| q * F,
    lagrangian = |(omega, v)| (omega.dot(&(self.inertia * omega)) + self.mass * v.norm_squared()) / 2,
    potential  = |q| self.mass * self.gravity * q.translation().z,
    constraint = |q, (omega, v)| {
        let up = q.rotation().transpose() * Vector3::z();
        let scaled = self.axes.component_mul(&self.axes).component_mul(&up);
        let contact = self.height * Vector3::z() - scaled / up.dot(&scaled).sqrt();
        [v + omega.cross(&contact) == Vector3::zeros()]
    },
)]
pub struct Rattleback {
    /// Inertia tensor about the centre of mass, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    /// Kilograms.
    pub mass: f64,
    /// g, m/s².
    pub gravity: f64,
    /// Half axes of the ellipsoid, metres.
    pub axes: Vector3<f64>,
    /// The centre of the ellipsoid above the centre of mass, metres.
    pub height: f64,
}

/// The ellipsoid and the inertia of Kane and Levinson, for a mass of 1 kg.
///
/// Their third axis points down and ours up, so the product of inertia and the spin have the other sign.
fn published() -> Rattleback {
    Rattleback {
        inertia: Matrix3::new(2.0, 0.2, 0.0, 0.2, 16.0, 0.0, 0.0, 0.0, 17.0) * 1e-4,
        mass: 1.0,
        gravity: 9.81,
        axes: Vector3::new(0.2, 0.03, 0.02),
        height: 0.01,
    }
}

const SCENE: Scene = Scene {
    name: "rattleback",
    step_size: "0.00025",
    time_unit: "seconds",
    steps: "48000",
    order: "2",
    order_note: "steps with a constraint have order 2",
    columns_note: "spun counterclockwise: attitude R11..R33 (body to space), position x1,x2,x3 of the centre of mass (m), angular velocity w1,w2,w3 (body frame, rad/s)",
};

/// How long orders are measured, seconds: beyond the first reversal.
const COMPARED: f64 = 3.0;
/// Intervals of the table.
const ROWS: usize = 12;

/// A rattleback: spun one way it rocks and comes back the other way round, spun the other way it goes on for long
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Spin at the start, rad/s, seen from above; it is tried both ways
    #[arg(long, value_name = "RATE", value_parser = positive, allow_hyphen_values = true, default_value = "5")]
    spin: f64,
    /// Tilt at the start about both horizontal axes, degrees
    #[arg(long, value_name = "ANGLE", value_parser = finite, allow_hyphen_values = true, default_value = "0.5")]
    tilt: f64,
    #[command(flatten)]
    run: Run,
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let body = published();
    let columns = "R11 R12 R13 R21 R22 R23 R31 R32 R33 x1 x2 x3 w1 w2 w3";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    let ways = [("clockwise", -flags.spin), ("counterclockwise", flags.spin)];
    let clockwise = follow(&body, &flags.run, flags.tilt, ways[0], |_, _, _, _| Ok(()))?;
    let counterclockwise = follow(&body, &flags.run, flags.tilt, ways[1], |step, time, place, omega| {
        let (attitude, at) = (place.fixed_view::<3, 3>(0, 0).into_owned(), place.fixed_view::<3, 1>(0, 3).into_owned());
        csv.row(step, time, by_rows(&attitude).chain(by_rows(&at)).chain(by_rows(omega)))
    })?;
    let spins = [clockwise, counterclockwise];
    say(format_args!(
        "rattleback over {} s: {} steps of {} s\n",
        flags.run.duration(),
        flags.run.steps,
        flags.run.step_size
    ));
    say(table(&spins));
    csv.finish()?;
    figure::draw(flags, &spins)?;

    let mut claims = Claims::new();
    for (watch, way) in spins.iter().zip(ways) {
        watch.claim(&mut claims);
        let steps = ((COMPARED / flags.run.step_size).clamp(1.0, 1e9) as u64).min(flags.run.steps);
        let of = |part: u64| {
            let run = Run { step_size: flags.run.step_size / part as f64, steps: steps * part, ..flags.run.clone() };
            follow(&body, &run, flags.tilt, way, |_, _, _, _| Ok(()))
        };
        Watch::claim_order(&[of(1)?, of(2)?, of(4)?], steps, &mut claims);
    }
    Ok(claims)
}

fn table(spins: &[Watch; 2]) -> Table<6> {
    let mut table =
        Table::new(["time / s", "clockwise", "by the other", "counterclockwise", "by the other", "its tilt / °"]);
    let [first, second] = spins;
    let interval = first.samples.len().saturating_sub(1).div_ceil(ROWS).max(1);
    for (one, other) in first.samples.iter().zip(&second.samples).step_by(interval) {
        let spin = |value: f64| format!("{value:.4}");
        let tilt = format!("{:.2}", other.tilt.to_degrees());
        let time = format!("{:.2}", one.time);
        table.row([time, spin(one.spins[0]), spin(one.spins[1]), spin(other.spins[0]), spin(other.spins[1]), tilt]);
    }
    table
}

/// One run, from a tilt at rest but for the spin.
fn follow(
    body: &Rattleback,
    run: &Run,
    tilt: f64,
    (name, spin): (&'static str, f64),
    mut record: impl FnMut(u64, f64, &Matrix4<f64>, &Vector3<f64>) -> Result<(), Failure>,
) -> Result<Watch, Failure> {
    let stepper = body.stepper(run.step_size)?;
    let inverse = body.inertia.try_inverse().unwrap_or_default();
    let (sin, cos) = tilt.to_radians().sin_cos();
    let (omega, up) = (Vector3::z() * spin, Vector3::new(cos * sin, sin, cos * cos));
    let (contact, turn) = (body.contact(&up), Rotation3::rotation_between(&up, &Vector3::z()).unwrap_or_default());
    let v = contact.cross(&omega);
    let mut place = turn.to_homogeneous();
    place[(2, 3)] = -contact.dot(&up);
    let start = stepper.state_moving(place, SVector::from([omega.x, omega.y, omega.z, v.x, v.y, v.z]))?;
    let motion = |omega: Vector3<f64>, up: Vector3<f64>| Rolling::from([omega.x, omega.y, omega.z, up.x, up.y, up.z]);
    let mut watch = Watch::new(run, body, name, motion(omega, up));
    integrate(run, &stepper, start, |step, time, state| {
        let (q, n) = (state.configuration(), state.momentum());
        let omega = inverse * n.fixed_rows::<3>(0);
        let moment = Moment {
            motion: motion(omega, q.fixed_view::<1, 3>(2, 0).transpose()),
            velocity: n.fixed_rows::<3>(3) / body.mass,
            height: q[(2, 3)],
            energy: stepper.energy(state),
        };
        record(step, time, q, &omega)?;
        watch.observe(step, &moment);
        Ok(())
    })?;
    Ok(watch)
}
