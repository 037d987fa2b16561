//! Dual numbers of the crate `num-dual` as scalars: a simulation is differentiated by parameters, step size and initial data.
//!
//! Comparisons look at the values alone: a step goes as without derivatives. Iterations go on until derivatives are right, [`Scalar::DERIVATIVES`].

use crate::Scalar;
use nalgebra::Const;
use num_dual::{Derivative, Dual, Dual2, Dual2Vec, Dual3, DualNum, DualVec, HyperDual};

/// Functions by the method of the same name of a dual number.
macro_rules! elementary {
    ($($method:ident)*) => {$(
        #[inline]
        fn $method(self) -> Self {
            DualNum::$method(&self)
        }
    )*};
}

/// One implementation for each type: the order of its derivatives, and these derivatives as they are in a constant.
macro_rules! duals {
    ($([$($parameter:tt)*] $dual:ident<$($argument:ty),*>, $order:literal, $($name:ident: $zero:expr),*;)*) => {$(
        impl<$($parameter)*> Scalar for $dual<$($argument),*> {
            crate::one_number!();

            const DERIVATIVES: u32 = $order;
            const EPSILON: Self = $dual { re: f64::EPSILON, $($name: $zero),* };
            const PI: Self = $dual { re: core::f64::consts::PI, $($name: $zero),* };

            #[inline]
            fn from_ratio(numerator: i64, denominator: i64) -> Self {
                <f64 as Scalar>::from_ratio(numerator, denominator).into()
            }
            #[inline]
            fn from_f64(value: f64) -> Self {
                value.into()
            }
            #[inline]
            fn to_f64(self) -> f64 {
                self.re
            }
            #[inline]
            fn is_finite(self) -> bool {
                self.re.is_finite() $(&& self.$name.all(f64::is_finite))*
            }
            #[inline]
            fn abs(self) -> Self {
                if self.re < 0.0 { -self } else { self }
            }
            #[inline]
            fn powf(self, exponent: Self) -> Self {
                let is_constant = true $(&& exponent.$name.all(|part| part == 0.0))*;
                if is_constant { DualNum::powf(&self, exponent.re) } else { self.powd(exponent) }
            }
            #[inline]
            fn powi(self, exponent: i32) -> Self {
                DualNum::powi(&self, exponent)
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                DualNum::sin_cos(&self)
            }
            elementary!(sqrt recip sin cos tan asin acos atan sinh cosh tanh exp ln);
        }
    )*};
}

/// Numbers, or the entries of a matrix of derivatives; a constant has no such matrix.
trait Parts {
    /// Whether all of them pass.
    fn all(&self, pass: impl Fn(f64) -> bool) -> bool;
}

impl Parts for f64 {
    fn all(&self, pass: impl Fn(f64) -> bool) -> bool {
        pass(*self)
    }
}

impl<const R: usize, const C: usize> Parts for Derivative<f64, Const<R>, Const<C>> {
    fn all(&self, pass: impl Fn(f64) -> bool) -> bool {
        self.0.as_ref().is_none_or(|matrix| matrix.iter().all(|&part| pass(part)))
    }
}

duals! {
    [] Dual<f64>, 1, eps: 0.0;
    [] Dual2<f64>, 2, v1: 0.0, v2: 0.0;
    [] Dual3<f64>, 3, v1: 0.0, v2: 0.0, v3: 0.0;
    [] HyperDual<f64>, 2, eps1: 0.0, eps2: 0.0, eps1eps2: 0.0;
    [const N: usize] DualVec<f64, Const<N>>, 1, eps: Derivative(None);
    [const N: usize] Dual2Vec<f64, Const<N>>, 2, v1: Derivative(None), v2: Derivative(None);
}
