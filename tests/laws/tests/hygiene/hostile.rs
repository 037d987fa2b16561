//! Every name that generated code could mean is something else here.

#![allow(dead_code, non_camel_case_types, unused_imports, unused_macros, clippy::all)]

// Macros with the names of those of the standard library and of the linear algebra.
macro_rules! assert {
    () => {};
}
macro_rules! concat {
    () => {};
}
macro_rules! format {
    () => {};
}
macro_rules! matrix {
    () => {};
}
macro_rules! panic {
    () => {};
}
macro_rules! stringify {
    () => {};
}
macro_rules! vec {
    () => {};
}
macro_rules! vector {
    () => {};
}
macro_rules! write {
    () => {};
}

/// Modules where paths might begin.
mod crates {
    pub mod alloc {}
    pub mod clebsch {}
    pub mod core {}
    pub mod libm {}
    pub mod nalgebra {}
    pub mod num_traits {}
    pub mod std {}
}
use crates::*;

/// Types, and the names in the prelude.
macro_rules! types {
    ($($name:ident)*) => {$(pub struct $name;)*};
}
types! {
    Box Debug Default Drop Err Error Formatter From Into Iterator Matrix None Ok Option Result Self_ Some String Vec
    Constants Equation Equation1 Equation2 Impulse Momentum Orientation SMatrix SVector Space Step Terms
    bool char f32 i64 str u32 usize
}

/// Traits whose methods everything has.
pub trait Everywhere {
    /// As an operator.
    fn add(&self, _: &Self) {}
    /// As an operator.
    fn mul(&self, _: &Self) {}
    /// As a conversion.
    fn into(&self) {}
    /// As a method of an option.
    fn ok_or(&self) {}
    /// As a method of a scalar.
    fn sqrt(&self) {}
    /// As a method of a scalar.
    fn is_finite(&self) {}
    /// As a part of a step.
    fn advance(&self) {}
    /// As a part of a step.
    fn euler_poincare(&self) {}
    /// As a part of a step.
    fn increment(&self) {}
    /// As a part of a step.
    fn start_kick(&self) {}
    /// As a part of a step.
    fn solve(&self) {}
}
impl<T: ?Sized> Everywhere for T {}

/// Traits with the names of those that are derived or implemented.
macro_rules! traits {
    ($($name:ident)*) => {$(pub trait $name {})*};
}
traits!(Add Clebsch Clone Copy Mul Neg One Scalar Zero);

/// Functions with the names of those that are called.
macro_rules! functions {
    ($($name:ident)*) => {$(pub fn $name() {})*};
}
functions!(annihilator_defect check_finite drop from_increment h invert largest mu q sin solve sqrt t0 vector x1 zero);

::core::include!("systems.rs");
