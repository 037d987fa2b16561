//! Against values of 60 digits (mpmath), and the exponential.

use super::{logarithm, motion_logarithm};
use crate::exponential::exponential;
use crate::runner::proptest;
use nalgebra::{Matrix2, Matrix3, Matrix4, Rotation3, Vector3};
use proptest::prelude::*;

/// By rows, from the series and square roots in 60 digits (mpmath).
#[rustfmt::skip]
const EXACT: [f64; 9] = [
    1.5365385070677517, -0.642026298162378, 0.30299445486448906,
    0.40928370288501764, 1.727129986592835, 0.06016980996897717,
    -0.05620148766970299, 0.23274259527736033, 1.0930403330290053,
];

/// The second one in 60 digits too.
#[test]
fn generic_and_ill_scaled_matrices() {
    let generic = Matrix3::new(4.0, -3.0, 1.0, 2.0, 5.0, 0.5, 0.0, 1.0, 3.0);
    let exact = Matrix3::from_row_slice(&EXACT);
    assert!((logarithm(&generic) - exact).amax() < 4e-15);
    let stretched = Matrix2::new(2.0_f64.powi(-30), 1.0, 0.0, 2.0_f64.powi(30));
    let exact = Matrix2::new(-20.79441541679836, 3.873261700719289e-8, 0.0, 20.79441541679836);
    assert!((logarithm(&stretched) - exact).amax() < 1e-13, "{}", logarithm(&stretched));
}

#[test]
fn small_logarithms_have_all_their_digits() {
    let turned = Matrix2::new(1.0, 2.0_f64.powi(-40), -2.0_f64.powi(-41), 1.0);
    let exact =
        Matrix2::new(2.0679515313825692e-25, 9.094947017729282e-13, -4.547473508864641e-13, 2.0679515313825692e-25);
    assert!(logarithm(&turned).component_div(&exact).add_scalar(-1.0).amax() < 1e-15);
    assert_eq!(logarithm(&Matrix2::<f64>::identity()), Matrix2::zeros());
    let shear = Matrix3::new(1.0, 1e9, 1e18, 0.0, 1.0, 1e9, 0.0, 0.0, 1.0);
    assert_eq!(logarithm(&shear), Matrix3::new(0.0, 1e9, 5e17, 0.0, 0.0, 1e9, 0.0, 0.0, 0.0));
}

/// Rotations by angles up to π less 10⁻⁶, where the logarithm is as ill-conditioned as is written there.
#[test]
fn rotations_by_nearly_half_a_turn_are_undone() {
    let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
    for rest in [3.0, 1.0, 0.1, 1e-3, 1e-6] {
        let vector = axis * (core::f64::consts::PI - rest);
        let found = logarithm(Rotation3::from_scaled_axis(vector).matrix());
        let error = (found - vector.cross_matrix()).amax();
        assert!(error < 1e-14 / f64::min(rest, 1.0), "π − {rest}: {error:e}");
    }
}

/// A displacement of SE(3): turned by 2 about e3 and shifted so that (v, 2e3) with v = (10⁷, 0, 10⁷) is the logarithm.
#[test]
fn large_shifts_leave_the_rotation_its_digits() {
    let (far, sine, cosine) = (1e7, f64::sin(2.0), f64::cos(2.0));
    let (x, y) = (far * sine / 2.0, far * (1.0 - cosine) / 2.0);
    let (a, b) = ([cosine, -sine, 0.0, x], [sine, cosine, 0.0, y]);
    let motion = Matrix4::from_row_slice(&[a, b, [0.0, 0.0, 1.0, far], [0.0, 0.0, 0.0, 1.0]].concat());
    let (mut generator, mut error) = (Matrix4::zeros(), logarithm(&motion));
    (generator[(1, 0)], generator[(0, 1)], generator[(0, 3)], generator[(2, 3)]) = (2.0, -2.0, far, far);
    error -= generator;
    assert!(error.fixed_view::<4, 3>(0, 0).amax() < 4e-14 && error.amax() < 1e-14 * far, "{error}");
    assert!((exponential(&generator) - motion).amax() < 1e-15 * far);
}

