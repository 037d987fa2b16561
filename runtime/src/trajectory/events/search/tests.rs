//! Roots and dips of functions that are known.

use super::{dip, root};
use crate::Error;

type Function = fn(f64) -> f64;

/// The root of a function between 0 and 1, and how often the function was evaluated.
fn found(f: impl Fn(f64) -> f64) -> (f64, u32) {
    let mut count = 0;
    let evaluate = |x| {
        count += 1;
        Ok((x, f(x)))
    };
    let found = root([(0.0, f(0.0)), (1.0, f(1.0))], evaluate).expect("finite values");
    let part = found.map_or(0.0, |found| found.part);
    assert!(found.is_none_or(|found| found.state == part), "its own state");
    (part, count)
}

#[test]
fn roots_are_found_to_the_last_place_on_the_near_side() {
    let half = 0.5_f64;
    let cases: [(Function, f64, u32); 6] = [
        (|x| x - 0.3, 0.3, 12),
        (|x| 0.7 - x, 0.7, 12),
        (|x| x * x - 0.5, half.sqrt(), 16),
        (|x| x.exp() - 1.5, 1.5_f64.ln(), 16),
        // steps and flat places: at most two more than bisection
        (|x| if x < 0.123 { -1e300 } else { 1e-300 }, 0.123, 54),
        (|x| (x - 0.9).powi(9), 0.9, 54),
    ];
    for (f, exact, most) in cases {
        let (part, count) = found(f);
        assert!((part - exact).abs() <= 2.0 * f64::EPSILON || f(part).abs() < 1e-130, "{part} for {exact}");
        assert_eq!(f(part) > 0.0, f(0.0) > 0.0, "the side where it came from");
        assert!(count <= most, "{count} evaluations for {exact}");
    }
}

#[test]
fn dips_are_found_where_three_points_show_them() {
    let dips = |f: Function| dip([(0.0, f(0.0)), (1.0, f(1.0)), (-1.0, f(-1.0))], 4, |x| Ok(f(x)));
    let below = dips(|x| (x - 0.4) * (x - 0.401)).expect("two crossings").expect("a point between them");
    assert!((0.4..0.401).contains(&below.0) && below.1 < 0.0);
    let above =
        dips(|x| -(x - 0.4) * (x - 0.401) * (1.0 + x * x)).expect("two crossings").expect("a point between them");
    assert!((0.4..0.401).contains(&above.0) && above.1 > 0.0);
    assert_eq!(dips(|x| (x - 0.4).powi(2) + 1e-9), Ok(None));
    assert_eq!(dips(|x| 1.0 + x), Ok(None));
    let touch = dips(|x| (x - 0.4).powi(2));
    assert!(matches!(touch, Err(Error::EventGrazes { event: 4, .. })), "{touch:?}");
}
