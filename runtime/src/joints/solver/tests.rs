use super::is_worse;

/// A NaN in the middle stays the largest, whatever follows it.
#[test]
fn no_number_is_worse_than_nan() {
    let mut worst = 0.0;
    for ratio in [1.0, 3.0, f64::NAN, 2.0, f64::INFINITY, 5.0] {
        if is_worse(ratio, worst) {
            worst = ratio;
        }
    }
    assert!(worst.is_nan(), "{worst}");
    assert!(is_worse(f64::INFINITY, 3.0) && !is_worse(3.0, 3.0) && !is_worse(2.0, 3.0));
}
