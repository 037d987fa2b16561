//! Numbers of twice the precision of `f64`, for reference runs: pairs of the crate `qd`.

use crate::Scalar;
use crate::stumpff::series;
use core::fmt::{self, Display, Formatter};
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::{One, Zero};
use qd::Quad;

/// The unevaluated sum of two `f64`, the second at most half a unit in the last place of the first: 31 digits.
///
/// ```
/// use clebsch::{DoubleDouble, Scalar};
///
/// let third = DoubleDouble::from_ratio(1, 3);
/// let remainder = third + third + third - DoubleDouble::from_f64(1.0);
/// assert!(remainder.to_f64().abs() < 1e-31);
/// ```
///
/// Sums, differences, products, quotients and square roots are right to a few 2⁻¹⁰⁴. So are elementary functions of
/// numbers of order one; for logarithms, sines and cosines this is an absolute error. The range is that of `f64`, but
/// below 10⁻²⁹² the second number has lost digits.
///
/// For references take order 2: the sizes of orders 6 and 8, and the weights of splittings with `discretization = exact`, have 17 digits.
///
/// Source: Joldes, Muller and Popescu, *Tight and rigorous error bounds for basic building blocks of double-word arithmetic* (2017).
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct DoubleDouble(Quad);

impl DoubleDouble {
    /// The sum of two numbers, whatever their sizes are.
    #[inline]
    pub fn new(large: f64, small: f64) -> Self {
        Self(Quad::from_f64(large).add_accurate(Quad::from_f64(small)))
    }

    /// The two numbers, the larger first.
    #[inline]
    pub fn parts(self) -> [f64; 2] {
        [self.0.0, self.0.1]
    }

    /// Sine and cosine of the remainder after the nearest number of quarter turns, and that number modulo 4.
    fn turned(self) -> (Self, Self, i64) {
        let quarter = Self::PI / Self::from(2.0);
        let turns = libm::round((self / quarter).to_f64());
        let rest = self - quarter * Self::from(turns);
        let square = rest * rest;
        (rest * series(1, square), series(0, square), libm::fmod(turns, 4.0) as i64)
    }
}

impl From<f64> for DoubleDouble {
    #[inline]
    fn from(value: f64) -> Self {
        Self(Quad::from_f64(value))
    }
}

/// As its two numbers.
#[cfg(feature = "serde")]
impl serde::Serialize for DoubleDouble {
    fn serialize<W: serde::Serializer>(&self, writer: W) -> Result<W::Ok, W::Error> {
        self.parts().serialize(writer)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for DoubleDouble {
    fn deserialize<R: serde::Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        let [large, small] = <[f64; 2]>::deserialize(reader)?;
        Ok(Self::new(large, small))
    }
}

/// Both numbers, as their sum.
impl Display for DoubleDouble {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [large, small] = self.parts();
        if small == 0.0 { Display::fmt(&large, f) } else { write!(f, "{large:e} + {small:e}") }
    }
}

/// An operator by a method of the pair, and the one that assigns.
macro_rules! operators {
    ($($trait:ident $method:ident $assign:ident $assign_method:ident $own:ident),*) => {$(
        impl $trait for DoubleDouble {
            type Output = Self;

            #[inline]
            fn $method(self, other: Self) -> Self {
                let exact = Self(self.0.$own(other.0));
                // an infinite number has no remainder: the second number would be NaN
                if exact.is_finite() { exact } else { $trait::$method(self.0.0, other.0.0).into() }
            }
        }

        impl $assign for DoubleDouble {
            #[inline]
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}

operators!(Add add AddAssign add_assign add_accurate, Sub sub SubAssign sub_assign sub_accurate,
           Mul mul MulAssign mul_assign mul, Div div DivAssign div_assign div);

impl Neg for DoubleDouble {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Zero for DoubleDouble {
    #[inline]
    fn zero() -> Self {
        Self::from(0.0)
    }
    #[inline]
    fn is_zero(&self) -> bool {
        self.0.0 == 0.0
    }
}

impl One for DoubleDouble {
    #[inline]
    fn one() -> Self {
        Self::from(1.0)
    }
}

impl Scalar for DoubleDouble {
    crate::one_number!();

    const EPSILON: Self = Self(Quad::EPSILON);
    const PI: Self = Self(Quad::PI);

    #[inline]
    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        // halves of 32 bits are exact
        let exact = |n: i64| Self::new((n >> 32) as f64 * 4_294_967_296.0, (n & 0xffff_ffff) as f64);
        exact(numerator) / exact(denominator)
    }
    #[inline]
    fn from_f64(value: f64) -> Self {
        value.into()
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self.0.0
    }
    #[inline]
    fn is_finite(self) -> bool {
        self.0.0.is_finite() && self.0.1.is_finite()
    }

    #[inline]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    #[inline]
    fn sqrt(self) -> Self {
        if self.to_f64() == f64::INFINITY { self } else { Self(self.0.sqrt()) }
    }
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine, turns) = self.turned();
        match turns.rem_euclid(4) {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }
    fn tan(self) -> Self {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }
    fn asin(self) -> Self {
        let one = Self::one();
        (self / ((one - self) * (one + self)).sqrt()).atan()
    }
    fn acos(self) -> Self {
        let one = Self::one();
        let half = ((one - self) / (one + self)).sqrt().atan();
        half + half
    }
    /// One correction of the arctangent y in `f64`: tan(x − y) = (x cos y − sin y)/(cos y + x sin y).
    fn atan(self) -> Self {
        let near = Self::from(Scalar::atan(self.to_f64()));
        if self.to_f64().abs() > 1e32 {
            let quarter = Self::PI / Self::from(2.0);
            return if self.to_f64() > 0.0 { quarter } else { -quarter };
        }
        let (sine, cosine) = near.sin_cos();
        near + (self * cosine - sine) / (cosine + self * sine)
    }
    fn sinh(self) -> Self {
        let square = self * self;
        if square <= Self::one() {
            return self * series(1, -square);
        }
        let exponential = self.exp();
        (exponential - exponential.recip()) / Self::from(2.0)
    }
    fn cosh(self) -> Self {
        let exponential = self.exp();
        (exponential + exponential.recip()) / Self::from(2.0)
    }
    fn tanh(self) -> Self {
        match self.to_f64() {
            x if x.abs() > 40.0 => Self::from(x.signum()),
            _ => self.sinh() / self.cosh(),
        }
    }
    fn exp(self) -> Self {
        Self(self.0.exp())
    }
    /// One correction of the logarithm y in `f64`: y + 2(x − eʸ)/(x + eʸ).
    fn ln(self) -> Self {
        let near = Self::from(Scalar::ln(self.to_f64()));
        if !near.is_finite() {
            return near;
        }
        let power = near.exp();
        near + Self::from(2.0) * (self - power) / (self + power)
    }
    fn powf(self, exponent: Self) -> Self {
        let whole = libm::round(exponent.to_f64());
        if exponent == Self::from(whole) && whole.abs() < f64::from(i32::MAX) {
            return self.powi(whole as i32);
        }
        if self.is_zero() { self } else { (exponent * self.ln()).exp() }
    }
}

#[cfg(test)]
mod tests;
