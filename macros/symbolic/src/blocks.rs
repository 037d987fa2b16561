//! Blocks of matrices, and matrices made of blocks.

use crate::node::{ExprNode, Id, Operation};
use crate::{Expr, Shape, integer};

impl<'g> Expr<'g> {
    /// The entry in row i and column j, counted from zero.
    pub fn entry(self, i: usize, j: usize) -> Expr<'g> {
        self.block(i, j, Shape::scalar())
    }

    /// All entries, row by row.
    pub fn entries(self) -> Vec<Expr<'g>> {
        self.shape().positions().map(|(i, j)| self.entry(i, j)).collect()
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
            ExprNode::Literal(entries) => graph.literal(shape, positions().map(|k| entries[k].clone()).collect()),
            ExprNode::Stack(entries) => graph.stack(shape, positions().map(|k| graph.expr(entries[k])).collect()),
            ExprNode::Hadamard(a, b) => {
                let [a, b] = [a, b].map(|factor| graph.expr(*factor).block(row, column, shape));
                a.hadamard(b)
            }
            ExprNode::Of(Operation::Block(r, c), inner) => graph.expr(*inner).block(r + row, c + column, shape),
            ExprNode::Of(Operation::DiagonalMatrix, _) if shape.is_scalar() && row != column => graph.zero(shape),
            ExprNode::Of(Operation::DiagonalMatrix, inner) if shape.is_scalar() => graph.expr(*inner).entry(row, 0),
            ExprNode::Of(Operation::Embed(r, c), inner) => {
                let inner = graph.expr(*inner);
                // where the block and the embedded matrix meet
                let (first_row, first_column) = (row.max(*r), column.max(*c));
                let last_row = (row + shape.rows).min(r + inner.shape().rows);
                let last_column = (column + shape.columns).min(c + inner.shape().columns);
                if last_row <= first_row || last_column <= first_column {
                    return graph.zero(shape);
                }
                let part = Shape::new(last_row - first_row, last_column - first_column);
                let part = inner.block(first_row - r, first_column - c, part);
                part.embed(shape, first_row - row, first_column - column)
            }
            ExprNode::Sum(terms) if terms.len() == 1 && terms[0].word.len() > 1 => {
                self.block_of_word(&terms[0].word, row, column, shape)
            }
            ExprNode::Sum(terms) if terms.len() == 1 && terms[0].word.is_empty() => {
                let one_at = |(i, j): (usize, usize)| integer((row + i == column + j) as i64);
                graph.literal(shape, shape.positions().map(one_at).collect())
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
