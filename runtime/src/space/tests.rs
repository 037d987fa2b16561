use super::Space;
use nalgebra::{Matrix3, Quaternion, Vector2};

#[test]
fn nested_spaces_are_visited_completely() {
    let nested =
        ([(1.0, Vector2::new(-7.0, 2.0)); 2], Matrix3::<f64>::identity(), (), Quaternion::new(-8.0, 0.0, 0.0, 0.0));
    assert!(nested.all_finite());
    assert_eq!(Space::<f64>::max_abs(&nested), 8.0);
    let mut broken = nested;
    (broken.0[1].1.y, broken.3.coords.w) = (5.0, -4.0);
    assert_eq!(Space::<f64>::distance_squared(&nested, &broken), 25.0);
    broken.0[1].1.y = f64::NAN;
    assert!(!broken.all_finite());
    broken.0[1].1.y = f64::NEG_INFINITY;
    assert!(!broken.all_finite());
}
