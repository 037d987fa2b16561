//! The operations of a number.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, possibly with derivatives: `f64`, [`DoubleDouble`](super::double_double::DoubleDouble), and
/// [`Dual`](super::dual::Dual) of these.
///
/// Parameters are `f64` and multiply a number as they are, `x * self.mass`; an exact decimal is a [`Real::ratio`].
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
{
    /// A correction of this size is the last: with a Jacobian in `f64`, Newton's method leaves only the rounding error.
    const LAST_CORRECTION: f64;

    /// This number, exactly.
    fn of(value: f64) -> Self;
    /// The nearest `f64`, without derivatives.
    fn to_f64(self) -> f64;
    /// |value| and, for dual numbers, the sizes of the derivatives added: zero only for zero.
    fn size(self) -> f64;
    /// √x.
    fn sqrt(self) -> Self;
    /// sin x.
    fn sin(self) -> Self;
    /// cos x.
    fn cos(self) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// ln x.
    fn ln(self) -> Self;

    /// 0.
    fn zero() -> Self {
        Self::of(0.0)
    }
    /// 1.
    fn one() -> Self {
        Self::of(1.0)
    }
    /// a/b, rounded once: one tenth is `ratio(1, 10)`, not `of(0.1)`.
    fn ratio(a: i32, b: i32) -> Self {
        Self::of(f64::from(a)) / Self::of(f64::from(b))
    }
    /// xⁿ for n ≥ 0, by repeated multiplication.
    fn power(self, n: u32) -> Self {
        (0..n).fold(Self::one(), |power, _| power * self)
    }
}

macro_rules! as_in_the_standard_library {
    ($($function:ident)*) => { $(fn $function(self) -> f64 { self.$function() })* };
}

impl Real for f64 {
    const LAST_CORRECTION: f64 = 1e-10;

    fn of(value: f64) -> f64 {
        value
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn size(self) -> f64 {
        self.abs()
    }
    as_in_the_standard_library! { sqrt sin cos exp ln }
}
