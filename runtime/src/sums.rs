//! How a step adds to q and N: by plain addition, or with compensated sums, which store the rounding error.

use crate::{Scalar, Space};

/// a + b as the rounded sum and its rounding error, whichever of a and b is larger. The source is that of
/// [`Clock`](crate::Clock).
#[inline(always)]
pub(crate) fn exact_sum<T: Scalar>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    (sum, (a - of_a) + (b - of_b))
}

/// (s⁺, r⁺) with s⁺ = s + y rounded and r⁺ its rounding error: s⁺ + r⁺ = s + y exactly. Here y = d + r adds the
/// rounding error r of earlier sums to d.
///
/// Of n sums the errors of y alone add up, ε |d| each in place of ε |s|. For each scalar
///
/// ```text
/// y = d + r,    s⁺ = s + y,    z = s⁺ − s,    r⁺ = (s − (s⁺ − z)) + (y − z)
/// ```
/// These are seven additions, and two of them stand between s and s⁺. Valid for any sizes of s and y, as long as s + y
/// does not overflow.
///
/// Source: Kahan, *Further remarks on reducing truncation errors*, Comm. ACM 8 (1965).
#[inline(always)]
pub fn accumulate<T: Scalar, S: Space<T>>(sum: &S, rest: &S, increment: &S) -> (S, S) {
    let increment = increment.zip_map(rest, |d, r| d + r);
    (sum.zip_map(&increment, |s, y| exact_sum(s, y).0), sum.zip_map(&increment, |s, y| exact_sum(s, y).1))
}

/// How a step adds to q and N.
pub trait Sums {
    /// Whether the rounding error is stored, and added in the next step.
    const ARE_COMPENSATED: bool;

    /// The rounding error of a sum; `()` if it is not stored.
    type Rest<T: Scalar, V: Space<T>>: Space<T>;
    /// The data that one step passes to the next: an impulse I and the rounding errors of q and N.
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

    /// The rounding error of a sum as it was read, in the entries where it is below the last place of the sum. The
    /// other entries are 0.
    fn resumed<T: Scalar, V: Space<T>>(sum: &V, rest: Self::Rest<T, V>) -> Self::Rest<T, V>;

    /// The sum from the result of a kernel. This is the new sum itself or, where sums are compensated, the addition.
    #[inline(always)]
    fn made<T: Scalar, V: Space<T>>(sum: &V, rest: &mut Self::Rest<T, V>, made: V) -> V {
        if Self::ARE_COMPENSATED { Self::sum(sum, rest, &made) } else { made }
    }
}

/// The rounding errors of q and N.
pub type Rests<S, T, Q, N> = (<S as Sums>::Rest<T, Q>, <S as Sums>::Rest<T, N>);

/// Sums as numbers are added.
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

    fn resumed<T: Scalar, V: Space<T>>(_: &V, (): ()) {}
}

/// Compensated sums.
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

    fn resumed<T: Scalar, V: Space<T>>(sum: &V, rest: V) -> V {
        rest.zip_map(sum, |rest, sum| T::select(rest.abs().at_most(T::EPSILON * sum.abs()), rest, T::zero()))
    }
}

#[cfg(test)]
mod tests;
