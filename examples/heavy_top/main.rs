//! A heavy top on a fixed point: it nutates, and conserves the momenta on which gravity does not act.

mod figure;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, Declared, Method};
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, finite, finite_list, moments_of_inertia, parse};
use clebsch_examples::integrate::integrate;
use clebsch_examples::motion;
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_plot::{Motion, Shape};
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::path::PathBuf;
use std::process::ExitCode;
use watch::{Sample, Watch};

/// Steps of first order: drift, then kick.
pub struct Kicked;

/// A rigid body turning about a fixed pivot in uniform gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    method Kicked = (order = 1),
)]
pub struct HeavyTop {
    /// ½tr(J)I − J = ∫ρρᵀdm about the pivot, kg·m².
    pub mass_matrix: Matrix3<f64>,
    /// Weight times the distance from the pivot to the centre of mass, N·m.
    pub weight: f64,
    /// The direction of the centre of mass, body frame.
    pub center: Vector3<f64>,
}

const SCENE: Scene = Scene {
    name: "heavy_top",
    step_size: "0.01",
    time_unit: "seconds",
    steps: "4200",
    order: "2",
    order_note: "1 drifts, then kicks; 2 kicks by half at both ends",
    columns_note: "attitude R11..R33 (body to space), momentum pi1,pi2,pi3 (body frame, kg m2/s; at order 1 after the kick)",
};

/// A heavy top: the nutation of its axis, the band of its energy and its vertical momentum
#[derive(Parser, Debug)]
struct Flags {
    /// Principal moments of inertia about the pivot, kg m2
    #[arg(long, value_name = "A,B,C", value_parser = moments_of_inertia, allow_hyphen_values = true)]
    #[arg(default_value = "1,1,0.5")]
    inertia: [f64; 3],
    /// Weight times the distance from the pivot to the centre of mass, N m
    #[arg(long, value_name = "MGL", value_parser = finite, allow_hyphen_values = true, default_value = "1")]
    weight: f64,
    /// Direction of the centre of mass, body frame; its length multiplies the weight
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "0,0,1")]
    center: [f64; 3],
    /// Attitude at the start: rotation vector from the body frame to space, radians
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "1,0,0")]
    attitude: [f64; 3],
    /// Angular momentum at the start, body frame, kg m2/s
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "0,0,3.2")]
    momentum: [f64; 3],
    /// Write a page that plays the motion to FILE, as HTML
    #[arg(long, value_name = "FILE")]
    motion: Option<PathBuf>,
    #[command(flatten)]
    run: Run,
}

impl Flags {
    /// Whether turning about the third body axis changes neither the inertia nor the centre of mass.
    fn is_symmetric(&self) -> bool {
        self.inertia[0] == self.inertia[1] && self.center[0] == 0.0 && self.center[1] == 0.0
    }
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    let inertia = Matrix3::from_diagonal(&flags.inertia.into());
    let mass_matrix = Matrix3::identity() * (inertia.trace() / 2.0) - inertia;
    let (weight, center) = (flags.weight, flags.center.into());
    let top = HeavyTop { mass_matrix, weight, center };
    conclude(match flags.run.order {
        Order::First => run::<Kicked>(&top, &flags),
        Order::Second => run::<Declared>(&top, &flags),
    })
}

fn run<M: Method<HeavyTop>>(top: &HeavyTop, flags: &Flags) -> Result<Claims, Failure> {
    let stepper = top.stepper_by::<M>(flags.run.step_size)?;
    let attitude = Rotation3::from_scaled_axis(Vector3::from(flags.attitude)).into_inner();
    let start = stepper.state(attitude, flags.momentum.into())?;

    let columns = ["R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33", "pi1", "pi2", "pi3"];
    let mut csv = Csv::create(&flags.run, &columns)?;
    let mut watch = Watch::new(flags);
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let (attitude, momentum) = (state.configuration(), state.momentum());
        csv.row(step, time, by_rows(attitude).chain(by_rows(&momentum)))?;
        let (energy, potential) = (stepper.energy(state), stepper.potential_at(0.0, attitude));
        let sample = Sample::new(time, attitude, &momentum, energy, potential);
        watch.observe(step, attitude, &momentum, sample, stepper.system().orbit_defect(attitude));
        Ok(())
    })?;

    let Run { step_size, steps, order, .. } = flags.run;
    let duration = flags.run.duration();
    say(format_args!("heavy top over {duration} s: {steps} steps of {step_size} s, order {order}\n"));
    say(&watch.table);
    csv.finish()?;
    figure::draw(flags, &watch)?;
    motion::save(flags.motion.as_deref(), || {
        let axis = Vector3::from(flags.center).try_normalize(0.0).unwrap_or_else(Vector3::z);
        let body = Shape::ellipsoid([0.7, 0.7, 0.35]).at((axis * 0.6).into());
        Motion::new(motion::states(&flags.run, &stepper, start))?
            .body("top", body, |state| *state.configuration())?
            .link("axis", |state| [Vector3::zeros(), state.configuration() * axis])?
            .point("its path", |state| state.configuration() * axis)
            .map(|motion| motion.sphere(1.0).title("A heavy top").time_unit("s"))
    })?;

    let mut claims = Claims::new();
    watch.claim(flags, &mut claims);
    Ok(claims)
}
