//! The operations on expressions, each simplified as it is made.

use crate::blocks::common;
use crate::node::{Analytic, ExprNode, Id, Operation, Term};
use crate::{Expr, Graph, Group, IntoList, Property, Rational, Shape};

impl<'g> Expr<'g> {
    /// The operation on this expression as a node of its own.
    pub(crate) fn atom_of(self, operation: Operation, shape: Shape) -> Expr<'g> {
        self.graph.intern(ExprNode::Of(operation, self.id), shape)
    }

    /// Applies a linear operation to each term of a sum, `operation` being given single terms without their scalars.
    pub(crate) fn linear(self, shape: Shape, operation: impl Fn(Expr<'g>) -> Expr<'g>) -> Expr<'g> {
        let image = |term: Term| {
            let (scale, plain) = term.split();
            let image = operation(self.graph.collect(self.shape(), [plain]));
            self.graph.scalar(scale) * image
        };
        self.graph.total(shape, self.terms().into_iter().map(image))
    }

    /// The transpose Aᵀ.
    pub fn transpose(self) -> Expr<'g> {
        let graph = self.graph;
        if self.shape().is_scalar() {
            return self;
        }
        self.remembered(&graph.transposed, || match &*self.node() {
            ExprNode::Sum(_) => self.linear(self.shape().transposed(), |plain| {
                let word = plain.factor().word;
                word.iter().rev().map(|&letter| graph.expr(letter).transpose()).reduce(Expr::product).unwrap_or(plain)
            }),
            _ => self.transpose_letter(),
        })
    }

    fn transpose_letter(self) -> Expr<'g> {
        let graph = self.graph;
        let shape = self.shape().transposed();
        let positions = || shape.positions().map(|(i, j)| j * shape.rows + i);
        match &*self.node() {
            ExprNode::Sum(_) => self.transpose(),
            ExprNode::Literal(entries) => graph.literal(shape, positions().map(|k| entries[k].clone()).into_list()),
            ExprNode::Stack(entries) => graph.stack(shape, positions().map(|k| graph.expr(entries[k])).into_list()),
            ExprNode::Hadamard(a, b) => graph.expr(*a).transpose().hadamard(graph.expr(*b).transpose()),
            ExprNode::Symbol(symbol) if symbol.property.is_symmetric() => self,
            ExprNode::Symbol(symbol) if symbol.property == Property::Skew => -self,
            ExprNode::Of(operation, inner) => {
                let inner = graph.expr(*inner);
                match *operation {
                    Operation::Transpose => inner,
                    Operation::DiagonalMatrix => self,
                    Operation::Wedge(algebra) if algebra.is_skew => -self,
                    Operation::Inverse => inner.transpose().inverse(),
                    Operation::Analytic(function) => inner.transpose().analytic(function),
                    Operation::Block(row, column) => inner.transpose().block(column, row, shape),
                    Operation::Embed(row, column) => inner.transpose().embed(shape, column, row),
                    _ => self.atom_of(Operation::Transpose, shape),
                }
            }
            _ => self.atom_of(Operation::Transpose, shape),
        }
    }

    /// ½(A + Aᵀ).
    pub fn symmetric_part(self) -> Expr<'g> {
        (self + self.transpose()) / 2
    }

    /// The trace of a square matrix.
    pub fn trace(self) -> Expr<'g> {
        if self.shape().is_scalar() {
            return self;
        }
        self.linear(Shape::scalar(), |plain| plain.graph.trace_of_word(plain.factor().word, plain.shape().rows))
    }

    /// The inverse of a square matrix.
    pub fn inverse(self) -> Expr<'g> {
        let graph = self.graph;
        if self.shape().is_scalar() {
            return self.powi(-1);
        }
        let (scale, plain) = self.factor().split();
        let scale = graph.scalar(scale).powi(-1);
        if plain.word.iter().any(|&letter| !graph.shape(letter).is_square()) {
            return self.atom_of(Operation::Inverse, self.shape());
        }
        let inverses = plain.word.iter().rev().map(|&letter| graph.expr(letter).inverse_letter());
        scale * inverses.fold(graph.identity(self.shape().rows), Expr::product)
    }

    fn inverse_letter(self) -> Expr<'g> {
        let graph = self.graph;
        let atom = |matrix: Expr<'g>| matrix.atom_of(Operation::Inverse, self.shape());
        match &*self.node() {
            ExprNode::Of(Operation::Inverse, inner) => graph.expr(*inner),
            ExprNode::Of(Operation::Transpose, inner) if graph.is_orthogonal(*inner) => graph.expr(*inner),
            ExprNode::Symbol(_) if graph.is_orthogonal(self.id) => self.transpose(),
            ExprNode::Of(Operation::Analytic(Analytic::Exponential), inner) => (-graph.expr(*inner)).exponential(),
            ExprNode::Literal(entries) => self.inverse_of_literal(entries).unwrap_or_else(|| atom(self)),
            ExprNode::Sum(terms) => {
                // I + c L rather than a I + b L: the form that the rules of `expand` know.
                let unit = terms.iter().find(|term| term.word.is_empty() && term.scalars.is_empty());
                let scale = unit.map_or_else(Rational::one, |term| term.coefficient.recip());
                atom(self.times(&scale)).times(&scale)
            }
            _ => atom(self),
        }
    }

    /// The inverse of a matrix of numbers, by exact elimination.
    fn inverse_of_literal(self, entries: &[Rational]) -> Option<Expr<'g>> {
        let n = self.shape().rows;
        let unit = |i: usize, j: usize| if i == j { Rational::one() } else { Rational::zero() };
        let row = |(i, row): (usize, &[Rational])| row.iter().cloned().chain((0..n).map(|j| unit(i, j))).into_list();
        let mut rows: Vec<Vec<Rational>> = entries.chunks(n).enumerate().map(row).into_list();
        crate::reduce(&mut rows).iter().copied().take(n).eq(0..n).then(|| {
            let entries = rows.into_iter().flat_map(|row| row.into_iter().skip(n));
            self.graph.literal(self.shape(), entries.into_list())
        })
    }

    /// The determinant of a square matrix.
    pub fn determinant(self) -> Expr<'g> {
        let graph = self.graph;
        let n = self.shape().rows;
        if self.shape().is_scalar() {
            return self;
        }
        if self.is_zero() {
            return graph.integer(0);
        }
        if self.is_identity() || graph.is_rotation_or(self.id, Group::is_special) {
            return graph.integer(1);
        }
        let (scale, plain) = self.factor().split();
        let scale = graph.scalar(scale);
        let plain = graph.collect(self.shape(), [plain]);
        let is_identity = plain.is_identity();
        let value = if is_identity { graph.integer(1) } else { plain.atom_of(Operation::Determinant, Shape::scalar()) };
        scale.powi(n as i32) * value
    }

    /// The scalar product aᵀb of vectors, tr(AᵀB) of matrices.
    pub fn dot(self, other: Expr<'g>) -> Expr<'g> {
        let product = self.transpose() * other;
        if self.shape().is_column() { product } else { product.trace() }
    }

    /// ⟨A, B⟩ = tr(AᵀB) for arrays of any shape.
    pub fn pairing(self, other: Expr<'g>) -> Expr<'g> {
        if self.shape().is_scalar() { self * other } else { self.dot(other) }
    }

    /// The square of the Euclidean or Frobenius norm.
    pub fn norm_squared(self) -> Expr<'g> {
        self.dot(self)
    }

    /// The Euclidean or Frobenius norm.
    pub fn norm(self) -> Expr<'g> {
        self.norm_squared().sqrt()
    }

    /// A / |A|.
    pub fn normalize(self) -> Expr<'g> {
        self / self.norm()
    }

    /// The product entry by entry.
    pub fn hadamard(self, other: Expr<'g>) -> Expr<'g> {
        assert_eq!(self.shape(), other.shape(), "an entrywise product of `{self}` and `{other}`");
        if self.shape().is_scalar() {
            return self * other;
        }
        let shape = self.shape();
        self.linear(shape, |left| {
            other.linear(shape, |right| {
                let (a, b) = if left.id <= right.id { (left, right) } else { (right, left) };
                self.graph.intern(ExprNode::Hadamard(a.id, b.id), shape)
            })
        })
    }

    /// The diagonal matrix of a vector.
    pub fn diagonal_matrix(self) -> Expr<'g> {
        let shape = Shape::square(self.shape().rows);
        if shape.is_scalar() {
            return self;
        }
        self.linear(shape, |plain| match &*plain.node() {
            ExprNode::Literal(entries) => {
                plain.graph.sparse_literal(shape, entries.iter().enumerate().map(|(i, entry)| (i, i, entry.clone())))
            }
            _ => plain.atom_of(Operation::DiagonalMatrix, shape),
        })
    }

    /// The diagonal of a square matrix, as a vector.
    pub fn diagonal(self) -> Expr<'g> {
        let shape = Shape::vector(self.shape().rows);
        self.linear(shape, |plain| match &*plain.node() {
            ExprNode::Of(Operation::DiagonalMatrix, inner) => plain.graph.expr(*inner),
            _ if plain.is_identity() => plain.graph.literal(shape, vec![Rational::one(); shape.rows]),
            _ => plain.atom_of(Operation::Diagonal, shape),
        })
    }
}

