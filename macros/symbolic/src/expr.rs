//! Handles to expressions, and the operators on them.

use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::rc::Rc;

use crate::node::{ExprNode, Id};
use crate::{Graph, Property, Rational, Role, Shape, Symbol, integer};

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
            ExprNode::Symbol(symbol) => Some((**symbol).clone()),
            _ => None,
        }
    }

    /// The role of a symbol; `None` for other expressions.
    pub fn role(self) -> Option<Role> {
        self.as_symbol().map(|symbol| symbol.role)
    }

    /// The promise about the values of a symbol; none about other expressions.
    pub fn property(self) -> Property {
        match &*self.node() {
            ExprNode::Symbol(symbol) => symbol.property,
            _ => Property::General,
        }
    }

    /// The value, if it is a rational number.
    pub fn as_number(self) -> Option<Rational> {
        let nodes = self.graph.nodes.borrow();
        let ExprNode::Sum(terms) = &*nodes.value(self.id.0 as usize).0 else { return None };
        match terms.as_slice() {
            _ if !self.shape().is_scalar() => None,
            [] => Some(Rational::zero()),
            [term] if term.scalars.is_empty() => Some(term.coefficient.clone()),
            _ => None,
        }
    }

    /// Whether it is the zero of its shape.
    pub fn is_zero(self) -> bool {
        let nodes = self.graph.nodes.borrow();
        matches!(&*nodes.value(self.id.0 as usize).0, ExprNode::Sum(terms) if terms.is_empty())
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
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Expr<'_> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.id.cmp(&other.id)
    }
}

impl fmt::Debug for Expr<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

/// The operators, each by a function of its operands.
macro_rules! operators {
    ($($operator:ident::$function:ident($a:ident: $left:ty, $b:ident: $right:ty) = $result:expr;)*) => {$(
        impl<'g> $operator<$right> for $left {
            type Output = Expr<'g>;
            fn $function(self, $b: $right) -> Expr<'g> {
                let $a = self;
                $result
            }
        }
    )*};
}

operators! {
    Add::add(a: Expr<'g>, b: Expr<'g>) = a.sum(b, Rational::one());
    Sub::sub(a: Expr<'g>, b: Expr<'g>) = a.sum(b, integer(-1));
    Mul::mul(a: Expr<'g>, b: Expr<'g>) = a.product(b);
    Mul::mul(a: i64, b: Expr<'g>) = b.times(&integer(a));
    Div::div(a: Expr<'g>, b: Expr<'g>) = a * b.powi(-1);
    Div::div(a: Expr<'g>, b: i64) = a.times(&integer(b).recip());
}

impl<'g> Neg for Expr<'g> {
    type Output = Expr<'g>;
    fn neg(self) -> Expr<'g> {
        self.times(&integer(-1))
    }
}
