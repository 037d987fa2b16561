//! Exact rational numbers that can be copied: what literals are evaluated with. A number too large to be held is no number.

use clebsch_symbolic::{Analytic, CheckedAdd, CheckedMul, Function, Matrix, Number, Ratio, Rational, Shape, Zero};

/// A rational number, or `None` where it does not fit or something is divided by 0.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub(super) struct Exact(Option<Ratio<i128>>);

impl Exact {
    /// The number, if it could be held.
    pub fn rational(self) -> Option<Rational> {
        self.0.map(|value| Rational::new(*value.numer(), *value.denom()))
    }

    /// The least numerator has no negative.
    fn held(value: Option<Ratio<i128>>) -> Exact {
        Exact(value.filter(|value| *value.numer() != i128::MIN))
    }
}

impl Number for Exact {
    fn from_rational(value: &Rational) -> Exact {
        let parts = i128::try_from(value.numer()).ok().zip(i128::try_from(value.denom()).ok());
        Exact::held(parts.map(|(numerator, denominator)| Ratio::new_raw(numerator, denominator)))
    }

    fn from_integer(value: i64) -> Exact {
        Exact(Some(Ratio::from_integer(value.into())))
    }

    fn add(self, other: Exact) -> Exact {
        Exact::held(self.0.zip(other.0).and_then(|(a, b)| a.checked_add(&b)))
    }

    fn multiply(self, other: Exact) -> Exact {
        Exact::held(self.0.zip(other.0).and_then(|(a, b)| a.checked_mul(&b)))
    }

    fn reciprocal(self) -> Exact {
        Exact(self.0.filter(|value| !value.is_zero()).map(|value| value.recip()))
    }

    fn fractional_power(self, _: (i64, i64)) -> Exact {
        Exact(None)
    }

    fn function(self, _: Function) -> Exact {
        Exact(None)
    }

    fn analytic(_: Analytic, argument: &Matrix<Exact>) -> Matrix<Exact> {
        Matrix::from_fn(argument.shape, |_| Exact(None))
    }

    fn opaque(_: &str, _: usize, _: &[&Matrix<Exact>], shape: Shape) -> Matrix<Exact> {
        Matrix::from_fn(shape, |_| Exact(None))
    }

    fn pi() -> Exact {
        Exact(None)
    }
}
