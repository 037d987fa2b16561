//! The numbers in which equations are evaluated: exact rational numbers that can be copied, and truncated power series.
//! The latter give the change of a formula along a curve.

use clebsch_symbolic::{Analytic, Function, Matrix, Number, Rational, Shape};

/// The elementary functions of numbers that have none, all of the same value.
macro_rules! without_functions {
    ($none:expr) => {
        fn fractional_power(self, _: (i64, i64)) -> Self {
            $none
        }

        fn function(self, _: Function) -> Self {
            $none
        }

        fn analytic(_: Analytic, argument: &Matrix<Self>) -> Matrix<Self> {
            Matrix::from_fn(argument.shape, |_| $none)
        }

        fn opaque(_: &str, _: usize, _: &[&Matrix<Self>], shape: Shape) -> Matrix<Self> {
            Matrix::from_fn(shape, |_| $none)
        }

        fn pi() -> Self {
            $none
        }
    };
}

/// A rational number, or `None` where it does not fit or something is divided by 0.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub(super) struct Exact(Option<(i128, i128)>);

impl Exact {
    /// The number, if it fits.
    pub fn rational(self) -> Option<Rational> {
        self.0.map(|(numerator, denominator)| Rational::new(numerator, denominator))
    }

    fn of(self, other: Exact, operation: impl Fn(Rational, Rational) -> Rational) -> Exact {
        Exact(self.rational().zip(other.rational()).and_then(|(a, b)| operation(a, b).wide_parts()))
    }
}

impl Number for Exact {
    fn from_rational(value: &Rational) -> Exact {
        Exact(value.wide_parts())
    }

    fn from_integer(value: i64) -> Exact {
        Exact(Some((value.into(), 1)))
    }

    fn add(self, other: Exact) -> Exact {
        self.of(other, |a, b| a + b)
    }

    fn multiply(self, other: Exact) -> Exact {
        self.of(other, |a, b| a * b)
    }

    fn reciprocal(self) -> Exact {
        Exact(self.rational().filter(|value| !value.is_zero()).and_then(|value| value.recip().wide_parts()))
    }

    without_functions!(Exact(None));
}

/// c_0 + c_1 s + … + c_{N−1} s^{N−1}.
#[derive(Copy, Clone, Debug)]
pub(super) struct Series<K, const N: usize>(pub [K; N]);

/// The search for pivots compares with zero; a pivot is a series that can be inverted, whose value at s = 0 is not zero.
impl<K: Number, const N: usize> PartialEq for Series<K, N> {
    fn eq(&self, other: &Self) -> bool {
        self.0[0] == other.0[0]
    }
}

impl<K: Number, const N: usize> Series<K, N> {
    fn constant(value: K) -> Self {
        let zero = K::from_integer(0);
        Series(std::array::from_fn(|k| if k == 0 { value } else { zero }))
    }
}

impl<K: Number, const N: usize> Number for Series<K, N> {
    fn from_rational(value: &Rational) -> Self {
        Series::constant(K::from_rational(value))
    }

    fn add(self, other: Self) -> Self {
        Series(std::array::from_fn(|k| self.0[k].add(other.0[k])))
    }

    fn vanishes(self) -> bool {
        self.0.iter().all(|coefficient| coefficient.vanishes())
    }

    fn multiply(self, other: Self) -> Self {
        let zero = K::from_integer(0);
        Series(std::array::from_fn(|k| (0..=k).fold(zero, |sum, i| sum.add(self.0[i].multiply(other.0[k - i])))))
    }

    /// b_0 = 1/a_0, b_k = −(a_1 b_{k−1} + … + a_k b_0)/a_0.
    fn reciprocal(self) -> Self {
        let zero = K::from_integer(0);
        let (first, minus) = (self.0[0].reciprocal(), K::from_integer(-1));
        let mut inverse = [zero; N];
        inverse[0] = first;
        for k in 1..N {
            let sum = (1..=k).fold(zero, |sum, i| sum.add(self.0[i].multiply(inverse[k - i])));
            inverse[k] = minus.multiply(first).multiply(sum);
        }
        Series(inverse)
    }

    // by construction: the formulas that are followed along a curve are rational
    without_functions!(Series::constant(K::from_integer(0)));
}
