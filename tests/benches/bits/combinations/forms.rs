//! The same small systems by many methods.

use clebsch::{Clebsch, Scalar};
use nalgebra::{Matrix3, Matrix4, Vector3};

pub struct Unrolled;
pub struct Matrices;
pub struct UnrolledCompensated;
pub struct MatricesCompensated;
pub struct MatricesFirst;
pub struct MatricesFourth;
pub struct MatricesFourthCompensated;
pub struct UnrolledSixteenth;
pub struct SixteenthCompensated;
pub struct LooseSixteenth;
pub struct Exponential;
pub struct Tolerant;
pub struct FixedPoint;
pub struct Iterated;

/// Implicit, with kicks.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |R| self.weight * (R * self.center).z,
    method Unrolled                  = (code = unrolled),
    method Matrices                  = (code = matrices),
    method UnrolledCompensated       = (code = unrolled, summation = compensated),
    method MatricesCompensated       = (code = matrices, summation = compensated),
    method MatricesFirst             = (code = matrices, order = 1),
    method MatricesFourth            = (code = matrices, order = 4),
    method MatricesFourthCompensated = (code = matrices, order = 4, summation = compensated),
    method UnrolledSixteenth         = (code = unrolled, order = 16),
    method SixteenthCompensated      = (order = 16, summation = compensated),
    method LooseSixteenth            = (order = 16, tolerance = 1e-6),
    method Exponential               = (discretization = exponential),
    method Tolerant                  = (tolerance = 1e-6, summation = compensated),
    method FixedPoint                = (solver = fixed_point),
    method Iterated                  = (iterations = 3),
)]
pub struct Top<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
}

/// Explicit.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, q: Unit<Vector3>| F * q,
    lagrangian = |omega| omega.norm_squared() / 2,
    potential  = |q| self.gravity * q.z,
    method Unrolled                  = (code = unrolled),
    method Matrices                  = (code = matrices),
    method UnrolledCompensated       = (code = unrolled, summation = compensated),
    method MatricesCompensated       = (code = matrices, summation = compensated),
    method MatricesFirst             = (code = matrices, order = 1),
    method MatricesFourth            = (code = matrices, order = 4),
    method MatricesFourthCompensated = (code = matrices, order = 4, summation = compensated),
    method UnrolledSixteenth         = (code = unrolled, order = 16),
    method SixteenthCompensated      = (order = 16, summation = compensated),
    method LooseSixteenth            = (order = 16, tolerance = 1e-6),
    method Exponential               = (discretization = exponential),
    method Tolerant                  = (tolerance = 1e-6, summation = compensated),
    method FixedPoint                = (solver = fixed_point),
    method Iterated                  = (iterations = 3),
)]
pub struct Pendulum<T: Scalar> {
    pub gravity: T,
}

/// Six unknowns, free.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<4>, R: SO<4>| R * F,
    lagrangian = |omega| (self.j_d * omega.matrix() * omega.matrix().transpose()).trace(),
    method Unrolled                  = (code = unrolled),
    method Matrices                  = (code = matrices),
    method UnrolledCompensated       = (code = unrolled, summation = compensated),
    method MatricesCompensated       = (code = matrices, summation = compensated),
    method MatricesFirst             = (code = matrices, order = 1),
    method MatricesFourth            = (code = matrices, order = 4),
    method MatricesFourthCompensated = (code = matrices, order = 4, summation = compensated),
    method UnrolledSixteenth         = (code = unrolled, order = 16),
    method SixteenthCompensated      = (order = 16, summation = compensated),
    method LooseSixteenth            = (order = 16, tolerance = 1e-6),
    method Exponential               = (discretization = exponential),
    method Tolerant                  = (tolerance = 1e-6, summation = compensated),
    method FixedPoint                = (solver = fixed_point),
    method Iterated                  = (iterations = 3),
)]
pub struct Body4<T: Scalar> {
    #[clebsch(symmetric)]
    pub j_d: Matrix4<T>,
}
