//! A neutrally buoyant ellipsoid in an ideal fluid: when ballast and spin keep it on its course.
//!
//! Sources: Kirchhoff's equations and the added masses, Lamb, *Hydrodynamics*, §114, §115 and §124. Stability, Leonard,
//! *Stability of a bottom-heavy underwater vehicle*, Automatica 33 (1997) 331–346. Leonard and Marsden, *Stability and
//! drift of underwater vehicle dynamics: mechanical systems with rigid motion symmetry*, Physica D 105 (1997) 130–162.

mod figure;
mod kirchhoff;
mod steady;
mod survey;
mod vehicle;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, Declared, Method};
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::{Convergence, refined};
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, finite, parse, positive, positive_list};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use kirchhoff::Kirchhoff;
use nalgebra::{Matrix6, Vector3};
use std::process::ExitCode;
use steady::{Course, Steady};
use survey::{Case, Family};
use vehicle::Vehicle;
use watch::Watch;

/// Steps of first order: drift, then kick.
pub struct Kicked;

/// A neutrally buoyant vehicle in an ideal fluid (Kirchhoff): its momentum is that of body and fluid.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<3>, q: SE<3>| q * F,
    lagrangian = |xi| xi.dot(&(self.inertia * xi)) / 2,
    potential  = |q| self.weight * (q.rotation() * self.center).z,
    method Kicked = (order = 1),
)]
pub struct UnderwaterVehicle {
    /// Body and added inertia on (ω, v), kg·m², kg·m, kg.
    #[clebsch(symmetric)]
    pub inertia: Matrix6<f64>,
    /// m·g, newtons, balanced by buoyancy at the origin.
    pub weight: f64,
    /// Centre of mass from the centre of buoyancy, m.
    pub center: Vector3<f64>,
}

impl From<&Vehicle> for UnderwaterVehicle {
    fn from(vehicle: &Vehicle) -> Self {
        Self { inertia: vehicle.inertia(), weight: vehicle.weight(), center: vehicle.center() }
    }
}

const SCENE: Scene = Scene {
    name: "underwater_vehicle",
    step_size: "0.01",
    time_unit: "seconds",
    steps: "6000",
    order: "2",
    order_note: "1 drifts, then kicks; 2 kicks by half at both ends",
    columns_note: "attitude R11..R33 (body to space), position x1,x2,x3 (m), momentum of body and fluid, body frame: angular Pi1,Pi2,Pi3 (kg m2/s), linear P1,P2,P3 (kg m/s); at order 1 after the kick",
};

/// An ellipsoid in an ideal fluid: ballast and spin on both sides of the thresholds of Leonard and Marsden, and one rise in detail
#[derive(Parser, Debug)]
struct Flags {
    /// Semi-axes of the vehicle that rises along its third axis, m
    #[arg(long, value_name = "A,B,C", value_parser = positive_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "0.4,0.4,1.2")]
    semi_axes: [f64; 3],
    /// Semi-axes of the vehicle that cruises along its first axis, the third one upright, m
    #[arg(long, value_name = "A,B,C", value_parser = positive_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "1,1.5,0.6")]
    wing: [f64; 3],
    /// Speed of both, m/s
    #[arg(long, value_name = "U", value_parser = positive, allow_hyphen_values = true, default_value = "1.5")]
    speed: f64,
    /// Centre of mass of the rising vehicle below its centre of buoyancy, m
    #[arg(long, value_name = "L", value_parser = finite, allow_hyphen_values = true, default_value = "0.04")]
    offset: f64,
    /// Spin of the rising vehicle about its third axis, rad/s
    #[arg(long, value_name = "OMEGA", value_parser = finite, allow_hyphen_values = true, default_value = "2")]
    spin: f64,
    /// Tilt of the rising vehicle at the start, radians
    #[arg(long, value_name = "ANGLE", value_parser = finite, allow_hyphen_values = true, default_value = "0.02")]
    tilt: f64,
    #[command(flatten)]
    run: Run,
}

impl Flags {
    /// The steady rise that the run starts near.
    fn rise(&self) -> Steady {
        let vehicle = Vehicle::new(self.semi_axes, self.offset);
        Steady { vehicle, course: Course::Rise, speed: self.speed, spin: self.spin }
    }

