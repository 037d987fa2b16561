//! Numbers of 106 bits, 32 digits: the unevaluated sum of two `f64`.
//!
//! The algorithms are those of Dekker (1971). Those of Joldeș, Muller and Popescu are in *Tight and rigorous error bounds
//! for basic building blocks of double-word arithmetic*, 2017. Each has a relative error of a few units of 2⁻¹⁰⁶ ≈ 1.2e-32.
//! The functions are Taylor series.

use std::f64::consts::{FRAC_PI_2, LN_2};
use std::num::ParseFloatError;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::str::FromStr;

use super::real::Real;

/// high + low, where |low| is at most half a unit in the last place of high.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

const PI_HALVES: DoubleDouble = DoubleDouble { high: FRAC_PI_2, low: 6.123_233_995_736_766e-17 };
const LN_TWO: DoubleDouble = DoubleDouble { high: LN_2, low: 2.319_046_813_846_299_6e-17 };

/// a + b exactly, for |a| ≥ |b|.
fn ordered_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// a + b exactly.
fn sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let b_part = high - a;
    DoubleDouble { high, low: (a - (high - b_part)) + (b - b_part) }
}

/// a in two halves of at most 26 bits, whose products are exact.
fn halves(a: f64) -> (f64, f64) {
    let scaled = 134_217_729.0 * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

/// ab exactly, below the magnitude 2⁹⁹⁶.
fn product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    DoubleDouble { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let carried = ordered_sum(high.high, high.low + low.high);
        ordered_sum(carried.high, low.low + carried.low)
    }
}
impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        DoubleDouble { high: -self.high, low: -self.low }
    }
}
impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}
impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let exact = product(self.high, other.high);
        ordered_sum(exact.high, exact.low + (self.high * other.low + self.low * other.high))
    }
}
impl Mul<f64> for DoubleDouble {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        let exact = product(self.high, other);
        ordered_sum(exact.high, exact.low + self.low * other)
    }
}
impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let second = (self - other * first).high / other.high;
        let third = (self - other * first - other * second).high / other.high;
        ordered_sum(first, second) + Self::of(third)
    }
}

impl DoubleDouble {
    /// (sin x, cos x): the remainder of x after quarter turns, then both series at once.
    fn sine_and_cosine(self) -> (Self, Self) {
        let turns = (self.high / FRAC_PI_2).round();
        let x = self - PI_HALVES * turns;
        let (mut term, mut sine, mut cosine) = (Self::one(), Self::zero(), Self::one());
        for n in 1..=30 {
            term = term * x / Self::of(f64::from(n));
            match n % 4 {
                0 => cosine = cosine + term,
                1 => sine = sine + term,
                2 => cosine = cosine - term,
                _ => sine = sine - term,
            }
        }
        match turns.rem_euclid(4.0) as u8 {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }
}

impl Real for DoubleDouble {
    const LAST_CORRECTION: f64 = 1e-20;

    fn of(value: f64) -> Self {
        DoubleDouble { high: value, low: 0.0 }
    }
    fn to_f64(self) -> f64 {
        self.high
    }
    fn size(self) -> f64 {
        self.high.abs()
    }
    fn sqrt(self) -> Self {
        let root = Self::of(self.high.sqrt());
        if self.high == 0.0 { root } else { (root + self / root) * 0.5 }
    }
    fn sin(self) -> Self {
        self.sine_and_cosine().0
    }
    fn cos(self) -> Self {
        self.sine_and_cosine().1
    }
    fn exp(self) -> Self {
        let doublings = (self.high / LN_2).round();
        let x = self - LN_TWO * doublings;
        let (mut term, mut sum) = (Self::one(), Self::one());
        for n in 1..=30 {
            term = term * x / Self::of(f64::from(n));
            sum = sum + term;
        }
        sum * doublings.exp2()
    }
    fn ln(self) -> Self {
        let near = Self::of(self.high.ln());
        near + (self * (-near).exp() - Self::one())
    }
}

/// Decimal digits, such as those of a computation with 60 digits.
impl FromStr for DoubleDouble {
    type Err = ParseFloatError;

    fn from_str(text: &str) -> Result<Self, ParseFloatError> {
        let nearest: f64 = text.parse()?;
        if !nearest.is_finite() {
            return Ok(Self::of(nearest));
        }
        let (digits, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
        let ten = Self::of(10.0);
        let digit = |number: Self, digit: u32| number * ten + Self::of(f64::from(digit));
        let number = digits.chars().filter_map(|c| c.to_digit(10)).fold(Self::zero(), digit);
        let shift = exponent.parse::<i32>().unwrap_or(0) - decimals;
        let scale = ten.power(shift.unsigned_abs());
        let number = if shift < 0 { number / scale } else { number * scale };
        Ok(if digits.starts_with('-') { -number } else { number })
    }
}
