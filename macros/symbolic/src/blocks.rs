//! Blocks of matrices, and matrices made of blocks.
//!
//! Products can drop the zeros of their letters: F·embed(X, 0, 0) becomes embed(F[0..4, 0..3]·X, 0, 0). Blocks of
//! products become products of blocks. Graphs do not store expressions in this form. (F − I)(F + I)⁻¹ has to stay one
//! product until F is substituted: only then it simplifies.

use std::ops::Range;

use crate::memory::Images;
use crate::node::{ExprNode, Id, Operation, Term};
use crate::{Expr, IntoList, Property, Shape, both, integer};

impl<'g> Expr<'g> {
    /// The entry in row i and column j, counted from zero.
    pub fn entry(self, i: usize, j: usize) -> Expr<'g> {
        self.block(i, j, Shape::scalar())
    }

    /// All entries, row by row.
    pub fn entries(self) -> Vec<Expr<'g>> {
        self.shape().positions().map(|(i, j)| self.entry(i, j)).into_list()
    }

    /// The block of the given shape whose first entry is (row, column).
    pub fn block(self, row: usize, column: usize, shape: Shape) -> Expr<'g> {
        assert!(
            row + shape.rows <= self.shape().rows && column + shape.columns <= self.shape().columns,
            "a block of `{self}`"
        );
        if shape == self.shape() {
            return self;
        }
        self.linear(shape, |plain| plain.block_of_plain(row, column, shape))
    }

    fn block_of_plain(self, row: usize, column: usize, shape: Shape) -> Expr<'g> {
        let graph = self.graph;
        let columns = self.shape().columns;
        let positions = || shape.positions().map(move |(i, j)| (row + i) * columns + column + j);
        match &*self.node() {
            ExprNode::Literal(entries) => graph.literal(shape, positions().map(|k| entries[k].clone()).into_list()),
            ExprNode::Stack(entries) => graph.stack(shape, positions().map(|k| graph.expr(entries[k])).into_list()),
            ExprNode::Hadamard(a, b) => {
                let [a, b] = both([a, b], |factor| graph.expr(*factor).block(row, column, shape));
                a.hadamard(b)
            }
            ExprNode::Of(Operation::Block(r, c), inner) => graph.expr(*inner).block(r + row, c + column, shape),
            ExprNode::Symbol(symbol)
                if symbol.property == Property::Diagonal
                    && common((row, shape.rows), (column, shape.columns)).is_empty() =>
            {
                graph.zero(shape)
            }
            ExprNode::Of(Operation::DiagonalMatrix, inner) => {
                let diagonal = common((row, shape.rows), (column, shape.columns));
                if diagonal.is_empty() {
                    return graph.zero(shape);
                }
                let entries = graph.expr(*inner).block(diagonal.start, 0, Shape::vector(diagonal.len()));
                entries.diagonal_matrix().embed(shape, diagonal.start - row, diagonal.start - column)
            }
            ExprNode::Of(Operation::Embed(r, c), inner) => {
                let inner = graph.expr(*inner);
                let rows = common((row, shape.rows), (*r, inner.shape().rows));
                let columns = common((column, shape.columns), (*c, inner.shape().columns));
                if rows.is_empty() || columns.is_empty() {
                    return graph.zero(shape);
                }
                let part = inner.block(rows.start - r, columns.start - c, Shape::new(rows.len(), columns.len()));
                part.embed(shape, rows.start - row, columns.start - column)
            }
            ExprNode::Sum(terms) if terms.len() == 1 && terms[0].word.len() > 1 => {
                self.block_of_word(&terms[0].word, row, column, shape)
            }
            ExprNode::Sum(terms) if terms.len() == 1 && terms[0].word.is_empty() => {
                let one_at = |(i, j): (usize, usize)| integer((row + i == column + j) as i64);
                graph.literal(shape, shape.positions().map(one_at).into_list())
            }
            _ => self.atom_of(Operation::Block(row, column), shape),
        }
    }

    /// The block of a product: rows of its first letter, columns of its last, where these are known to be mostly zero.
    fn block_of_word(self, word: &[Id], row: usize, column: usize, shape: Shape) -> Expr<'g> {
        let graph = self.graph;
        let letters = graph.exprs(word);
        let (first, last) = (letters[0], letters[letters.len() - 1]);
        let sparse = |letter: Expr<'g>| matches!(&*letter.node(), ExprNode::Of(Operation::Embed(..), _));
        if !sparse(first) && !sparse(last) {
            return self.atom_of(Operation::Block(row, column), shape);
        }
        let rows = first.block(row, 0, Shape::new(shape.rows, first.shape().columns));
        let columns = last.block(0, column, Shape::new(last.shape().rows, shape.columns));
        letters[1..letters.len() - 1].iter().copied().fold(rows, Expr::product) * columns
    }

    /// The matrix of the given shape that is zero but for this block at (row, column).
    pub fn embed(self, shape: Shape, row: usize, column: usize) -> Expr<'g> {
        assert!(
            row + self.shape().rows <= shape.rows && column + self.shape().columns <= shape.columns,
            "`{self}` in a {shape}"
        );
        if shape == self.shape() {
            return self;
        }
        if self.is_zero() {
            return self.graph.zero(shape);
        }
        if self.shape().is_scalar() {
            return self * self.graph.unit(shape, row, column);
        }
        self.linear(shape, |plain| match &*plain.node() {
            ExprNode::Of(Operation::Embed(r, c), inner) => plain.graph.expr(*inner).embed(shape, row + r, column + c),
            ExprNode::Literal(entries) => {
                let positions = plain.shape().positions().zip(entries);
                let moved = positions.map(|((i, j), value)| (i + row, j + column, value.clone()));
                plain.graph.sparse_literal(shape, moved)
            }
            ExprNode::Sum(terms) if terms.len() == 1 && terms[0].word.is_empty() => {
                let moved = (0..plain.shape().rows).map(|i| (i + row, i + column, integer(1)));
                plain.graph.sparse_literal(shape, moved)
            }
            _ => plain.atom_of(Operation::Embed(row, column), shape),
        })
    }
}

