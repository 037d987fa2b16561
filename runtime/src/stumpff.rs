//! The functions of Stumpff, by which closed forms of exponentials are written without a case for small angles.

use crate::{Mask, Real, Scalar};

/// c_k(s) = Σ_j (−s)ʲ/(k + 2j)! for k ≤ 7: c₀ = cos √s, c₁ = sin √s/√s, and cosh, sinh for negative s. A polynomial
/// stands for the series where |s| ≤ 1, for k ≥ 3 where |s| ≤ 16. Beyond, the closed form is used, by
/// c_{k+2} = (1/k! − c_k)/s, which loses no digits there.
///
/// Measured against sums of 31 digits, the error is below 1.5 ε |c_k| where |s| ≤ 1, and below 2.5 ε |c_k| up to
/// |s| = 16. Beyond it is below 4 ε (1 + √|s|)|c_k|, by the rounding of √|s|. Where c₀, c₁ or c₂ crosses 0, the bound
/// is this part of the amplitude s^(−k/2) of its oscillation.
///
/// The exponential of a skew 3×3 matrix is exp x^ = I + c₁(|x|²)x^ + c₂(|x|²)x^x^, and φ(x^) = I + c₂ x^ + c₃ x^x^.
///
/// Source: Stumpff, *Himmelsmechanik* I, 1959, section V.
#[inline]
pub fn stumpff<T: Scalar>(k: u32, s: T) -> T {
    if has_table::<T>(k, 0) && s.abs().at_most(T::from_f64(SMALL)).all() {
        return polynomial::<T, 2>(k, s);
    }
    T::from_lanes(|lane| beyond_small(k, s.lane(lane)))
}

/// Up to here the terms from s⁸ on are below ε/64 of the sum.
const SMALL: f64 = 0.25;

/// Whether the table has the digits of the type, and the terms that derivatives of this order ask for.
#[inline]
fn has_table<T: Scalar>(k: u32, derivatives: u32) -> bool {
    T::DERIVATIVES <= derivatives && T::EPSILON.to_f64() >= f64::EPSILON && k < LARGEST
}

/// One lane: the table for small numbers, too, so that each lane has the bits of a number by itself.
fn beyond_small<T: Real>(k: u32, s: T) -> T {
    let size = s.abs();
    let at_most = |limit| size <= T::from_f64(limit);
    if !at_most(if k < 3 { 1.0 } else { 16.0 }) {
        return closed(k, s);
    }
    if !has_table::<T>(k, 3) {
        return series(k, s);
    }
    if has_table::<T>(k, 0) && at_most(SMALL) {
        return polynomial::<T, 2>(k, s);
    }
    if at_most(1.0) { polynomial::<T, 3>(k, s) } else { polynomial::<T, 4>(k, s) }
}

/// The first 4 `GROUPS` terms of the series, in groups of four by powers of s⁴.
#[inline]
fn polynomial<T: Scalar, const GROUPS: usize>(k: u32, s: T) -> T {
    let square = s * s;
    let fourth = square * square;
    let group = |group: usize| {
        let at = |j: usize| T::from_f64(INVERSE_FACTORIALS[k as usize + 8 * group + 2 * j]);
        (at(0) - at(1) * s) + (at(2) - at(3) * s) * square
    };
    (0..GROUPS - 1).rev().fold(group(GROUPS - 1), |sum, index| group(index) + sum * fourth)
}

/// Below this k the table has all terms: k + 2·15 is below its length.
const LARGEST: u32 = 10;

/// 1/n!, rounded once up to 22! and to a few units in the last place beyond.
const INVERSE_FACTORIALS: [f64; 40] = {
    let (mut table, mut factorial, mut n) = ([1.0; 40], 1.0, 1);
    while n < 40 {
        factorial *= n as f64;
        table[n] = 1.0 / factorial;
        n += 1;
    }
    table
};

/// More terms than any precision asks for: 16⁴⁰/83! is 10⁻⁷⁶.
const TERMS: u32 = 40;

/// Terms until they, and their derivatives, cannot be seen.
pub(crate) fn series<T: Real>(k: u32, s: T) -> T {
    let mut term = inverse_factorial::<T>(k);
    let mut sum = term;
    let mut derivatives = T::DERIVATIVES;
    for j in 1..=TERMS {
        let n = i64::from(k + 2 * j);
        term = -term * s / T::from_f64((n * (n - 1)) as f64);
        sum += term;
        if term.abs() <= T::EPSILON * T::from_ratio(1, 8) * sum.abs() {
            if derivatives == 0 {
                break;
            }
            derivatives -= 1;
        }
    }
    sum
}

fn closed<T: Real>(k: u32, s: T) -> T {
    let root = s.abs().sqrt();
    let (odd, even) = if s > T::zero() { root.sin_cos() } else { (root.sinh(), root.cosh()) };
    let (mut value, mut index) = if k.is_multiple_of(2) { (even, 0) } else { (odd / root, 1) };
    while index < k {
        value = (inverse_factorial::<T>(index) - value) / s;
        index += 2;
    }
    value
}

/// 1/k!
fn inverse_factorial<T: Real>(k: u32) -> T {
    T::one() / (2..=k).fold(T::one(), |product, factor| product * T::from_f64(f64::from(factor)))
}

#[cfg(test)]
mod tests;
