//! Two attitudes, a body, a duration: the task of every slew.

use super::euler::Euler;
use crate::Flags;
use crate::attitude::noticeable_turn;
use crate::body::Body;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector3};

/// A body that has to be turned.
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
    /// The continuous motions.
    pub euler: Euler,
}

impl Problem {
    /// From the flags.
    ///
    /// # Errors
    /// [`Failure::Flags`] where the attitudes are equal.
    pub fn new(flags: &Flags, body: Body) -> Result<Self, Failure> {
        let (from, to, duration) = (flags.from, flags.to, flags.run.duration());
        let turn = noticeable_turn(&from, &to)?;
        Ok(Self { body, from, to, turn, duration, steps: flags.run.steps, euler: Euler::new(&body, &from, duration) })
    }

    /// The angular velocity of a turn about the fixed axis with so many turns more, rad/s.
    pub fn steady(&self, turns: i32) -> Vector3<f64> {
        let angle = self.turn.norm();
        self.turn * ((1.0 + std::f64::consts::TAU * f64::from(turns) / angle) / self.duration)
    }

    /// The action of the steady turn, J·s, which is no free motion unless its axis is principal.
    pub fn steady_action(&self, turns: i32) -> f64 {
        let omega = self.steady(turns);
        omega.dot(&(self.body.inertia * omega)) / 2.0 * self.duration
    }

    /// π₀ in units of [`Euler`].
    pub fn scaled(&self, momentum: &Vector3<f64>) -> Vector3<f64> {
        momentum / self.euler.momentum_unit
    }
}
