//! Quaternions as vectors of their coordinates i, j, k, w, which is how nalgebra stores them.

use clebsch_symbolic::{Expr, Graph, Shape};
pub(super) use clebsch_symbolic::{conjugate, quaternion_product as product};

pub(super) const COORDINATES: usize = 4;
/// The position of the scalar part.
const SCALAR: usize = 3;

pub(super) const NAMES: [&str; COORDINATES] = ["i", "j", "k", "w"];

pub(super) fn imaginary(q: Expr<'_>) -> Expr<'_> {
    q.block(0, 0, Shape::vector(SCALAR))
}

pub(super) fn scalar(q: Expr<'_>) -> Expr<'_> {
    q.entry(SCALAR, 0)
}

/// The quaternion s, whose vector part is zero.
pub(super) fn real<'g>(graph: &'g Graph, s: Expr<'g>) -> Expr<'g> {
    s * graph.unit(Shape::vector(COORDINATES), SCALAR, 0)
}

/// q x q⁻¹ for a unit quaternion w + u: x + 2w u × x + 2u × (u × x).
pub(super) fn turn<'g>(q: Expr<'g>, x: Expr<'g>) -> Expr<'g> {
    let (w, u) = (scalar(q), imaginary(q));
    let moved = u.cross(x);
    x + 2 * (w * moved + u.cross(moved))
}

/// q x q⁻¹ for any quaternion but 0.
pub(super) fn turn_by_any<'g>(q: Expr<'g>, x: Expr<'g>) -> Expr<'g> {
    x + (turn(q, x) - x) / q.norm_squared()
}

/// q⁻¹ for any quaternion but 0.
pub(super) fn inverse(q: Expr<'_>) -> Expr<'_> {
    conjugate(q) / q.norm_squared()
}
