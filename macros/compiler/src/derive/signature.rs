//! The signature of the kinetic energy: how many directions it is positive and negative in, for typical parameters.

use clebsch_symbolic::{Expr, IntoList, Matrix, Property, Role, identity, indexed};

#[cfg(test)]
mod tests;

/// The first seed of extreme values: those of typical ones are below.
const EXTREMES: u64 = 100;

/// The numbers of positive and of negative squares in ½ ξ·Σξ, if they are the same for several positive parameters.
/// Scalars and entries of vectors are positive, and matrices positive definite.
pub(super) fn signature(inertia: Expr<'_>) -> Option<(usize, usize)> {
    let at = |seed: u64| squares(&inertia.evaluate(&mut |symbol| typical(symbol, seed)));
    let first = at(0)?;
    (1..4).all(|seed| at(seed) == Some(first)).then_some(first)
}

/// Whether the signature stays the same for positive parameters of different sizes and for stretched symmetric matrices. Other square
/// matrices are positive definite too, or have positive entries.
pub(super) fn holds_for_all(inertia: Expr<'_>, are_definite: bool) -> bool {
    const TRIALS: u64 = 8;
    let found = signature(inertia);
    (0..TRIALS).all(|seed| {
        let matrix = inertia.evaluate(&mut |symbol| extreme(symbol, seed, are_definite));
        // in units in which all directions are alike: sizes hide no sign.
        let root = |i: usize| matrix.at(i, i).abs().sqrt();
        let entry =
            |(i, j)| if root(i) * root(j) > 0.0 { matrix.at(i, j) / (root(i) * root(j)) } else { matrix.at(i, j) };
        squares(&Matrix::from_fn(matrix.shape, entry)) == found
    })
}

/// A positive value of a parameter, between a thirtieth and thirty, or a positive definite matrix. Other symbols are typical.
fn extreme(symbol: Expr<'_>, seed: u64, are_definite: bool) -> Matrix<f64> {
    let usual = typical(symbol, seed);
    if !matches!(symbol.role(), Some(Role::Parameter(_) | Role::Constant(_))) {
        return usual;
    }
    let number = numbers(symbol, seed + EXTREMES);
    let shape = symbol.shape();
    match symbol.property() {
        property
            if shape.is_square()
                && !shape.is_scalar()
                && (property == Property::Symmetric || property == Property::General && are_definite) =>
        {
            let product =
                |i: usize, j: usize| (0..shape.rows).map(|k| (number(i, k) - 0.5) * (number(j, k) - 0.5)).sum();
            Matrix::from_fn(shape, |(i, j)| product(i, j))
        }
        Property::Diagonal => {
            Matrix::from_fn(shape, |(i, j)| if i == j { 30_f64.powf(2.0 * number(i, j) - 1.0) } else { 0.0 })
        }
        Property::General => Matrix::from_fn(shape, |(i, j)| 30_f64.powf(2.0 * number(i, j) - 1.0)),
        _ => usual,
    }
}

/// Numbers from 0 to 1 for the entries of a symbol, other ones for each symbol and seed.
fn numbers(symbol: Expr<'_>, seed: u64) -> impl Fn(usize, usize) -> f64 {
    let seeds = symbol.to_string().bytes().map(u64::from).chain([seed]).into_list();
    move |i, j| identity::fraction(&[seeds.as_slice(), &[i as u64, j as u64]].concat())
}

/// A positive value of a symbol: a matrix is a multiple of the identity and a small rest.
fn typical(symbol: Expr<'_>, seed: u64) -> Matrix<f64> {
    let shape = symbol.shape();
    let number = numbers(symbol, seed);
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
