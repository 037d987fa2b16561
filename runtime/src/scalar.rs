//! The numbers that an integrator computes with.

use core::fmt::{Debug, Display};
use core::ops::{BitAnd, BitOr, BitXor, Neg, Not};
use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign};
use num_traits::{One, Zero};

/// The number types of declarations: `f32` and `f64`, several of them as lanes, and numbers that carry derivatives.
///
/// Everything that declarations can write about a scalar is a method of this trait. Angles are in radians. Functions outside their domain give
/// NaN, as for `f64`; the stepper turns that into [`Error::NotFinite`](crate::Error::NotFinite).
///
/// Operations act on each lane by itself. Lanes have no order: a comparison answers with a [`Mask`](Self::Mask), and code that needs one answer
/// asks for a [`Real`]. An implementation for a single number writes `clebsch::one_number!();` for the lanes.
///
/// ```
/// use clebsch::Scalar;
///
/// /// The period of a pendulum of this length in m, in any number type.
/// fn period<T: Scalar>(length: T) -> T {
///     T::from_f64(2.0) * T::PI * (length / T::from_f64(9.8)).sqrt()
/// }
///
/// assert!((period(1.0_f64) - 2.007).abs() < 1e-3);
/// assert!((period(1.0_f32) - 2.007).abs() < 1e-3);
/// ```
pub trait Scalar:
    nalgebra::Scalar
    + Copy
    + Display
    + Zero
    + One
    + Neg<Output = Self>
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + ClosedDivAssign
{
    /// A single number: the type itself, or that of one lane.
    type Lane: Real;
    /// The answer of a comparison: `bool`, or one for each lane.
    type Mask: Mask;
    /// The number of lanes: 1 for a single number, at most 16.
    const LANES: usize;
    /// The order of the derivatives that a number carries along: 0 for a plain one.
    ///
    /// An iteration that stops when the value can no longer change goes on until they cannot either.
    const DERIVATIVES: u32 = 0;
    /// Distance from 1 to the next larger number.
    const EPSILON: Self;
    /// Half of the circumference of the unit circle.
    const PI: Self;

    /// `numerator / denominator`, rounded once where both are exact in `Self`.
    fn from_ratio(numerator: i64, denominator: i64) -> Self;
    /// The number of this type next to `value`.
    fn from_f64(value: f64) -> Self;
    /// The `f64` next to this number, for messages and tables; that of the first lane.
    fn to_f64(self) -> f64;
    /// Neither NaN nor infinite, in any lane.
    fn is_finite(self) -> bool;

    /// The number in a lane below [`LANES`](Self::LANES); NaN where lanes have none of that number.
    fn lane(self, lane: usize) -> Self::Lane;
    /// The number with `value(i)` in lane i.
    fn from_lanes(value: impl FnMut(usize) -> Self::Lane) -> Self;
    /// Where x < `other`; nowhere where either is NaN.
    fn below(self, other: Self) -> Self::Mask;
    /// Where x ≤ `other`; nowhere where either is NaN.
    fn at_most(self, other: Self) -> Self::Mask;
    /// Where x = `other`; nowhere where either is NaN.
    fn equals(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Where x is neither NaN nor infinite.
    fn finite(self) -> Self::Mask;

    /// Called once for every iteration of an implicit equation: a linearisation, a residual, or a sweep over the stages of a step of order 16.
    ///
    /// Does nothing, unless a number that counts the work done with it says otherwise.
    #[inline]
    fn iterated() {}

    /// |x|
    fn abs(self) -> Self;
    /// √x, NaN for x < 0
    fn sqrt(self) -> Self;
    /// 1 / x
    #[inline]
    fn recip(self) -> Self {
        Self::one() / self
    }
    /// sin x
    fn sin(self) -> Self;
    /// cos x
    fn cos(self) -> Self;
    /// (sin x, cos x), the same numbers. Types that reduce the angle once for both do it here.
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }
    /// tan x
    fn tan(self) -> Self;
    /// arcsin x, NaN for |x| > 1
    fn asin(self) -> Self;
    /// arccos x, NaN for |x| > 1
    fn acos(self) -> Self;
    /// arctan x
    fn atan(self) -> Self;
    /// sinh x
    fn sinh(self) -> Self;
    /// cosh x
    fn cosh(self) -> Self;
    /// tanh x
    fn tanh(self) -> Self;
    /// eˣ
    fn exp(self) -> Self;
    /// Natural logarithm, NaN for x < 0
    fn ln(self) -> Self;
    /// xⁿ by squaring; negative exponents through the reciprocal.
    #[inline]
    fn powi(self, exponent: i32) -> Self {
        let mut square = if exponent < 0 { self.recip() } else { self };
        let mut rest = exponent.unsigned_abs();
        let mut power = Self::one();
        while rest > 0 {
            if rest & 1 == 1 {
                power *= square;
            }
            square *= square;
            rest >>= 1;
        }
        power
    }
    /// xʸ, NaN for x < 0 and y no integer
    fn powf(self, exponent: Self) -> Self;
}

