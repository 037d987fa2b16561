//! Comparison of the results of two computations.

use nalgebra::SMatrix;

/// The largest difference of two entries.
pub fn distance<const R: usize, const C: usize>(a: &SMatrix<f64, R, C>, b: &SMatrix<f64, R, C>) -> f64 {
    // NaN counts as infinitely far, which a plain maximum would pass over
    a.iter()
        .zip(b.iter())
        .map(|(x, y)| if x == y { 0.0 } else { (x - y).abs() })
        .fold(0.0, |max, d| if d.is_nan() { f64::INFINITY } else { f64::max(max, d) })
}

/// Fails where two results differ by more than `tolerance`.
#[track_caller]
pub fn assert_near<const R: usize, const C: usize>(
    a: &SMatrix<f64, R, C>,
    b: &SMatrix<f64, R, C>,
    tolerance: f64,
    what: &str,
) {
    let distance = distance(a, b);
    assert!(distance <= tolerance, "{what}: {distance:.2e} apart, {tolerance:.0e} allowed\n{a}{b}");
}
