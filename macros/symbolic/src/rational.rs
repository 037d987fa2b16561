//! Exact rational numbers: the coefficients of every expression.
//!
//! They may have any size, but nearly all of them are fractions of machine words, and these take neither heap nor long arithmetic.

use std::borrow::Cow;
use std::cmp::Ordering;
use std::fmt;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::natural::Natural;
use crate::{both, work};

/// A fraction of machine words in lowest terms: exponents, and the coefficients that fit. Its numerator has a negative.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Debug)]
pub struct Fraction {
    numerator: i64,
    denominator: i64,
}

impl Fraction {
    /// 0.
    pub const ZERO: Fraction = Fraction::integer(0);
    /// 1.
    pub const ONE: Fraction = Fraction::integer(1);

    const fn integer(numerator: i64) -> Fraction {
        Fraction { numerator, denominator: 1 }
    }

    /// The fraction `numerator / denominator`; the denominator is not zero.
    fn new(numerator: i64, denominator: i64) -> Fraction {
        if denominator == 1 {
            return Fraction { numerator, denominator };
        }
        let (mut a, mut b) = (numerator, denominator);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        let common = if (a < 0) == (denominator < 0) { a } else { -a };
        Fraction { numerator: numerator / common, denominator: denominator / common }
    }

    /// Numerator and denominator, which is positive.
    #[inline(always)]
    pub fn parts(self) -> (i64, i64) {
        (self.numerator, self.denominator)
    }

    /// Whether it is 0.
    #[inline(always)]
    pub fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// Whether it is 1.
    #[inline(always)]
    pub fn is_one(self) -> bool {
        self.numerator == 1 && self.denominator == 1
    }

    /// Whether it is an integer.
    #[inline(always)]
    pub fn is_integer(self) -> bool {
        self.denominator == 1
    }

    /// Whether it is below zero.
    pub fn is_negative(self) -> bool {
        self.numerator < 0
    }

    /// The largest integer that is not above it.
    pub fn floor(self) -> i64 {
        self.numerator.div_euclid(self.denominator)
    }

    fn recip(self) -> Fraction {
        let sign = self.numerator.signum();
        Fraction { numerator: sign * self.denominator, denominator: sign * self.numerator }
    }
}

impl Add for Fraction {
    type Output = Fraction;
    fn add(self, other: Fraction) -> Fraction {
        let sum = self.numerator * other.denominator + other.numerator * self.denominator;
        Fraction::new(sum, self.denominator * other.denominator)
    }
}

impl Mul for Fraction {
    type Output = Fraction;
    fn mul(self, other: Fraction) -> Fraction {
        Fraction::new(self.numerator * other.numerator, self.denominator * other.denominator)
    }
}

impl Neg for Fraction {
    type Output = Fraction;
    fn neg(self) -> Fraction {
        Fraction { numerator: -self.numerator, ..self }
    }
}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Fraction) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Fraction) -> Ordering {
        let crossed = |a: &Fraction, b: &Fraction| i128::from(a.numerator) * i128::from(b.denominator);
        crossed(self, other).cmp(&crossed(other, self))
    }
}

impl fmt::Display for Fraction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.parts() {
            (numerator, 1) => write!(f, "{numerator}"),
            (numerator, denominator) => write!(f, "{numerator}/{denominator}"),
        }
    }
}

/// A rational number of any size.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Rational(Size);

/// A number that fits into machine words is stored short, so that equal numbers are equal values.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
enum Size {
    Short(Fraction),
    Long(Box<Long>),
}

/// A fraction in lowest terms.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
struct Long {
    is_negative: bool,
    numerator: Natural,
    denominator: Natural,
}

