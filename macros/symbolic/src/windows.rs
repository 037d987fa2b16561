//! Products freed of the zeros of their letters: F·embed(X, 0, 0) becomes embed(F[0..4, 0..3]·X, 0, 0), and blocks of products
//! become products of blocks.
//!
//! Expressions are not kept in this form: (F − I)(F + I)⁻¹ has to stay whole until F is put in, for then it simplifies as a whole.

use num_traits::Zero;

use crate::memory::Images;
use crate::node::{ExprNode, Id, Term};
use crate::{Expr, Shape};

/// A matrix that is zero outside of a part of it.
struct Window<'g> {
    part: Expr<'g>,
    row: usize,
    column: usize,
    /// The shape of the whole.
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
                    let scale = Term { word: Vec::new(), ..term.clone() };
                    let scale = self.graph.collect(Shape::scalar(), [scale]).rebuild(&images);
                    let word = match term.word.is_empty() {
                        true => self.graph.identity(expr.shape().rows),
                        false => product(term.word.iter().map(image)),
                    };
                    scale * word
                };
                self.graph.total(expr.shape(), terms.iter().map(image))
            }
            ExprNode::Word(word) => product(word.iter().map(image)),
            ExprNode::Trace(word) => product(word.iter().map(image)).trace(),
            ExprNode::Block(inner, row, column) => image(inner).cut(*row, *column, expr.shape()),
            _ => expr.rebuild(&images),
        })
    }

    /// The block at (row, column), in a product that of its letters.
    fn cut(self, row: usize, column: usize, shape: Shape) -> Expr<'g> {
        if shape == self.shape() {
            return self;
        }
        self.linear(shape, |plain| {
            let word = plain.factor().word;
            let letters = || word.iter().map(|&letter| plain.graph.expr(letter));
            let (first, last) = match word.as_slice() {
                [first, .., last] => (plain.graph.expr(*first), plain.graph.expr(*last)),
                _ => return plain.block(row, column, shape),
            };
            let rows = first.block(row, 0, Shape::new(shape.rows, first.shape().columns));
            let columns = last.block(0, column, Shape::new(last.shape().rows, shape.columns));
            let middle = letters().skip(1).take(word.len() - 2);
            product(std::iter::once(rows).chain(middle).chain([columns]))
        })
    }

    /// The part of a letter outside of which it is zero.
    fn window(self) -> Window<'g> {
        let shape = self.shape();
        match &*self.node() {
            ExprNode::Embed(inner, row, column) => {
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

/// The product of some letters.
fn product<'g>(mut letters: impl Iterator<Item = Expr<'g>>) -> Expr<'g> {
    // by construction: words are not empty
    let first = letters.next().expect("a word has letters").window();
    let whole = letters.fold(first, |left, letter| left.times(letter.window()));
    match whole.part.is_zero() {
        true => whole.part.graph.zero(whole.shape),
        false => whole.part.embed(whole.shape, whole.row, whole.column),
    }
}

impl<'g> Window<'g> {
    /// The product of what meets.
    fn times(self, other: Window<'g>) -> Window<'g> {
        let (a, b) = (self.part.shape(), other.part.shape());
        let start = self.column.max(other.row);
        let end = (self.column + a.columns).min(other.row + b.rows);
        let shape = Shape::new(self.shape.rows, other.shape.columns);
        let part = match start < end {
            true => {
                let left = self.part.cut(0, start - self.column, Shape::new(a.rows, end - start));
                let right = other.part.cut(start - other.row, 0, Shape::new(end - start, b.columns));
                left * right
            }
            false => self.part.graph.zero(Shape::new(a.rows, b.columns)),
        };
        Window { part, row: self.row, column: other.column, shape }
    }
}
