//! Exact rational numbers: the coefficients of every expression.
//!
//! They may have any size, but nearly all of them are fractions of machine words, and these take neither heap nor long arithmetic.

use std::cmp::Ordering;
use std::fmt;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use num_bigint::BigInt;
use num_rational::BigRational;
pub use num_rational::Ratio;
pub use num_traits::{CheckedAdd, CheckedMul, One, Zero};
use num_traits::{Pow, Signed, ToPrimitive};

use crate::work;

/// Fractions of machine words: exponents, and the coefficients that fit. Their numerators have a negative.
pub type Fraction = Ratio<i64>;

/// A rational number of any size.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Rational(Size);

/// What fits is short, so that equal numbers are equal values.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
enum Size {
    Short(Fraction),
    Long(Box<BigRational>),
}

/// The rational `numerator / denominator`; the denominator is not zero.
pub fn rational(numerator: i64, denominator: i64) -> Rational {
    match (numerator, denominator) {
        (i64::MIN, _) | (_, i64::MIN) => Rational::new(numerator.into(), denominator.into()),
        _ => Rational::short(Ratio::new(numerator, denominator)),
    }
}

/// The rational that equals an integer.
pub fn integer(value: i64) -> Rational {
    rational(value, 1)
}

/// a·b. Most coefficients are ±1, and a product with one costs nothing.
pub fn product(a: &Rational, b: &Rational) -> Rational {
    match (a.is_one(), b.is_one()) {
        (true, _) => b.clone(),
        (_, true) => a.clone(),
        _ => a * b,
    }
}

impl Rational {
    /// The rational `numerator / denominator`; the denominator is not zero.
    pub fn new(numerator: i128, denominator: i128) -> Rational {
        Rational::from(BigRational::new(numerator.into(), denominator.into()))
    }

    pub(crate) fn short(fraction: Fraction) -> Rational {
        Rational(Size::Short(fraction))
    }

    /// The value as a fraction of machine words, if it is one.
    pub(crate) fn as_fraction(&self) -> Option<Fraction> {
        match &self.0 {
            Size::Short(fraction) => Some(*fraction),
            Size::Long(_) => None,
        }
    }

    fn long(&self) -> BigRational {
        match &self.0 {
            Size::Short(fraction) => BigRational::new_raw((*fraction.numer()).into(), (*fraction.denom()).into()),
            Size::Long(value) => (**value).clone(),
        }
    }

    /// Numerator and denominator, if they are machine words.
    pub fn parts(&self) -> Option<(i64, i64)> {
        self.as_fraction().map(Fraction::into_raw)
    }

    /// The machine words that it takes beside one for each part.
    pub(crate) fn digits(&self) -> usize {
        match &self.0 {
            Size::Short(_) => 0,
            Size::Long(value) => ((value.numer().bits() + value.denom().bits()) / 64) as usize,
        }
    }

    /// The numerator in lowest terms.
    pub fn numer(&self) -> BigInt {
        self.parts().map_or_else(|| self.long().numer().clone(), |(numerator, _)| numerator.into())
    }

    /// The denominator in lowest terms, positive.
    pub fn denom(&self) -> BigInt {
        self.parts().map_or_else(|| self.long().denom().clone(), |(_, denominator)| denominator.into())
    }

    /// Whether it is whole.
    pub fn is_integer(&self) -> bool {
        self.parts().map_or_else(|| self.long().is_integer(), |(_, denominator)| denominator == 1)
    }

    /// Whether it is below zero.
    pub fn is_negative(&self) -> bool {
        self.parts().map_or_else(|| self.long().is_negative(), |(numerator, _)| numerator < 0)
    }

    /// |a|.
    pub fn abs(&self) -> Rational {
        if self.is_negative() { -self } else { self.clone() }
    }

    /// 1/a of a number that is not zero.
    pub fn recip(&self) -> Rational {
        self.as_fraction()
            .map_or_else(|| Rational::from(self.long().recip()), |fraction| Rational::short(fraction.recip()))
    }

    /// The largest integer that is not above it.
    pub fn floor(&self) -> Rational {
        // not `Ratio::floor`, which overflows next to the least machine word
        self.parts().map_or_else(|| Rational::from(self.long().floor()), |(n, d)| integer(n.div_euclid(d)))
    }

