//! The arena of expressions: each distinct expression exists once, so equality is a comparison of indices.

use std::cell::{OnceCell, RefCell};
use std::rc::Rc;

use num_traits::{One, Zero};

use crate::algebra::Basis;
use crate::group::{Block, Definition};
use crate::identity::Evaluated;
use crate::memory::{Images, Maps};
use crate::node::{ExprNode, Id, OpaqueId, SymbolId, Term};
use crate::{Expr, Group, Interner, Property, Rational, Role, Shape, Symbol, Table, integer, rational, work};

/// Owns expressions. Nodes are only added, and children come before their parents.
#[derive(Default)]
pub struct Graph {
    nodes: RefCell<Interner<(Rc<ExprNode>, Shape)>>,
    symbols: RefCell<Vec<Symbol>>,
    bases: RefCell<Vec<Rc<Basis>>>,
    blocks: RefCell<Table<Group, Rc<[Block]>>>,
    definitions: RefCell<Vec<Rc<Definition>>>,
    methods: RefCell<Vec<String>>,
    pub(crate) transposed: Images,
    pub(crate) expanded: Images,
    pub(crate) maps: Maps,
    pub(crate) evaluated: Evaluated,
    another: OnceCell<Box<Graph>>,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Graph {
        Graph::default()
    }

    /// A graph that lives as long and is empty when it is first asked for: what is made there does not depend on what is made here.
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
        work::spend(node.size());
        let (position, _) = self.nodes.borrow_mut().intern((Rc::new(node), shape));
        self.expr(Id(position as u32))
    }

    pub(crate) fn expr(&self, id: Id) -> Expr<'_> {
        Expr { graph: self, id }
    }

    pub(crate) fn node(&self, id: Id) -> Rc<ExprNode> {
        self.nodes.borrow().value(id.0 as usize).0.clone()
    }

    pub(crate) fn shape(&self, id: Id) -> Shape {
        self.nodes.borrow().value(id.0 as usize).1
    }

    /// The index of a basis among those of this graph.
    pub(crate) fn basis_index(&self, basis: Basis) -> u32 {
        let known = self.bases.borrow().iter().position(|other| **other == basis);
        known.unwrap_or_else(|| {
            self.bases.borrow_mut().push(Rc::new(basis));
            self.bases.borrow().len() - 1
        }) as u32
    }

    pub(crate) fn basis_at(&self, index: u32) -> Rc<Basis> {
        self.bases.borrow()[index as usize].clone()
    }

    /// The blocks of a group, made by `make` when they are first asked for.
    pub(crate) fn blocks_of(&self, group: Group, make: impl FnOnce() -> Vec<Block>) -> Rc<[Block]> {
        if let Some(known) = self.blocks.borrow().get(&group) {
            return known.clone();
        }
        let made: Rc<[Block]> = make().into();
        self.blocks.borrow_mut().insert(group, made.clone());
        made
    }

    /// Keeps the definition of a group and gives its index.
    pub(crate) fn keep_definition(&self, definition: Definition) -> u32 {
        self.definitions.borrow_mut().push(Rc::new(definition));
        self.definitions.borrow().len() as u32 - 1
    }

    pub(crate) fn definition_at(&self, index: u32) -> Rc<Definition> {
        self.definitions.borrow()[index as usize].clone()
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
        self.intern(ExprNode::Symbol(SymbolId(index as u32)), shape)
    }

    /// What a method of the user's gives for some arguments: its value for `output` 0, its gradient with respect to argument i for
    /// `output` i + 1.
    pub fn opaque<'g>(&'g self, name: &str, output: usize, arguments: &[Expr<'g>], shape: Shape) -> Expr<'g> {
        let known = self.methods.borrow().iter().position(|other| other == name);
        let index = known.unwrap_or_else(|| {
            self.methods.borrow_mut().push(name.to_string());
            self.methods.borrow().len() - 1
        });
        self.opaque_of(OpaqueId(index as u32), output, arguments.to_vec(), shape)
    }

    pub(crate) fn opaque_of<'g>(
        &'g self,
        name: OpaqueId,
        output: usize,
        arguments: Vec<Expr<'g>>,
        shape: Shape,
    ) -> Expr<'g> {
        self.intern(ExprNode::Opaque(name, output, arguments.iter().map(|argument| argument.id).collect()), shape)
    }

    pub(crate) fn opaque_name(&self, name: OpaqueId) -> String {
        self.methods.borrow()[name.0 as usize].clone()
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
        let terms = match value.is_zero() {
            true => Vec::new(),
            false => vec![Term { coefficient: value, scalars: Vec::new(), word: Vec::new() }],
        };
        self.intern(ExprNode::Sum(terms), Shape::square(n))
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
        self.intern(ExprNode::Literal(entries), shape)
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
        self.intern(ExprNode::Stack(entries.iter().map(|entry| entry.id).collect()), shape)
    }
}
