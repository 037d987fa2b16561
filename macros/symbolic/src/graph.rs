//! The arena of expressions: each distinct expression exists once, so equality is a comparison of indices.

use std::cell::{OnceCell, RefCell};
use std::rc::Rc;

use crate::algebra::{Algebra, Basis, InverseGram, dense};
use crate::group::{Block, Definition};
use crate::identity::Evaluated;
use crate::memory::{Images, Maps};
use crate::node::{ExprNode, Id, Term};
use crate::table::mixed;
use crate::{Elements, Expr, Group, Interner, Property, Rational, Role, Shape, Symbol, Table, integer, rational, work};

/// Owns expressions. Nodes are only added, and children come before their parents.
#[derive(Default)]
pub struct Graph {
    pub(crate) nodes: RefCell<Interner<(Rc<ExprNode>, Shape)>>,
    pub(crate) bases: RefCell<Interner<Rc<Basis>>>,
    pub(crate) blocks: RefCell<Table<Group, Rc<[Block]>>>,
    pub(crate) definitions: RefCell<Vec<Rc<Definition>>>,
    pub(crate) transposed: Images,
    pub(crate) expanded: Images,
    /// Expressions that are too long to be expanded, each its own image.
    pub(crate) long: Images,
    pub(crate) maps: Maps,
    /// The matrices of ad of the bases of groups.
    pub(crate) adjoints: RefCell<Table<Group, Algebra>>,
    /// The inverses of the Gram matrices of bases.
    pub(crate) inverse_grams: RefCell<Table<Algebra, Rc<InverseGram>>>,
    pub(crate) evaluated: Evaluated,
    another: OnceCell<Box<Graph>>,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Graph {
        Graph::default()
    }

    /// A graph that lives as long, and is empty when it is first asked for. Expressions made there do not depend on
    /// those made here.
    pub fn another(&self) -> &Graph {
        self.another.get_or_init(Box::default)
    }

    /// The number of distinct expressions made so far.
    pub fn len(&self) -> usize {
        self.nodes.borrow().len()
    }

    /// Whether nothing has been made yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(crate) fn intern(&self, node: ExprNode, shape: Shape) -> Expr<'_> {
        work::spend(1 + node.size() / 2);
        let mut nodes = self.nodes.borrow_mut();
        let hash = mixed(node.hashed(), (shape.rows as u64) << 32 | shape.columns as u64);
        let found = nodes.find(hash, |(known, other)| *other == shape && known.is_same(&node));
        let position = match found {
            Ok(known) => known,
            Err(slot) => nodes.insert(slot, hash, (Rc::new(node), shape)),
        };
        Expr { graph: self, id: Id(position as u32) }
    }

    #[inline(always)]
    pub(crate) fn expr(&self, id: Id) -> Expr<'_> {
        Expr { graph: self, id }
    }

    pub(crate) fn exprs<'g>(&'g self, ids: &[Id]) -> Vec<Expr<'g>> {
        ids.each(|id| self.expr(*id))
    }

    pub(crate) fn node(&self, id: Id) -> Rc<ExprNode> {
        self.nodes.borrow().value(id.0 as usize).0.clone()
    }

    pub(crate) fn shape(&self, id: Id) -> Shape {
        self.nodes.borrow().value(id.0 as usize).1
    }

    /// The symbol with this name, shape, role and property; asking twice gives the same expression.
    pub fn symbol(&self, name: &str, shape: Shape, role: Role, property: Property) -> Expr<'_> {
        let symbol = Symbol { name: name.to_string(), shape, role, property };
        self.intern(ExprNode::Symbol(Rc::new(symbol)), shape)
    }

    /// The result of a method of the user for some arguments. `output` 0 is its value, and `output` i + 1 its gradient
    /// with respect to argument i.
    pub fn opaque<'g>(&'g self, name: &str, output: usize, arguments: &[Expr<'g>], shape: Shape) -> Expr<'g> {
        self.intern(ExprNode::Opaque(name.into(), output, arguments.each(|argument| argument.id)), shape)
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
        self.intern(ExprNode::Pi, Shape::scalar())
    }

    /// The n×n identity matrix.
    pub fn identity(&self, n: usize) -> Expr<'_> {
        self.scaled_identity(Rational::one(), n)
    }

    /// The zero matrix.
    pub fn zero(&self, shape: Shape) -> Expr<'_> {
        self.intern(ExprNode::Sum(Vec::new()), shape)
    }

    fn scaled_identity(&self, value: Rational, n: usize) -> Expr<'_> {
        let terms = if value.is_zero() { Vec::new() } else { vec![Term::number(value)] };
        self.intern(ExprNode::Sum(terms), Shape::square(n))
    }

    /// A matrix of numbers, row by row.
    pub fn literal(&self, shape: Shape, entries: Vec<Rational>) -> Expr<'_> {
        assert_eq!(entries.len(), shape.len(), "one number for each entry");
        if entries.iter().all(Rational::is_zero) {
            return self.zero(shape);
        }
        let diagonal = |(i, j): (usize, usize)| if i == j { entries[0].clone() } else { Rational::zero() };
        if shape.is_square() && shape.positions().map(diagonal).eq(entries.iter().cloned()) {
            return self.scaled_identity(entries[0].clone(), shape.rows);
        }
        self.intern(ExprNode::Literal(entries), shape)
    }

    /// A matrix of numbers from its entries (row, column, value) that are not zero.
    pub fn sparse_literal(
        &self,
        shape: Shape,
        entries: impl IntoIterator<Item = (usize, usize, Rational)>,
    ) -> Expr<'_> {
        self.literal(shape, dense(shape, entries))
    }

    /// The matrix with a one at (row, column) and zeros elsewhere.
    pub fn unit(&self, shape: Shape, row: usize, column: usize) -> Expr<'_> {
        self.sparse_literal(shape, [(row, column, Rational::one())])
    }

    /// Matrices with as many columns each, one below the other.
    pub fn below<'g>(&'g self, parts: &[Expr<'g>]) -> Expr<'g> {
        let columns = parts.first().map_or(1, |part| part.shape().columns);
        let shape = Shape::new(parts.iter().map(|part| part.shape().rows).sum(), columns);
        let mut row = 0;
        let placed = parts.iter().map(|part| {
            row += part.shape().rows;
            part.embed(shape, row - part.shape().rows, 0)
        });
        self.total(shape, placed)
    }

    /// Matrices with as many rows each, side by side.
    pub fn beside<'g>(&'g self, parts: &[Expr<'g>]) -> Expr<'g> {
        let rows = parts.first().map_or(1, |part| part.shape().rows);
        let shape = Shape::new(rows, parts.iter().map(|part| part.shape().columns).sum());
        let mut column = 0;
        let placed = parts.iter().map(|part| {
            column += part.shape().columns;
            part.embed(shape, 0, column - part.shape().columns)
        });
        self.total(shape, placed)
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
        self.intern(ExprNode::Stack(entries.each(|entry| entry.id)), shape)
    }
}
