//! How many operations and linearisations a step makes: the four scenes over a number that counts.
//!
//! The declarations are those of the fixtures of the same names, with T for f64.

#![allow(missing_docs)]

use clebsch::{Clebsch, Scalar, State, Stepper};
use nalgebra::{Matrix3, Matrix4, Vector3};
use num_traits::{One, Zero};
use std::cell::Cell;
use std::fmt::{self, Display, Formatter};
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = moser_veselov,
)]
pub struct PrincipalBody<T: Scalar> {
    pub moments: Vector3<T>,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
)]
pub struct HeavyTop<T: Scalar> {
    pub mass_matrix: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.mass * self.length.powi(2) * (F - I).norm_squared() / (4 * h),
    potential = |q| self.mass * self.gravity * self.length * q.z,
)]
pub struct SphericalPendulum<T: Scalar> {
    pub mass: T,
    pub length: T,
    pub gravity: T,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<4>, R: SO<4>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct RigidBody4<T: Scalar> {
    #[clebsch(symmetric)]
    pub j_d: Matrix4<T>,
}

/// Means over some steps.
#[derive(Copy, Clone, Debug)]
pub struct Work {
    /// Additions, multiplications, divisions and roots of a step.
    pub operations: f64,
    /// Linearisations of the equation of a step.
    pub linearizations: f64,
}

/// The work of `steps` steps.
pub fn work<S: Clebsch<Scalar = Counted>>(stepper: &Stepper<S>, start: State<S>, steps: u64) -> Work {
    OPERATIONS.set(0);
    ITERATIONS.set(0);
    let mut state = start;
    for _ in 0..steps {
        state = stepper.step(&state).expect("a step of moderate size");
    }
    let [operations, linearizations] = [&OPERATIONS, &ITERATIONS].map(|count| count.get() as f64 / steps as f64);
    Work { operations, linearizations }
}

thread_local! {
    static OPERATIONS: Cell<u64> = const { Cell::new(0) };
    static ITERATIONS: Cell<u64> = const { Cell::new(0) };
}

/// An `f64` that counts its operations.
#[derive(Copy, Clone, Debug, PartialEq, PartialOrd)]
pub struct Counted(pub f64);

fn counted(value: f64) -> Counted {
    OPERATIONS.set(OPERATIONS.get() + 1);
    Counted(value)
}

impl Display for Counted {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Zero for Counted {
    fn zero() -> Self {
        Self(0.0)
    }
    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl One for Counted {
    fn one() -> Self {
        Self(1.0)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! arithmetic {
    ($($operator:ident $method:ident $assigner:ident $assign:ident;)*) => {$(
        impl $operator for Counted {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                counted($operator::$method(self.0, other.0))
            }
        }
        impl $assigner for Counted {
            fn $assign(&mut self, other: Self) {
                *self = $operator::$method(*self, other);
            }
        }
    )*};
}
arithmetic! { Add add AddAssign add_assign; Sub sub SubAssign sub_assign; Mul mul MulAssign mul_assign; Div div DivAssign div_assign; }

macro_rules! functions {
    ($($method:ident)*) => { $(fn $method(self) -> Self { counted(f64::$method(self.0)) })* };
}

impl Scalar for Counted {
    clebsch::one_number!();

    const EPSILON: Self = Self(f64::EPSILON);
    const PI: Self = Self(std::f64::consts::PI);

    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        Self(numerator as f64 / denominator as f64)
    }
    fn from_f64(value: f64) -> Self {
        Self(value)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    fn iterated() {
        ITERATIONS.set(ITERATIONS.get() + 1);
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    functions! { sqrt recip sin cos tan asin acos atan sinh cosh tanh exp ln }
    fn powi(self, exponent: i32) -> Self {
        counted(self.0.powi(exponent))
    }
    fn powf(self, exponent: Self) -> Self {
        counted(self.0.powf(exponent.0))
    }
}
