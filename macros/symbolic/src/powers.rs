//! Powers and functions of scalars, power series of matrices.

use num_traits::{One, Zero};

use crate::node::{Analytic, Exponent, ExprNode, Function, Id, Term};
use crate::{Expr, Graph, Rational, Shape, rational};

impl<'g> Expr<'g> {
    /// An integer power of a scalar.
    pub fn powi(self, exponent: i32) -> Expr<'g> {
        self.power(rational(exponent as i64, 1))
    }

    /// The square root of a scalar.
    pub fn sqrt(self) -> Expr<'g> {
        self.power(rational(1, 2))
    }

    /// A rational power of a scalar. Powers of powers are merged only where that is true for every real value.
    pub fn power(self, exponent: Rational) -> Expr<'g> {
        assert!(self.shape().is_scalar(), "a power of `{self}`");
        let graph = self.graph;
        let Some(exponent) = small_exponent(&exponent) else {
            return (self.function(Function::Ln) * graph.number(exponent)).function(Function::Exp);
        };
        if exponent.is_zero() {
            return graph.integer(1);
        }
        if self.is_zero() && exponent > Exponent::ZERO {
            return self;
        }
        let Term { coefficient, scalars, word: _ } = self.factor();
        let mut term = Term::number(Rational::one());
        match Graph::small_integer(&exponent) {
            Some(power) if !coefficient.is_zero() => {
                term.coefficient = coefficient.power(power);
                let powers: Vec<(Id, Exponent)> = scalars.iter().map(|&(id, e)| (id, e * exponent)).collect();
                term.multiply_scalars(&powers);
            }
            _ => match self
                .as_number()
                .filter(|number| number.is_one() || (number.is_zero() && exponent > Exponent::ZERO))
            {
                Some(number) => return graph.number(number),
                None => term.multiply_scalars(&[(self.id, exponent)]),
            },
        }
        graph.collect(Shape::scalar(), [term])
    }

    /// exp A.
    pub fn exponential(self) -> Expr<'g> {
        self.analytic(Analytic::Exponential)
    }

    /// A power series of a square matrix.
    pub fn analytic(self, function: Analytic) -> Expr<'g> {
        let graph = self.graph;
        let identity = graph.identity(self.shape().rows);
        match (function, &*self.node()) {
            (Analytic::Exponential | Analytic::Phi, _) if self.is_zero() => identity,
            // of A with A² = 0
            (Analytic::Exponential, _) if (self * self).is_zero() => identity + self,
            (Analytic::Phi, _) if (self * self).is_zero() => identity + self / 2,
            (Analytic::Logarithm, _) if self.is_identity() => graph.zero(self.shape()),
            (Analytic::Logarithm, ExprNode::Analytic(Analytic::Exponential, inner)) => graph.expr(*inner),
            _ => self.atom_of(ExprNode::Analytic(function, self.id), self.shape()),
        }
    }

    /// The inverse of a matrix of numbers, by exact elimination.
    pub(crate) fn rational_inverse_of_literal(self) -> Option<Expr<'g>> {
        let n = self.shape().rows;
        let ExprNode::Literal(entries) = &*self.node() else { return None };
        let unit = |i: usize, j: usize| if i == j { Rational::one() } else { Rational::zero() };
        let row = |i: usize| -> Vec<Rational> {
            entries[i * n..(i + 1) * n].iter().cloned().chain((0..n).map(|j| unit(i, j))).collect()
        };
        let mut rows: Vec<Vec<Rational>> = (0..n).map(row).collect();
        crate::reduce(&mut rows).iter().copied().take(n).eq(0..n).then(|| {
            let entries = rows.into_iter().flat_map(|row| row.into_iter().skip(n));
            self.graph.literal(self.shape(), entries.collect())
        })
    }

    /// An elementary function of a scalar.
    pub fn function(self, function: Function) -> Expr<'g> {
        assert!(self.shape().is_scalar(), "a function of `{self}`");
        let graph = self.graph;
        let value_at_zero = match function {
            Function::Cos | Function::Cosh | Function::Exp => Some(1),
            Function::Sin | Function::Tan | Function::Asin | Function::Atan | Function::Sinh | Function::Tanh => {
                Some(0)
            }
            Function::Acos | Function::Ln | Function::Stumpff(_) => None,
        };
        match value_at_zero {
            Some(value) if self.is_zero() => graph.integer(value),
            _ if self.is_zero()
                && let Function::Stumpff(k) = function =>
            {
                graph.rational(1, (1..=i64::from(k)).product())
            }
            _ if function == Function::Ln && self.is_identity() => graph.integer(0),
            _ => self.atom_of(ExprNode::Function(function, self.id), Shape::scalar()),
        }
    }
}

/// An exponent with small numerator and denominator.
fn small_exponent(exponent: &Rational) -> Option<Exponent> {
    let small = |(numerator, denominator): (i64, i64)| numerator.abs() <= 1 << 20 && denominator <= 1 << 20;
    exponent.as_fraction().filter(|fraction| small(fraction.parts()))
}
