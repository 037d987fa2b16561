//! Numbers with first and second derivatives by six variables: an independent way to the derivatives of a step.

use core::ops::{Add, Mul, Neg, Sub};
use nalgebra::{Matrix6, Vector6};

/// f + g·s + ½ s·Hs
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    pub value: f64,
    pub slope: Vector6<f64>,
    pub curvature: Matrix6<f64>,
}

impl Jet {
    pub fn constant(value: f64) -> Self {
        Self { value, slope: Vector6::zeros(), curvature: Matrix6::zeros() }
    }

    pub fn variable(value: f64, index: usize) -> Self {
        Self { slope: Vector6::ith(index, 1.0), ..Self::constant(value) }
    }

    pub fn is_zero(&self) -> bool {
        self.value == 0.0 && [self.slope.as_slice(), self.curvature.as_slice()].into_iter().flatten().all(|x| *x == 0.0)
    }

    /// F(f) from F, F′ and F″ at f.
    fn chain(self, value: f64, first: f64, second: f64) -> Self {
        let curvature = self.curvature * first + self.slope * self.slope.transpose() * second;
        Self { value, slope: self.slope * first, curvature }
    }

    pub fn sin(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.chain(sin, cos, -sin)
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
            curvature: self.curvature + other.curvature,
        }
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mixed = self.slope * other.slope.transpose();
        Self {
            value: self.value * other.value,
            slope: self.slope * other.value + other.slope * self.value,
            curvature: self.curvature * other.value + other.curvature * self.value + mixed + mixed.transpose(),
        }
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, c: f64) -> Self {
        Self { value: self.value * c, slope: self.slope * c, curvature: self.curvature * c }
    }
}
