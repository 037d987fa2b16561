//! Numbers that count the iterations of the implicit equations that they are used in.

use clebsch::{Real, Scalar};
use num_traits::{One, Zero};
use std::cell::Cell;
use std::fmt::{self, Debug, Display, Formatter};
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

thread_local! {
    static ITERATIONS: Cell<u32> = const { Cell::new(0) };
}

/// The result of `work`, and the number of iterations for it in this thread.
pub fn iterations<R>(work: impl FnOnce() -> R) -> (R, u32) {
    ITERATIONS.set(0);
    let result = work();
    (result, ITERATIONS.get())
}

/// A number of type T, with all its bits, that counts iterations.
#[derive(Copy, Clone, Debug, PartialEq, PartialOrd)]
pub struct Counted<T>(pub T);

impl<T: Display> Display for Counted<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<T: Real> Zero for Counted<T> {
    fn zero() -> Self {
        Self(T::zero())
    }
    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
}

impl<T: Real> One for Counted<T> {
    fn one() -> Self {
        Self(T::one())
    }
}

impl<T: Real> Neg for Counted<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! arithmetic {
    ($($operator:ident $method:ident $assigner:ident $assign:ident;)*) => {$(
        impl<T: Real> $operator for Counted<T> {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                Self($operator::$method(self.0, other.0))
            }
        }
        impl<T: Real> $assigner for Counted<T> {
            #[inline]
            fn $assign(&mut self, other: Self) {
                *self = $operator::$method(*self, other);
            }
        }
    )*};
}
arithmetic! { Add add AddAssign add_assign; Sub sub SubAssign sub_assign; Mul mul MulAssign mul_assign; Div div DivAssign div_assign; }

macro_rules! functions {
    ($($method:ident)*) => {$(
        #[inline]
        fn $method(self) -> Self {
            Self(self.0.$method())
        }
    )*};
}

impl<T: Real> Scalar for Counted<T> {
    clebsch::one_number!();

    const EPSILON: Self = Self(T::EPSILON);
    const PI: Self = Self(T::PI);

    #[inline]
    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        Self(T::from_ratio(numerator, denominator))
    }
    #[inline]
    fn from_f64(value: f64) -> Self {
        Self(T::from_f64(value))
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self.0.to_f64()
    }
    #[inline]
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    #[inline]
    fn iterated() {
        ITERATIONS.set(ITERATIONS.get() + 1);
    }
    functions! { abs sqrt recip sin cos tan asin acos atan sinh cosh tanh exp ln }
    #[inline]
    fn powi(self, exponent: i32) -> Self {
        Self(self.0.powi(exponent))
    }
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        Self(self.0.powf(exponent.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clebsch::implicit::{Equation, solve};
    use nalgebra::{Matrix1, Vector1};

    /// x + x²/4 = μ
    struct Parabola;

    impl<T: Real> Equation<T, 1> for Parabola {
        type Terms = T;
        type Jacobian = Matrix1<T>;

        fn prepare(&self, target: &Vector1<T>) -> T {
            target.x
        }
        fn predict(&self, target: &Vector1<T>) -> Vector1<T> {
            *target
        }
        fn linearize(&self, target: &T, x: &Vector1<T>) -> (Vector1<T>, Matrix1<T>) {
            let quarter = T::from_ratio(1, 4);
            (Vector1::new(x.x + quarter * x.x * x.x - *target), Matrix1::new(T::one() + quarter * (x.x + x.x)))
        }
    }

    /// A body at rest takes one linearisation, a moving one takes more; the bits are those of plain numbers.
    #[test]
    fn iterations_are_counted() {
        let (rest, at_rest) = iterations(|| solve(&Parabola, &Vector1::new(Counted(0.0_f64))));
        let (moved, moving) = iterations(|| solve(&Parabola, &Vector1::new(Counted(0.25_f64))));
        assert_eq!((rest.map(|x| x.x.0), at_rest), (Ok(0.0), 1));
        assert!((2..=4).contains(&moving), "{moving}");
        assert_eq!(moved.map(|x| x.x.0), solve(&Parabola, &Vector1::new(0.25)).map(|x| x.x));
    }
}
