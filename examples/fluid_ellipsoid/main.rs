//! Dirichlet's fluid ellipsoid without gravity: a drop whose flow is linear follows a geodesic of SL(3) in the flat metric.
//!
//! Sources: Dirichlet (1860) and Riemann (1861) as in Chandrasekhar, *Ellipsoidal Figures of Equilibrium*, chapter 4.
//! Sideris, *Global existence and asymptotic behavior of affine motion of 3D ideal fluids surrounded by vacuum*,
//! Archive for Rational Mechanics and Analysis 225 (2017) 141–176.

mod exact;
mod figure;
mod geodesic;
mod spheroid;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, Declared};
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::{Convergence, refined};
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, finite, finite_list, parse, positive, positive_list};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::{Matrix3, Vector3};
use spheroid::Spheroid;
use std::process::ExitCode;
use watch::Watch;

/// A drop of ideal fluid in the shape of an ellipsoid: the particle at x in the unit ball is at q x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |F: SL<3>, q: SL<3>| F * q, cost = |h, q, F| self.mass * (F * q - q).norm_squared() / (2 * h))]
pub struct FluidEllipsoid {
    /// A fifth of the mass times the square of the radius, kg·m².
    pub mass: f64,
}

const SCENE: Scene = Scene {
    name: "fluid_ellipsoid",
    step_size: "0.005",
    time_unit: "seconds",
    steps: "1200",
    order: "2",
    order_note: "it places the potential; a drop without gravity has none, so 1 and 2 give the same step",
    columns_note: "deformation q11..q33 (in units of the radius of the sphere of equal volume), momentum N1..N8 (kg m2/s; basis E11-E22, E22-E33, E12, E13, E21, E23, E31, E32)",
};

/// A drop of ideal fluid in the shape of an ellipsoid, without gravity, against an independent integration, a
/// quadrature and an exact flow
#[derive(Parser, Debug)]
struct Flags {
    /// Semi-axes at the start, along the axes of space; only their ratios count, the volume is that of the unit ball
    #[arg(long, value_name = "A,B,C", value_parser = positive_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "1.3,1,0.8")]
    semi_axes: [f64; 3],
    /// Velocity gradient at the start row by row, 1/s; its trace must vanish
    #[arg(long, value_name = "G11,…,G33", value_parser = trace_free, allow_hyphen_values = true)]
    #[arg(default_value = "-0.3,-1.1,0.3,0.9,-0.2,0.6,-0.2,0.4,0.5")]
    gradient: [f64; 9],
    /// A fifth of the mass times the square of the radius, kg m2
    #[arg(long, value_name = "M", value_parser = positive, allow_hyphen_values = true, default_value = "1")]
    mass: f64,
    /// Radius of the swirling spheroid at the start, in units of that of the sphere
    #[arg(long, value_name = "A", value_parser = positive, allow_hyphen_values = true, default_value = "1.5")]
    radius: f64,
    /// Rate of that radius at the start, 1/s; negative: it contracts
    #[arg(long, value_name = "RATE", value_parser = finite, allow_hyphen_values = true, default_value = "-0.8")]
    radius_rate: f64,
    /// Angular velocity of the spheroid at the start, rad/s
    #[arg(long, value_name = "OMEGA", value_parser = finite, allow_hyphen_values = true, default_value = "0.3")]
    swirl: f64,
    #[command(flatten)]
    run: Run,
}

/// Nine numbers, the rows of a matrix whose trace is no more than rounding.
fn trace_free(text: &str) -> Result<[f64; 9], String> {
    let rows = finite_list::<9>(text)?;
    let (trace, size) = (rows[0] + rows[4] + rows[8], rows[0].abs() + rows[4].abs() + rows[8].abs());
    if trace.abs() > 1e-12 * size {
        return Err(format!("the trace is {trace}, so the flow would change the volume: make G11 + G22 + G33 zero"));
    }
    Ok(rows)
}

impl Flags {
    /// q and q̇.
    fn start(&self) -> Result<(Matrix3<f64>, Matrix3<f64>), Failure> {
        let q = spheroid::of_unit_volume(&Vector3::from(self.semi_axes))
            .ok_or_else(|| Failure::Flags(format!("semi-axes {:?} are too far apart", self.semi_axes)))?;
        Ok((q, Matrix3::from_row_slice(&self.gradient) * q))
    }

    /// The swirling spheroid.
    fn spheroid(&self) -> Spheroid {
        Spheroid { radius: self.radius, rate: self.radius_rate, swirl: self.swirl }
    }
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let drop = FluidEllipsoid { mass: flags.mass };
    let stepper = drop.clone().into_stepper(flags.run.step_size)?;
    let (q, velocity) = flags.start()?;
    let start = stepper.state(q, geodesic::momentum(flags.mass, &q, &velocity))?;

    let columns = "q11 q12 q13 q21 q22 q23 q31 q32 q33 N1 N2 N3 N4 N5 N6 N7 N8";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    let mut watch = Watch::new(flags, &q, &velocity);
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let (q, momentum) = (state.configuration(), state.momentum());
        csv.row(step, time, by_rows(q).chain(by_rows(&momentum)))?;
        watch.observe(step, time, q, &momentum, stepper.energy(state), &stepper.conserved(state));
        Ok(())
    })?;

    let Run { step_size, steps, .. } = flags.run;
    say(format_args!("fluid ellipsoid over {} s: {steps} steps of {step_size} s\n", flags.run.duration()));
    say(&watch.table);
    let spheroid = exact::spheroid(&drop, &flags.spheroid(), &flags.run)?;
    let shear = exact::shear(&drop, flags)?;
    csv.finish()?;
    figure::draw(flags, &watch, &spheroid)?;

    let mut claims = Claims::new();
    watch.claim(&mut claims);
    convergence(&drop, &watch, flags)?.claim(Order::Second, "the order against q̈ = λ q⁻ᵀ", &mut claims);
    spheroid.claim(&mut claims);
    shear.claim(&mut claims);
    Ok(claims)
}

/// The end of the first seconds with steps of h, h/2 and h/4, against q̈ = λ q⁻ᵀ.
fn convergence(drop: &FluidEllipsoid, watch: &Watch, flags: &Flags) -> Result<Convergence, Failure> {
    let steps = flags.run.steps.min(exact::STEPS);
    let (q, velocity) = flags.start()?;
    let momentum = geodesic::momentum(flags.mass, &q, &velocity);
    let ends = refined::<_, Declared>(drop, &flags.run, steps, |stepper| stepper.state(q, momentum))?;
    let exact = geodesic::motion(&q, &velocity, flags.run.time(steps), watch.rate());
    let (end, end_velocity) = geodesic::halves(&exact.end);
    let end_momentum = geodesic::momentum(flags.mass, &end, &end_velocity);
    let (size, momentum_size) = (end.amax(), end_momentum.amax().max(f64::MIN_POSITIVE));
    let errors = ends.map(|state| {
        let momentum = (state.momentum() - end_momentum).amax() / momentum_size;
        momentum.max((state.configuration() - end).amax() / size)
    });
    let rounding = geodesic::rounding(flags.mass, &end, &end_velocity) / momentum_size;
    Ok(Convergence { errors, reference: exact.error / size + rounding * (4.0 * steps as f64).sqrt(), steps })
}
