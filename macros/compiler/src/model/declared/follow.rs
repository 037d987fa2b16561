//! Along curves through the identity: the value of an equation there, its derivative, and whether it holds along the group that its
//! derivative suggests.

use clebsch_symbolic::identity::Residue;
use clebsch_symbolic::{Expr, Matrix, Number, Rational, Shape, Sparse, integer, rational};

use super::exact::Exact;
use super::series::Series;

/// The order up to which curves are followed.
const ORDER: usize = 8;

/// The values of expressions at F = I; `None` where they are no rational numbers that can be held.
pub(super) fn at_identity<'g>(expr: Expr<'g>, symbol: Expr<'g>) -> Option<Vec<Rational>> {
    let value = expr.evaluate(&mut |_| Matrix::scaled_identity(symbol.shape().rows, Exact::from_rational(&integer(1))));
    value.entries.into_iter().map(Exact::rational).collect()
}

/// The derivatives at F = I: a row for each entry of the expressions, a column for each entry of F, column by column.
pub(super) fn derivative<'g>(expressions: &[Expr<'g>], symbol: Expr<'g>) -> Option<Vec<Vec<Rational>>> {
    let n = symbol.shape().rows;
    let [zero, one] = [0, 1].map(|value| Exact::from_rational(&integer(value)));
    let moved = |row: usize, column: usize| {
        let entry = |position: (usize, usize)| {
            let constant = if position.0 == position.1 { one } else { zero };
            Series([constant, if position == (row, column) { one } else { zero }])
        };
        Matrix::from_fn(Shape::square(n), entry)
    };
    let slopes = |(row, column): (usize, usize)| -> Option<Vec<Rational>> {
        let element = moved(row, column);
        let values = expressions.iter().flat_map(|expr| expr.evaluate(&mut |_| element.clone()).entries);
        values.map(|value| value.0[1].rational()).collect()
    };
    let columns: Vec<Vec<Rational>> =
        (0..n).flat_map(|column| (0..n).map(move |row| (row, column))).map(slopes).collect::<Option<_>>()?;
    let rows = columns.first().map_or(0, Vec::len);
    Some((0..rows).map(|row| columns.iter().map(|column| column[row].clone()).collect()).collect())
}

/// The first power of s with which F = exp(s ξ) leaves the solutions.
pub(super) fn leaves_at<'g>(expressions: &[Expr<'g>], symbol: Expr<'g>, direction: &[(i64, &Sparse)]) -> Option<usize> {
    let element = exponential(symbol.shape().rows, direction);
    let orders = expressions.iter().flat_map(|expr| expr.evaluate(&mut |_| element.clone()).entries);
    let zero = Residue::from_rational(&integer(0));
    orders.filter_map(|series| series.0.iter().position(|coefficient| *coefficient != zero)).min()
}

/// The rank of the derivative at a general matrix, decided over a prime field.
pub(super) fn general_rank<'g>(expressions: &[Expr<'g>], symbol: Expr<'g>) -> usize {
    let along = |(i, j): (usize, usize)| {
        let direction = symbol.graph().unit(symbol.shape(), i, j);
        let moved: Vec<_> = expressions.iter().map(|expr| expr.differential(&[(symbol, direction)])).collect();
        let entries = entries(&moved);
        symbol.graph().stack(Shape::new(1, entries.len()), entries)
    };
    let derivatives: Vec<Expr<'g>> = symbol.shape().positions().map(along).collect();
    let shape = Shape::new(derivatives.len(), derivatives[0].shape().columns);
    let entries = shape.positions().map(|(i, j)| derivatives[i].entry(0, j)).collect();
    clebsch_symbolic::identity::rank(symbol.graph().stack(shape, entries))
}

/// All entries of expressions, one after the other.
pub(super) fn entries<'g>(expressions: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let of_one = |expr: &Expr<'g>| expr.shape().positions().map(|(i, j)| expr.entry(i, j)).collect::<Vec<_>>();
    expressions.iter().flat_map(of_one).collect()
}

type Follow = Series<Residue, ORDER>;

/// exp(s Σ c_i E_i) to the order that is followed.
fn exponential(n: usize, direction: &[(i64, &Sparse)]) -> Matrix<Follow> {
    let residue = |value: &Rational| Residue::from_rational(value);
    let zero = residue(&integer(0));
    let mut generator = Matrix::from_fn(Shape::square(n), |_| Series([zero; ORDER]));
    for (scale, element) in direction {
        for (i, j, value) in element.iter() {
            let entry = &mut generator.entries[i * n + j].0[1];
            *entry = entry.add(residue(&(value * &integer(*scale))));
        }
    }
    let mut power: Matrix<Follow> = Matrix::scaled_identity(n, Series::from_rational(&integer(1)));
    let mut sum = power.clone();
    for k in 1..ORDER {
        let next = power.multiply(&generator);
        let factor = Series::from_rational(&rational(1, k as i64));
        power = Matrix::from_fn(next.shape, |(i, j)| next.at(i, j).multiply(factor));
        sum = Matrix::from_fn(sum.shape, |(i, j)| sum.at(i, j).add(power.at(i, j)));
    }
    sum
}
