//! Reasons for which a call does nothing, as numbers. `docs/book/src/live/live.js` has a text for each.

use clebsch::Error;

/// Why a run cannot begin or go on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u32)]
pub enum Refusal {
    /// There is no run to go on with.
    NoRun = 1,
    /// A parameter or a result is NaN or infinite.
    NotFinite = 2,
    /// The step size, a length or a moment of inertia is not positive.
    NotPositive = 3,
    /// No body has these moments of inertia: one is greater than the sum of the two others.
    NoBody = 4,
    /// No method of the scene has this order.
    NoOrder = 5,
    /// The step is too long for this momentum: its equation has no solution.
    TooLong = 6,
    /// The equation of the step was not solved in the iterations that are allowed.
    NotSolved = 7,
    /// The start is no state of the system.
    NoState = 8,
}

impl Refusal {
    /// The number that JavaScript receives. 0 is none of them: it stands for success.
    pub fn number(self) -> u32 {
        self as u32
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        match error {
            Error::NotFinite { .. } => Self::NotFinite,
            Error::StepSize { .. }
            | Error::SingularKineticEnergy { .. }
            | Error::IndefiniteKineticEnergy { .. } => Self::NotPositive,
            Error::Unsolvable { .. } => Self::TooLong,
            Error::NotConverged { .. } => Self::NotSolved,
            _ => Self::NoState,
        }
    }
}

/// Refuses numbers that are not finite and positive.
pub fn positive(values: &[f64]) -> Result<(), Refusal> {
    finite(values)?;
    if values.iter().all(|&value| value > 0.0) { Ok(()) } else { Err(Refusal::NotPositive) }
}

/// Refuses NaN and infinity.
pub fn finite(values: &[f64]) -> Result<(), Refusal> {
    if values.iter().all(|value| value.is_finite()) { Ok(()) } else { Err(Refusal::NotFinite) }
}
