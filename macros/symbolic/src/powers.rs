//! Powers and functions of scalars, power series of matrices.

use crate::node::{Analytic, Exponent, ExprNode, Function, Operation, Term};
use crate::{Expr, Rational, Shape, rational};

impl<'g> Expr<'g> {
    /// An integer power of a scalar.
    pub fn powi(self, exponent: i32) -> Expr<'g> {
        self.power(rational(exponent.into(), 1))
    }

    /// The square root of a scalar.
    pub fn sqrt(self) -> Expr<'g> {
        self.power(rational(1, 2))
    }

    /// A rational power of a scalar. Powers of powers are merged only where that is true for every real value.
    pub fn power(self, exponent: Rational) -> Expr<'g> {
        assert!(self.shape().is_scalar(), "a power of `{self}`");
        let graph = self.graph;
        let is_small = |fraction: &Exponent| {
            let (numerator, denominator) = fraction.parts();
            numerator.abs().max(denominator) <= 1 << 20
        };
        let Some(exponent) = exponent.as_fraction().filter(is_small) else {
            return (self.function(Function::Ln) * graph.number(exponent)).function(Function::Exp);
        };
        if exponent.is_zero() {
            return graph.integer(1);
        }
        let number = self.as_number();
        if number.is_some_and(|number| number.is_one() || (number.is_zero() && !exponent.is_negative())) {
            return self;
        }
        let Term { coefficient, scalars, word: _ } = self.factor();
        let mut term = Term::number(Rational::one());
        match exponent.parts() {
            (power, 1) => {
                term.coefficient = coefficient.power(power as i32);
                scalars.iter().for_each(|&(id, e)| term.multiply_scalars(&[(id, e * exponent)]));
            }
            _ => term.multiply_scalars(&[(self.id, exponent)]),
        }
        graph.scalar(term)
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
            (Analytic::Logarithm | Analytic::MotionLogarithm, _) if self.is_identity() => graph.zero(self.shape()),
            (Analytic::Logarithm, ExprNode::Of(Operation::Analytic(Analytic::Exponential), inner)) => {
                graph.expr(*inner)
            }
            _ => self.atom_of(Operation::Analytic(function), self.shape()),
        }
    }

    /// An elementary function of a scalar.
    pub fn function(self, function: Function) -> Expr<'g> {
        assert!(self.shape().is_scalar(), "a function of `{self}`");
        let graph = self.graph;
        let known = match function {
            Function::Ln => self.is_identity().then(|| graph.integer(0)),
            Function::Acos => None,
            _ if !self.is_zero() => None,
            Function::Cos | Function::Cosh | Function::Exp => Some(graph.integer(1)),
            Function::Stumpff(k) => Some(graph.rational(1, (1..=i64::from(k)).product())),
            _ => Some(graph.integer(0)),
        };
        known.unwrap_or_else(|| self.atom_of(Operation::Function(function), Shape::scalar()))
    }
}
