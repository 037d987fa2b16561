//! Exact motions: equations of motion, integrated by the classical Runge–Kutta method with steps so small that round-off remains.

use clebsch::Clebsch;
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

/// The errors at t = 1 from a configuration and a momentum, in 20, 40 and 80 steps.
pub fn errors_of_halved_steps<S: Clebsch<Scalar = f64, Time = ()> + Clone>(
    system: &S,
    (q, mu): (S::Configuration, S::Momentum),
    error: impl Fn(&S::Configuration) -> f64,
) -> [f64; 3] {
    [20, 40, 80].map(|steps: usize| {
        let stepper = system.stepper(1.0 / steps as f64).expect("a regular system");
        let end = stepper.advance(&stepper.state(q, mu).expect("a state"), steps).expect("steps");
        error(end.configuration())
    })
}

/// Asserts that errors for step sizes that halve are of second order, to 0.1.
pub fn assert_second_order(name: &str, errors: &[f64]) {
    let measured = order(errors);
    println!("{name}: order {measured:.3}, errors {errors:?}");
    assert!((measured - 2.0).abs() < 0.1, "{name}: {measured}");
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
