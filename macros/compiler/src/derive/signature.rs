//! The signature of the kinetic energy: how many directions it is positive and negative in, for typical parameters.

use clebsch_symbolic::{Expr, Matrix, Property, indexed};

#[cfg(test)]
mod tests;

/// The numbers of positive and of negative squares in ½ ξ·Σξ, if they are the same for several positive parameters.
/// Scalars and entries of vectors are positive, and matrices positive definite.
pub(super) fn signature(inertia: Expr<'_>) -> Option<(usize, usize)> {
    let at = |seed: u64| squares(&inertia.evaluate(&mut |symbol| typical(symbol, seed)));
    let first = at(0)?;
    (1..4).all(|seed| at(seed) == Some(first)).then_some(first)
}

/// A positive value of a symbol: a matrix is a multiple of the identity and a small rest.
fn typical(symbol: Expr<'_>, seed: u64) -> Matrix<f64> {
    let shape = symbol.shape();
    let number = |i: usize, j: usize| {
        let place = ((i * 31 + j) as u64).wrapping_mul(0x2545_f491_4f6c_dd1d);
        let mixed = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(place);
        (mixed >> 33) as f64 / (1_u64 << 31) as f64
    };
    let small = 0.1 / shape.rows as f64;
    Matrix::from_fn(shape, |(i, j)| match (shape.is_column(), i == j, symbol.property()) {
        (true, ..) => 0.5 + number(i, j),
        (_, true, Property::Projector(rank)) => {
            if i < rank {
                1.0
            } else {
                0.0
            }
        }
        (_, true, Property::Orthonormal) => 1.0,
        (_, true, _) => 1.0 + 0.5 * number(i, i),
        (_, false, Property::Diagonal) => 0.0,
        (_, false, Property::General) => small * number(i, j),
        (_, false, _) => small * number(i.min(j), i.max(j)),
    })
}

/// The signs of the pivots of a symmetric matrix, by Sylvester's law of inertia; `None` where a pivot is too small to have one.
fn squares(matrix: &Matrix<f64>) -> Option<(usize, usize)> {
    let n = matrix.shape.rows;
    let mut rows: Vec<Vec<f64>> = indexed(n, |i| indexed(n, |j| matrix.at(i, j)));
    let scale = matrix.entries.iter().fold(0.0_f64, |scale, entry| scale.max(entry.abs()));
    let (mut positive, mut negative) = (0, 0);
    for step in 0..n {
        // symmetric pivoting keeps the signs
        let pivot = (step..n).max_by(|&a, &b| rows[a][a].abs().total_cmp(&rows[b][b].abs()))?;
        rows.swap(step, pivot);
        rows.iter_mut().for_each(|row| row.swap(step, pivot));
        let value = rows[step][step];
        if value.abs() <= 1e-9 * scale || !value.is_finite() {
            return None;
        }
        if value > 0.0 {
            positive += 1
        } else {
            negative += 1
        }
        let above = rows[step].clone();
        for row in rows.iter_mut().skip(step + 1) {
            let factor = row[step] / value;
            row.iter_mut().zip(&above).for_each(|(entry, other)| *entry -= factor * other);
        }
    }
    Some((positive, negative))
}
