//! Against values of 60 digits (mpmath), and the laws of the exponential.

use super::{exponential, phi, phi_times};
use crate::runner::proptest;
use crate::stumpff::stumpff;
use nalgebra::{Matrix2, Matrix3, SMatrix, Vector3};
use proptest::prelude::*;

/// |A − B| relative to |B|, in the largest entries.
fn error<const N: usize>(a: SMatrix<f64, N, N>, b: SMatrix<f64, N, N>) -> f64 {
    (a - b).amax() / b.amax()
}

fn generic() -> Matrix3<f64> {
    Matrix3::new(0.25, -0.5, 1.0, 0.75, 0.125, -0.25, -0.375, 0.5, -0.625)
}

/// Values of Taylor's series in 60 digits (mpmath), by rows: exp A and φ(A) of the matrix above, and of −16 times it.
#[rustfmt::skip]
const EXACT: [[f64; 9]; 4] = [
    [0.9485720289442111, -0.3153339501445894, 0.7945956159854093, 0.8418382855334027, 0.9243811133068072,
     0.1565278133454803, -0.11355467583626926, 0.4246190939420764, 0.4103982591658654],
    [1.0202846680239452, -0.19009522982072638, 0.43714057518994787, 0.4132806047152035, 0.9917442324182619,
     0.014106773224252384, -0.09985883570417348, 0.2280619735197231, 0.6923638588000486],
    [3.9701160505919635, 16.64895517992098, -36.31174261939225, -31.75455535386962, 7.127744092388778,
     2.5479657591557667, 10.226342190278016, -18.658176686287838, 32.85463492715782],
    [2.385540487786279, -0.7915371451822325, 0.502305376591715, -1.2444243382153388, 1.8273998968998044,
     -2.467242323988887, -1.404229544216237, 0.07102453600039918, 0.9102864075696432],
];

#[test]
fn generic_matrices_of_any_size() {
    let exact = EXACT.map(|rows| Matrix3::from_row_slice(&rows));
    assert!(error(exponential(&generic()), exact[0]) < 4e-16);
    assert!(error(phi(&generic()), exact[1]) < 4e-16);
    assert!(error(exponential(&(generic() * -16.0)), exact[2]) < 4e-15);
    assert!(error(phi(&(generic() * -16.0)), exact[3]) < 4e-15);
}

/// Off-diagonal entries are a million times the diagonal ones, and an exponential is far below one; 60 digits (mpmath).
#[test]
fn ill_scaled_matrices_keep_their_digits() {
    let lopsided = Matrix2::new(1.0, 1e6, 2.0_f64.powi(-20), -1.0);
    let exact = Matrix2::new(3.5055381564343473, 1358939.8196638222, 1.2959860035551284e-6, 0.787658517106703);
    let found = exponential(&lopsided);
    assert!(found.component_div(&exact).add_scalar(-1.0).amax() < 4e-15, "{found}");
    let exact = Matrix2::new(1.945833104354012, 586893.2846901898, 5.597050520803354e-7, 0.7720465349736324);
    assert!(phi(&lopsided).component_div(&exact).add_scalar(-1.0).amax() < 4e-15);
    let decaying = Matrix2::new(-20.0, 1000.0, 0.0, -21.0);
    let exact = Matrix2::new(2.061153622438558e-9, 1.3028975796473672e-6, 0.0, 7.582560427911907e-10);
    assert!(error(exponential(&decaying), exact) < 4e-14);
    let exact = Matrix2::new(0.04999999989694232, 2.3809523140021303, 0.0, 0.04761904758294019);
    assert!(error(phi(&decaying), exact) < 4e-15);
}

#[test]
fn nilpotent_matrices_have_finite_series() {
    let shear = Matrix3::new(0.0, 1e9, 5e17, 0.0, 0.0, 1e9, 0.0, 0.0, 0.0);
    assert_eq!(exponential(&shear), Matrix3::new(1.0, 1e9, 1e18, 0.0, 1.0, 1e9, 0.0, 0.0, 1.0));
    assert_eq!(exponential(&Matrix3::<f64>::zeros()), Matrix3::identity());
    assert_eq!(phi(&Matrix3::<f64>::zeros()), Matrix3::identity());
}

/// Below |A| = 1 by a series of vectors, beyond by the matrix; 60 digits (mpmath).
#[test]
fn products_with_vectors_need_no_matrix() {
    let v = Vector3::new(0.5, -1.0, 2.0);
    for (a, exact) in [(generic(), EXACT[1]), (generic() * -16.0, EXACT[3])] {
        let exact = Matrix3::from_row_slice(&exact) * v;
        assert!((phi_times(&a, &v) - exact).amax() < 4e-15 * exact.amax());
    }
    let small = generic() * 0.25;
    let exact = phi(&small) * v;
    assert!((phi_times(&small, &v) - exact).amax() < 4e-16 * exact.amax(), "{}", phi_times(&small, &v) - exact);
    assert_eq!(phi_times(&small, &Vector3::zeros()), Vector3::zeros());
    for broken in [f64::NAN, f64::INFINITY] {
        assert!(phi_times(&small, &Vector3::new(0.0, broken, 0.0)).x.is_nan());
        assert!(phi_times(&(small * broken), &v).x.is_nan());
    }
}

#[test]
fn what_is_not_finite_stays_so() {
    for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let matrix = Matrix2::new(0.0, broken, 0.0, 0.0);
        assert!(exponential(&matrix)[(0, 1)].is_nan() && phi(&matrix)[(0, 1)].is_nan());
    }
    assert!(!exponential(&(Matrix2::<f64>::identity() * 1e308))[(0, 0)].is_finite());
    assert_eq!(exponential(&(Matrix2::<f64>::identity() * -1e308)), Matrix2::zeros());
}

#[test]
fn single_precision_is_exact_to_single_precision() {
    let quarter_turn = Matrix2::new(0.0, -1.0, 1.0, 0.0) * core::f32::consts::FRAC_PI_2;
    assert!((exponential(&quarter_turn) - Matrix2::new(0.0, -1.0, 1.0, 0.0)).amax() < 2e-7);
}

proptest! {
    /// exp x^ = I + c₁x^ + c₂x^², φ(x^) = I + c₂x^ + c₃x^², and their inverses and products.
    #[test]
    fn rotations_are_those_of_rodrigues(x in prop::array::uniform3(-8.0_f64..8.0)) {
        let hat = Vector3::from(x).cross_matrix();
        let s = Vector3::from(x).norm_squared();
        let rotation = Matrix3::identity() + hat * stumpff(1, s) + hat * hat * stumpff(2, s);
        let found = exponential(&hat);
        prop_assert!((found - rotation).amax() < 1e-14, "{} {}", found, rotation);
        let slope = Matrix3::identity() + hat * stumpff(2, s) + hat * hat * stumpff(3, s);
        prop_assert!((phi(&hat) - slope).amax() < 1e-14);
        prop_assert!((found * exponential(&-hat) - Matrix3::identity()).amax() < 2e-14);
        prop_assert!((hat * phi(&hat) + Matrix3::identity() - found).amax() < 2e-14);
    }
}
