//! Natural numbers of any size: numerators and denominators that are no machine words.

use std::cmp::Ordering;
use std::fmt;

/// A natural number: its digits to the base 2⁶⁴, from the least to the greatest, which is not zero.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Natural(Vec<u64>);

impl Natural {
    fn new(mut digits: Vec<u64>) -> Natural {
        while digits.last() == Some(&0) {
            digits.pop();
        }
        Natural(digits)
    }

    /// Whether it is 1.
    pub fn is_one(&self) -> bool {
        self.0[..] == [1]
    }

    /// The number, if it is a machine word with a sign.
    pub fn word(&self) -> Option<i64> {
        i64::try_from(self.wide()?).ok()
    }

    /// The number, if it fits into two machine words with a sign.
    pub fn wide(&self) -> Option<i128> {
        match self.0[..] {
            [] => Some(0),
            [low] => Some(low.into()),
            [low, high] => i128::try_from(u128::from(high) << 64 | u128::from(low)).ok(),
            _ => None,
        }
    }

    /// The number of its binary digits.
    pub fn bits(&self) -> usize {
        self.0.last().map_or(0, |top| 64 * self.0.len() - top.leading_zeros() as usize)
    }

    /// a + b.
    pub fn plus(&self, other: &Natural) -> Natural {
        let (mut sum, other) = if self.0.len() < other.0.len() { (other.clone(), self) } else { (self.clone(), other) };
        sum.0.push(0);
        add_product(&mut sum.0, 1, &other.0);
        Natural::new(sum.0)
    }

    /// a − b of a number b that is not above a.
    pub fn minus(&self, other: &Natural) -> Natural {
        let mut rest = self.0.clone();
        subtract_product(&mut rest, 1, &other.0);
        Natural::new(rest)
    }

    /// a·b.
    pub fn times(&self, other: &Natural) -> Natural {
        let mut digits = vec![0; self.0.len() + other.0.len()];
        let factors = self.0.as_slice();
        let mut k = 0;
        while k < factors.len() {
            add_product(&mut digits[k..], factors[k], &other.0);
            k += 1;
        }
        Natural::new(digits)
    }

    /// aⁿ.
    pub fn power(&self, mut exponent: u32) -> Natural {
        let mut square = self.clone();
        let mut power = Natural::from(1);
        while exponent > 0 {
            if exponent % 2 == 1 {
                power = power.times(&square);
            }
            exponent /= 2;
            if exponent > 0 {
                square = square.times(&square);
            }
        }
        power
    }

    /// a·2ⁿ.
    pub fn shifted(&self, bits: usize) -> Natural {
        let mut power = vec![0; bits / 64];
        power.push(1 << (bits % 64));
        self.times(&Natural(power))
    }

    /// Quotient and remainder of the division by a number that is not zero.
    ///
    /// Source: Knuth, The Art of Computer Programming, volume 2, section 4.3.1, algorithm D.
    pub fn divided(&self, divisor: &Natural) -> (Natural, Natural) {
        if self < divisor {
            return (Natural::from(0), self.clone());
        }
        // with a leading digit of at least 2⁶³, the guess of a digit of the quotient is at most 2 too large
        let shift = divisor.bits().wrapping_neg() % 64;
        let divisor = divisor.shifted(shift).0;
        let mut rest = self.shifted(shift).0;
        rest.push(0);
        let length = divisor.len();
        let leading = u128::from(divisor[length - 1]);
        let mut quotient = vec![0; rest.len() - length];
        for (k, digit) in quotient.iter_mut().enumerate().rev() {
            let rest = &mut rest[k..=k + length];
            let above = u128::from(rest[length]) << 64 | u128::from(rest[length - 1]);
            *digit = u64::try_from(above / leading).unwrap_or(u64::MAX);
            let mut is_negative = subtract_product(rest, *digit, &divisor);
            while is_negative {
                *digit -= 1;
                is_negative = !add_product(rest, 1, &divisor);
            }
        }
        for k in 0..length {
            rest[k] = ((u128::from(rest[k + 1]) << 64 | u128::from(rest[k])) >> shift) as u64;
        }
        rest.truncate(length);
        (Natural::new(quotient), Natural::new(rest))
    }

