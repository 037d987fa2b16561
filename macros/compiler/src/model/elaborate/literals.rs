//! Numbers: exact rationals, whatever the notation.

use clebsch_symbolic::{Rational, integer, rational};
use syn::{ExprLit, Lit};

use super::super::value::Value;
use super::Elaborator;
use crate::diagnostic::refuse;

/// Digits of a literal, and the size of its decimal exponent: f64 ends at 1e308.
const DIGITS: usize = 400;

impl<'g> Elaborator<'_, '_, 'g> {
    /// A literal.
    pub(super) fn literal(&mut self, literal: &ExprLit) -> Option<Value<'g>> {
        let (digits, suffix) = match &literal.lit {
            Lit::Int(number) => (number.base10_digits(), number.suffix()),
            Lit::Float(number) => (number.base10_digits(), number.suffix()),
            other => refuse!(self, other, "the only literals are numbers"; help "remove it"),
        };
        if !suffix.is_empty() {
            refuse!(self, literal, "the suffix `{suffix}` has no meaning here";
                help "write `{digits}`";
                note "numbers are exact; the scalar of the system is that of its fields");
        }
        let Some(value) = decimal(digits) else {
            refuse!(self, literal, "this number is beyond the range of `f64`"; help "choose units in which it is smaller");
        };
        Some(Value::Matrix(self.graph().number(value)))
    }
}

/// The exact value of a decimal number, `6.67e-11`.
pub(super) fn decimal(text: &str) -> Option<Rational> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i64>().ok()?),
        None => (text, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent = exponent.checked_sub(fraction.len() as i64)?;
    if mantissa.len() > DIGITS || exponent.unsigned_abs() > 2 * DIGITS as u64 {
        return None;
    }
    let ten = integer(10);
    let mut value = integer(0);
    for digit in whole.chars().chain(fraction.chars()) {
        value = value * &ten + integer(i64::from(digit.to_digit(10)?));
    }
    let step = if exponent < 0 { rational(1, 10) } else { ten };
    Some((0..exponent.unsigned_abs()).fold(value, |value, _| value * &step))
}
