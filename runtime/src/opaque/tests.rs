use super::check_slope;
use crate::Error;

#[test]
fn a_gradient_has_to_be_that_of_the_value() {
    let value = |x: f64| (3.0 * x).sin() / x;
    let slope = |x: f64| 3.0 * (3.0 * x).cos() / x - (3.0 * x).sin() / (x * x);
    for x in [-2.0, 0.3, 1.7] {
        assert_eq!(check_slope(value, x, slope(x), 0), Ok(()));
        assert!(matches!(check_slope(value, x, -slope(x), 5), Err(Error::WrongGradient { entry: 5, .. })));
        assert!(matches!(check_slope(value, x, slope(x) * 1.001, 0), Err(Error::WrongGradient { .. })));
    }
    assert!(matches!(check_slope(|_| f64::NAN, 1.0, 0.0, 0), Err(Error::NotFinite { .. })));
}
