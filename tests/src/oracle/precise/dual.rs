//! Dual numbers over any number: exact derivatives in one direction, and of second order when nested.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::matrix::Matrix;
use super::real::Real;

/// value + slope ε with ε² = 0.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Dual<R> {
    /// The number.
    pub value: R,
    /// Its derivative.
    pub slope: R,
}

impl<R: Real> Dual<R> {
    /// A number that does not change.
    pub fn constant(value: R) -> Self {
        Dual { value, slope: R::zero() }
    }

    /// f(x), given f(x) and f'(x).
    fn chain(self, value: R, derivative: R) -> Self {
        Dual { value, slope: derivative * self.slope }
    }
}

impl<R: Real> Add for Dual<R> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Dual { value: self.value + other.value, slope: self.slope + other.slope }
    }
}
impl<R: Real> Sub for Dual<R> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Dual { value: self.value - other.value, slope: self.slope - other.slope }
    }
}
impl<R: Real> Mul for Dual<R> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Dual { value: self.value * other.value, slope: self.value * other.slope + self.slope * other.value }
    }
}
impl<R: Real> Mul<f64> for Dual<R> {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        Dual { value: self.value * other, slope: self.slope * other }
    }
}
impl<R: Real> Div for Dual<R> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        Dual { value: quotient, slope: (self.slope - quotient * other.slope) / other.value }
    }
}
impl<R: Real> Neg for Dual<R> {
    type Output = Self;
    fn neg(self) -> Self {
        Dual { value: -self.value, slope: -self.slope }
    }
}

impl<R: Real> Real for Dual<R> {
    const LAST_CORRECTION: f64 = R::LAST_CORRECTION;

    fn of(value: f64) -> Self {
        Self::constant(R::of(value))
    }
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }
    fn size(self) -> f64 {
        self.value.size() + self.slope.size()
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, R::one() / (root * 2.0))
    }
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }
    fn exp(self) -> Self {
        self.chain(self.value.exp(), self.value.exp())
    }
    fn ln(self) -> Self {
        self.chain(self.value.ln(), R::one() / self.value)
    }
}

/// Matrices that do not change.
pub(super) fn constant<R: Real>(matrices: &[Matrix<R>]) -> Vec<Matrix<Dual<R>>> {
    matrices.iter().map(|matrix| matrix.map(Dual::constant)).collect()
}

/// Matrices, one of them moving.
pub(super) fn moving<R: Real>(matrices: &[Matrix<R>], k: usize, slope: &Matrix<R>) -> Vec<Matrix<Dual<R>>> {
    let mut duals = constant(matrices);
    let (rows, columns) = slope.shape();
    duals[k] = Matrix::from_fn(rows, columns, |i, j| Dual { value: matrices[k][(i, j)], slope: slope[(i, j)] });
    duals
}

/// Numbers, one of them moving.
pub(super) fn along<R: Real>(numbers: &[R], i: usize) -> Vec<Dual<R>> {
    let slope = |j| if i == j { R::one() } else { R::zero() };
    (0..numbers.len()).map(|j| Dual { value: numbers[j], slope: slope(j) }).collect()
}