    /// Vehicle and speed of a family, and whether that has a threshold to be surveyed.
    fn family(&self, family: Family) -> (Steady, bool) {
        let (base, is_held) = match family {
            Family::CruiseWithBallast => {
                let vehicle = Vehicle::new(self.wing, 0.0);
                let cruise = Steady { vehicle, course: Course::Cruise, speed: self.speed, spin: 0.0 };
                // With a first axis longer than the second the vehicle yaws, whatever its ballast.
                (cruise, self.wing[0] < self.wing[1])
            }
            _ => (self.rise(), self.semi_axes[0] == self.semi_axes[1]),
        };
        let heaviest = family.member(&base, survey::LARGEST_RATIO).vehicle;
        (base, is_held && base.critical_offset() > 0.0 && heaviest.inverse_inertia().is_some())
    }
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(match flags.run.order {
        Order::First => run::<Kicked>(&flags),
        Order::Second => run::<Declared>(&flags),
    })
}

fn run<M: Method<UnderwaterVehicle>>(flags: &Flags) -> Result<Claims, Failure> {
    let rise = flags.rise();
    let kirchhoff = Kirchhoff::new(&rise.vehicle).ok_or_else(|| survey::too_low(flags.offset))?;
    let vehicle = UnderwaterVehicle::from(&rise.vehicle);
    let stepper = vehicle.stepper_by::<M>(flags.run.step_size)?;
    let (pose, momentum) = rise.tilted(flags.tilt);
    let start = stepper.state(pose, momentum)?;

    let columns = "R11 R12 R13 R21 R22 R23 R31 R32 R33 x1 x2 x3 Pi1 Pi2 Pi3 P1 P2 P3";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    let mut watch = Watch::new(&flags.run, kirchhoff);
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let (pose, momentum) = (state.configuration(), state.momentum());
        let (rotation, position) = (pose.fixed_view::<3, 3>(0, 0), pose.fixed_view::<3, 1>(0, 3));
        csv.row(step, time, by_rows(&rotation.into()).chain(by_rows(&position.into())).chain(by_rows(&momentum)))?;
        let energies = (stepper.energy(state), stepper.potential_at(0.0, pose));
        watch.observe(step, time, pose, &momentum, energies, &stepper.conserved(state));
        watch.observe_orbit(stepper.system().orbit_defect(pose));
        Ok(())
    })?;

    let Run { step_size, steps, order, .. } = flags.run;
    let duration = flags.run.duration();
    say(format_args!("underwater vehicle over {duration} s: {steps} steps of {step_size} s, order {order}\n"));
    say(&watch.table);

    let mut claims = Claims::new();
    watch.claim(&mut claims);
    convergence::<M>(&vehicle, &kirchhoff, &watch, flags)?.claim(
        order,
        "the order against Kirchhoff's equations",
        &mut claims,
    );
    let cases = survey::<M>(flags, &mut claims)?;
    csv.finish()?;
    figure::draw(flags, &watch, &cases)?;
    Ok(claims)
}

/// The families of steady motions, their table and their claims.
fn survey<M: Method<UnderwaterVehicle>>(flags: &Flags, claims: &mut Claims) -> Result<Vec<Case>, Failure> {
    let mut cases = Vec::new();
    for family in Family::ALL {
        let (base, has_threshold) = flags.family(family);
        if has_threshold {
            cases.extend(survey::follow::<M>(family, &base, &flags.run)?);
        } else {
            survey::skip(family, &base, claims);
        }
    }
    say(survey::table(&cases));
    cases.iter().for_each(|case| case.claim(claims));
    Ok(cases)
}

/// The end of the first seconds of the rise, with steps of h, h/2 and h/4, against Kirchhoff's equations.
fn convergence<M: Method<UnderwaterVehicle>>(
    vehicle: &UnderwaterVehicle,
    kirchhoff: &Kirchhoff,
    watch: &Watch,
    flags: &Flags,
) -> Result<Convergence, Failure> {
    /// Steps of h: so few that a tilt which grows has not grown much.
    const STEPS: u64 = 500;
    let steps = flags.run.steps.min(STEPS);
    let (pose, momentum) = flags.rise().tilted(flags.tilt);
    let ends = refined::<_, M>(vehicle, &flags.run, steps, |stepper| stepper.state(pose, momentum))?;
    let exact = kirchhoff.motion(&pose, &momentum, flags.run.time(steps), watch.rate());
    let scale = exact.end.amax();
    let errors = ends.map(|end| (kirchhoff::state(end.configuration(), &end.momentum()) - exact.end).amax() / scale);
    Ok(Convergence { errors, reference: exact.error / scale, steps })
}
