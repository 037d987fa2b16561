//! The momentum equation of a rotating body by the Cayley map, of whatever inertia, by one scalar unknown.
//!
//! The discrete Lagrangian of the velocity ξ = 2x/h has the momentum A x + x × A x + (x·A x) x, with A = 2Σ/h. So
//!
//! ```text
//! (1 + |x|²) A x = μ + μ × x
//! ```
//! With s = 1 + |x|² it is linear in x, so that x = r/p with
//!
//! ```text
//! r = s² adj(A) μ + s A μ × μ + |μ|² μ,    p = s (s² det A + μ·A μ)
//! 0 = f(s) = s − 1 − |r|²/p²
//! ```
//! f increases from s = 1 on where |μ| (1/a₁ − 1/a₃) < 2, a₁ and a₃ the least and the largest eigenvalue of A. Its slope
//! is 1 + 2 yᵀ(s − A⁻¹μ^) y with (sA − μ^) y = A x. So the root is the only one. It is that of the solution which is
//! connected to the identity, as smaller momenta have one root too.
//!
//! Source: the Cayley map is that of A. Iserles, H. Z. Munthe-Kaas, S. P. Norsett, A. Zanna, *Lie-group methods*, Acta
//! Numerica 9 (2000); that its equation is linear in x for a given s is our own.

use super::{RotatingBody, Tensor, Vector, dot};
use crate::{Mask, Scalar};
use nalgebra::SVector;

/// Newton's steps for s: six for turns by h|ω| = 3, eight at 10.
const MOST: u32 = 8;

/// The polynomials of one momentum, over det A.
struct Polynomials<T> {
    /// r(s) = r₀ + r₁s + r₂s²
    r: [Vector<T>; 3],
    /// |r|² = n₀ + n₂s² + n₃s³ + n₄s⁴: A μ × μ and μ are perpendicular.
    n: [T; 4],
    /// p(s) = s (s² + k)
    k: T,
}

impl<T: Scalar, A: Tensor<T>> RotatingBody<T, A> {
    /// A multiple (p, r) of the quaternion, in which lanes it is found, those where f increases, and by how many of Newton's steps.
    #[inline(always)]
    pub(super) fn cayley_turn(&self, mu: &Vector<T>) -> (T, Vector<T>, T::Mask, u32) {
        let polynomials = self.cayley_polynomials(mu);
        // (1/a₁ − 1/a₃)² is at most twice the square of the deviator of A⁻¹
        let increases = (dot(mu, mu) * self.deviation).at_most(T::from_ratio(15, 4));
        let (mut solved, mut open, mut made) = (T::Mask::nowhere(), increases, 0);
        let mut s = polynomials.start();
        let (mut w, mut x) = polynomials.turn(s);
        if !open.any() {
            return (w, x, solved, made);
        }
        while made < MOST {
            T::iterated();
            made += 1;
            let (correction, is_last) = polynomials.correction(s);
            // the same as at s + δ, which does not wait for the division
            let moved = polynomials.turn_near(s, correction);
            w = T::select(open, moved.0, w);
            x = SVector::from_fn(|i, _| T::select(open, moved.1[i], x[i]));
            s = T::select(open, s + correction, s);
            solved = solved | open & is_last;
            open = open & !is_last;
            if !open.any() {
                break;
            }
        }
        (w, x, solved, made)
    }

    #[inline(always)]
    fn cayley_polynomials(&self, mu: &Vector<T>) -> Polynomials<T> {
        let [.., one] = self.per_determinant;
        let (image, adjugate) = (self.tensor.times(mu), self.adjugate.times(mu));
        let ([[x, y, z]], [[a, b, c]]) = (mu.data.0, image.data.0);
        let square = dot(mu, mu) * one;
        let velocity = adjugate.map(|entry| entry * one);
        let turned = SVector::from([(b * z - c * y) * one, (c * x - a * z) * one, (a * y - b * x) * one]);
        let along = mu.map(|entry| entry * square);
        let twice = |value: T| value + value;
        let n = [
            dot(&along, &along),
            dot(&turned, &turned) + twice(dot(&velocity, &along)),
            twice(dot(&velocity, &turned)),
            dot(&velocity, &velocity),
        ];
        Polynomials { r: [along, turned, velocity], n, k: dot(mu, &image) * one }
    }
}

impl<T: Scalar> Polynomials<T> {
    /// The root but for terms of the third order in |x|²: the first of Newton's steps from s = 1, without its division.
    #[inline(always)]
    fn start(&self) -> T {
        let [n0, n2, n3, n4] = self.n;
        let size = (n0 + n2) + (n3 + n4);
        let slope = (n2 + n2) + T::from_ratio(3, 1) * n3 + T::from_ratio(4, 1) * n4;
        let one = T::one();
        let start = one + size * (one + slope - (self.k + self.k) - T::from_ratio(6, 1) * size);
        T::select(one.at_most(start), start, one)
    }

    /// Newton's correction of s, and whether the next one would be below a quarter of ε.
    #[inline(always)]
    fn correction(&self, s: T) -> (T, T::Mask) {
        let [n0, n2, n3, n4] = self.n;
        let (two, three, four) = (T::from_ratio(2, 1), T::from_ratio(3, 1), T::from_ratio(4, 1));
        let square = s * s;
        let factor = square + self.k;
        // f = s − 1 − n/q with q = p²
        let q = square * (factor * factor);
        let slope_of_q = two * s * factor * (factor + two * square);
        let n = n0 + square * (n2 + s * (n3 + s * n4));
        let slope_of_n = s * (two * n2 + s * (three * n3 + four * s * n4));
        let f = (s - T::one()) * q - n;
        let correction = -(f * q) / (q * (q - slope_of_n) + n * slope_of_q);
        // the second derivative of f is at most 42 (s − 1 − f)/s², and its slope at least 1
        let size = (s - T::one()).abs() + correction.abs();
        let next = T::from_ratio(84, 1) * size * (correction * correction);
        (correction, next.at_most(T::EPSILON * (s * square)))
    }

    /// p(s) and r(s)
    #[inline(always)]
    fn turn(&self, s: T) -> (T, Vector<T>) {
        let [r0, r1, r2] = &self.r;
        (s * (s * s + self.k), SVector::from_fn(|i, _| r0[i] + s * (r1[i] + s * r2[i])))
    }

    /// p(s + δ) but for δ³, and r(s + δ).
    #[inline(always)]
    fn turn_near(&self, s: T, delta: T) -> (T, Vector<T>) {
        let (w, x) = self.turn(s);
        let [_, r1, r2] = &self.r;
        let (twice, three) = (s + s, T::from_ratio(3, 1) * s);
        let near = |i: usize| x[i] + delta * (r1[i] + (twice + delta) * r2[i]);
        (w + delta * (three * (s + delta) + self.k), SVector::from_fn(|i, _| near(i)))
    }
}
