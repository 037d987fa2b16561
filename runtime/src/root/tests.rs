//! Roots that are there, and some that are not.

use super::root;
use nalgebra::Vector2;

#[test]
fn roots_are_found_or_said_to_be_none() {
    // a circle and a line: (0.6, 0.8)
    let defect = |x: &Vector2<f64>| Some(Vector2::new(x.norm_squared() - 1.0, 4.0 * x.x - 3.0 * x.y));
    let found = root(Vector2::new(1.0, 1.0), defect).expect("a root");
    assert!((found - Vector2::new(0.6, 0.8)).norm() < 1e-15);
    // a circle and a line that do not meet
    assert_eq!(root(Vector2::new(1.0, 1.0), |x| Some(Vector2::new(x.norm_squared() - 1.0, x.x - 2.0))), None);
    assert_eq!(root(Vector2::new(1.0, 1.0), |_| Some(Vector2::from_element(f64::NAN))), None);
    assert_eq!(root(Vector2::new(1.0, 1.0), |_| None), None);
}
