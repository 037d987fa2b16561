//! Fractions of machine words: exponents, and the coefficients that fit, which is nearly all of them.

use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, Mul, Neg};

/// numerator/denominator in lowest terms, with a positive denominator and a numerator that has a negative.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Debug)]
pub struct Fraction {
    pub(crate) numerator: i64,
    pub(crate) denominator: i64,
}

impl Fraction {
    pub(crate) const ZERO: Fraction = Fraction::integer(0);
    pub(crate) const ONE: Fraction = Fraction::integer(1);

    /// An integer above the least.
    pub(crate) const fn integer(value: i64) -> Fraction {
        Fraction { numerator: value, denominator: 1 }
    }

    /// numerator/denominator in lowest terms; `None` where the denominator is zero or the result does not fit.
    pub(crate) fn reduced(numerator: i128, denominator: i128) -> Option<Fraction> {
        let divisor = greatest_common_divisor(numerator.unsigned_abs(), denominator.unsigned_abs());
        let divisor = i128::try_from(divisor).ok().filter(|_| denominator != 0)?;
        let divisor = if denominator < 0 { -divisor } else { divisor };
        let numerator = i64::try_from(numerator / divisor).ok().filter(|numerator| *numerator != i64::MIN)?;
        Some(Fraction { numerator, denominator: i64::try_from(denominator / divisor).ok()? })
    }

    /// Numerator and denominator.
    pub fn parts(self) -> (i64, i64) {
        (self.numerator, self.denominator)
    }

    pub(crate) fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// Whether it is one.
    pub fn is_one(self) -> bool {
        self == Fraction::ONE
    }

    pub(crate) fn is_negative(self) -> bool {
        self.numerator < 0
    }

    /// The value, if it is whole.
    pub(crate) fn as_integer(self) -> Option<i64> {
        (self.denominator == 1).then_some(self.numerator)
    }

    /// The largest integer that is not above it.
    pub(crate) fn floor(self) -> i64 {
        self.numerator.div_euclid(self.denominator)
    }

    /// The reciprocal; `None` for zero.
    pub(crate) fn reciprocal(self) -> Option<Fraction> {
        let sign = self.numerator.signum();
        (sign != 0).then(|| Fraction { numerator: sign * self.denominator, denominator: sign * self.numerator })
    }

    /// a + b, where it fits.
    pub(crate) fn checked_add(self, other: Fraction) -> Option<Fraction> {
        if self.denominator == 1 && other.denominator == 1 {
            let sum = self.numerator.checked_add(other.numerator).filter(|sum| *sum != i64::MIN);
            return sum.map(Fraction::integer);
        }
        let (a, b) = (i128::from(self.numerator), i128::from(self.denominator));
        let (c, d) = (i128::from(other.numerator), i128::from(other.denominator));
        Fraction::reduced((a * d).checked_add(c * b)?, b * d)
    }

    /// a·b, where it fits.
    pub(crate) fn checked_mul(self, other: Fraction) -> Option<Fraction> {
        if self.denominator == 1 && other.denominator == 1 {
            let product = self.numerator.checked_mul(other.numerator).filter(|product| *product != i64::MIN);
            return product.map(Fraction::integer);
        }
        let numerator = i128::from(self.numerator) * i128::from(other.numerator);
        Fraction::reduced(numerator, i128::from(self.denominator) * i128::from(other.denominator))
    }
}

fn greatest_common_divisor(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl Neg for Fraction {
    type Output = Fraction;
    fn neg(self) -> Fraction {
        Fraction { numerator: -self.numerator, ..self }
    }
}

impl Add for Fraction {
    type Output = Fraction;
    fn add(self, other: Fraction) -> Fraction {
        // by construction: what is added without a check are exponents, which are small
        self.checked_add(other).expect("exponents are small")
    }
}

impl Mul for Fraction {
    type Output = Fraction;
    fn mul(self, other: Fraction) -> Fraction {
        // by construction: what is multiplied without a check are exponents, which are small
        self.checked_mul(other).expect("exponents are small")
    }
}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Fraction) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Fraction) -> Ordering {
        if self.denominator == other.denominator {
            return self.numerator.cmp(&other.numerator);
        }
        let left = i128::from(self.numerator) * i128::from(other.denominator);
        left.cmp(&(i128::from(other.numerator) * i128::from(self.denominator)))
    }
}

impl fmt::Display for Fraction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fraction { numerator, denominator } = self;
        if *denominator == 1 { numerator.fmt(f) } else { write!(f, "{numerator}/{denominator}") }
    }
}
