//! The arena of expressions: each distinct expression exists once, so equality is a comparison of indices.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use num_traits::{One, Zero};

use crate::node::{Id, Node, SymbolId, Term};
use crate::{Expr, Property, Rational, Role, Shape, Symbol, integer, rational};

/// Owns expressions. Nodes are only added, and children come before their parents.
#[derive(Default)]
pub struct Graph {
    nodes: RefCell<Vec<(Rc<Node>, Shape)>>,
    index: RefCell<HashMap<(Rc<Node>, Shape), Id>>,
    symbols: RefCell<Vec<Symbol>>,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Graph {
        Graph::default()
    }

    /// The number of distinct expressions made so far.
    pub fn len(&self) -> usize {
        self.nodes.borrow().len()
    }

    /// Whether nothing has been made yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(crate) fn intern(&self, node: Node, shape: Shape) -> Expr<'_> {
        let key = (Rc::new(node), shape);
        if let Some(&id) = self.index.borrow().get(&key) {
            return self.expr(id);
        }
        let id = Id(self.nodes.borrow().len() as u32);
        self.nodes.borrow_mut().push(key.clone());
        self.index.borrow_mut().insert(key, id);
        self.expr(id)
    }

    pub(crate) fn expr(&self, id: Id) -> Expr<'_> {
        Expr { graph: self, id }
    }

    pub(crate) fn node(&self, id: Id) -> Rc<Node> {
        self.nodes.borrow()[id.0 as usize].0.clone()
    }

    pub(crate) fn shape(&self, id: Id) -> Shape {
        self.nodes.borrow()[id.0 as usize].1
    }

    pub(crate) fn symbol_data(&self, id: SymbolId) -> Symbol {
        self.symbols.borrow()[id.0 as usize].clone()
    }

    /// The symbol with this name, shape, role and property; asking twice gives the same expression.
    pub fn symbol(&self, name: &str, shape: Shape, role: Role, property: Property) -> Expr<'_> {
        let symbol = Symbol { name: name.to_string(), shape, role, property };
        let known = self.symbols.borrow().iter().position(|other| *other == symbol);
        let index = known.unwrap_or_else(|| {
            self.symbols.borrow_mut().push(symbol);
            self.symbols.borrow().len() - 1
        });
        self.intern(Node::Symbol(SymbolId(index as u32)), shape)
    }

    /// A rational number.
    pub fn number(&self, value: Rational) -> Expr<'_> {
        self.scaled_identity(value, 1)
    }

    /// An integer.
    pub fn integer(&self, value: i64) -> Expr<'_> {
        self.number(integer(value))
    }

    /// The number `numerator / denominator`.
    pub fn rational(&self, numerator: i64, denominator: i64) -> Expr<'_> {
        self.number(rational(numerator, denominator))
    }

    /// π.
    pub fn pi(&self) -> Expr<'_> {
        self.intern(Node::Pi, Shape::scalar())
    }

    /// The n×n identity matrix.
    pub fn identity(&self, n: usize) -> Expr<'_> {
        self.scaled_identity(Rational::one(), n)
    }

    /// The zero matrix.
    pub fn zero(&self, shape: Shape) -> Expr<'_> {
        self.intern(Node::Sum(Vec::new()), shape)
    }

    fn scaled_identity(&self, value: Rational, n: usize) -> Expr<'_> {
        let terms = match value.is_zero() {
            true => Vec::new(),
            false => vec![Term { coefficient: value, scalars: Vec::new(), word: Vec::new() }],
        };
        self.intern(Node::Sum(terms), Shape::square(n))
    }

    /// A matrix of numbers, row by row.
    pub fn literal(&self, shape: Shape, entries: Vec<Rational>) -> Expr<'_> {
        assert_eq!(entries.len(), shape.len(), "one number for each entry");
        if shape.is_scalar() {
            return self.number(entries[0].clone());
        }
        if entries.iter().all(Rational::is_zero) {
            return self.zero(shape);
        }
        let diagonal = |(i, j): (usize, usize)| if i == j { entries[0].clone() } else { Rational::zero() };
        if shape.is_square() && shape.positions().map(diagonal).eq(entries.iter().cloned()) {
            return self.scaled_identity(entries[0].clone(), shape.rows);
        }
        self.intern(Node::Literal(entries), shape)
    }

    /// The matrix with a one at (row, column) and zeros elsewhere.
    pub fn unit(&self, shape: Shape, row: usize, column: usize) -> Expr<'_> {
        let one_at = |position| if position == (row, column) { Rational::one() } else { Rational::zero() };
        self.literal(shape, shape.positions().map(one_at).collect())
    }

    /// A matrix of scalar expressions, row by row.
    pub fn stack<'g>(&'g self, shape: Shape, entries: Vec<Expr<'g>>) -> Expr<'g> {
        assert_eq!(entries.len(), shape.len(), "one expression for each entry");
        if shape.is_scalar() {
            return entries[0];
        }
        if let Some(numbers) = entries.iter().map(|entry| entry.as_number()).collect::<Option<Vec<_>>>() {
            return self.literal(shape, numbers);
        }
        self.intern(Node::Stack(entries.iter().map(|entry| entry.id).collect()), shape)
    }
}
