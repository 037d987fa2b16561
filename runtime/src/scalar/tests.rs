//! Powers and ratios of plain numbers.

use super::Scalar;

#[test]
fn powers_by_squaring() {
    assert_eq!(Scalar::powi(3.0_f64, 5), 243.0);
    assert_eq!(Scalar::powi(2.0_f64, -3), 0.125);
    assert_eq!(Scalar::powi(0.0_f64, 0), 1.0);
    assert_eq!(Scalar::powi(-1.0_f64, i32::MIN), 1.0);
    assert_eq!(Scalar::powi(-2.0_f32, 3), -8.0);
}

#[test]
fn ratios_are_rounded_once() {
    assert_eq!(<f64 as Scalar>::from_ratio(1, 3), 1.0 / 3.0);
    assert_eq!(<f32 as Scalar>::from_ratio(-1, 10), -0.1_f32);
}
