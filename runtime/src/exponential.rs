//! The exponential of a matrix and the function φ(z) = (eᶻ − 1)/z of it, alone and times a vector: Taylor series, scaled and doubled.
//!
//! Terms are added until they cannot be seen, whatever the precision of the scalar; derivatives of dual numbers come
//! along. Errors are a few units in the last place of |exp A| for |A| ≤ 1, and grow like |A| beyond. Scaling looks at
//! powers of A, and exp A − I is doubled. So neither large off-diagonal entries, as of a translation, nor a small A
//! cost digits.
//!
//! Source: Higham, *Functions of Matrices*, 2008, sections 10.3 and 10.7.4. Theorem 4.2 of Al-Mohy and Higham, *A New
//! Scaling and Squaring Algorithm for the Matrix Exponential*, 2009.

use crate::linear::{function, norm, product};
use crate::matrices::shifted;
use crate::space::larger;
use crate::{Real, Scalar, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// More terms than any precision asks for: 1/40! is 10⁻⁴⁸.
const TERMS: i64 = 40;
/// Halvings that bring every finite `f64` below one.
const HALVINGS: u32 = 1100;

/// exp A = Σ Aᵏ/k!; NaN where A is not finite.
pub fn exponential<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    function(a, |a| {
        let (scaled, mut halvings) = scale(a);
        let mut increment = series(&scaled, 0);
        // exp A itself is squared only once it is small, else the digits of its difference from I would be lost.
        while halvings > 0 && !is_small(&increment) {
            // exp 2A − I = 2E + E², E = exp A − I
            increment = increment + increment + product(&increment, &increment);
            halvings -= 1;
        }
        let mut power = shifted(&increment, T::Lane::one());
        for _ in 0..halvings {
            power = product(&power, &power);
        }
        Some(power)
    })
}

/// φ(A) = Σ Aᵏ/(k+1)!, which is (exp A − I)A⁻¹ where A is regular; NaN where A is not finite. φ(ad_ξ) is the right-trivialised derivative of
/// exp at ξ: the derivative of exp(ξ + εη) by ε is (φ(ad_ξ)η) exp ξ.
pub fn phi<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    function(a, |a| Some(scaled_phi(a)))
}

/// φ(A)v; NaN where A or v is not finite.
///
/// For |A| ≤ 1 the series is one of vectors: a term takes N² multiplications in place of N³. Beyond it is the product with φ(A).
pub fn phi_times<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>, v: &SVector<T, N>) -> SVector<T, N> {
    Space::<T>::side_by_side(|lane| {
        let (a, v) = (a.lane(lane), v.lane(lane));
        if !Space::<T::Lane>::all_finite(&a) || !Space::<T::Lane>::all_finite(&v) {
            return SVector::from_element(T::Lane::zero() / T::Lane::zero());
        }
        if norm(&a) <= T::Lane::one() { series_of_vectors(&a, &v) } else { scaled_phi(&a) * v }
    })
}

/// φ(A) from φ(A/2ˢ), for finite A.
fn scaled_phi<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let (mut scaled, halvings) = scale(a);
    let mut value = shifted(&series(&scaled, 1), T::one());
    for _ in 0..halvings {
        // φ(2z) = φ(z)(1 + z φ(z)/2)
        value += product(&value, &product(&scaled, &value)) * T::from_ratio(1, 2);
        scaled += scaled;
    }
    value
}

/// Σ Aᵏv/(k + 1)! for |A| ≤ 1.
fn series_of_vectors<T: Real, const N: usize>(a: &SMatrix<T, N, N>, v: &SVector<T, N>) -> SVector<T, N> {
    summed(*v, |term, k| product(a, term) * T::from_ratio(1, k))
}

/// A/2ˢ and s. From the second on, all powers of A/2ˢ are at most one in norm (or A/2ˢ itself is).
fn scale<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> (SMatrix<T, N, N>, u32) {
    let (one, half) = (T::one(), T::from_ratio(1, 2));
    let mut first = norm(a);
    if first <= one {
        return (*a, 0);
    }
    // Every k ≥ 2 is a sum of twos and threes. Where these overflow the norm of A decides.
    let square = product(a, a);
    let (mut second, mut third) = (norm(&square), norm(&product(&square, a)));
    let (mut factor, mut halvings) = (one, 0);
    while first > one && !(second <= one && third <= one) && halvings < HALVINGS {
        first *= half;
        second *= half * half;
        third *= half * half * half;
        factor *= half;
        halvings += 1;
    }
    (a * factor, halvings)
}

/// Σ_{k ≥ 1} Aᵏ/(k + shift)! for a shift of 0 or 1.
fn series<T: Real, const N: usize>(a: &SMatrix<T, N, N>, shift: i64) -> SMatrix<T, N, N> {
    summed(a * T::from_ratio(1, 1 + shift), |term, k| product(term, a) * T::from_ratio(1, k + shift))
}

/// The sum of terms, each made of the one before and of its number, until they, and their derivatives, cannot be seen.
#[inline]
fn summed<T: Real, const N: usize, const M: usize>(
    first: SMatrix<T, N, M>,
    next: impl Fn(&SMatrix<T, N, M>, i64) -> SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    let (mut term, mut sum) = (first, first);
    let negligible = T::EPSILON * T::from_ratio(1, 8) * norm(&first);
    let mut derivatives = T::DERIVATIVES;
    for k in 2..=TERMS {
        term = next(&term, k);
        sum += term;
        if norm(&term) <= negligible {
            if derivatives == 0 {
                break;
            }
            derivatives -= 1;
        }
    }
    sum
}

/// Whether I + E is at most ½ on its diagonal.
fn is_small<T: Real, const N: usize>(increment: &SMatrix<T, N, N>) -> bool {
    let largest = increment.diagonal().iter().fold(T::zero(), |max, x| larger(max, (*x + T::one()).abs()));
    largest <= T::from_ratio(1, 2)
}

#[cfg(test)]
mod tests;