/// One truth value for each lane: `bool` for a single number.
///
/// ```
/// use clebsch::{Mask, Scalar};
///
/// fn is_small<T: Scalar>(x: T) -> bool {
///     x.abs().below(T::from_f64(1e-3)).all() // in every lane
/// }
///
/// assert!(is_small(1e-4_f64));
/// ```
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
    /// True in the lanes whose bit is set; lane 0 has the lowest bit.
    fn from_bits(bits: u16) -> Self;
    /// One bit for each lane, that of lane 0 the lowest.
    fn bits(self) -> u16;
    /// Whether some lane is true.
    fn any(self) -> bool;
    /// Whether all lanes are true.
    fn all(self) -> bool;

    /// Whether there is a lane `lane`, and it is true.
    #[inline]
    fn lane(self, lane: usize) -> bool {
        lane < 16 && self.bits() >> lane & 1 == 1
    }

    /// True in all lanes.
    #[inline]
    fn everywhere() -> Self {
        Self::from_bits(u16::MAX)
    }

    /// True in no lane.
    #[inline]
    fn nowhere() -> Self {
        Self::from_bits(0)
    }
}

impl Mask for bool {
    #[inline]
    fn from_bits(bits: u16) -> Self {
        bits & 1 == 1
    }
    #[inline]
    fn bits(self) -> u16 {
        self.into()
    }
    #[inline]
    fn any(self) -> bool {
        self
    }
    #[inline]
    fn all(self) -> bool {
        self
    }
}

/// A single number, without lanes and with an order.
///
/// Implemented for every [`Scalar`] that is one.
///
/// ```
/// use clebsch::Real;
///
/// fn larger<T: Real>(a: T, b: T) -> T {
///     if a < b { b } else { a }
/// }
///
/// assert_eq!(larger(1.0_f32, 2.0), 2.0);
/// ```
pub trait Real: Scalar<Lane = Self, Mask = bool> + PartialOrd {}

impl<T: Scalar<Lane = T, Mask = bool> + PartialOrd> Real for T {}

/// The functions of lanes in an implementation of [`Scalar`](crate::Scalar) for a single number, which is its own only
/// lane.
#[doc(hidden)]
#[macro_export]
macro_rules! one_number {
    () => {
        type Lane = Self;
        type Mask = bool;
        const LANES: usize = 1;

        #[inline]
        fn lane(self, _: usize) -> Self {
            self
        }
        #[inline]
        fn from_lanes(mut value: impl FnMut(usize) -> Self) -> Self {
            value(0)
        }
        #[inline]
        fn below(self, other: Self) -> bool {
            self < other
        }
        #[inline]
        fn at_most(self, other: Self) -> bool {
            self <= other
        }
        #[inline]
        fn equals(self, other: Self) -> bool {
            self == other
        }
        #[inline]
        fn select(mask: bool, yes: Self, no: Self) -> Self {
            if mask { yes } else { no }
        }
        #[inline]
        fn finite(self) -> bool {
            $crate::Scalar::is_finite(self)
        }
    };
}

/// A floating point type, whose functions are those of `std`, or of `libm` by the name that stands behind.
macro_rules! floating_point {
    ($scalar:ident, $sqrt:ident, $sin_cos:ident; $($method:ident $(($argument:ident))? $libm:ident),*) => {
        impl Scalar for $scalar {
            $crate::one_number!();

            const EPSILON: Self = $scalar::EPSILON;
            const PI: Self = core::$scalar::consts::PI;

            #[inline]
            fn from_ratio(numerator: i64, denominator: i64) -> Self {
                numerator as $scalar / denominator as $scalar
            }
            #[inline]
            fn from_f64(value: f64) -> Self {
                value as $scalar
            }
            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline]
            fn is_finite(self) -> bool {
                $scalar::is_finite(self)
            }
            #[inline]
            fn abs(self) -> Self {
                $scalar::abs(self)
            }
            #[inline]
            fn sqrt(self) -> Self {
                // the same number: the optimiser sees into this root, and takes those of two sites at once. That of `libm` is a block of
                // assembler for the oldest processors, by which wider registers wait
                #[cfg(feature = "roots")]
                { <$scalar>::sqrt(self) }
                #[cfg(not(feature = "roots"))]
                { libm::$sqrt(self) }
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                #[cfg(feature = "std")]
                { <$scalar>::sin_cos(self) }
                #[cfg(not(feature = "std"))]
                { libm::$sin_cos(self) }
            }
            $(
                #[inline]
                fn $method(self $(, $argument: Self)?) -> Self {
                    #[cfg(feature = "std")]
                    { <$scalar>::$method(self $(, $argument)?) }
                    #[cfg(not(feature = "std"))]
                    { libm::$libm(self $(, $argument)?) }
                }
            )*
        }
    };
}

floating_point!(f64, sqrt, sincos; sin sin, cos cos, tan tan, asin asin, acos acos, atan atan,
                sinh sinh, cosh cosh, tanh tanh, exp exp, ln log, powf(exponent) pow);
floating_point!(f32, sqrtf, sincosf; sin sinf, cos cosf, tan tanf, asin asinf, acos acosf, atan atanf,
                sinh sinhf, cosh coshf, tanh tanhf, exp expf, ln logf, powf(exponent) powf);

#[cfg(test)]
mod tests;
