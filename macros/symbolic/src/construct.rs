//! The operations on expressions, each simplified as it is made.

use num_traits::{One, Zero};

use crate::node::{Analytic, ExprNode, Id, Term};
use crate::{Expr, Graph, Property, Rational, Shape};

impl<'g> Expr<'g> {
    pub(crate) fn atom_of(self, node: ExprNode, shape: Shape) -> Expr<'g> {
        self.graph.intern(node, shape)
    }

    /// Applies a linear operation to each term of a sum, `operation` being given single terms without their scalars.
    pub(crate) fn linear(self, shape: Shape, operation: impl Fn(Expr<'g>) -> Expr<'g>) -> Expr<'g> {
        let image = |Term { coefficient, scalars, word }| {
            let plain = Term { coefficient: Rational::one(), scalars: Vec::new(), word };
            let image = operation(self.graph.collect(self.shape(), [plain]));
            let scale = self.graph.collect(Shape::scalar(), [Term { coefficient, scalars, word: Vec::new() }]);
            scale * image
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
        match &*self.node() {
            ExprNode::Sum(_) => self.transpose(),
            ExprNode::Transpose(inner) => graph.expr(*inner),
            ExprNode::Inverse(inner) => graph.expr(*inner).transpose().inverse(),
            ExprNode::DiagonalMatrix(_) => self,
            ExprNode::Analytic(function, inner) => graph.expr(*inner).transpose().analytic(*function),
            ExprNode::Wedge(algebra, _) if algebra.is_skew() => -self,
            ExprNode::Hadamard(a, b) => graph.expr(*a).transpose().hadamard(graph.expr(*b).transpose()),
            ExprNode::Symbol(id) => match graph.symbol_data(*id).property {
                Property::Symmetric | Property::Diagonal => self,
                Property::Skew => -self,
                _ => self.atom_of(ExprNode::Transpose(self.id), shape),
            },
            ExprNode::Literal(entries) => {
                let entry = |(i, j): (usize, usize)| entries[j * self.shape().columns + i].clone();
                graph.literal(shape, shape.positions().map(entry).collect())
            }
            ExprNode::Stack(entries) => {
                let entry = |(i, j): (usize, usize)| graph.expr(entries[j * self.shape().columns + i]);
                graph.stack(shape, shape.positions().map(entry).collect())
            }
            ExprNode::Block(inner, row, column) => graph.expr(*inner).transpose().block(*column, *row, shape),
            ExprNode::Embed(inner, row, column) => graph.expr(*inner).transpose().embed(shape, *column, *row),
            _ => self.atom_of(ExprNode::Transpose(self.id), shape),
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
        let Term { coefficient, scalars, word } = self.factor();
        let scale = graph.collect(Shape::scalar(), [Term { coefficient, scalars, word: Vec::new() }]).powi(-1);
        let square = word.iter().all(|&letter| graph.shape(letter).is_square());
        match square {
            true => {
                let inverses = word.iter().rev().map(|&letter| graph.expr(letter).inverse_letter());
                scale * inverses.fold(graph.identity(self.shape().rows), Expr::product)
            }
            false => self.atom_of(ExprNode::Inverse(self.id), self.shape()),
        }
    }

    fn inverse_letter(self) -> Expr<'g> {
        let graph = self.graph;
        match &*self.node() {
            ExprNode::Inverse(inner) => graph.expr(*inner),
            ExprNode::Transpose(inner) if graph.is_orthogonal(*inner) => graph.expr(*inner),
            ExprNode::Symbol(_) if graph.is_orthogonal(self.id) => self.transpose(),
            ExprNode::Analytic(Analytic::Exponential, inner) => (-graph.expr(*inner)).exponential(),
            ExprNode::Literal(_) => {
                let inverse = self.rational_inverse_of_literal();
                inverse.unwrap_or_else(|| self.atom_of(ExprNode::Inverse(self.id), self.shape()))
            }
            ExprNode::Sum(terms) => {
                // I + c L rather than a I + b L: the form that the rules of `expand` know.
                let unit = terms.iter().find(|term| term.word.is_empty() && term.scalars.is_empty());
                match unit.map(|term| term.coefficient.clone()).filter(|coefficient| !coefficient.is_one()) {
                    Some(coefficient) => {
                        let monic = self.times(&coefficient.recip());
                        self.atom_of(ExprNode::Inverse(monic.id), self.shape()).times(&coefficient.recip())
                    }
                    None => self.atom_of(ExprNode::Inverse(self.id), self.shape()),
                }
            }
            _ => self.atom_of(ExprNode::Inverse(self.id), self.shape()),
        }
    }

    /// The determinant of a square matrix.
    pub fn determinant(self) -> Expr<'g> {
        let graph = self.graph;
        let n = self.shape().rows;
        if self.shape().is_scalar() {
            return self;
        }
        match self.is_zero() {
            true => graph.integer(0),
            false if self.is_identity() || graph.is_special(self.id) => graph.integer(1),
            false => {
                let Term { coefficient, scalars, word } = self.factor();
                let scale = graph.collect(Shape::scalar(), [Term { coefficient, scalars, word: Vec::new() }]);
                let plain =
                    graph.collect(self.shape(), [Term { coefficient: Rational::one(), scalars: Vec::new(), word }]);
                let value = match plain.is_identity() {
                    true => graph.integer(1),
                    false => self.atom_of(ExprNode::Determinant(plain.id), Shape::scalar()),
                };
                scale.powi(n as i32) * value
            }
        }
    }

    /// The scalar product aᵀb of vectors, tr(AᵀB) of matrices.
    pub fn dot(self, other: Expr<'g>) -> Expr<'g> {
        match self.shape().is_column() {
            true => self.transpose() * other,
            false => (self.transpose() * other).trace(),
        }
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
                left.atom_of(ExprNode::Hadamard(a.id, b.id), shape)
            })
        })
    }

    /// The diagonal matrix of a vector.
    pub fn diagonal_matrix(self) -> Expr<'g> {
        let shape = Shape::square(self.shape().rows);
        self.linear(shape, |plain| match &*plain.node() {
            ExprNode::Literal(entries) => {
                let entry = |(i, j): (usize, usize)| if i == j { entries[i].clone() } else { Rational::zero() };
                plain.graph.literal(shape, shape.positions().map(entry).collect())
            }
            _ => plain.atom_of(ExprNode::DiagonalMatrix(plain.id), shape),
        })
    }

    /// The diagonal of a square matrix, as a vector.
    pub fn diagonal(self) -> Expr<'g> {
        let shape = Shape::vector(self.shape().rows);
        self.linear(shape, |plain| match &*plain.node() {
            ExprNode::DiagonalMatrix(inner) => plain.graph.expr(*inner),
            _ if plain.is_identity() => plain.graph.literal(shape, vec![Rational::one(); shape.rows]),
            _ => plain.atom_of(ExprNode::Diagonal(plain.id), shape),
        })
    }
}

