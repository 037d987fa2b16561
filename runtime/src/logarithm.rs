//! The principal logarithm of a matrix: square roots until it is near the identity, then the series of 2 artanh.
//!
//! Source: Higham, *Functions of Matrices*, 2008, equations 6.29 (the product form of the iteration of Denman and Beavers) and 11.31.

use crate::linear::{divided, function, norm, product};
use crate::matrices::shifted;
use crate::{Real, Scalar};
use nalgebra::SMatrix;
use num_traits::{One, Zero};

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

/// The same of a rotation R or a rigid motion (R d; 0 1) in the plane or in space, by a closed form. NaN of matrices of other sizes. The axis of a turn by π has either direction.
///
/// ```text
/// (w, v) = (cos ½θ, n sin ½θ),    log R = θ n^,    u = d − ½ θ n×d + (1 − ½θ cot ½θ) n×(n×d)
/// ```
/// Source: Murray, Li and Sastry, *A Mathematical Introduction to Robotic Manipulation*, 1994, proposition 2.9. Shepperd, *Quaternion from
/// rotation matrix*, Journal of Guidance and Control 1 (1978), for w and v.
pub fn motion_logarithm<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    function(a, |a| {
        let at = |i: usize, j: usize| a.get((i, j)).copied().unwrap_or_else(T::Lane::zero);
        let is_motion = (0..N).all(|j| at(N - 1, j) == if j + 1 == N { T::Lane::one() } else { T::Lane::zero() });
        let zero = T::Lane::zero();
        let (turn, shift) = match (N, is_motion) {
            (2, _) => (of_plane(&at), [zero; 3]),
            (3, true) => (of_plane(&at), [at(0, 2), at(1, 2), zero]),
            (3, false) => (of_space(&at), [zero; 3]),
            (4, true) => (of_space(&at), [at(0, 3), at(1, 3), at(2, 3)]),
            _ => return None,
        };
        let y = turn.map(|v| v.0);
        let mut log = SMatrix::<T::Lane, N, N>::from_element(zero);
        let mut put = |i: usize, j: usize, value: T::Lane| {
            if let Some(entry) = log.get_mut((i, j)) {
                *entry = value;
            }
        };
        // in the plane the turn is about the third axis
        put(1, 0, y[2]);
        put(0, 1, -y[2]);
        let rows = if is_motion { N - 1 } else { N };
        if rows == 3 {
            put(2, 1, y[0]);
            put(1, 2, -y[0]);
            put(0, 2, y[1]);
            put(2, 0, -y[1]);
        }
        if is_motion && N > 2 {
            let (once, axis) = (cross(&y, &shift), turn.map(|v| v.1));
            let twice = cross(&axis, &cross(&axis, &shift));
            for i in 0..rows {
                put(i, N - 1, shift[i] - once[i] * T::Lane::from_ratio(1, 2) + turn[i].2 * twice[i]);
            }
        }
        Some(log)
    })
}

fn cross<T: Real>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Component by component: the logarithm of a turn, its axis, and 1 − ½θ cot ½θ.
type Turn<T> = [(T, T, T); 3];

/// Of a turn of the plane by θ, from cos θ and sin θ.
fn of_plane<T: Real>(at: &impl Fn(usize, usize) -> T) -> Turn<T> {
    let (cosine, sine) = ((at(0, 0) + at(1, 1)) * T::from_ratio(1, 2), (at(1, 0) - at(0, 1)) * T::from_ratio(1, 2));
    // tan ½θ by the form that does not cancel
    let (w, v) =
        if cosine >= T::zero() { (T::one() + cosine, sine) } else { (sine.abs(), signed(T::one() - cosine, sine)) };
    let scale = (w * w + v * v).sqrt();
    of_quaternion(w / scale, [T::zero(), T::zero(), v / scale])
}

/// |a| with the sign of b.
fn signed<T: Real>(a: T, b: T) -> T {
    if b < T::zero() { -a } else { a }
}

/// Of a turn in space.
fn of_space<T: Real>(at: &impl Fn(usize, usize) -> T) -> Turn<T> {
    let diagonal = [at(0, 0), at(1, 1), at(2, 2)];
    let trace = diagonal[0] + diagonal[1] + diagonal[2];
    let skew = [at(2, 1) - at(1, 2), at(0, 2) - at(2, 0), at(1, 0) - at(0, 1)];
    let half = T::from_ratio(1, 2);
    let (w, v) = if trace > T::zero() {
        let twice = (T::one() + trace).sqrt();
        (twice * half, skew.map(|entry| entry * half / twice))
    } else {
        // about the axis with the largest entry
        let i = if diagonal[0] >= diagonal[1] && diagonal[0] >= diagonal[2] {
            0
        } else {
            1 + usize::from(diagonal[2] > diagonal[1])
        };
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let twice = (T::one() + diagonal[i] - diagonal[j] - diagonal[k]).sqrt();
        let mut v = [T::zero(); 3];
        v[i] = twice * half;
        v[j] = (at(j, i) + at(i, j)) * half / twice;
        v[k] = (at(k, i) + at(i, k)) * half / twice;
        (skew[i] * half / twice, v)
    };
    of_quaternion(w, v)
}

/// θ n, n and 1 − ½θ cot ½θ from w = cos ½θ and v = n sin ½θ, or from −w and −v.
fn of_quaternion<T: Real>(w: T, v: [T; 3]) -> Turn<T> {
    let (w, v) = if w < T::zero() { (-w, v.map(|entry| -entry)) } else { (w, v) };
    let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let (tangent, two) = (square / (w * w), T::from_ratio(2, 1));
    if T::DERIVATIVES > 0 && tangent <= T::from_ratio(1, 16) {
        // where the root has no derivative
        let part = arctangent(tangent);
        let (per, cotangent) = (two * part / w, T::one() - part);
        // n×(n×d) times this is v×(v×d) times that over |v|², which is smooth
        let scale = T::one() / w;
        let rest = if square > T::zero() { cotangent / tangent } else { T::from_ratio(1, 3) };
        return v.map(|entry| (per * entry, scale * entry, rest));
    }
    let sine = square.sqrt();
    let half = if w > T::zero() { (sine / w).atan() } else { two * T::one().atan() };
    if sine == T::zero() {
        return v.map(|entry| (two * entry, entry, T::zero()));
    }
    let (per, inverse) = (two * half / sine, T::one() / sine);
    v.map(|entry| (per * entry, inverse * entry, T::one() - half * w * inverse))
}

/// arctan √s / √s.
fn arctangent<T: Real>(s: T) -> T {
    let (mut power, mut sum) = (T::one(), T::one());
    let mut derivatives = T::DERIVATIVES;
    for k in 1..=TERMS {
        power = -power * s;
        let term = power * T::from_ratio(1, 2 * k + 1);
        sum += term;
        if term.abs() <= T::EPSILON * T::from_ratio(1, 8) {
            if derivatives == 0 {
                break;
            }
            derivatives -= 1;
        }
    }
    sum
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
