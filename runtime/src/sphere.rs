//! Points on spheres in (q, w), where the momentum is M = wqᵀ − qwᵀ: a step in n numbers in place of n(n − 1)/2.
//!
//! w is the velocity times the inertia, perpendicular to q. Each kick removes the component of w along q, which comes
//! from rounding. Otherwise the errors of q·w and of |q| grow exponentially.

use crate::matrices::skew_times;
use crate::orbit::longer;
use crate::{Error, Mask, Scalar};
use nalgebra::SVector;

/// w = Mq/|q|² of the momentum with the components μ, without its component along q, which is rounding. |q|² differs
/// from one by rounding alone.
#[inline]
pub fn tangent<T: Scalar, const N: usize, const M: usize>(q: &SVector<T, N>, mu: &SVector<T, M>) -> SVector<T, N> {
    let missing = T::one() - q.dot(q);
    let mut w = skew_times(mu, q);
    straighten(q, &mut w);
    w * (T::one() + missing)
}

/// Adds `weight` g to w, and removes the component of w along q.
#[inline]
pub fn push<T: Scalar, const N: usize>(q: &SVector<T, N>, w: &mut SVector<T, N>, gradient: &SVector<T, N>, weight: T) {
    w.zip_apply(gradient, |w, g| *w += g * weight);
    straighten(q, w);
}

/// Removes the component of w along q.
#[inline]
fn straighten<T: Scalar, const N: usize>(q: &SVector<T, N>, w: &mut SVector<T, N>) {
    let along = q.dot(w);
    w.zip_apply(q, |w, q| *w -= q * along);
}

/// q, brought back to length one as by [`of_length_one`](crate::orbit::of_length_one), and w made longer in return: wqᵀ − qwᵀ stays.
#[inline]
fn mend<T: Scalar, const N: usize>(q: &mut SVector<T, N>, w: &mut SVector<T, N>) {
    let missing = T::one() - q.dot(q);
    let is_off = (T::from_ratio(8, 1) * T::EPSILON).below(missing.abs());
    if is_off.any() {
        let longer = longer(missing);
        q.apply(|x| *x = T::select(is_off, *x + *x * longer, *x));
        w.apply(|x| *x = T::select(is_off, *x - *x * longer, *x));
    }
}

/// q⁺ = cq + aw and w⁺ = cw − a|w|²q with c = √(1 − a²|w|²), along a great circle. The angle has the sine a|w|. Here a
/// is h/κ, with the inertia κ. Lanes without a solution are NaN. Rounding is taken off the length of q⁺.
///
/// # Errors
/// Where it exists in no lane: [`Error::Unsolvable`] with 1/|sin θ|, the solvable fraction of the momentum; [`Error::NotFinite`]. Nothing has moved then.
///
/// Source: Nordkvist, Crouch and Bloch, *Discrete Clebsch Optimal Control*, example B.
#[inline]
pub fn turn_great_circle<T: Scalar, const N: usize>(
    a: T,
    q: &mut SVector<T, N>,
    w: &mut SVector<T, N>,
) -> Result<(), Error> {
    let back = (*w * a).dot(w);
    let cosine = cosine_of(a * back)?;
    for (q, w) in q.iter_mut().zip(w.iter_mut()) {
        (*q, *w) = (*q * cosine + *w * a, *w * cosine - *q * back);
    }
    mend(q, w);
    Ok(())
}

/// √(1 − sin²θ), NaN in lanes where there is none.
#[inline]
fn cosine_of<T: Scalar>(sine_squared: T) -> Result<T, Error> {
    if !sine_squared.below(T::one()).any() {
        return Err(crate::element::beyond_right_angle(sine_squared));
    }
    Ok((T::one() - sine_squared).sqrt())
}

/// The same for a point that nothing pushes, with w = Mq and the constant momentum M = vuᵀ − uvᵀ. q stays in the plane
/// of u and v: each step multiplies its rounding error out of the plane by c. A point that knows only its q and w meets
/// the same rounding on each round. Its plane then turns away in proportion to the number of steps.
#[inline]
pub fn turn_freely<T: Scalar, const N: usize>(
    a: T,
    (u, v): &(SVector<T, N>, SVector<T, N>),
    q: &mut SVector<T, N>,
) -> Result<(), Error> {
    let (along, across) = (u.dot(q), v.dot(q));
    let mut w = v.zip_map(u, |v, u| v * along - u * across);
    let cosine = cosine_of(a * (w * a).dot(&w))?;
    q.zip_apply(&w, |q, w| *q = *q * cosine + w * a);
    mend(q, &mut w);
    Ok(())
}

/// q and p, both turned by F with the momentum M = pqᵀ − qpᵀ, along a great circle of a sphere of any radius. The plane
/// of q and p turns by the angle with the sine a|M|. Here a is h/κ, with the inertia κ. The component of p along q
/// stays along q. Lanes without a solution are NaN.
///
/// ```text
/// p = βq + w, w ⊥ q:    q⁺ = cq + a|q|²w,    p⁺ = βq⁺ + cw − a|w|²q,    c² = 1 − a²|q|²|w|²
/// ```
///
/// Source: Nordkvist, Crouch and Bloch, *Discrete Clebsch Optimal Control*, theorem 1 and example B.
#[inline]
#[allow(clippy::type_complexity, reason = "the point and its covector")]
pub fn turned_in_plane<T: Scalar, const N: usize>(
    a: T,
    q: &SVector<T, N>,
    p: &SVector<T, N>,
) -> Result<(SVector<T, N>, SVector<T, N>), Error> {
    let square = q.dot(q);
    let along = q.dot(p) / square;
    let w = p.zip_map(q, |p, q| p - q * along);
    let turn = w * (a * square);
    let back = a * w.dot(&w);
    let cosine = cosine_of(a * square * back)?;
    let next = q.zip_map(&turn, |q, turn| q * cosine + turn);
    let covector = w.zip_map(q, |w, q| w * cosine - q * back);
    Ok((next, covector.zip_map(&next, |w, q| w + q * along)))
}