    /// aⁿ; a is not zero where n is negative.
    pub(crate) fn power(&self, exponent: i32) -> Rational {
        match exponent {
            0 => Rational::one(),
            1 => self.clone(),
            _ => Rational::from(Pow::pow(&self.long(), exponent)),
        }
    }

    /// The nearest floating-point number.
    pub fn to_f64(&self) -> f64 {
        self.long().to_f64().unwrap_or(f64::NAN)
    }
}

impl From<BigRational> for Rational {
    fn from(value: BigRational) -> Rational {
        match value.numer().to_i64().zip(value.denom().to_i64()) {
            Some((numerator, denominator)) if numerator != i64::MIN => {
                Rational::short(Ratio::new_raw(numerator, denominator))
            }
            _ => {
                let value = Rational(Size::Long(Box::new(value)));
                // digits meet digits in products and in lowest terms
                work::spend(1 + value.digits() * value.digits() / 8);
                value
            }
        }
    }
}

impl Zero for Rational {
    fn zero() -> Rational {
        Rational::short(Ratio::ZERO)
    }
    fn is_zero(&self) -> bool {
        self.as_fraction().is_some_and(|fraction| fraction.is_zero())
    }
}

impl One for Rational {
    fn one() -> Rational {
        Rational::short(Ratio::ONE)
    }
    fn is_one(&self) -> bool {
        self.as_fraction().is_some_and(|fraction| fraction.is_one())
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Rational) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Rational) -> Ordering {
        match (&self.0, &other.0) {
            (Size::Short(a), Size::Short(b)) => a.cmp(b),
            _ => self.long().cmp(&other.long()),
        }
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Size::Short(fraction) => fraction.fmt(f),
            Size::Long(value) => value.fmt(f),
        }
    }
}

impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        self.as_fraction().map_or_else(|| Rational::from(-self.long()), |fraction| Rational::short(-fraction))
    }
}

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        -&self
    }
}

impl Sub for &Rational {
    type Output = Rational;
    fn sub(self, other: &Rational) -> Rational {
        self + &-other
    }
}

impl Div for &Rational {
    type Output = Rational;
    fn div(self, other: &Rational) -> Rational {
        product(self, &other.recip())
    }
}

/// The operators that fractions of machine words have, where the result fits.
macro_rules! checked {
    ($($operator:ident $function:ident $checked:ident),*) => {$(
        impl $operator for &Rational {
            type Output = Rational;
            fn $function(self, other: &Rational) -> Rational {
                let short = self.as_fraction().zip(other.as_fraction()).and_then(|(a, b)| a.$checked(&b));
                let short = short.filter(|fraction| *fraction.numer() != i64::MIN);
                short.map_or_else(|| Rational::from(self.long().$function(other.long())), Rational::short)
            }
        }
    )*};
}

checked!(Add add checked_add, Mul mul checked_mul);

/// The operators on values, by those on references.
macro_rules! by_reference {
    ($($operator:ident $function:ident),*) => {$(
        impl $operator for Rational {
            type Output = Rational;
            fn $function(self, other: Rational) -> Rational {
                $operator::$function(&self, &other)
            }
        }

        impl $operator<&Rational> for Rational {
            type Output = Rational;
            fn $function(self, other: &Rational) -> Rational {
                $operator::$function(&self, other)
            }
        }
    )*};
}

by_reference!(Add add, Sub sub, Mul mul, Div div);

/// The assignments, by the operators.
macro_rules! assigned {
    ($($assignment:ident $function:ident: $operator:tt),*) => {$(
        impl $assignment for Rational {
            fn $function(&mut self, other: Rational) {
                *self = &*self $operator &other;
            }
        }

        impl $assignment<&Rational> for Rational {
            fn $function(&mut self, other: &Rational) {
                *self = &*self $operator other;
            }
        }
    )*};
}

assigned!(AddAssign add_assign: +, SubAssign sub_assign: -, MulAssign mul_assign: *);

impl Sum for Rational {
    fn sum<I: Iterator<Item = Rational>>(terms: I) -> Rational {
        terms.fold(Rational::zero(), |sum, term| sum + term)
    }
}