    /// The greatest common divisor, by Euclid's algorithm.
    pub fn common_divisor(&self, other: &Natural) -> Natural {
        if self.is_one() || other.is_one() {
            return Natural::from(1);
        }
        let (mut a, mut b) = (self.clone(), other.clone());
        while !b.0.is_empty() {
            if let (Some(a), Some(b)) = (a.wide(), b.wide()) {
                let (mut a, mut b) = (a.unsigned_abs(), b.unsigned_abs());
                while b != 0 {
                    (a, b) = (b, a % b);
                }
                return Natural::from(a);
            }
            let (_, remainder) = a.divided(&b);
            a = std::mem::replace(&mut b, remainder);
        }
        a
    }

    /// The nearest floating-point number to a/b, where b is not zero.
    pub fn ratio(&self, divisor: &Natural) -> f64 {
        let (above, below) = (self.bits() as i32, divisor.bits() as i32);
        if self.0.is_empty() || above - below < f64::MIN_EXP - 55 {
            return 0.0;
        }
        // the quotient has 55 or 56 bits, or fewer where the result is subnormal; the last one tells whether more follow
        let exponent = (above - below).max(f64::MIN_EXP) - 55;
        let (numerator, denominator) =
            (self.shifted(0.max(-exponent) as usize), divisor.shifted(0.max(exponent) as usize));
        let (quotient, remainder) = numerator.divided(&denominator);
        let mut quotient = quotient.0.first().copied().unwrap_or(0);
        quotient |= u64::from(!remainder.0.is_empty());
        // a subnormal result is a multiple of the least one, which is four units of the quotient
        if quotient >> 54 == 0 {
            let (whole, part) = (quotient >> 2, quotient & 3);
            let rounded = whole + u64::from(part > 2 || (part == 2 && whole % 2 == 1));
            return f64::from_bits(rounded);
        }
        let half = exponent / 2;
        quotient as f64 * 2_f64.powi(half) * 2_f64.powi(exponent - half)
    }
}

impl From<u128> for Natural {
    fn from(value: u128) -> Natural {
        Natural::new(vec![value as u64, (value >> 64) as u64])
    }
}

impl PartialOrd for Natural {
    fn partial_cmp(&self, other: &Natural) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Natural {
    fn cmp(&self, other: &Natural) -> Ordering {
        self.0.len().cmp(&other.0.len()).then_with(|| self.0.iter().rev().cmp(other.0.iter().rev()))
    }
}

impl fmt::Display for Natural {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.wide() {
            Some(number) => write!(f, "{number}"),
            None => {
                let (above, below) = self.divided(&Natural::from(10_u128.pow(18)));
                write!(f, "{above}{:018}", below.wide().unwrap_or(0))
            }
        }
    }
}

/// Adds factor·digits to a sum that has as many digits or more, and says whether its last digit overflows.
fn add_product(sum: &mut [u64], factor: u64, digits: &[u64]) -> bool {
    let (mut carry, mut k) = (0, 0);
    while k < sum.len() && (k < digits.len() || carry != 0) {
        let digit = if k < digits.len() { digits[k] } else { 0 };
        let value = factor as u128 * digit as u128 + sum[k] as u128 + carry;
        sum[k] = value as u64;
        carry = value >> 64;
        k += 1;
    }
    carry != 0
}

/// Subtracts factor·digits from a number that has as many digits or more, and says whether the difference is negative.
fn subtract_product(rest: &mut [u64], factor: u64, digits: &[u64]) -> bool {
    let (mut carry, mut k) = (0, 0);
    while k < rest.len() && (k < digits.len() || carry != 0) {
        let digit = if k < digits.len() { digits[k] } else { 0 };
        let value = factor as u128 * digit as u128 + carry;
        let (difference, is_below) = rest[k].overflowing_sub(value as u64);
        rest[k] = difference;
        carry = (value >> 64) + is_below as u128;
        k += 1;
    }
    carry != 0
}
