//! The inertia of a tumbling spacecraft from its attitudes: nonlinear least squares with the exact sensitivities of the steps.
//!
//! Envisat has been out of control since 2012. Before it can be seized, its inertia has to be known, and there is only
//! its motion to tell. It turned in 134.74 s in September 2013, and it tumbles. Rotation: Kucharski and others,
//! *Attitude and spin period of space debris Envisat measured by satellite laser ranging*, IEEE TGRS 52 (2014)
//! 7651–7657. Tumbling: Sommer and others, *Temporal analysis of Envisat's
//! rotational motion*, JBIS 70 (2017) 45–51. The inertia that the data are made with is that of Bastida Virgili,
//! Lemmens and Krag, *Investigation on Envisat attitude motion*, e.Deorbit Workshop, ESA (2014).
//!
//! **Observability.** The equations J ω̇ + ω × Jω = 3n² ŷ × Jŷ are homogeneous in J. So neither free tumbling nor the
//! gradient of gravity tells the scale of the inertia, only its ratios. (A torque that is known and not proportional to
//! J would: thrusters, a wheel.) So the trace is taken as known. Five of the six entries are estimated, with attitude
//! and angular velocity at the start. The scene claims that the sixth direction moves no attitude. The first guess of
//! the ratios counts as known to a tenth of the trace. This settles the directions that the shortest arcs do not
//! determine. In a steady rotation about a principal axis less is observable. Source: Sheinfeld and Rock, *Rigid body
//! inertia estimation with applications to the capture of a tumbling satellite*, AAS 09-123 (2009).

mod checks;
mod estimator;
mod figure;
mod fit;
mod measurement;
mod report;
mod rotation;
mod unknowns;

use clap::Parser;
use clebsch::{Clebsch, Declared, Differentiated};
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, count, finite_list, moments_of_inertia, parse, positive};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use estimator::Estimator;
use measurement::{Measurements, Schedule};
use nalgebra::{Matrix3, Vector3};
use report::Report;
use rotation::logarithm;
use std::process::ExitCode;
use unknowns::{Chart, Start, Unknowns};

/// GM of the Earth, m³/s²; IERS Conventions (2010).
const GRAVITATION: f64 = 3.986_004_418e14;

/// A rigid body on a circular orbit, in the gradient of gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = moser_veselov,
    potential      = |t, R| {
        let phase = self.mean_motion * t;
        let outwards = R.transpose() * Vector3::new(phase.cos(), phase.sin(), 0);
        3 * self.mean_motion.powi(2) / 2 * outwards.dot(&(self.inertia * outwards))
    },
    emit           = [tangent],
    method FirstOrder = (order = 1, discretization = moser_veselov),
)]
pub struct Spacecraft {
    /// Inertia tensor about the centre of mass, body frame, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    /// Mean motion of the orbit, rad/s.
    pub mean_motion: f64,
}

/// Drift, then kick.
pub struct FirstOrder;

const SCENE: Scene = Scene {
    name: "inertia_estimation",
    step_size: "0.02",
    time_unit: "seconds",
    steps: "30000",
    order: "2",
    order_note: "1 drifts, then kicks; 2 kicks by half at both ends",
    columns_note: "of the estimated body: attitude R11..R33 (body to space), momentum pi1,pi2,pi3 (body frame, kg m2/s)",
};

/// The inertia and the start of a tumbling spacecraft from noisy attitudes: Levenberg-Marquardt on exact sensitivities
#[derive(Parser, Debug)]
pub struct Flags {
    /// True inertia tensor about the centre of mass, body frame, kg m2; its trace is known to the fit
    #[arg(long, value_name = "XX,YY,ZZ,XY,XZ,YZ", value_parser = finite_list::<6>, allow_hyphen_values = true)]
    #[arg(default_value = "17023.3,124825.7,129112.2,397.1,-2171.4,344.2")]
    inertia: [f64; 6],
    /// True angular velocity at the start, body frame, degrees per second
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "1,1.6,1.892")]
    spin: [f64; 3],
    /// Radius of the circular orbit about the Earth, m
    #[arg(long, value_name = "R", value_parser = positive, allow_hyphen_values = true, default_value = "7.159e6")]
    radius: f64,
    /// Principal moments of the first guess, about the body axes, in any one unit
    #[arg(long, value_name = "A,B,C", value_parser = moments_of_inertia, allow_hyphen_values = true)]
    #[arg(default_value = "1,5,5")]
    guess: [f64; 3],
    /// Measured attitudes after that at the start, at most
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true, default_value = "240")]
    measurements: u64,
    /// Standard deviation of a measurement about each axis, arcseconds: 20 for a star tracker, 2000 for a camera nearby
    #[arg(long, value_name = "SIGMA", value_parser = positive, allow_hyphen_values = true, default_value = "20")]
    noise: f64,
    /// Seed of the noise
    #[arg(long, value_name = "SEED", default_value = "1")]
    seed: u64,
    #[command(flatten)]
    run: Run,
}

