//! How a step adds to q and N: as numbers are added, or with compensated sums, which keep what rounding takes off.

use crate::{Scalar, Space};

/// a + b as the rounded sum and what rounding took from it, whichever is the larger.
///
/// Source: Knuth, *The Art of Computer Programming* 2, §4.2.2, theorem B (the error of a sum, due to Møller).
#[inline(always)]
pub(crate) fn exact_sum<T: Scalar>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    (sum, (a - of_a) + (b - of_b))
}

/// (s⁺, r⁺) with s⁺ = s + y rounded, where y = d + r is what is added and what earlier sums have left, and r⁺ what that takes off:
/// s⁺ + r⁺ = s + y without an error.
///
/// Of n sums the errors of y alone add up, ε |d| each in place of ε |s|. For each scalar
///
/// ```text
/// y = d + r,    s⁺ = s + y,    z = s⁺ − s,    r⁺ = (s − (s⁺ − z)) + (y − z)
/// ```
/// seven additions, of which two stand between s and s⁺. Valid for any sizes of s and y, as long as s + y does not overflow.
///
/// Source: Kahan, *Further remarks on reducing truncation errors*, Comm. ACM 8 (1965).
#[inline(always)]
pub fn accumulate<T: Scalar, S: Space<T>>(sum: &S, rest: &S, increment: &S) -> (S, S) {
    let increment = increment.zip_map(rest, |d, r| d + r);
    (sum.zip_map(&increment, |s, y| exact_sum(s, y).0), sum.zip_map(&increment, |s, y| exact_sum(s, y).1))
}

/// How a step adds to q and N.
pub trait Sums {
    /// Whether what rounding takes off is kept, and added in the next step.
    const ARE_COMPENSATED: bool;

    /// What rounding has taken off a sum; `()` where that is not kept.
    type Rest<T: Scalar, V: Space<T>>: Space<T>;
    /// What one step leaves to the next: an impulse I and the rests of q and N.
    type Left<T: Scalar, I: Space<T>, Q: Space<T>, N: Space<T>>: Space<T>;

    /// Both in one.
    fn joined<T: Scalar, I: Space<T>, Q: Space<T>, N: Space<T>>(
        impulse: I,
        rests: Rests<Self, T, Q, N>,
    ) -> Self::Left<T, I, Q, N>;

    /// The impulse and the rests.
    fn parted<T: Scalar, I: Space<T>, Q: Space<T>, N: Space<T>>(
        left: &Self::Left<T, I, Q, N>,
    ) -> (&I, Rests<Self, T, Q, N>);

    /// The sum and its new rest.
    fn sum<T: Scalar, V: Space<T>>(sum: &V, rest: &mut Self::Rest<T, V>, increment: &V) -> V;

    /// What a kernel has made of a sum: it gives the new sum itself, or, where sums are compensated, what is added.
    fn made<T: Scalar, V: Space<T>>(sum: &V, rest: &mut Self::Rest<T, V>, made: V) -> V;

    /// The same where no rest is kept.
    fn made_plainly<T: Scalar, V: Space<T>>(sum: &V, made: V) -> V;
}

/// What rounding has taken off q and N.
pub type Rests<S, T, Q, N> = (<S as Sums>::Rest<T, Q>, <S as Sums>::Rest<T, N>);

/// Sums as numbers are added.
#[derive(Clone, Copy, Debug)]
pub struct Plain;

impl Sums for Plain {
    const ARE_COMPENSATED: bool = false;

    type Rest<T: Scalar, V: Space<T>> = ();
    type Left<T: Scalar, I: Space<T>, Q: Space<T>, N: Space<T>> = I;

    #[inline(always)]
    fn joined<T: Scalar, I: Space<T>, Q: Space<T>, N: Space<T>>(impulse: I, _: ((), ())) -> I {
        impulse
    }

    #[inline(always)]
    fn parted<T: Scalar, I: Space<T>, Q: Space<T>, N: Space<T>>(left: &I) -> (&I, ((), ())) {
        (left, ((), ()))
    }

    #[inline(always)]
    fn sum<T: Scalar, V: Space<T>>(sum: &V, (): &mut (), increment: &V) -> V {
        sum.zip_map(increment, |a, b| a + b)
    }

    #[inline(always)]
    fn made<T: Scalar, V: Space<T>>(_: &V, (): &mut (), made: V) -> V {
        made
    }

    #[inline(always)]
    fn made_plainly<T: Scalar, V: Space<T>>(_: &V, made: V) -> V {
        made
    }
}

/// Compensated sums.
#[derive(Clone, Copy, Debug)]
pub struct Compensated;

impl Sums for Compensated {
    const ARE_COMPENSATED: bool = true;

    type Rest<T: Scalar, V: Space<T>> = V;
    type Left<T: Scalar, I: Space<T>, Q: Space<T>, N: Space<T>> = (I, (Q, N));

    #[inline(always)]
    fn joined<T: Scalar, I: Space<T>, Q: Space<T>, N: Space<T>>(impulse: I, rests: (Q, N)) -> (I, (Q, N)) {
        (impulse, rests)
    }

    #[inline(always)]
    fn parted<T: Scalar, I: Space<T>, Q: Space<T>, N: Space<T>>(left: &(I, (Q, N))) -> (&I, (Q, N)) {
        (&left.0, left.1)
    }

    #[inline(always)]
    fn sum<T: Scalar, V: Space<T>>(sum: &V, rest: &mut V, increment: &V) -> V {
        let (sum, left) = accumulate(sum, rest, increment);
        *rest = left;
        sum
    }

    #[inline(always)]
    fn made<T: Scalar, V: Space<T>>(sum: &V, rest: &mut V, made: V) -> V {
        Self::sum(sum, rest, &made)
    }

    #[inline(always)]
    fn made_plainly<T: Scalar, V: Space<T>>(sum: &V, made: V) -> V {
        sum.zip_map(&made, |a, b| a + b)
    }
}

#[cfg(test)]
mod tests {
    use super::accumulate;
    use nalgebra::{Matrix2, Quaternion, Vector3};
    use proptest::prelude::*;

    /// 10⁶ tenths: what is added is the number next to 1/10, a million times, and the nearest number to that is found; plain sums are off in
    /// the sixth digit from the last.
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
}
