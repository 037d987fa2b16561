//! The attitude of a satellite, and the bias of its gyro, from a magnetometer. Each estimate is a plan whose start is unknown: the motion
//! that makes the measurements most probable. A window of some minutes moves along, and the arrival cost stands for all that was before.
//!
//! A magnetometer sees one direction, so no single measurement tells the attitude. The extended Kalman filter that satellites
//! fly is next to it, written by hand. Orbit, noise and errors at the start: Crassidis and Markley, *Unscented filtering for spacecraft attitude
//! estimation* (2003).
//!
//! | file | its job |
//! |---|---|
//! | `declaration` | the satellite with the price of its measurements, as the macro is given it |
//! | `orbit` | the true motion, and measurements by gyro and magnetometer |
//! | `window` | estimates over a window that moves along |
//! | `filter` | the extended Kalman filter |
//! | `report` | their table and claims |
//! | `figure` | drawn |

mod declaration;
mod figure;
mod filter;
mod orbit;
mod report;
mod window;

use clap::Parser;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, count, parse};
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::{Matrix3, Matrix6, Rotation3, Vector3, Vector6};
use orbit::{Orbit, PER_HOUR};
use report::Case;
use std::process::ExitCode;

const SCENE: Scene = Scene {
    name: "attitude_estimation",
    step_size: "10",
    time_unit: "seconds",
    steps: "2160",
    order: "2",
    order_note: "estimates are made with steps of order 2",
    columns_note: "of the window with a wrong bias: error of the attitude (degrees), errors of the bias b1,b2,b3 (degrees/hour), standard deviations of both a1,a2,a3,s1,s2,s3",
};

/// The attitude and the bias.
type Place = (Matrix3<f64>, Vector3<f64>);

/// The attitude of a satellite and the bias of its gyro from the field of the Earth, against a Kalman filter
#[derive(Parser, Debug)]
pub struct Flags {
    /// Steps of a window
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true, default_value = "120")]
    window: u64,
    /// Steps from one estimate to the next
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true, default_value = "6")]
    stride: u64,
    /// Seed of the noise
    #[arg(long, value_name = "SEED", default_value = "1")]
    seed: u64,
    #[command(flatten)]
    run: Run,
}

/// The guess before anything is measured.
pub struct Start {
    place: Place,
    /// Standard deviations, rad and rad/s.
    spread: [f64; 2],
}

impl Start {
    /// So many degrees and degrees per hour away from the truth.
    fn new(truth: &Place, [attitude, bias]: [[f64; 3]; 2], [turn, drift]: [f64; 2]) -> Self {
        let off = Vector3::from(attitude).map(f64::to_radians);
        let place = (truth.0 * orbit::turned(&off), truth.1 + Vector3::from(bias) * PER_HOUR);
        Self { place, spread: [turn.to_radians(), drift * PER_HOUR] }
    }

    fn diagonal(&self, of: impl Fn(f64) -> f64) -> Matrix6<f64> {
        Matrix6::from_diagonal(&Vector6::from_fn(|i, _| of(self.spread[i / 3])))
    }

    fn covariance(&self) -> Matrix6<f64> {
        self.diagonal(|spread| spread * spread)
    }

    fn information(&self) -> Matrix6<f64> {
        self.diagonal(|spread| (spread * spread).recip())
    }
}

/// The place as it is known after `k` steps.
pub struct Estimate {
    k: usize,
    place: Place,
    /// `None` where it is not known.
    information: Option<Matrix6<f64>>,
}

impl Estimate {
    /// The small change that leads to the truth.
    fn error(&self, orbit: &Orbit) -> Vector6<f64> {
        let truth = &orbit.places[self.k];
        let turn = Rotation3::from_matrix_unchecked(self.place.0.transpose() * truth.0).scaled_axis();
        let bias = truth.1 - self.place.1;
        Vector6::from_fn(|i, _| if i < 3 { turn[i] } else { bias[i - 3] })
    }

    /// The error of the attitude, degrees.
    fn off(&self, orbit: &Orbit) -> f64 {
        self.error(orbit).fixed_rows::<3>(0).norm().to_degrees()
    }
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    if flags.stride > flags.window {
        return Err(Failure::Flags("--stride: no more steps than those of --window".to_owned()));
    }
    let orbit = Orbit::new(flags);
    let (minutes, ahead) = (flags.window as f64 * orbit.h / 60.0, flags.stride as f64 * orbit.h);
    say(format_args!(
        "{} steps of {} s, a window of {minutes} min, an estimate each {ahead} s\n",
        flags.run.steps, orbit.h
    ));
    let mut claims = Claims::new();
    let cases = report::STARTS.iter().map(|start| Case::new(flags, &orbit, start)).collect::<Result<Vec<_>, _>>()?;
    say(report::table(&orbit, &cases));
    report::claim(flags, &orbit, &cases, &mut claims);
    write(flags, &orbit, &cases[report::WRONG_BIAS])?;
    figure::draw(flags, &orbit, &cases)?;
    Ok(claims)
}

/// Errors and their standard deviations, as a file.
fn write(flags: &Flags, orbit: &Orbit, case: &Case) -> Result<(), Failure> {
    let columns = "attitude b1 b2 b3 a1 a2 a3 s1 s2 s3";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    for estimate in &case.window {
        let unit = Vector6::from_fn(|i, _| if i < 3 { 1.0_f64.to_degrees() } else { PER_HOUR.recip() });
        let error = estimate.error(orbit);
        let covariance = estimate.information.and_then(|known| known.try_inverse()).unwrap_or_default();
        let spread = covariance.diagonal().map(f64::sqrt).component_mul(&unit);
        let bias: Vector3<f64> = error.fixed_rows::<3>(3) / PER_HOUR;
        let numbers = [estimate.off(orbit)].into_iter().chain(by_rows(&bias)).chain(by_rows(&spread));
        let step = estimate.k as u64;
        csv.row(step, flags.run.time(step), numbers)?;
    }
    csv.finish()
}
