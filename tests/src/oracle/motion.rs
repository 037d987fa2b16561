//! Exact motions: equations of motion, integrated by the classical Runge–Kutta method with steps so small that round-off remains.

use nalgebra::SVector;

/// y(t) for y' = f(y), in `steps` steps: an error of about t (L t/steps)⁴, where L is the rate of f.
pub fn motion<const N: usize>(
    f: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: SVector<f64, N>,
    t: f64,
    steps: usize,
) -> SVector<f64, N> {
    let h = t / steps as f64;
    let mut carry = SVector::zeros();
    let mut y = start;
    for _ in 0..steps {
        let a = f(&y);
        let b = f(&(y + a * (h / 2.0)));
        let c = f(&(y + b * (h / 2.0)));
        let d = f(&(y + c * h));
        // compensated summation: rounding does not add up over many steps
        let change = (a + (b + c) * 2.0 + d) * (h / 6.0) - carry;
        let next = y + change;
        carry = (next - y) - change;
        y = next;
    }
    y
}

/// The slope of log₂ errors for step sizes that halve, by least squares.
pub fn order(errors: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> = errors.iter().enumerate().map(|(k, error)| (-(k as f64), error.log2())).collect();
    slope(&points)
}

/// The slope of the straight line through points (x, y), by least squares.
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let product: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    product / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>()
}
