//! Affine equations whose solutions are known.

use super::{LinearEquation, solve_linear_equation};
use crate::Error;
use nalgebra::{Matrix1, Matrix2, Vector1, Vector2, Vector3};

/// (1 − μ) ξ = μ
struct Growing;

impl LinearEquation<f64, 1> for Growing {
    fn system(&self, target: &Vector1<f64>) -> (Matrix1<f64>, Vector1<f64>) {
        (Matrix1::new(1.0 - target.x), *target)
    }
}

/// A charge in the plane: m ξ + μ₃ Jξ = (μ₁, μ₂), solvable for every μ.
struct Turning(f64);

impl LinearEquation<f64, 2, 3> for Turning {
    fn system(&self, target: &Vector3<f64>) -> (Matrix2<f64>, Vector2<f64>) {
        (Matrix2::new(self.0, target.z, -target.z, self.0), target.xy())
    }
}

#[test]
fn one_elimination_solves() {
    assert_eq!(solve_linear_equation(&Growing, &Vector1::new(0.75)), Ok(Vector1::new(3.0)));
    let target = Vector3::new(1.0, -3.0, 2.0);
    // (m ξ₁ + 2ξ₂, m ξ₂ − 2ξ₁) = (1, −3) with m = 4, by Cramer's rule
    assert_eq!(solve_linear_equation(&Turning(4.0), &target), Ok(Vector2::new(10.0 / 20.0, -10.0 / 20.0)));
}

/// For μ > 1 there is a solution, but it has come from infinity.
#[test]
fn solutions_beyond_infinity_are_none() {
    let Err(Error::Unsolvable { solvable_fraction, .. }) = solve_linear_equation(&Growing, &Vector1::new(4.0)) else {
        panic!("the branch ends at μ = 1");
    };
    assert!((solvable_fraction - 0.25).abs() < 1e-3, "{solvable_fraction}");
}

#[test]
fn what_is_broken_is_named() {
    let broken = solve_linear_equation(&Growing, &Vector1::new(f64::NAN));
    assert_eq!(broken, Err(Error::NotFinite { name: "the momentum" }));
    assert!(solve_linear_equation(&Turning(0.0), &Vector3::new(1.0, 1.0, 1.0)).is_err());
}
