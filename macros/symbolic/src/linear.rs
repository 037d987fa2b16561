//! Linear parts: the matrix of a map that is linear in a vector, and the powers of a scalar in a sum.

use crate::node::{Exponent, Term};
use crate::{Expr, Rational, Shape};

/// A longer vector is looked at as a whole before the derivatives are taken along each of its directions.
const LONG: usize = 16;

impl<'g> Expr<'g> {
    /// The matrix A with `self` = A·v, for an expression that is linear in the vector symbol v.
    pub fn matrix_of_linear(self, vector: Expr<'g>) -> Expr<'g> {
        let graph = self.graph;
        let shape = Shape::new(self.shape().rows, vector.shape().rows);
        let expanded = self.expand();
        let mut sum = graph.zero(shape);
        for term in expanded.terms() {
            let whole = graph.collect(self.shape(), [term.clone()]);
            let mut matrix = term;
            let trailing = matrix.word.pop() == Some(vector.id);
            let mut factors = matrix.word.iter().chain(matrix.scalars.iter().map(|(base, _)| base));
            let linear = trailing && !factors.any(|&factor| graph.expr(factor).depends_on(vector));
            sum = sum + if linear { graph.collect(shape, [matrix]) } else { whole.jacobian(vector) };
        }
        sum
    }

    /// The matrix of derivatives of a vector expression, column by column.
    pub fn jacobian(self, vector: Expr<'g>) -> Expr<'g> {
        let graph = self.graph;
        let shape = Shape::new(self.shape().rows, vector.shape().rows);
        if shape.columns > LONG
            && let Some(factor) = self.over(vector)
        {
            return factor * graph.identity(shape.rows);
        }
        let column = |j| self.differential(&[(vector, graph.unit(vector.shape(), j, 0))]);
        let columns: Vec<Expr<'g>> = (0..shape.columns).map(column).collect();
        graph.stack(shape, shape.positions().map(|(i, j)| columns[j].entry(i, 0)).collect())
    }

    /// s, where the expression is the multiple s·v of a vector v that s does not depend on, as it is written.
    pub fn over(self, vector: Expr<'g>) -> Option<Expr<'g>> {
        let graph = self.graph;
        let mut sum = graph.integer(0);
        for term in self.terms() {
            let scale = graph.scale(&term);
            if term.word != [vector.id] || scale.depends_on(vector) {
                return None;
            }
            sum = sum + scale;
        }
        Some(sum)
    }

    /// The least exponent with which a scalar symbol occurs among the terms of the expanded expression; `None` for zero.
    pub fn least_exponent(self, scalar: Expr<'g>) -> Option<Rational> {
        let exponent = |term: &Term| {
            let found = term.scalars.iter().find(|(base, _)| *base == scalar.id);
            found.map_or(Exponent::ZERO, |(_, exponent)| *exponent)
        };
        self.expand().terms().iter().map(exponent).min().map(Rational::short)
    }
}
