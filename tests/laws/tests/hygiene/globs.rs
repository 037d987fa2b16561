//! Both crates by their globs: a method of a number or of a vector is that of one trait.

use clebsch::*;
use nalgebra::*;

#[test]
fn globs_of_both_crates_go_together() {
    let numbers = [1.0_f64, f64::NAN, f64::INFINITY];
    assert_eq!(numbers.iter().filter(|x| x.is_finite()).count(), 1);
    let place = (Vector3::new(1.0, -3.0, 2.0), Matrix2::<f64>::identity());
    assert!(place.all_finite() && place.max_abs() == 3.0);
    assert!(!Vector2::new(0.0, f64::NAN).all_finite());
}
