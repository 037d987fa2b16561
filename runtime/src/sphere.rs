//! Points on spheres in (q, w), where the momentum is M = wqᵀ − qwᵀ: a step in n numbers in place of n(n − 1)/2.
//!
//! w is the velocity times the inertia, perpendicular to q. What rounding leaves of it along q is taken off at each kick: without that
//! the errors of q·w and of |q| grow exponentially.

use crate::matrices::skew_times;
use crate::{Error, Mask, Scalar};
use nalgebra::SVector;

/// w = Mq/|q|² of the momentum with the components μ, without what rounding leaves of it along q; |q|² is off one by rounding alone.
#[inline]
pub fn tangent<T: Scalar, const N: usize, const M: usize>(q: &SVector<T, N>, mu: &SVector<T, M>) -> SVector<T, N> {
    let missing = T::one() - q.dot(q);
    perpendicular(q, &skew_times(mu, q)) * (T::one() + missing)
}

/// w + g without what of it is along q.
#[inline]
pub fn pushed<T: Scalar, const N: usize>(
    q: &SVector<T, N>,
    w: &SVector<T, N>,
    gradient: &SVector<T, N>,
) -> SVector<T, N> {
    perpendicular(q, &(w + gradient))
}

/// w without what of it is along q.
#[inline]
pub fn perpendicular<T: Scalar, const N: usize>(q: &SVector<T, N>, w: &SVector<T, N>) -> SVector<T, N> {
    let along = q.dot(w);
    w.zip_map(q, |w, q| w - q * along)
}

/// q, brought back to length one as by [`of_length_one`](crate::orbit::of_length_one), and w longer by as much as q is shorter: the momentum
/// wqᵀ − qwᵀ stays.
#[inline]
#[allow(clippy::type_complexity, reason = "the point and its w")]
pub fn on_sphere<T: Scalar, const N: usize>(q: SVector<T, N>, w: SVector<T, N>) -> (SVector<T, N>, SVector<T, N>) {
    let missing = T::one() - q.dot(&q);
    let is_off = (T::from_ratio(8, 1) * T::EPSILON).below(missing.abs());
    if !is_off.any() {
        return (q, w);
    }
    let half = missing * T::from_ratio(1, 2);
    (q.map(|x| T::select(is_off, x + x * half, x)), w.map(|x| T::select(is_off, x - x * half, x)))
}

/// q⁺ = cq + aw and w⁺ = cw − a|w|²q with c = √(1 − a²|w|²), along a great circle by the angle with the sine a|w|; a is h/κ, κ the inertia.
/// Lanes without a solution are NaN.
///
/// # Errors
/// Where it exists in no lane: [`Error::Unsolvable`] with 1/|sin θ|, the fraction of the momentum for which it would;
/// [`Error::NotFinite`].
///
/// Source: Nordkvist, Crouch and Bloch, *Discrete Clebsch Optimal Control*, example B.
#[inline]
#[allow(clippy::type_complexity, reason = "the point and its w")]
pub fn great_circle<T: Scalar, const N: usize>(
    a: T,
    q: &SVector<T, N>,
    w: &SVector<T, N>,
) -> Result<(SVector<T, N>, SVector<T, N>), Error> {
    let turn = w * a;
    let square = turn.dot(&turn);
    let exists = square.below(T::one());
    if !exists.any() {
        return Err(crate::element::beyond_right_angle(square));
    }
    // NaN where the root is
    let cosine = (T::one() - square).sqrt();
    let back = turn.dot(w);
    Ok((q.zip_map(&turn, |q, turn| q * cosine + turn), w.zip_map(q, |w, q| w * cosine - q * back)))
}
