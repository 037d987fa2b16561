//! Exact rational numbers that can be copied: what literals are evaluated with. A number too large to be held is no number.

use clebsch_symbolic::{Analytic, Function, Matrix, Number, Rational, Shape};

/// numerator/denominator in lowest terms with a positive denominator, or `None` where that overflows or divides by 0.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub(super) struct Exact(Option<(i128, i128)>);

impl Exact {
    /// No number.
    pub const UNKNOWN: Exact = Exact(None);

    fn reduced(numerator: Option<i128>, denominator: Option<i128>) -> Exact {
        let lowest = |(n, d): (i128, i128)| {
            let divisor = greatest_common_divisor(n.unsigned_abs(), d.unsigned_abs());
            let divisor = i128::try_from(divisor).ok().filter(|divisor| *divisor > 0)?;
            let sign = if d < 0 { -1 } else { 1 };
            Some((sign * n / divisor, sign * d / divisor))
        };
        // the ends of the range have no negative
        let fits = |(n, d): &(i128, i128)| *d != 0 && *n != i128::MIN && *d != i128::MIN;
        Exact(numerator.zip(denominator).filter(fits).and_then(lowest))
    }

    /// The number, if it could be held.
    pub fn rational(self) -> Option<Rational> {
        self.0.map(|(numerator, denominator)| Rational::new(numerator, denominator))
    }
}

fn greatest_common_divisor(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl Number for Exact {
    fn from_rational(value: &Rational) -> Exact {
        match value.parts() {
            Some((numerator, denominator)) => Exact(Some((numerator.into(), denominator.into()))),
            None => Exact::reduced(i128::try_from(value.numer()).ok(), i128::try_from(value.denom()).ok()),
        }
    }

    fn from_integer(value: i64) -> Exact {
        Exact(Some((value.into(), 1)))
    }

    fn add(self, other: Exact) -> Exact {
        let sum = self.0.zip(other.0).map(|((a, b), (c, d))| {
            let numerator = a.checked_mul(d).zip(c.checked_mul(b)).and_then(|(left, right)| left.checked_add(right));
            Exact::reduced(numerator, b.checked_mul(d))
        });
        sum.unwrap_or(Exact(None))
    }

    fn multiply(self, other: Exact) -> Exact {
        let product = self.0.zip(other.0).map(|((a, b), (c, d))| Exact::reduced(a.checked_mul(c), b.checked_mul(d)));
        product.unwrap_or(Exact(None))
    }

    fn reciprocal(self) -> Exact {
        self.0.map_or(Exact(None), |(numerator, denominator)| Exact::reduced(Some(denominator), Some(numerator)))
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
