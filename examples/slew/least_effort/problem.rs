//! A body at rest, another attitude, a duration, bounds: the task of every plan.

use super::declaration::{Place, SteeredBody, Steering};
use crate::Flags;
use crate::attitude::{noticeable_turn, turn};
use crate::body::Body;
use clebsch::{Controlled, Error};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector3};

/// The bound where none is given, as a part of the torque that the smoothest turn about the fixed axis needs.
const PART: f64 = 0.8;

/// A body that has to be turned from rest to rest.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The body.
    pub body: Body,
    /// From the body to space, at the start.
    pub from: Matrix3<f64>,
    /// The same at the end.
    pub to: Matrix3<f64>,
    /// Axis times angle between both, body frame, rad.
    pub turn: Vector3<f64>,
    /// s
    pub duration: f64,
    /// The number of steps.
    pub steps: u64,
    /// The largest torque about each axis, N·m.
    pub top: f64,
}

impl Problem {
    /// From the flags.
    ///
    /// # Errors
    /// [`Failure::Flags`] where the attitudes are equal.
    pub fn new(flags: &Flags, body: Body) -> Result<Self, Failure> {
        let (from, to, duration) = (flags.from, flags.to, flags.run.duration());
        let turn = noticeable_turn(&from, &to)?;
        let smooth = (body.inertia * turn).amax() * 6.0 / duration.powi(2);
        let top = flags.torque.unwrap_or(PART * smooth);
        Ok(Self { body, from, to, turn, duration, steps: flags.run.steps, top })
    }

    /// With steps that are `finer` times shorter.
    ///
    /// # Errors
    /// A body or a step size that the macro refuses.
    pub fn steering(&self, finer: u64) -> Result<Steering, Error> {
        let system = SteeredBody { inertia: self.body.inertia, top: self.top };
        system.control(self.duration / (self.steps * finer) as f64)
    }

    /// At rest.
    pub fn start(&self) -> Place {
        (self.from, Vector3::zeros())
    }

    /// At rest.
    pub fn goal(&self) -> Place {
        (self.to, Vector3::zeros())
    }
}

/// How far a place is from attitude and rest of another, as an angle, rad, and as a momentum, N·m·s.
pub fn apart(a: &Place, b: &Place) -> (f64, f64) {
    (turn(&a.0, &b.0).norm(), (a.1 - b.1).norm())
}
