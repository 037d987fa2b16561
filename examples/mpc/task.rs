//! The track, the obstacle, and the references of a plan.

use super::declaration::{Follower, Place, Reference, Steering};
use super::place::pose;
use super::vehicle::{DRAG, GRAVITY, MASS, TOP, Vehicle};
use crate::Flags;
use clebsch::{Controlled, Error};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector1, Vector3, Vector6};
use std::f64::consts::TAU;

/// A round of the track, s.
const PERIOD: f64 = 3.6;
/// Half of the length and of the height of the track, m.
const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.2;
/// When the obstacle is next to the track, as a part of a round, and where it is then, from the track, m.
const MEETING: f64 = 0.625;
const ASIDE: Vector3<f64> = Vector3::new(0.0, 0.15, 0.0);
/// The velocity of the obstacle, m/s.
const DRIFT: Vector3<f64> = Vector3::new(0.2, 0.0, 0.0);
/// An obstacle that is nowhere near, m.
const NOWHERE: Vector3<f64> = Vector3::new(0.0, 0.0, -1e3);

/// A vehicle, a track, gusts, and the dials of plans.
#[derive(Clone, Debug)]
pub struct Task {
    /// The vehicle with its prices.
    pub system: Follower,
    /// s
    pub h: f64,
    /// The number of ticks.
    pub steps: usize,
    /// Steps of a plan.
    pub horizon: usize,
    /// The largest velocity that a gust adds in a step, m/s.
    pub gust: f64,
    /// Seed of the gusts.
    pub seed: u64,
    /// The least distance from the obstacle, m.
    pub clearance: f64,
}

impl Task {
    /// From the flags.
    ///
    /// # Errors
    /// [`Failure::Flags`] where the horizon is longer than memory.
    pub fn new(flags: &Flags) -> Result<Self, Failure> {
        let number = |flag: &str, value: u64| {
            let small = usize::try_from(value).ok().filter(|number| *number <= 100_000);
            small.ok_or_else(|| Failure::Flags(format!("--{flag} {value}: no more than 100000 fit")))
        };
        let (steps, horizon) = (number("steps", flags.run.steps)?, number("horizon", flags.horizon)?);
        let vehicle = |text: &str| text.parse().unwrap_or(f64::NAN);
        let vehicle = Vehicle::new(vehicle(MASS), vehicle(TOP))?;
        let system = Follower {
            mass_matrix: vehicle.mass_matrix(),
            mass: vehicle.mass,
            gravity: GRAVITY,
            arm: Vehicle::arm(),
            drag: DRAG,
            hover: vehicle.hover(),
            top: vehicle.top,
            length: 0.03,
            turn: 0.1,
            speed: 0.2,
            spin: 10.0,
            end_time: 0.1,
        };
        let Flags { gust, seed, clearance, .. } = *flags;
        Ok(Self { system, h: flags.run.step_size, steps, horizon, gust, seed, clearance })
    }

    /// The time of a tick, s.
    pub fn time(&self, tick: usize) -> f64 {
        tick as f64 * self.h
    }

    /// A figure of eight, tilted: where to be, m.
    pub fn track(&self, t: f64) -> Vector3<f64> {
        let (sin, cos) = (TAU * t / PERIOD).sin_cos();
        Vector3::new(LENGTH * sin, LENGTH * sin * cos, HEIGHT * sin)
    }

    /// Its velocity, m/s.
    pub fn velocity(&self, t: f64) -> Vector3<f64> {
        let (sin, cos) = (TAU * t / PERIOD).sin_cos();
        Vector3::new(LENGTH * cos, LENGTH * (cos * cos - sin * sin), HEIGHT * cos) * (TAU / PERIOD)
    }

    /// The attitude that the track takes, with the first axis as much ahead as it can be, and the thrust of each rotor, N.
    fn lean(&self, t: f64) -> (Matrix3<f64>, f64) {
        let (sin, cos) = (TAU * t / PERIOD).sin_cos();
        let acceleration = -Vector3::new(LENGTH * sin, 4.0 * LENGTH * sin * cos, HEIGHT * sin) * (TAU / PERIOD).powi(2);
        let up = acceleration + Vector3::z() * GRAVITY;
        let left = up.cross(&Vector3::x());
        let (up, left, size) = (up.normalize(), left.normalize(), up.norm());
        (Matrix3::from_columns(&[left.cross(&up), left, up]), self.system.mass * size / 4.0)
    }

    /// Where the obstacle is, m.
    pub fn obstacle(&self, t: f64) -> Vector3<f64> {
        let meeting = MEETING * PERIOD;
        self.track(meeting) + ASIDE + DRIFT * (t - meeting)
    }

    /// Level, with the velocity of the track.
    pub fn start(&self) -> Place {
        let mut momentum = Vector6::zeros();
        momentum.fixed_rows_mut::<3>(3).copy_from(&(self.velocity(0.0) * self.system.mass));
        (pose(&Matrix3::identity(), &self.track(0.0)), momentum)
    }

    /// Plans that start at a tick, with the track at their end.
    ///
    /// # Errors
    /// A step size that the macro refuses.
    pub fn steering(&self, tick: usize) -> Result<Steering, Error> {
        let (start, end) = (self.time(tick), self.time(tick + self.horizon));
        let steering = self.system.clone().control(self.h)?.starting_at(start)?;
        steering.with_end_reference((self.track(end), self.velocity(end)))
    }

    /// The reference of step j of a plan, at the time t.
    ///
    /// A gust adds no more than w to the velocity. With the same thrusts, step j of the next plan is then no more than j h w
    /// from step j + 1 of this one. So the margin w h j (j − 1)/2 leaves room for all gusts to come.
    pub fn reference(&self, j: usize, t: f64, has_obstacle: bool) -> Reference {
        let (track, (attitude, thrust)) = (self.track(t), self.lean(t));
        let margin = self.gust * self.h * (j * j.saturating_sub(1)) as f64 / 2.0;
        let (obstacle, apart) = if has_obstacle { (self.obstacle(t), self.clearance + margin) } else { (NOWHERE, 0.0) };
        (track, attitude, Vector1::new(thrust), obstacle, Vector1::new(apart))
    }
}