#[test]
fn where_there_is_no_logarithm_there_is_nan() {
    let half_turn = Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, 1.0));
    let tilted = Rotation3::from_scaled_axis(Vector3::new(0.6, 0.0, 0.8) * core::f64::consts::PI);
    let conditions = [half_turn, -Matrix3::identity(), Matrix3::zeros(), half_turn * f64::NAN, half_turn / 0.0];
    for matrix in conditions {
        assert!(logarithm(&matrix).iter().all(|x| x.is_nan()), "{matrix}");
    }
    // Half a turn but for rounding: one of the two logarithms, or none.
    let found = logarithm(tilted.matrix());
    assert!(found[(0, 0)].is_nan() || (exponential(&found) - tilted.matrix()).amax() < 1e-6, "{found}");
    assert!(logarithm(&Matrix2::new(-1.0_f64, 3.0, 0.0, 2.0))[(0, 0)].is_nan());
}

#[test]
fn single_precision_is_exact_to_single_precision() {
    let found = logarithm(&Matrix2::new(0.0_f32, -1.0, 1.0, 0.0));
    assert!((found - Matrix2::new(0.0, -1.0, 1.0, 0.0) * core::f32::consts::FRAC_PI_2).amax() < 4e-7);
}

/// A motion as a matrix of its algebra: a turn vector and a shift.
fn algebra(turn: Vector3<f64>, shift: Vector3<f64>) -> Matrix4<f64> {
    let mut matrix = turn.cross_matrix().to_homogeneous();
    matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&shift);
    matrix[(3, 3)] = 0.0;
    matrix
}

/// Every angle up to half a turn, where the general logarithm has lost half of its digits or has no value.
#[test]
fn motions_by_any_angle_are_undone() {
    let (shift, half) = (Vector3::new(0.3, -1.2, 0.7), core::f64::consts::PI);
    for axis in [Vector3::new(2.0, -1.0, 2.0) / 3.0, Vector3::z(), Vector3::new(-0.6, 0.0, 0.8), -Vector3::x()] {
        for angle in [0.0, 1e-300, 1e-160, 1e-9, 1e-3, 0.5, 1.57, 1.58, 2.0, 2.2, 3.0, half - 1e-4, half - 1e-9] {
            let (turn, motion) = (axis * angle, algebra(axis * angle, shift));
            let found = motion_logarithm(&exponential(&motion));
            assert!((found - motion).amax() < 1e-14, "{angle} about {axis}: {}", found - motion);
            let found = motion_logarithm(Rotation3::from_scaled_axis(turn).matrix());
            assert!((found - turn.cross_matrix()).amax() < 1e-14, "{angle} about {axis}: {found}");
            let plane = Matrix2::new(0.0, -angle, angle, 0.0);
            assert!((motion_logarithm(&exponential(&plane)) - plane).amax() < 1e-15);
            let flat = Matrix3::new(0.0, angle, 0.3, -angle, 0.0, -1.2, 0.0, 0.0, 0.0);
            let found = motion_logarithm(&exponential(&flat));
            assert!((found - flat).amax() < 1e-14, "{angle} in the plane: {found}");
        }
    }
    // half a turn: one of the two logarithms
    for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
        let turn = Rotation3::from_scaled_axis(axis * half);
        let found = motion_logarithm(turn.matrix());
        assert!((exponential(&found) - turn.matrix()).amax() < 1e-15);
        assert!((found.norm() - half * f64::sqrt(2.0)).abs() < 1e-15);
    }
    assert!(motion_logarithm(&Matrix4::from_diagonal_element(1.0)) == Matrix4::zeros());
    assert!(motion_logarithm(&Matrix4::<f64>::from_element(0.3))[(0, 0)].is_nan());
    assert!(motion_logarithm(&(Matrix3::identity() * f64::NAN))[(0, 0)].is_nan());
}

proptest! {
    #[test]
    fn motions_are_those_of_the_general_logarithm(turn in prop::array::uniform3(-1.7_f64..1.7), shift in prop::array::uniform3(-9.0_f64..9.0)) {
        let motion = exponential(&algebra(turn.into(), shift.into()));
        prop_assert!((motion_logarithm(&motion) - logarithm(&motion)).amax() < 1e-12);
    }

    #[test]
    fn logarithms_undo_exponentials(entries in prop::array::uniform9(-0.9_f64..0.9)) {
        let matrix = Matrix3::from_row_slice(&entries);
        prop_assert!((logarithm(&exponential(&matrix)) - matrix).amax() < 4e-14);
    }
}
