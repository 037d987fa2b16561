//! Exact rational numbers: the coefficients of every expression.

pub use num_rational::BigRational as Rational;
pub use num_traits::{One, Signed, Zero};

use num_bigint::BigInt;

/// The rational `numerator / denominator`; the denominator is not zero.
pub fn rational(numerator: i64, denominator: i64) -> Rational {
    Rational::new(BigInt::from(numerator), BigInt::from(denominator))
}

/// The rational that equals an integer.
pub fn integer(value: i64) -> Rational {
    Rational::from_integer(BigInt::from(value))
}

/// a·b. Most coefficients are ±1, and a product with one costs nothing.
pub fn product(a: &Rational, b: &Rational) -> Rational {
    match (a.is_one(), b.is_one()) {
        (true, _) => b.clone(),
        (_, true) => a.clone(),
        _ => a * b,
    }
}
