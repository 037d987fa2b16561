use super::accumulate;
use crate::runner::proptest;
use nalgebra::{Matrix2, Quaternion, Vector3};
use proptest::prelude::*;

/// 10⁶ tenths: the number next to 1/10 is added a million times, and the result is the nearest number to that product.
/// Plain sums are off in the sixth digit from the last.
#[test]
fn a_million_sums_are_as_one_product() {
    let (mut sum, mut rest, mut plain) = (0.0_f64, 0.0, 0.0);
    let (count, drift) = if cfg!(miri) { (1000_u32, 1e-12) } else { (1_000_000, 1e-6) };
    for _ in 0..count {
        (sum, rest) = accumulate(&sum, &rest, &0.1);
        plain += 0.1;
    }
    // 0.1 is 3602879701896397/2⁵⁵
    let exact = 3_602_879_701_896_397_u128 * u128::from(count);
    let scaled = |x: f64| (x * 2.0_f64.powi(30)) as u128 * (1 << 25);
    assert!(scaled(sum).abs_diff(exact) <= (1 << 55) / (1 << 36), "{sum}");
    assert_eq!(sum, f64::from(count) / 10.0, "the nearest to 100000.0000000000055");
    assert!((plain - sum).abs() > drift, "{plain}");
}

#[test]
fn all_scalars_of_a_space_are_summed() {
    let space = |x: f64| ([(x, Vector3::repeat(x)); 2], Matrix2::repeat(x), (), Quaternion::new(x, x, x, x));
    let (sum, rest) = accumulate(&space(1.0), &space(0.0), &space(1e-20));
    assert_eq!((sum, rest), (space(1.0), space(1e-20)));
    let (sum, rest) = accumulate(&sum, &rest, &space(1.0));
    assert_eq!((sum, rest), (space(2.0), space(0.0)), "what is added is rounded itself");
}

proptest! {
    /// s + y = s⁺ + r⁺ for whole numbers, whose sums the computer knows.
    #[test]
    fn nothing_is_lost(s in any::<i64>(), y in any::<i64>(), shift in 0..52) {
        let (s, y) = (s >> 10, (y >> 10) >> shift);
        let scale = 2.0_f64.powi(20);
        // numbers with up to 54 bits, some of them rounded before
        let (a, b) = (s as f64, y as f64 / scale);
        let (sum, rest) = accumulate(&a, &0.0, &b);
        let whole = |x: f64| { assert_eq!((x * scale).fract(), 0.0); (x * scale) as i128 };
        prop_assert_eq!(whole(sum) + whole(rest), whole(a) + whole(b));
        prop_assert!(rest.abs() <= sum.abs() * f64::EPSILON / 2.0);
    }

    /// In single precision, against the sum in double.
    #[test]
    fn sums_are_those_of_twice_the_precision(parts in prop::collection::vec(-1e-3_f32..1e-3, 1..if cfg!(miri) { 50 } else { 2000 })) {
        let (mut sum, mut rest, mut exact) = (1.0_f32, 0.0, 1.0_f64);
        let count = parts.len() as f64;
        for part in parts {
            (sum, rest) = accumulate(&sum, &rest, &part);
            exact += f64::from(part);
        }
        // half a unit in the last place of each part
        prop_assert!((f64::from(sum) + f64::from(rest) - exact).abs() <= count * f64::from(f32::EPSILON) * 1e-3);
        prop_assert!((f64::from(sum) - exact).abs() <= f64::from(f32::EPSILON) * exact);
    }
}