/// The indices that two ranges have in common, each from its first index and its length.
pub(crate) fn common((a, length): (usize, usize), (b, other): (usize, usize)) -> Range<usize> {
    a.max(b)..(a + length).min(b + other)
}

/// A matrix that is zero outside of a part of it.
struct Window<'g> {
    part: Expr<'g>,
    row: usize,
    column: usize,
    /// The shape of the block matrix.
    shape: Shape,
}

impl<'g> Expr<'g> {
    /// The same with products freed of zeros and blocks taken of their letters.
    pub fn blockwise(self) -> Expr<'g> {
        let images = Images::default();
        let image = |part: &Id| images.of(self.graph, part);
        self.mapped(&images, |expr| match &*expr.node() {
            ExprNode::Sum(terms) => {
                let image = |term: &Term| {
                    let scale = self.graph.scale(term).rebuild(&images);
                    let word = product(term.word.iter().map(image));
                    scale * word.unwrap_or_else(|| self.graph.identity(expr.shape().rows))
                };
                self.graph.total(expr.shape(), terms.iter().map(image))
            }
            // by construction: words of `Word` and `Trace` nodes are not empty
            ExprNode::Word(word) => product(word.iter().map(image)).expect("a word has letters"),
            ExprNode::Trace(word) => product(word.iter().map(image)).expect("a word has letters").trace(),
            ExprNode::Of(Operation::Block(row, column), inner) => image(inner).cut(*row, *column, expr.shape()),
            _ => expr.rebuild(&images),
        })
    }

    /// The block at (row, column), in a product that of its letters.
    fn cut(self, row: usize, column: usize, shape: Shape) -> Expr<'g> {
        if shape == self.shape() {
            return self;
        }
        self.linear(shape, |plain| {
            let word = plain.graph.exprs(&plain.factor().word);
            let [first, middle @ .., last] = word.as_slice() else { return plain.block(row, column, shape) };
            let rows = first.block(row, 0, Shape::new(shape.rows, first.shape().columns));
            let columns = last.block(0, column, Shape::new(last.shape().rows, shape.columns));
            // by construction: there are two letters at least
            product([&[rows], middle, &[columns]].concat().into_iter()).expect("a word has letters")
        })
    }

    /// The part of a letter that may be nonzero.
    fn window(self) -> Window<'g> {
        let shape = self.shape();
        match &*self.node() {
            ExprNode::Of(Operation::Embed(row, column), inner) => {
                Window { part: self.graph.expr(*inner), row: *row, column: *column, shape }
            }
            ExprNode::Literal(entries) => {
                let filled = || shape.positions().zip(entries).filter(|(_, entry)| !entry.is_zero()).map(|(at, _)| at);
                let extent = |of: fn((usize, usize)) -> usize| {
                    (filled().map(of).min().unwrap_or(0), filled().map(of).max().unwrap_or(0) + 1)
                };
                let ((row, last_row), (column, last_column)) = (extent(|at| at.0), extent(|at| at.1));
                let part = Shape::new(last_row - row, last_column - column);
                Window { part: self.block(row, column, part), row, column, shape }
            }
            _ => Window { part: self, row: 0, column: 0, shape },
        }
    }
}

/// The product of some letters, or `None` of none.
fn product<'g>(letters: impl Iterator<Item = Expr<'g>>) -> Option<Expr<'g>> {
    let whole = letters.map(Expr::window).reduce(Window::times)?;
    Some(whole.part.embed(whole.shape, whole.row, whole.column))
}

impl<'g> Window<'g> {
    /// The product, in which only rows and columns that meet count.
    fn times(self, other: Window<'g>) -> Window<'g> {
        let part = self.part.graph.overlap((self.part, self.column), (other.part, other.row), Expr::cut);
        let shape = Shape::new(self.shape.rows, other.shape.columns);
        Window { part, row: self.row, column: other.column, shape }
    }
}
