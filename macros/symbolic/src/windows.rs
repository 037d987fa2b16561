//! Products freed of the zeros of their letters: F·embed(X, 0, 0) becomes embed(F[0..4, 0..3]·X, 0, 0), and blocks of products
//! become products of blocks.
//!
//! Expressions are not kept in this form: (F − I)(F + I)⁻¹ has to stay whole until F is put in, for then it simplifies as a whole.

use num_traits::Zero;

use crate::memory::Images;
use crate::node::{ExprNode, Id, Operation, Term};
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

    /// The part of a letter outside of which it is zero.
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
    /// The product of what meets.
    fn times(self, other: Window<'g>) -> Window<'g> {
        let part = self.part.graph.overlap((self.part, self.column), (other.part, other.row), Expr::cut);
        let shape = Shape::new(self.shape.rows, other.shape.columns);
        Window { part, row: self.row, column: other.column, shape }
    }
}
