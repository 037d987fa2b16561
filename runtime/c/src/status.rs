//! How a call ended, as a number and in words.

use clebsch::Error;
use core::fmt::{self, Write};

/// Declares the statuses: the name in C, its number, and its text.
macro_rules! statuses {
    ($($(#[doc = $doc:literal])* $variant:ident = $number:literal, $name:literal;)*) => {
        /// How a call ended. In C it is an `int32_t`, and 0 is success.
        ///
        /// ```
        /// use clebsch::Error;
        /// use clebsch_c::Status;
        ///
        /// let status = Status::from(Error::NotFinite { name: "weight" });
        /// assert_eq!((status, status as i32), (Status::NotFinite, 2));
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(i32)]
        #[non_exhaustive]
        pub enum Status { $($(#[doc = $doc])* $variant = $number,)* }

        /// Each name in C, its number, and its meaning.
        pub(crate) const STATUSES: &[(&str, i32, &str)] = &[$(($name, $number, concat!($($doc),*)),)*];
    };
}

statuses! {
    /// The call succeeded.
    Ok = 0, "OK";
    /// The step size is zero or not finite.
    StepSize = 1, "STEP_SIZE";
    /// A number is not finite, or overflowed.
    NotFinite = 2, "NOT_FINITE";
    /// A parameter is not symmetric, and has to be.
    NotSymmetric = 3, "NOT_SYMMETRIC";
    /// A parameter is not diagonal, and has to be.
    NotDiagonal = 4, "NOT_DIAGONAL";
    /// A parameter is not of length one, and has to be.
    NotUnit = 5, "NOT_UNIT";
    /// The kinetic energy is singular for these parameters.
    SingularKineticEnergy = 6, "SINGULAR_KINETIC_ENERGY";
    /// The kinetic energy is negative for some velocity.
    IndefiniteKineticEnergy = 7, "INDEFINITE_KINETIC_ENERGY";
    /// The configuration is off its space, as a matrix that is no rotation.
    OffOrbit = 8, "OFF_ORBIT";
    /// The momentum has a component along motions that leave the configuration unchanged.
    OutsideMomentumSpace = 9, "OUTSIDE_MOMENTUM_SPACE";
    /// The configuration violates the constraint.
    OffConstraint = 10, "OFF_CONSTRAINT";
    /// The velocity violates the constraint.
    ConstraintViolated = 11, "CONSTRAINT_VIOLATED";
    /// The rows of the constraint depend on each other.
    DependentConstraints = 12, "DEPENDENT_CONSTRAINTS";
    /// The step is too long for this momentum.
    Unsolvable = 13, "UNSOLVABLE";
    /// The step is too long for this constraint.
    StepTooLong = 14, "STEP_TOO_LONG";
    /// The equation of the step was not solved in the iterations that are allowed.
    NotConverged = 15, "NOT_CONVERGED";
    /// Another error of the stepper.
    Other = 99, "OTHER";
    /// A pointer is null.
    Null = 100, "NULL";
    /// The header has another size for this struct: make it anew, for this target and this version.
    Size = 101, "SIZE";
}

impl From<Error> for Status {
    fn from(error: Error) -> Self {
        match error {
            Error::StepSize { .. } => Self::StepSize,
            Error::NotFinite { .. } => Self::NotFinite,
            Error::NotSymmetric { .. } => Self::NotSymmetric,
            Error::NotDiagonal { .. } => Self::NotDiagonal,
            Error::NotUnit { .. } => Self::NotUnit,
            Error::SingularKineticEnergy { .. } => Self::SingularKineticEnergy,
            Error::IndefiniteKineticEnergy { .. } => Self::IndefiniteKineticEnergy,
            Error::OffOrbit { .. } => Self::OffOrbit,
            Error::OutsideMomentumSpace { .. } => Self::OutsideMomentumSpace,
            Error::OffConstraint { .. } => Self::OffConstraint,
            Error::ConstraintViolated { .. } => Self::ConstraintViolated,
            Error::DependentConstraints { .. } => Self::DependentConstraints,
            Error::Unsolvable { .. } => Self::Unsolvable,
            Error::StepTooLong { .. } => Self::StepTooLong,
            Error::NotConverged { .. } => Self::NotConverged,
            _ => Self::Other,
        }
    }
}

/// The bytes of a message, with the zero at its end.
pub(crate) const MESSAGE: usize = 512;

/// A text for C: UTF-8, with a zero at its end. A longer one is cut.
///
/// ```
/// use clebsch_c::Message;
/// use core::fmt::Write;
///
/// let mut message = Message::default();
/// write!(message, "a step of {} s", 0.5)?;
/// assert_eq!(message.text(), "a step of 0.5 s");
/// # Ok::<(), core::fmt::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Message {
    text: [u8; MESSAGE],
}

impl Default for Message {
    fn default() -> Self {
        Self { text: [0; MESSAGE] }
    }
}

impl Message {
    fn length(&self) -> usize {
        self.text.iter().position(|&byte| byte == 0).unwrap_or(MESSAGE)
    }

    /// The text.
    pub fn text(&self) -> &str {
        self.text.get(..self.length()).and_then(|text| core::str::from_utf8(text).ok()).unwrap_or_default()
    }
}

impl Write for Message {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let mut length = self.length();
        for character in text.chars() {
            let mut bytes = [0; 4];
            let bytes = character.encode_utf8(&mut bytes).as_bytes();
            let end = length + bytes.len();
            let Some(place) = self.text.get_mut(length..end).filter(|_| end < MESSAGE) else { break };
            place.copy_from_slice(bytes);
            length = end;
        }
        Ok(())
    }
}