/// The rational `numerator / denominator`; the denominator is not zero.
pub fn rational(numerator: i64, denominator: i64) -> Rational {
    Rational::new(numerator.into(), denominator.into())
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
        match (i64::try_from(numerator), i64::try_from(denominator)) {
            (Ok(numerator), Ok(denominator)) if numerator != i64::MIN && denominator != i64::MIN => {
                Rational::short(Fraction::new(numerator, denominator))
            }
            _ => {
                let is_negative = (numerator < 0) != (denominator < 0);
                Rational::of(is_negative, numerator.unsigned_abs().into(), denominator.unsigned_abs().into())
            }
        }
    }

    /// 0.
    pub fn zero() -> Rational {
        Rational::short(Fraction::ZERO)
    }

    /// 1.
    pub fn one() -> Rational {
        Rational::short(Fraction::ONE)
    }

    pub(crate) fn short(fraction: Fraction) -> Rational {
        Rational(Size::Short(fraction))
    }

    /// ±a/b, where b is not zero.
    fn of(is_negative: bool, numerator: Natural, denominator: Natural) -> Rational {
        let common = numerator.common_divisor(&denominator);
        if common.is_one() {
            return Rational::in_lowest_terms(Long { is_negative, numerator, denominator });
        }
        let [numerator, denominator] = both([numerator, denominator], |part| part.divided(&common).0);
        Rational::in_lowest_terms(Long { is_negative, numerator, denominator })
    }

    fn in_lowest_terms(value: Long) -> Rational {
        let value = Rational::fitted(value);
        if !matches!(value.0, Size::Short(_)) {
            // digits meet digits in products and in lowest terms
            work::spend(25 + value.digits() * value.digits() / 8);
        }
        value
    }

    fn fitted(value: Long) -> Rational {
        match (value.numerator.word(), value.denominator.word()) {
            (Some(numerator), Some(denominator)) => {
                let numerator = if value.is_negative { -numerator } else { numerator };
                Rational::short(Fraction { numerator, denominator })
            }
            _ => Rational(Size::Long(Box::new(value))),
        }
    }

    /// The value as a fraction of machine words, if it is one.
    #[inline(always)]
    pub(crate) fn as_fraction(&self) -> Option<Fraction> {
        match &self.0 {
            Size::Short(fraction) => Some(*fraction),
            Size::Long(_) => None,
        }
    }

    fn long(&self) -> Cow<'_, Long> {
        match &self.0 {
            Size::Short(fraction) => Cow::Owned(Long {
                is_negative: fraction.is_negative(),
                numerator: u128::from(fraction.numerator.unsigned_abs()).into(),
                denominator: u128::from(fraction.denominator.unsigned_abs()).into(),
            }),
            Size::Long(value) => Cow::Borrowed(value),
        }
    }

    /// Numerator and denominator, if they are machine words.
    pub fn parts(&self) -> Option<(i64, i64)> {
        self.as_fraction().map(Fraction::parts)
    }

    /// Numerator and denominator, if they fit into two machine words each.
    pub fn wide_parts(&self) -> Option<(i128, i128)> {
        let value = self.long();
        let numerator = value.numerator.wide()?;
        Some((if value.is_negative { -numerator } else { numerator }, value.denominator.wide()?))
    }

    /// The remainders of numerator and denominator in the division by a number.
    pub(crate) fn remainders(&self, modulus: u64) -> [u64; 2] {
        let value = self.long();
        let remainder = |part: &Natural| part.divided(&u128::from(modulus).into()).1.wide().unwrap_or(0) as u64;
        let above = remainder(&value.numerator);
        [if value.is_negative && above > 0 { modulus - above } else { above }, remainder(&value.denominator)]
    }

    /// The number of binary digits of numerator and denominator.
    pub fn bits(&self) -> usize {
        let value = self.long();
        value.numerator.bits() + value.denominator.bits()
    }

    /// The machine words that it takes in addition to one for each part.
    pub(crate) fn digits(&self) -> usize {
        if matches!(self.0, Size::Short(_)) { 0 } else { self.bits() / 64 }
    }

    /// The numerator in lowest terms.
    pub fn numer(&self) -> Rational {
        Rational::fitted(Long { denominator: 1.into(), ..self.long().into_owned() })
    }

    /// The denominator in lowest terms, positive.
    pub fn denom(&self) -> Rational {
        let numerator = self.long().into_owned().denominator;
        Rational::fitted(Long { is_negative: false, numerator, denominator: 1.into() })
    }

    /// Whether it is 0.
    #[inline(always)]
    pub fn is_zero(&self) -> bool {
        matches!(&self.0, Size::Short(fraction) if fraction.is_zero())
    }

    /// Whether it is 1.
    #[inline(always)]
    pub fn is_one(&self) -> bool {
        matches!(&self.0, Size::Short(fraction) if fraction.is_one())
    }

    /// Whether it is an integer.
    pub fn is_integer(&self) -> bool {
        match &self.0 {
            Size::Short(fraction) => fraction.is_integer(),
            Size::Long(value) => value.denominator.word() == Some(1),
        }
    }

    /// Whether it is below zero.
    pub fn is_negative(&self) -> bool {
        match &self.0 {
            Size::Short(fraction) => fraction.is_negative(),
            Size::Long(value) => value.is_negative,
        }
    }

    /// |a|.
    pub fn abs(&self) -> Rational {
        if self.is_negative() { -self } else { self.clone() }
    }

    /// 1/a of a number that is not zero.
    pub fn recip(&self) -> Rational {
        match &self.0 {
            Size::Short(fraction) => Rational::short(fraction.recip()),
            Size::Long(_) => {
                let Long { is_negative, numerator, denominator } = self.long().into_owned();
                Rational::in_lowest_terms(Long { is_negative, numerator: denominator, denominator: numerator })
            }
        }
    }

    /// The largest integer that is not above it.
    pub fn floor(&self) -> Rational {
        match &self.0 {
            Size::Short(fraction) => integer(fraction.floor()),
            Size::Long(value) => {
                let (whole, remainder) = value.numerator.divided(&value.denominator);
                let is_above = value.is_negative && remainder.word() != Some(0);
                let numerator = if is_above { whole.plus(&1.into()) } else { whole };
                let denominator = 1.into();
                Rational::in_lowest_terms(Long { is_negative: value.is_negative, numerator, denominator })
            }
        }
    }

    /// aⁿ; a is not zero where n is negative.
    pub(crate) fn power(&self, exponent: i32) -> Rational {
        if exponent == 1 {
            return self.clone();
        }
        if exponent == -1 {
            return self.recip();
        }
        let Long { is_negative, numerator, denominator } = self.long().into_owned();
        let [numerator, denominator] = both([numerator, denominator], |part| part.power(exponent.unsigned_abs()));
        let is_negative = is_negative && exponent % 2 != 0;
        let power = Long { is_negative, numerator, denominator };
        if exponent < 0 { Rational::fitted(power).recip() } else { Rational::in_lowest_terms(power) }
    }

    /// The nearest floating-point number.
    pub fn to_f64(&self) -> f64 {
        let is_exact = |part: i64| part.unsigned_abs() <= 1 << f64::MANTISSA_DIGITS;
        match self.parts() {
            Some((numerator, denominator)) if is_exact(numerator) && is_exact(denominator) => {
                numerator as f64 / denominator as f64
            }
            _ => {
                let value = self.long();
                let magnitude = value.numerator.ratio(&value.denominator);
                if value.is_negative { -magnitude } else { magnitude }
            }
        }
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Rational) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Rational) -> Ordering {
        if let (Size::Short(a), Size::Short(b)) = (&self.0, &other.0) {
            return a.cmp(b);
        }
        let (a, b) = (self.long(), other.long());
        let magnitudes = a.numerator.times(&b.denominator).cmp(&b.numerator.times(&a.denominator));
        match (a.is_negative, b.is_negative) {
            (false, false) => magnitudes,
            (true, true) => magnitudes.reverse(),
            (a, b) => b.cmp(&a),
        }
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Size::Short(fraction) => fraction.fmt(f),
            Size::Long(value) => {
                write!(f, "{}{}", if value.is_negative { "-" } else { "" }, value.numerator)?;
                if self.is_integer() { Ok(()) } else { write!(f, "/{}", value.denominator) }
            }
        }
    }
}

impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        match &self.0 {
            Size::Short(fraction) => Rational::short(-*fraction),
            Size::Long(value) => {
                Rational::in_lowest_terms(Long { is_negative: !value.is_negative, ..(**value).clone() })
            }
        }
    }
}

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        -&self
    }
}

impl Add for &Rational {
    type Output = Rational;
    fn add(self, other: &Rational) -> Rational {
        if let (Size::Short(a), Size::Short(b)) = (&self.0, &other.0) {
            if let (1, 1, Some(sum)) = (a.denominator, b.denominator, a.numerator.checked_add(b.numerator))
                && sum != i64::MIN
            {
                return Rational::short(Fraction::integer(sum));
            }
            let crossed = |a: &Fraction, b: &Fraction| i128::from(a.numerator) * i128::from(b.denominator);
            // below 2¹²⁷
            return Rational::new(crossed(a, b) + crossed(b, a), i128::from(a.denominator) * i128::from(b.denominator));
        }
        let (a, b) = (self.long(), other.long());
        let (left, right) = (a.numerator.times(&b.denominator), b.numerator.times(&a.denominator));
        let (is_negative, sum) = match left.cmp(&right) {
            _ if a.is_negative == b.is_negative => (a.is_negative, left.plus(&right)),
            Ordering::Less => (b.is_negative, right.minus(&left)),
            _ => (a.is_negative, left.minus(&right)),
        };
        Rational::of(is_negative, sum, a.denominator.times(&b.denominator))
    }
}

impl Mul for &Rational {
    type Output = Rational;
    fn mul(self, other: &Rational) -> Rational {
        if let (Size::Short(a), Size::Short(b)) = (&self.0, &other.0) {
            if let (1, 1, Some(product)) = (a.denominator, b.denominator, a.numerator.checked_mul(b.numerator))
                && product != i64::MIN
            {
                return Rational::short(Fraction::integer(product));
            }
            let numerator = i128::from(a.numerator) * i128::from(b.numerator);
            return Rational::new(numerator, i128::from(a.denominator) * i128::from(b.denominator));
        }
        let (a, b) = (self.long(), other.long());
        let is_negative = a.is_negative != b.is_negative;
        Rational::of(is_negative, a.numerator.times(&b.numerator), a.denominator.times(&b.denominator))
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