impl Flags {
    fn mean_motion(&self) -> f64 {
        (GRAVITATION / self.radius).sqrt() / self.radius
    }

    /// # Errors
    /// [`Failure::Flags`] where no body has this inertia, or a step is longer than the motion.
    fn truth(&self) -> Result<Start, Failure> {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        if !unknowns::is_of_a_body(&inertia) {
            return Err(Failure::Flags(
                "no body has this inertia: a moment is not less than the sum of the others".into(),
            ));
        }
        let spin = Vector3::from(self.spin).map(f64::to_radians);
        let turn = self.run.step_size * (spin.norm() + self.mean_motion());
        if turn > 1.0 || turn.is_nan() {
            return Err(Failure::Flags(format!("a step turns body and orbit by {turn:.1e} rad: take shorter steps")));
        }
        Ok(Start { inertia, attitude: Matrix3::identity(), spin })
    }
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(match flags.run.order {
        Order::First => run::<FirstOrder>(&flags),
        Order::Second => run::<Declared>(&flags),
    })
}

/// The first guess: a body along its first axis, turning as the first two measurements say.
fn guess(flags: &Flags, chart: &Chart, measured: &[Matrix3<f64>], schedule: &Schedule) -> Unknowns {
    let moments = Vector3::from(flags.guess);
    let inertia = Matrix3::from_diagonal(&(moments * chart.trace / moments.sum()));
    let spin = logarithm(&(measured[0].transpose() * measured[1])) / schedule.interval();
    chart.unknowns(&Start { inertia, attitude: measured[0], spin })
}

fn run<M: Differentiated<Spacecraft, 3>>(flags: &Flags) -> Result<Claims, Failure> {
    let (truth, schedule) = (flags.truth()?, Schedule::new(&flags.run, flags.measurements)?);
    let sigma = (flags.noise / 3600.0).to_radians();
    let measurements = Measurements::new(&truth, flags.mean_motion(), &schedule, sigma, flags.seed);
    let chart = Chart { trace: truth.inertia.trace(), anchor: measurements.measured[0] };
    let (start, truth) = (guess(flags, &chart, &measurements.measured, &schedule), chart.unknowns(&truth));
    let estimator = Estimator::<M>::new(chart, flags.mean_motion(), sigma, start);
    estimator.start(&truth, flags.run.step_size)?;
    let fit = fit::fit(&estimator, &measurements.measured, &schedule, start);
    let estimate = fit.unknowns;
    say(format_args!(
        "{} attitudes, one every {} s, σ = {} arcsec about each axis",
        schedule.count,
        schedule.interval(),
        flags.noise
    ));
    say(format_args!(
        "exact to {:.0e} rad by extrapolation; noise with the seed {}\n",
        measurements.reference_error, flags.seed
    ));
    say(&fit.table);

    let lost =
        || Failure::Flags("a step of the true or of the estimated motion was refused: take shorter steps".into());
    let report = Report::new(&estimator, &measurements, &schedule, fit, truth).ok_or_else(lost)?;
    say(report.table());
    say(format_args!("{}\n", report.summary()));
    say(checks::cost(&estimator, &truth, flags.run.step_size)?);
    let mut claims = Claims::new();
    report.claim(&mut claims);
    checks::claim(&estimator, &measurements, &schedule, &truth, &mut claims).ok_or_else(lost)?;
    write(flags, &estimator, &estimate)?;
    let predicted = estimator.predict(&estimate, &schedule).ok_or_else(lost)?;
    let drawing = figure::Drawing {
        schedule: &schedule,
        measurements: &measurements,
        guessed: &estimator.attitudes(&start, &schedule).unwrap_or_default(),
        estimated: &predicted.attitudes,
        slopes: &predicted.slopes,
        covariance: report.covariance,
    };
    figure::draw(flags, &drawing)?;
    Ok(claims)
}

/// The motion of the estimated body, as a file.
fn write<M: Differentiated<Spacecraft, 3>>(
    flags: &Flags,
    estimator: &Estimator<M>,
    estimate: &Unknowns,
) -> Result<(), Failure> {
    let columns = ["R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33", "pi1", "pi2", "pi3"];
    let mut csv = Csv::create(&flags.run, &columns)?;
    let (stepper, start) = estimator.start(estimate, flags.run.step_size)?;
    integrate(&flags.run, &stepper, start, |step, time, state| {
        csv.row(step, time, by_rows(state.configuration()).chain(by_rows(&state.momentum())))
    })?;
    csv.finish()
}
