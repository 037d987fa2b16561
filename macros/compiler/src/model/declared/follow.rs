//! Along curves through the identity: the value of an equation there, its derivative, and whether it holds along the group that its
//! derivative suggests.

use clebsch_symbolic::identity::{self, Residue};
use clebsch_symbolic::{Elements, Expr, IntoList, Matrix, Number, Rational, Shape, Sparse, rational};

use super::numbers::{Exact, Series};

/// The order up to which curves are followed.
const ORDER: usize = 8;

/// The values of an expression at F = I; `None` if they are not rational numbers of the available size.
pub(super) fn at_identity<'g>(expr: Expr<'g>, symbol: Expr<'g>) -> Option<Vec<Rational>> {
    let value = expr.evaluate(&mut |_| Matrix::scaled_identity(symbol.shape().rows, Exact::from_integer(1)));
    value.entries.into_iter().map(Exact::rational).collect()
}

/// The derivatives at F = I: a row for each entry of the equation, a column for each entry of F, column by column.
pub(super) fn derivative<'g>(equation: Expr<'g>, symbol: Expr<'g>) -> Option<Vec<Vec<Rational>>> {
    let n = symbol.shape().rows;
    let one_if = |condition: bool| Exact::from_integer(condition.into());
    let slopes = |entry: usize| -> Option<Vec<Rational>> {
        let place = (entry % n, entry / n);
        let moved = |(i, j): (usize, usize)| Series([one_if(i == j), one_if((i, j) == place)]);
        let values = equation.evaluate(&mut |_| Matrix::from_fn(Shape::square(n), moved)).entries;
        values.into_iter().map(|value| value.0[1].rational()).collect()
    };
    let columns: Vec<Vec<Rational>> = (0..n * n).map(slopes).collect::<Option<_>>()?;
    let row = |row: usize| columns.each(|column| column[row].clone());
    Some((0..equation.shape().len()).map(row).into_list())
}

/// The first power of s with which F = exp(s ξ) leaves the solutions.
pub(super) fn leaves_at<'g>(equation: Expr<'g>, symbol: Expr<'g>, direction: &[(i64, &Sparse)]) -> Option<usize> {
    let element = exponential(symbol.shape().rows, direction);
    let orders = equation.evaluate(&mut |_| element.clone()).entries.into_iter();
    let zero = Residue::from_integer(0);
    orders.filter_map(|series| series.0.iter().position(|coefficient| *coefficient != zero)).min()
}

/// The rank of the derivative at a general matrix, decided over a prime field.
pub(super) fn general_rank<'g>(equation: Expr<'g>, symbol: Expr<'g>) -> usize {
    let graph = symbol.graph();
    let slopes = symbol.shape().positions().flat_map(|(i, j)| {
        let slope = equation.differential(&[(symbol, graph.unit(symbol.shape(), i, j))]);
        slope.shape().positions().map(move |(i, j)| slope.entry(i, j))
    });
    let shape = Shape::new(symbol.shape().len(), equation.shape().len());
    identity::rank(graph.stack(shape, slopes.into_list()))
}

type Follow = Series<Residue, ORDER>;

/// exp(s Σ c_i E_i) to the order that is followed.
fn exponential(n: usize, direction: &[(i64, &Sparse)]) -> Matrix<Follow> {
    let mut generator = Matrix::from_fn(Shape::square(n), |_| Series([Residue::from_integer(0); ORDER]));
    for (scale, element) in direction {
        for (i, j, value) in element.iter() {
            let entry = &mut generator.entries[i * n + j].0[1];
            *entry = entry.add(Residue::from_rational(value).multiply(Residue::from_integer(*scale)));
        }
    }
    let mut power: Matrix<Follow> = Matrix::scaled_identity(n, Series::from_integer(1));
    let mut sum = power.clone();
    for k in 1..ORDER {
        let next = power.multiply(&generator);
        let factor = Series::from_rational(&rational(1, k as i64));
        power = Matrix::from_fn(next.shape, |(i, j)| next.at(i, j).multiply(factor));
        sum = Matrix::from_fn(sum.shape, |(i, j)| sum.at(i, j).add(power.at(i, j)));
    }
    sum
}