impl Graph {
    /// The trace of a product of letters: cyclic, equal to that of the transpose, cut where an inner dimension is one.
    fn trace_of_word(&self, word: Vec<Id>, n: usize) -> Expr<'_> {
        match word.as_slice() {
            [] => return self.integer(n as i64),
            [letter] => return self.trace_of_letter(*letter),
            _ => {}
        }
        if let Some(start) = word.iter().position(|&letter| self.shape(letter).rows == 1) {
            let rotated = [&word[start..], &word[..start]].concat();
            return self.with_word(Term::number(Rational::one()), rotated, Shape::scalar());
        }
        let folded = self.expr(word[word.len() - 1]) * self.expr(word[0]);
        if folded.factor().word.len() < 2 && folded.terms().len() == 1 {
            let middle = word[1..word.len() - 1].iter().map(|&letter| self.expr(letter));
            return middle.fold(folded, Expr::product).trace();
        }
        self.least_trace(word)
    }

    fn trace_of_letter(&self, letter: Id) -> Expr<'_> {
        let expr = self.expr(letter);
        match &*self.node(letter) {
            ExprNode::Sum(_) => expr.trace(),
            ExprNode::Transpose(inner) => self.expr(*inner).trace(),
            ExprNode::Wedge(algebra, _) if algebra.is_skew() => self.integer(0),
            ExprNode::DiagonalMatrix(inner) => {
                let n = self.shape(*inner).rows;
                (0..n).map(|i| self.expr(*inner).entry(i, 0)).fold(self.integer(0), |sum, entry| sum + entry)
            }
            ExprNode::Literal(entries) => {
                let n = self.shape(letter).rows;
                self.number((0..n).map(|i| entries[i * n + i].clone()).sum())
            }
            ExprNode::Symbol(_) if self.has_property(letter, Property::Skew) => self.integer(0),
            ExprNode::Embed(inner, row, column) => {
                // the part on the diagonal of the whole
                let (inner, first) = (self.expr(*inner), (*row).max(*column));
                let last = (row + inner.shape().rows).min(column + inner.shape().columns);
                match last.checked_sub(first) {
                    Some(size) if size > 0 => inner.block(first - row, first - column, Shape::square(size)).trace(),
                    _ => self.integer(0),
                }
            }
            _ => self.intern(ExprNode::Trace(vec![letter]), Shape::scalar()),
        }
    }

    /// Of all rotations of a word and of its transpose, the first in the order of letters.
    fn least_trace(&self, word: Vec<Id>) -> Expr<'_> {
        let rotations =
            |word: &[Id]| -> Vec<Vec<Id>> { (0..word.len()).map(|k| [&word[k..], &word[..k]].concat()).collect() };
        let mut candidates: Vec<(Vec<Id>, Rational)> =
            rotations(&word).into_iter().map(|w| (w, Rational::one())).collect();
        if let Some((sign, reversed)) = self.transposed_word(&word) {
            candidates.extend(rotations(&reversed).into_iter().map(|w| (w, sign.clone())));
        }
        candidates.sort();
        // by construction: a word has at least one rotation
        let (least, sign) = candidates[0].clone();
        if candidates.iter().any(|(other, other_sign)| *other == least && *other_sign != sign) {
            return self.integer(0);
        }
        self.intern(ExprNode::Trace(least), Shape::scalar()).times(&sign)
    }
}
