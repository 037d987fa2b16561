//! Roots and dips of a function in a step, from values at parts of it.

use crate::space::larger;
use crate::{Error, Real};

/// A root: a part of a step, on the near side of it, and the state there.
#[derive(Clone, Copy)]
pub(super) struct Found<X, T> {
    pub part: T,
    pub state: X,
}

/// A part of a step with the value there.
type Point<T> = (T, T);

/// Evaluations with which the least value is looked for, at most.
const EVALUATIONS: usize = 60;
/// A parabola whose least value is above this part of the values at both ends is not looked at.
const NEAR: (i64, i64) = (1, 4);

/// The last part, to ε, before the function leaves its side of zero between two points on different sides, with the
/// state there. `None` is the first point.
///
/// The bracket [a, b] shrinks by the point of the method. It is the secant's x_f, moved by δ towards the middle, and then
/// into the distance r from the middle:
///
/// ```text
/// δ = max(κ₁(b − a)², ε),    r = ε 2^(n − j) − (b − a)/2,    n = ⌈log₂((b₀ − a₀)/2ε)⌉ + 1,    κ₁ = 0.2/(b₀ − a₀)
/// ```
/// So it ends after n evaluations, whatever the function is. A secant that has met the root to rounding is moved across
/// it by ε, which ends the search.
pub(super) fn root<X, T: Real>(
    [near, far]: [Point<T>; 2],
    mut evaluate: impl FnMut(T) -> Result<(X, T), Error>,
) -> Result<Option<Found<X, T>>, Error> {
    let half = T::from_ratio(1, 2);
    let is_above = near.1 > T::zero();
    let ((mut a, mut at_a), (mut b, mut at_b)) = (near, far);
    let mut found = None;
    let slack = T::from_ratio(1, 5) / (b - a);
    // ε 2^(n − j): twice the width of the bracket at first, and then half of it after each evaluation
    let mut budget = T::EPSILON;
    while budget < b - a {
        budget += budget;
    }
    while b - a > T::EPSILON + T::EPSILON {
        let middle = a + (b - a) * half;
        let reach = larger(budget - (b - a) * half, T::zero());
        let secant = (at_b * a - at_a * b) / (at_b - at_a);
        let towards = if secant < middle { T::one() } else { -T::one() };
        let moved = secant + towards * larger(slack * (b - a) * (b - a), T::EPSILON);
        let is_before = (middle - moved) * towards >= T::zero();
        // also where overflow has made it NaN
        let moved = if is_before { moved } else { middle };
        let part = if (moved - middle).abs() <= reach { moved } else { middle - towards * reach };
        let (state, value) = evaluate(part)?;
        if is_above == (value > T::zero()) {
            (a, at_a) = (part, value);
            found = Some(Found { part, state });
        } else {
            (b, at_b) = (part, value);
        }
        budget *= half;
    }
    Ok(found)
}

/// A point at which function k is on the other side of zero than at two points around it. It is looked for if the
/// parabola through a third point comes near zero between the two. The least value is looked for along parabolas and golden sections.
pub(super) fn dip<T: Real>(
    [near, far, third]: [Point<T>; 3],
    k: usize,
    mut evaluate: impl FnMut(T) -> Result<T, Error>,
) -> Result<Option<Point<T>>, Error> {
    // all values are taken on the side above zero
    let side = if near.1 > T::zero() { T::one() } else { -T::one() };
    let above = |(part, value): Point<T>| (part, side * value);
    let (mut a, mut b) = (above(near), above(far));
    let least = if a.1 < b.1 { a.1 } else { b.1 };
    // crossings that are nearer to each other than some ε^⅜ of the step are lost in rounding
    let touch = (T::EPSILON * T::EPSILON.sqrt()).sqrt() * larger(a.1, b.1);
    let Some((part, value)) = vertex(a, b, above(third)) else { return Ok(None) };
    if value > least * T::from_ratio(NEAR.0, NEAR.1) {
        return Ok(None);
    }
    let mut x = (part, side * evaluate(part)?);
    for _ in 0..EVALUATIONS {
        if x.1 < -touch {
            return Ok(Some((x.0, side * x.1)));
        }
        let golden = T::from_ratio(381_966, 1_000_000);
        let section = if x.0 - a.0 > b.0 - x.0 { x.0 - golden * (x.0 - a.0) } else { x.0 + golden * (b.0 - x.0) };
        let part = vertex(a, b, x).map_or(section, |(part, _)| part);
        if (part - x.0).abs() <= T::EPSILON.sqrt() {
            break;
        }
        let other = (part, side * evaluate(part)?);
        let (low, high) = if other.1 < x.1 { (other, x) } else { (x, other) };
        if high.0 < low.0 {
            a = high;
        } else {
            b = high;
        }
        x = low;
    }
    if x.1 > touch { Ok(None) } else { Err(Error::EventGrazes { event: k, least: x.1.to_f64() }) }
}

/// The least value of the parabola through three points, if it is between the first two, and where.
fn vertex<T: Real>((a, at_a): Point<T>, (b, at_b): Point<T>, (c, at_c): Point<T>) -> Option<Point<T>> {
    let slope = (at_b - at_a) / (b - a);
    let bend = ((at_c - at_a) / (c - a) - slope) / (c - b);
    let part = (a + b - slope / bend) * T::from_ratio(1, 2);
    let is_least = bend > T::zero() && a < part && part < b;
    is_least.then(|| (part, at_a + slope * (part - a) + bend * (part - a) * (part - b)))
}

#[cfg(test)]
mod tests;
