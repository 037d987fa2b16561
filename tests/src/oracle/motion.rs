//! Exact motions: equations of motion, integrated by a Runge–Kutta method of order 8 with steps so small that round-off remains.

use clebsch::Clebsch;
use nalgebra::SVector;

/// y(t) for y' = f(y), in `steps` steps: an error of about t (L t/steps)⁸, where L is the rate of f.
///
/// Cooper and Verner, *Some explicit Runge–Kutta methods of high order*, SIAM J. Numer. Anal. 9 (1972) 389–405.
pub fn motion<const N: usize>(
    f: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: SVector<f64, N>,
    t: f64,
    steps: usize,
) -> SVector<f64, N> {
    let h = t / steps as f64;
    let s = 21.0_f64.sqrt();
    // for each slope after the first: weights of those before it that are not zero
    let stages: [&[(usize, f64)]; 10] = [
        &[(0, 1.0 / 2.0)],
        &[(0, 1.0 / 4.0), (1, 1.0 / 4.0)],
        &[(0, 1.0 / 7.0), (1, (-7.0 - 3.0 * s) / 98.0), (2, (21.0 + 5.0 * s) / 49.0)],
        &[(0, (11.0 + s) / 84.0), (2, (18.0 + 4.0 * s) / 63.0), (3, (21.0 - s) / 252.0)],
        &[(0, (5.0 + s) / 48.0), (2, (9.0 + s) / 36.0), (3, (-231.0 + 14.0 * s) / 360.0), (4, (63.0 - 7.0 * s) / 80.0)],
        &[
            (0, (10.0 - s) / 42.0),
            (2, (-432.0 + 92.0 * s) / 315.0),
            (3, (633.0 - 145.0 * s) / 90.0),
            (4, (-504.0 + 115.0 * s) / 70.0),
            (5, (63.0 - 13.0 * s) / 35.0),
        ],
        &[(0, 1.0 / 14.0), (4, (14.0 - 3.0 * s) / 126.0), (5, (13.0 - 3.0 * s) / 63.0), (6, 1.0 / 9.0)],
        &[
            (0, 1.0 / 32.0),
            (4, (91.0 - 21.0 * s) / 576.0),
            (5, 11.0 / 72.0),
            (6, (-385.0 - 75.0 * s) / 1152.0),
            (7, (63.0 + 13.0 * s) / 128.0),
        ],
        &[
            (0, 1.0 / 14.0),
            (4, 1.0 / 9.0),
            (5, (-733.0 - 147.0 * s) / 2205.0),
            (6, (515.0 + 111.0 * s) / 504.0),
            (7, (-51.0 - 11.0 * s) / 56.0),
            (8, (132.0 + 28.0 * s) / 245.0),
        ],
        &[
            (4, (-42.0 + 7.0 * s) / 18.0),
            (5, (-18.0 + 28.0 * s) / 45.0),
            (6, (-273.0 - 53.0 * s) / 72.0),
            (7, (301.0 + 53.0 * s) / 72.0),
            (8, (28.0 - 28.0 * s) / 45.0),
            (9, (49.0 - 7.0 * s) / 18.0),
        ],
    ];
    let mut carry = SVector::zeros();
    let mut y = start;
    for _ in 0..steps {
        let mut slopes = [f(&y); 11];
        for (stage, weights) in stages.iter().enumerate() {
            let mut at = y;
            weights.iter().for_each(|&(earlier, weight)| at += slopes[earlier] * (h * weight));
            slopes[stage + 1] = f(&at);
        }
        let ends = (slopes[0] + slopes[10]) * (h / 20.0);
        let inside = (slopes[7] + slopes[9]) * (h * 49.0 / 180.0) + slopes[8] * (h * 16.0 / 45.0);
        // compensated summation: rounding does not add up over many steps
        let change = ends + inside - carry;
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
