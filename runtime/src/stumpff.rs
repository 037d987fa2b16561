//! The functions of Stumpff, by which closed forms of exponentials are written without a case for small angles.

use crate::{Real, Scalar};

/// c_k(s) = Σ_j (−s)ʲ/(k + 2j)! for k ≤ 7: c₀ = cos √s, c₁ = sin √s/√s, and cosh, sinh for negative s. The series is
/// summed where |s| ≤ 1, for k ≥ 3 where |s| ≤ 16; beyond, the closed form is used, by c_{k+2} = (1/k! − c_k)/s, which
/// loses no digits there. Measured on both sides, the error is below 3 ε |c_k| up to |s| = 16. Beyond it is below 4 ε
/// (1 + √|s|)|c_k|, by the rounding of √|s|. Where c₀, c₁ or c₂ crosses 0, the bound is this part of the amplitude
/// s^(−k/2) of its oscillation. The exponential of a skew 3×3 matrix is exp x^ = I + c₁(|x|²)x^ + c₂(|x|²)x^x^, and
/// φ(x^) = I + c₂ x^ + c₃ x^x^.
///
/// Source: Stumpff, *Himmelsmechanik* I, 1959, section V.
pub fn stumpff<T: Scalar>(k: u32, s: T) -> T {
    let switch = T::Lane::from_f64(if k < 3 { 1.0 } else { 16.0 });
    T::from_lanes(|lane| match s.lane(lane) {
        s if s.abs() <= switch => series(k, s),
        s => closed(k, s),
    })
}

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
    let (even, odd) = if s > T::zero() { (root.cos(), root.sin() / root) } else { (root.cosh(), root.sinh() / root) };
    let (mut value, mut index) = if k.is_multiple_of(2) { (even, 0) } else { (odd, 1) };
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