impl Graph {
    /// The trace of a product of letters: cyclic, equal to that of the transpose, cut where an inner dimension is one.
    fn trace_of_word(&self, word: Vec<Id>, n: usize) -> Expr<'_> {
        let (first, middle, last) = match word.as_slice() {
            [] => return self.integer(n as i64),
            [letter] => return self.trace_of_letter(*letter),
            [first, middle @ .., last] => (*first, middle, *last),
        };
        if let Some(start) = word.iter().position(|&letter| self.shape(letter).rows == 1) {
            let rotated = [&word[start..], &word[..start]].concat();
            return self.with_word(Term::number(Rational::one()), &rotated, Shape::scalar());
        }
        let folded = self.expr(last) * self.expr(first);
        if folded.factor().word.len() < 2 && folded.terms().len() == 1 {
            return middle.iter().map(|&letter| self.expr(letter)).fold(folded, Expr::product).trace();
        }
        self.least_trace(&word)
    }

    fn trace_of_letter(&self, letter: Id) -> Expr<'_> {
        let expr = self.expr(letter);
        let n = expr.shape().rows;
        match &*self.node(letter) {
            ExprNode::Sum(_) => expr.trace(),
            ExprNode::Of(Operation::Transpose, inner) => self.expr(*inner).trace(),
            ExprNode::Of(Operation::Wedge(algebra), _) if algebra.is_skew => self.integer(0),
            ExprNode::Symbol(symbol) if symbol.property == Property::Skew => self.integer(0),
            ExprNode::Of(Operation::DiagonalMatrix, inner) => {
                (0..n).map(|i| self.expr(*inner).entry(i, 0)).fold(self.integer(0), |sum, entry| sum + entry)
            }
            ExprNode::Literal(entries) => self.number(entries.iter().step_by(n + 1).cloned().sum()),
            ExprNode::Of(Operation::Embed(row, column), inner) => {
                let inner = self.expr(*inner);
                let diagonal = common((*row, inner.shape().rows), (*column, inner.shape().columns));
                if diagonal.is_empty() {
                    return self.integer(0);
                }
                inner.block(diagonal.start - row, diagonal.start - column, Shape::square(diagonal.len())).trace()
            }
            _ => self.intern(ExprNode::Trace(vec![letter]), Shape::scalar()),
        }
    }

    /// Of all rotations of a word and of its transpose, the first in the order of letters.
    fn least_trace(&self, word: &[Id]) -> Expr<'_> {
        let mut candidates: Vec<(Vec<Id>, Rational)> = Vec::new();
        let mut add_rotations = |sign: Rational, word: &[Id]| {
            candidates.extend((0..word.len()).map(|k| ([&word[k..], &word[..k]].concat(), sign.clone())));
        };
        add_rotations(Rational::one(), word);
        if let Some((sign, reversed)) = self.transposed_word(word) {
            add_rotations(sign, &reversed);
        }
        candidates.sort();
        // by construction: a word has at least one rotation
        let (least, sign) = &candidates[0];
        if candidates.iter().any(|(other, other_sign)| other == least && other_sign != sign) {
            return self.integer(0);
        }
        self.intern(ExprNode::Trace(least.clone()), Shape::scalar()).times(sign)
    }
}
