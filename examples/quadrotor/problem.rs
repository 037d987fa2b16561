//! Two hovering places and a time: the task of every flight.

use super::declaration::{Place, Quadrotor, Steering};
use super::place::hovering;
use super::vehicle::{DRAG, GRAVITY, Vehicle};
use crate::Flags;
use clebsch::{Controlled, Error};
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;

/// A quadrotor that has to go somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    /// The vehicle that flies.
    pub vehicle: Vehicle,
    /// Hovering at the origin.
    pub start: Place,
    /// Hovering where it is to go.
    pub goal: Place,
    /// m
    pub distance: f64,
    /// s
    pub duration: f64,
    /// The number of steps.
    pub steps: u64,
}

impl Problem {
    /// From the flags.
    ///
    /// # Errors
    /// [`Failure::Flags`] where there is nowhere to go, or nothing that can fly.
    pub fn new(flags: &Flags) -> Result<Self, Failure> {
        let (to, yaw) = (Vector3::from(flags.to), flags.yaw.to_radians());
        if to.norm() < 1e-6 && yaw.abs() < 1e-6 {
            return Err(Failure::Flags("--to and --yaw: another place to hover at is needed".to_owned()));
        }
        let (start, goal) = (hovering(&Vector3::zeros(), 0.0), hovering(&to, yaw));
        let (duration, steps) = (flags.run.duration(), flags.run.steps);
        Ok(Self { vehicle: Vehicle::new(flags.mass, flags.thrust)?, start, goal, distance: to.norm(), duration, steps })
    }

    /// With steps that are `finer` times shorter.
    ///
    /// # Errors
    /// A vehicle or a step size that the macro refuses.
    pub fn steering(&self, finer: u64) -> Result<Steering, Error> {
        self.vehicle.system().control(self.duration / (self.steps * finer) as f64)
    }
}

impl Vehicle {
    /// The declaration.
    pub fn system(&self) -> Quadrotor {
        Quadrotor {
            mass_matrix: self.mass_matrix(),
            mass: self.mass,
            gravity: GRAVITY,
            arm: Self::arm(),
            drag: DRAG,
            hover: self.hover(),
            top: self.top,
        }
    }
}
