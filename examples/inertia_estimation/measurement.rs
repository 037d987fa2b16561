//! Attitudes measured with noise, of a motion that the steps have no part in.

use crate::rotation::exponential;
use crate::unknowns::{COUNT, Start};
use clebsch_examples::flags::Run;
use clebsch_examples::noise::Noise;
use clebsch_examples::reference::solve;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, SVector, Vector3};

/// When attitudes are measured: at the steps 0, `every`, 2 `every`, ….
#[derive(Clone, Copy, Debug)]
pub struct Schedule {
    /// Seconds.
    pub step_size: f64,
    /// Steps from one measurement to the next.
    pub every: u64,
    /// Measurements, with that at the start.
    pub count: usize,
}

impl Schedule {
    /// About `wanted` measurements after the first, evenly spaced.
    ///
    /// # Errors
    /// [`Failure::Flags`] where they are fewer numbers than are asked for.
    pub fn new(run: &Run, wanted: u64) -> Result<Self, Failure> {
        let every = run.steps.div_ceil(wanted);
        let count = (run.steps / every) as usize + 1;
        if 3 * count <= COUNT {
            let text = format!(
                "{count} measured attitudes do not determine {COUNT} numbers: take more --steps or --measurements"
            );
            return Err(Failure::Flags(text));
        }
        Ok(Self { step_size: run.step_size, every, count })
    }

    /// Seconds between measurements.
    pub fn interval(&self) -> f64 {
        self.every as f64 * self.step_size
    }

    /// Steps up to the last measurement.
    pub fn steps(&self) -> u64 {
        (self.count as u64 - 1) * self.every
    }

    /// The same from the start up to the measurement number `count`.
    pub fn first(&self, count: usize) -> Self {
        Self { count: count.min(self.count), ..*self }
    }
}

/// Attitudes, as they are and as they are measured.
pub struct Measurements {
    /// R, by extrapolation.
    pub exact: Vec<Matrix3<f64>>,
    /// R exp(n̂), n normal with the standard deviation `sigma` in each component, in the body frame.
    pub measured: Vec<Matrix3<f64>>,
    /// Radians.
    pub sigma: f64,
    /// Of `exact`, radians, from above.
    pub reference_error: f64,
}

impl Measurements {
    /// Of a body on a circular orbit with the mean motion `rate`, rad/s.
    pub fn new(start: &Start, rate: f64, schedule: &Schedule, sigma: f64, seed: u64) -> Self {
        let (exact, reference_error) = motion(start, rate, schedule);
        let mut noise = Noise::new(seed);
        let mut disturb =
            |attitude: &Matrix3<f64>| attitude * exponential(&Vector3::from_fn(|_, _| sigma * noise.normal()));
        let measured = exact.iter().map(&mut disturb).collect();
        Self { exact, measured, sigma, reference_error }
    }
}

/// π̇ = π × ω + 3n² ŷ × Jŷ, Ṙ = R ω̂, with ŷ = Rᵀ(cos nt, sin nt, 0) and π = Jω. These are the equations of the
/// literature, for y = (R by columns, π over tr J, t).
///
/// Source: Hughes, *Spacecraft Attitude Dynamics* (1986), §8.1.
fn motion(start: &Start, rate: f64, schedule: &Schedule) -> (Vec<Matrix3<f64>>, f64) {
    let ratio = start.inertia / start.inertia.trace();
    let inverse = ratio.try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN));
    let field = |y: &SVector<f64, 13>| {
        let (attitude, momentum) = (Matrix3::from_column_slice(&y.as_slice()[..9]), Vector3::new(y[9], y[10], y[11]));
        let (omega, phase) = (inverse * momentum, rate * y[12]);
        let outwards = attitude.transpose() * Vector3::new(phase.cos(), phase.sin(), 0.0);
        let torque = outwards.cross(&(ratio * outwards)) * (3.0 * rate * rate);
        flat(&(attitude * omega.cross_matrix()), &(momentum.cross(&omega) + torque), 1.0)
    };
    let momentum = ratio * start.spin;
    let fastest = inverse.norm() * momentum.norm() + rate;
    let (mut y, mut error) = (flat(&start.attitude, &momentum, 0.0), 0.0);
    let mut attitudes = vec![start.attitude];
    for _ in 1..schedule.count {
        let solution = solve(field, y, schedule.interval(), fastest);
        (y, error) = (solution.end, error + solution.error);
        attitudes.push(Matrix3::from_column_slice(&y.as_slice()[..9]));
    }
    (attitudes, error)
}

fn flat(attitude: &Matrix3<f64>, momentum: &Vector3<f64>, time: f64) -> SVector<f64, 13> {
    let numbers = attitude.iter().chain(momentum.iter()).copied();
    SVector::from_iterator(numbers.chain(std::iter::once(time)))
}
