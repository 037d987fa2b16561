//! A spacecraft on its orbit: position and attitude as one system, coupled by the gradient of gravity.
//!
//! Envisat without control. Mass and inertia: Bastida Virgili, Lemmens and Krag, *Investigation on Envisat attitude
//! motion*, e.Deorbit Workshop, ESA (2014). Semi-major axis: mission parameters of DLR, 7159 km. GM of the Earth: IERS
//! Conventions (2010). Librations and their stability: Hughes, *Spacecraft Attitude Dynamics* (1986), chapter 9. DeBra
//! and Delp, *Rigid body attitude stability and natural frequencies in a circular orbit*, Journal of the Astronautical
//! Sciences 8 (1961) 14–17.

mod body;
mod equations;
mod exact;
mod figure;
mod libration;
mod orbit;
mod survey;
mod watch;

use body::{Body, Orientation};
use clap::Parser;
use clebsch::{Clebsch, Declared, Method};
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, finite, finite_list, parse, positive};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::{Matrix3, Vector3, Vector6};
use orbit::Circle;
use std::process::ExitCode;
use watch::Watch;

/// Position and attitude.
pub type Pose = (Vector3<f64>, Matrix3<f64>);
/// Linear momentum in space, then angular momentum in the body.
pub type Momentum = Vector6<f64>;

/// Linear and angular half.
pub fn halves(momentum: &Momentum) -> (Vector3<f64>, Vector3<f64>) {
    (momentum.fixed_rows::<3>(0).into(), momentum.fixed_rows::<3>(3).into())
}

/// Steps of first order: drift, then kick.
pub struct Kicked;

/// A rigid body about a point mass: the potential up to the second moments of the body (MacCullagh).
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(a, F): (Translation<3>, SO<3>), (x, R): (Vector3, SO<3>)| (x + a, R * F),
    cost      = |h, (a, F)| {
        let second_moment = self.inertia.trace() / 2 * I - self.inertia;
        let turn = F - I;
        (self.mass * a.norm_squared() + (second_moment * turn * turn.transpose()).trace()) / (2 * h)
    },
    potential = |(x, R)| {
        let r = x.norm();
        let y = R.transpose() * x;
        let quadrupole = 3 * y.dot(&(self.inertia * y)) / r.powi(2) - self.inertia.trace();
        self.gravitation * (quadrupole / (2 * r.powi(3)) - self.mass / r)
    },
    symmetry  = |S: SO<3>, (x, R), (a, F)| ((S * x, S * R), (S * a, F)),
    method Kicked = (order = 1),
)]
pub struct Spacecraft {
    /// Mass, kg.
    pub mass: f64,
    /// Inertia tensor about the centre of mass, body frame, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    /// GM of the planet, m³/s².
    pub gravitation: f64,
}

impl From<&Body> for Spacecraft {
    fn from(body: &Body) -> Self {
        Self { mass: body.mass, inertia: body.inertia, gravitation: body.gravitation }
    }
}

const SCENE: Scene = Scene {
    name: "spacecraft",
    step_size: "10",
    time_unit: "seconds",
    steps: "6000",
    order: "2",
    order_note: "1 drifts, then kicks; 2 kicks by half at both ends",
    columns_note: "position x1,x2,x3 (m), attitude R11..R33 (body to space), momentum p1,p2,p3 (space, kg m/s), angular momentum pi1,pi2,pi3 (body frame, kg m2/s); at order 1 after the kick",
};

/// Envisat without control, stabilised by the gradient of gravity: librations, their stability, and the orbit
#[derive(Parser, Debug)]
pub struct Flags {
    /// Inertia tensor about the centre of mass, body frame, kg m2
    #[arg(long, value_name = "XX,YY,ZZ,XY,XZ,YZ", value_parser = finite_list::<6>, allow_hyphen_values = true)]
    #[arg(default_value = "17023.3,124825.7,129112.2,397.1,-2171.4,344.2")]
    inertia: [f64; 6],
    /// Mass, kg
    #[arg(long, value_name = "M", value_parser = positive, allow_hyphen_values = true, default_value = "7827.867")]
    mass: f64,
    /// GM of the planet, m3/s2
    #[arg(long, value_name = "GM", value_parser = positive, allow_hyphen_values = true, default_value = "3.986004418e14")]
    gravitation: f64,
    /// Radius of the circular orbit, m
    #[arg(long, value_name = "R", value_parser = positive, allow_hyphen_values = true, default_value = "7.159e6")]
    radius: f64,
    /// Libration at the start: yaw, roll and pitch, degrees; at rest in the orbiting frame
    #[arg(long, value_name = "YAW,ROLL,PITCH", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "4,3,10")]
    libration: [f64; 3],
    /// Eccentricity of the orbit that is compared with Kepler's
    #[arg(long, value_name = "E", value_parser = eccentricity, allow_hyphen_values = true, default_value = "0.2")]
    eccentricity: f64,
    #[command(flatten)]
    run: Run,
}

/// A number from 0 to 0.9.
fn eccentricity(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if (0.0..=0.9).contains(&number) { Ok(number) } else { Err(format!("`{}` is not in 0 to 0.9", text.trim())) }
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(match flags.run.order {
        Order::First => run::<Kicked>(&flags),
        Order::Second => run::<Declared>(&flags),
    })
}

fn run<M: Method<Spacecraft>>(flags: &Flags) -> Result<Claims, Failure> {
    let body = Body::new(flags)?;
    let circle = Circle::new(&body, flags.radius, &flags.run)?;
    let orientation = Orientation::stable(&body);
    let spacecraft = Spacecraft::from(&body);
    let stepper = spacecraft.stepper_by::<M>(flags.run.step_size)?;
    let tilt = Vector3::from(flags.libration).map(f64::to_radians);
    let (pose, momentum) = circle.start(&body, &orientation, &tilt);
    let start = stepper.state(pose, momentum)?;

    let columns = "x1 x2 x3 R11 R12 R13 R21 R22 R23 R31 R32 R33 p1 p2 p3 pi1 pi2 pi3";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    let mut watch = Watch::new(&flags.run, &body, &orientation, &circle);
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let (pose, momentum) = (state.configuration(), state.momentum());
        let configuration = by_rows(&pose.0).chain(by_rows(&pose.1));
        csv.row(step, time, configuration.chain(by_rows(&momentum)))?;
        let energies = (stepper.energy(state), stepper.potential_at(0.0, pose));
        watch.observe(step, time, pose, &momentum, energies, &stepper.conserved(state));
        watch.observe_orbit(stepper.system().orbit_defect(pose));
        Ok(())
    })?;

    let Run { step_size, steps, order, .. } = flags.run;
    let duration = flags.run.duration();
    say(format_args!("spacecraft over {duration} s: {steps} steps of {step_size} s, order {order}\n"));
    say(&watch.table);

    let mut claims = Claims::new();
    watch.claim(&mut claims);
    let pitch = exact::pitch::<M>(&spacecraft, &body, &circle, &flags.run, tilt.z)?;
    pitch.claim(&mut claims);
    exact::convergence::<M>(&spacecraft, &body, flags, (pose, momentum), &mut claims)?;
    exact::exchange::<M>(&body, flags, &mut claims)?;
    let cases = survey::follow::<M>(&body, flags.radius, &flags.run)?;
    say(&pitch);
    say(survey::table(&cases));
    cases.iter().for_each(|case| case.claim(&mut claims));
    csv.finish()?;
    figure::draw(flags, &watch, &cases)?;
    Ok(claims)
}
