//! Dual numbers with K directions: exact derivatives of whatever is computed with them.

use clebsch::Scalar;
use num_traits::{One, Zero};
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// value + Σ derivative_i ε_i with ε_i ε_j = 0.
///
/// `abs` is a norm: |value| + Σ|derivative_i|, with no derivatives. So an iteration that stops when a correction is small has
/// also found the derivatives of its solution. Comparisons are those of the values.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Dual<const K: usize> {
    /// The number.
    pub value: f64,
    /// Its derivatives.
    pub derivatives: [f64; K],
}

impl<const K: usize> Dual<K> {
    /// A number that depends on nothing.
    pub fn constant(value: f64) -> Self {
        Dual { value, derivatives: [0.0; K] }
    }

    /// A number whose derivative in direction `k` is 1.
    pub fn variable(value: f64, k: usize) -> Self {
        Dual { value, derivatives: std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 }) }
    }

    /// f(value) where f' = `slope`.
    fn chain(self, value: f64, slope: f64) -> Self {
        Dual { value, derivatives: self.derivatives.map(|d| if d == 0.0 { 0.0 } else { slope * d }) }
    }

    /// Σ of both derivatives with these weights.
    fn combine(self, other: Self, value: f64, a: f64, b: f64) -> Self {
        Dual { value, derivatives: std::array::from_fn(|i| a * self.derivatives[i] + b * other.derivatives[i]) }
    }
}

impl<const K: usize> Add for Dual<K> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.combine(other, self.value + other.value, 1.0, 1.0)
    }
}
impl<const K: usize> Sub for Dual<K> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.combine(other, self.value - other.value, 1.0, -1.0)
    }
}
impl<const K: usize> Mul for Dual<K> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.combine(other, self.value * other.value, other.value, self.value)
    }
}
impl<const K: usize> Div for Dual<K> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        self.combine(other, quotient, 1.0 / other.value, -quotient / other.value)
    }
}
impl<const K: usize> Neg for Dual<K> {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}
impl<const K: usize> AddAssign for Dual<K> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<const K: usize> SubAssign for Dual<K> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
impl<const K: usize> MulAssign for Dual<K> {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}
impl<const K: usize> DivAssign for Dual<K> {
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}
impl<const K: usize> PartialOrd for Dual<K> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}
impl<const K: usize> Zero for Dual<K> {
    fn zero() -> Self {
        Dual::constant(0.0)
    }
    fn is_zero(&self) -> bool {
        *self == Dual::zero()
    }
}
impl<const K: usize> One for Dual<K> {
    fn one() -> Self {
        Dual::constant(1.0)
    }
}
impl<const K: usize> fmt::Display for Dual<K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} + {:?}ε", self.value, self.derivatives)
    }
}

impl<const K: usize> Scalar for Dual<K> {
    clebsch::one_number!();

    const EPSILON: Self = Dual { value: f64::EPSILON, derivatives: [0.0; K] };
    const PI: Self = Dual { value: std::f64::consts::PI, derivatives: [0.0; K] };

    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        Dual::constant(numerator as f64 / denominator as f64)
    }
    fn from_f64(value: f64) -> Self {
        Dual::constant(value)
    }
    fn to_f64(self) -> f64 {
        self.value
    }
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.derivatives.iter().all(|derivative| derivative.is_finite())
    }
    fn abs(self) -> Self {
        Dual::constant(self.value.abs() + self.derivatives.iter().map(|derivative| derivative.abs()).sum::<f64>())
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    fn recip(self) -> Self {
        Dual::one() / self
    }
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }
    fn tan(self) -> Self {
        self.chain(self.value.tan(), 1.0 + self.value.tan().powi(2))
    }
    fn asin(self) -> Self {
        self.chain(self.value.asin(), 1.0 / (1.0 - self.value.powi(2)).sqrt())
    }
    fn acos(self) -> Self {
        self.chain(self.value.acos(), -1.0 / (1.0 - self.value.powi(2)).sqrt())
    }
    fn atan(self) -> Self {
        self.chain(self.value.atan(), 1.0 / (1.0 + self.value.powi(2)))
    }
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }
    fn tanh(self) -> Self {
        self.chain(self.value.tanh(), 1.0 - self.value.tanh().powi(2))
    }
    fn exp(self) -> Self {
        self.chain(self.value.exp(), self.value.exp())
    }
    fn ln(self) -> Self {
        self.chain(self.value.ln(), 1.0 / self.value)
    }
    fn powi(self, exponent: i32) -> Self {
        self.chain(self.value.powi(exponent), f64::from(exponent) * self.value.powi(exponent - 1))
    }
    fn powf(self, exponent: Self) -> Self {
        (exponent * self.ln()).exp()
    }
}
