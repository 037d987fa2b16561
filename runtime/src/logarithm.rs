//! The principal logarithm of a matrix: square roots until it is near the identity, then the series of 2 artanh.
//!
//! Source: Higham, *Functions of Matrices*, 2008, equations 6.29 (the product form of the iteration of Denman and Beavers) and 11.31.

use crate::linear::{divided, function, norm, product};
use crate::matrices::shifted;
use crate::{Real, Scalar};
use nalgebra::SMatrix;

/// Square roots that bring every matrix of finite `f64` near the identity, unless entries off the diagonal are much the largest.
const ROOTS: u32 = 64;
/// Terms of the series: 3⁻⁸⁰ is 10⁻³⁸.
const TERMS: i64 = 40;
/// Iterations for one square root: scaled, five to ten are enough; for an eigenvalue on the negative axis none are.
const ITERATIONS: u32 = 40;

/// The principal logarithm, whose eigenvalues have imaginary parts between −π and π. NaN where A is not finite, is singular or has an
/// eigenvalue on the negative real axis. So it is where only round-off keeps one off it: square roots have lost half of the digits. For an
/// angle θ near π the error grows like ε/(π − θ), for so ill-conditioned is the logarithm there.
pub fn logarithm<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    function(a, |a| {
        let mut root = *a;
        let mut factor = T::Lane::from_f64(2.0);
        let mut roots = 0;
        while !is_near_identity(&root) {
            if roots == ROOTS {
                return None;
            }
            root = square_root(&root)?;
            factor += factor;
            roots += 1;
        }
        Some(inverse_hyperbolic_tangent(&root)? * factor)
    })
}

/// Whether |X − I| ≤ ½, or at least its powers N and N + 1 are as small: then the series converges like 9⁻ᵏ. These powers vanish for a
/// unipotent X, whose series is finite however large its entries are.
fn is_near_identity<T: Real, const N: usize>(x: &SMatrix<T, N, N>) -> bool {
    let difference = shifted(x, -T::one());
    let half = T::from_ratio(1, 2);
    let (mut power, mut bound) = (difference, half);
    if norm(&power) <= half {
        return true;
    }
    for _ in 1..N {
        power = product(&power, &difference);
        bound *= half;
    }
    norm(&power) <= bound && norm(&product(&power, &difference)) <= bound * half
}

/// ½ log X = Y + Y³/3 + Y⁵/5 + …, Y = (X + I)⁻¹(X − I).
fn inverse_hyperbolic_tangent<T: Real, const N: usize>(x: &SMatrix<T, N, N>) -> Option<SMatrix<T, N, N>> {
    let y = divided(&shifted(x, T::one()), &shifted(x, -T::one()))?;
    let square = product(&y, &y);
    let (mut power, mut sum) = (y, y);
    let first = norm(&y);
    let mut derivatives = T::DERIVATIVES;
    for k in 1..=TERMS {
        power = product(&power, &square);
        sum += power * T::from_ratio(1, 2 * k + 1);
        if norm(&power) <= T::EPSILON * T::from_ratio(1, 8) * first {
            if derivatives == 0 {
                break;
            }
            derivatives -= 1;
        }
    }
    Some(sum)
}

/// The principal square root X by X ← (X + Y⁻¹)/2, Y ← (Y + X⁻¹)/2 from A and I, where Y is X A⁻¹. `None` if the
/// iteration does not converge. The product form of the iteration, which needs one inverse less, loses the square of
/// the digits for angles near π.
fn square_root<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> Option<SMatrix<T, N, N>> {
    let identity = SMatrix::identity();
    let (mut x, mut y) = (*a, identity);
    let (half, hundredth) = (T::from_ratio(1, 2), T::from_ratio(1, 100));
    let mut before = T::one() / T::zero();
    for _ in 0..ITERATIONS {
        let (x_inverse, y_inverse) = (divided(&x, &identity)?, divided(&y, &identity)?);
        // Far off, a scaling makes eigenvalues and their inverses alike large.
        let scale = if before > hundredth {
            ((norm(&x_inverse) * norm(&y_inverse)).sqrt() / (norm(&x) * norm(&y)).sqrt()).sqrt()
        } else {
            T::one()
        };
        let mean = |x: &SMatrix<T, N, N>, inverse: &SMatrix<T, N, N>| (x * scale + inverse / scale) * half;
        let (next, next_y) = (mean(&x, &y_inverse), mean(&y, &x_inverse));
        let distance = norm(&(next - x)) / norm(&next);
        (x, y) = (next, next_y);
        // The iteration after the last one that helps is made, for derivatives are behind by one.
        if distance <= T::EPSILON || before < hundredth && distance > before * half {
            // X² is A to half of the digits at least
            return (norm(&(product(&x, &x) - a)) <= T::EPSILON.sqrt() * norm(a)).then_some(x);
        }
        before = distance;
    }
    None
}

#[cfg(test)]
mod tests;
