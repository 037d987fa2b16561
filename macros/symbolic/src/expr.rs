//! Handles to expressions, and the operators on them.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::rc::Rc;

use num_traits::{One, Zero};

use crate::node::{ExprNode, Id};
use crate::{Graph, Rational, Shape, Symbol, integer};

/// A matrix-valued expression; scalars are 1×1. Copying is free, equality is structural.
///
/// Operators and methods expect operands whose shapes fit; whoever builds expressions from a user's input checks that first.
#[derive(Copy, Clone)]
pub struct Expr<'g> {
    pub(crate) graph: &'g Graph,
    pub(crate) id: Id,
}

impl<'g> Expr<'g> {
    /// The graph that owns it.
    pub fn graph(self) -> &'g Graph {
        self.graph
    }

    /// Rows and columns.
    pub fn shape(self) -> Shape {
        self.graph.shape(self.id)
    }

    /// Its place in the order in which the expressions of its graph were made.
    pub fn position(self) -> usize {
        self.id.0 as usize
    }

    pub(crate) fn node(self) -> Rc<ExprNode> {
        self.graph.node(self.id)
    }

    /// The symbol, if it is one.
    pub fn as_symbol(self) -> Option<Symbol> {
        match &*self.node() {
            ExprNode::Symbol(id) => Some(self.graph.symbol_data(*id)),
            _ => None,
        }
    }

    /// The value, if it is a rational number.
    pub fn as_number(self) -> Option<Rational> {
        match &*self.node() {
            ExprNode::Sum(terms) if self.shape().is_scalar() => match terms.as_slice() {
                [] => Some(Rational::zero()),
                [term] if term.scalars.is_empty() => Some(term.coefficient.clone()),
                _ => None,
            },
            _ => None,
        }
    }

    /// Whether it is the zero of its shape.
    pub fn is_zero(self) -> bool {
        matches!(&*self.node(), ExprNode::Sum(terms) if terms.is_empty())
    }

    /// Whether it is the identity matrix, or the number one.
    pub fn is_identity(self) -> bool {
        self.shape().is_square() && self == self.graph.identity(self.shape().rows)
    }

    /// Whether the transpose is the same expression.
    pub fn is_symmetric(self) -> bool {
        self.transpose() == self
    }
}

impl PartialEq for Expr<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Eq for Expr<'_> {}

impl Hash for Expr<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.id.hash(state);
    }
}

impl PartialOrd for Expr<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Expr<'_> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.id.cmp(&other.id)
    }
}

impl fmt::Debug for Expr<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl<'g> Add for Expr<'g> {
    type Output = Expr<'g>;
    fn add(self, other: Expr<'g>) -> Expr<'g> {
        self.sum(other, Rational::one())
    }
}

impl<'g> Sub for Expr<'g> {
    type Output = Expr<'g>;
    fn sub(self, other: Expr<'g>) -> Expr<'g> {
        self.sum(other, integer(-1))
    }
}

impl<'g> Neg for Expr<'g> {
    type Output = Expr<'g>;
    fn neg(self) -> Expr<'g> {
        self.times(&integer(-1))
    }
}

impl<'g> Mul for Expr<'g> {
    type Output = Expr<'g>;
    fn mul(self, other: Expr<'g>) -> Expr<'g> {
        self.product(other)
    }
}

impl<'g> Mul<Expr<'g>> for i64 {
    type Output = Expr<'g>;
    fn mul(self, other: Expr<'g>) -> Expr<'g> {
        other.times(&integer(self))
    }
}

impl<'g> Div for Expr<'g> {
    type Output = Expr<'g>;
    fn div(self, other: Expr<'g>) -> Expr<'g> {
        self * other.powi(-1)
    }
}

impl<'g> Div<i64> for Expr<'g> {
    type Output = Expr<'g>;
    fn div(self, other: i64) -> Expr<'g> {
        self.times(&integer(other).recip())
    }
}
