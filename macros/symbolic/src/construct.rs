//! The operations on expressions, each simplified as it is made.

use num_traits::{One, Zero};

use crate::node::{Exponent, Function, Id, Node, Term};
use crate::{Algebra, Expr, Graph, Property, Rational, Shape, integer, rational};

impl<'g> Expr<'g> {
    fn atom_of(self, node: Node, shape: Shape) -> Expr<'g> {
        self.graph.intern(node, shape)
    }

    /// Applies a linear operation to each term of a sum, `operation` being given single terms without their scalars.
    pub(crate) fn linear(self, shape: Shape, operation: impl Fn(Expr<'g>) -> Expr<'g>) -> Expr<'g> {
        let mut result = self.graph.zero(shape);
        for Term { coefficient, scalars, word } in self.terms() {
            let plain = Term { coefficient: Rational::one(), scalars: Vec::new(), word };
            let image = operation(self.graph.collect(self.shape(), [plain]));
            let scale = self.graph.collect(Shape::scalar(), [Term { coefficient, scalars, word: Vec::new() }]);
            result = result + scale * image;
        }
        result
    }

    /// The transpose Aᵀ.
    pub fn transpose(self) -> Expr<'g> {
        let graph = self.graph;
        if self.shape().is_scalar() {
            return self;
        }
        match &*self.node() {
            Node::Sum(_) => self.linear(self.shape().transposed(), |plain| {
                let word = plain.factor().word;
                word.iter()
                    .rev()
                    .map(|&letter| graph.expr(letter).transpose_letter())
                    .reduce(Expr::product)
                    .unwrap_or(plain)
            }),
            _ => self.transpose_letter(),
        }
    }

    fn transpose_letter(self) -> Expr<'g> {
        let graph = self.graph;
        let shape = self.shape().transposed();
        match &*self.node() {
            Node::Sum(_) => self.transpose(),
            Node::Transpose(inner) => graph.expr(*inner),
            Node::Inverse(inner) => graph.expr(*inner).transpose().inverse(),
            Node::DiagonalMatrix(_) => self,
            Node::Wedge(algebra, _) if algebra.is_skew() => -self,
            Node::Hadamard(a, b) => graph.expr(*a).transpose().hadamard(graph.expr(*b).transpose()),
            Node::Symbol(id) => match graph.symbol_data(*id).property {
                Property::Symmetric | Property::Diagonal => self,
                Property::Skew => -self,
                _ => self.atom_of(Node::Transpose(self.id), shape),
            },
            Node::Literal(entries) => {
                let entry = |(i, j): (usize, usize)| entries[j * self.shape().columns + i].clone();
                graph.literal(shape, shape.positions().map(entry).collect())
            }
            Node::Stack(entries) => {
                let entry = |(i, j): (usize, usize)| graph.expr(entries[j * self.shape().columns + i]);
                graph.stack(shape, shape.positions().map(entry).collect())
            }
            Node::Block(inner, row, column) => graph.expr(*inner).transpose().block(*column, *row, shape),
            Node::Embed(inner, row, column) => graph.expr(*inner).transpose().embed(shape, *column, *row),
            _ => self.atom_of(Node::Transpose(self.id), shape),
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
            false => self.atom_of(Node::Inverse(self.id), self.shape()),
        }
    }

    fn inverse_letter(self) -> Expr<'g> {
        let graph = self.graph;
        match &*self.node() {
            Node::Inverse(inner) => graph.expr(*inner),
            Node::Transpose(inner) if graph.has_property(*inner, Property::Orthogonal) => graph.expr(*inner),
            Node::Symbol(_) if graph.has_property(self.id, Property::Orthogonal) => self.transpose(),
            Node::Sum(terms) => {
                // I + c L rather than a I + b L: the form that the rules of `expand` know.
                let unit = terms.iter().find(|term| term.word.is_empty() && term.scalars.is_empty());
                match unit.map(|term| term.coefficient.clone()).filter(|coefficient| !coefficient.is_one()) {
                    Some(coefficient) => {
                        let monic = self.times(&coefficient.recip());
                        self.atom_of(Node::Inverse(monic.id), self.shape()).times(&coefficient.recip())
                    }
                    None => self.atom_of(Node::Inverse(self.id), self.shape()),
                }
            }
            _ => self.atom_of(Node::Inverse(self.id), self.shape()),
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
            false if self.is_identity() || graph.has_property(self.id, Property::Orthogonal) => graph.integer(1),
            false => {
                let Term { coefficient, scalars, word } = self.factor();
                let scale = graph.collect(Shape::scalar(), [Term { coefficient, scalars, word: Vec::new() }]);
                let plain =
                    graph.collect(self.shape(), [Term { coefficient: Rational::one(), scalars: Vec::new(), word }]);
                let value = match plain.is_identity() {
                    true => graph.integer(1),
                    false => self.atom_of(Node::Determinant(plain.id), Shape::scalar()),
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

    /// The matrix of x ↦ a × x.
    pub fn hat(self) -> Expr<'g> {
        self.wedge(Algebra::SpecialOrthogonal(3))
    }

    /// a × b.
    pub fn cross(self, other: Expr<'g>) -> Expr<'g> {
        self.hat() * other
    }

    /// Σ v_i E_i in the basis of the algebra.
    pub fn wedge(self, algebra: Algebra) -> Expr<'g> {
        let shape = algebra.matrix_shape();
        if algebra.is_identification() {
            return self;
        }
        if algebra.dimension() == 1 {
            return self.wedge_of_scalar(algebra);
        }
        if let Node::Literal(entries) = &*self.node() {
            let basis = algebra.basis(self.graph);
            let terms = entries.iter().zip(basis).map(|(entry, element)| element.times(entry));
            return terms.fold(self.graph.zero(shape), |sum, term| sum + term);
        }
        self.linear(shape, |plain| match &*plain.node() {
            Node::Literal(_) if plain != self => plain.wedge(algebra),
            _ => plain.atom_of(Node::Wedge(algebra, plain.id), shape),
        })
    }

    /// v E_1 of a one-dimensional algebra, kept as one letter so that its products are known as those of v^.
    fn wedge_of_scalar(self, algebra: Algebra) -> Expr<'g> {
        let graph = self.graph;
        let shape = algebra.matrix_shape();
        self.terms().into_iter().fold(graph.zero(shape), |sum, Term { coefficient, scalars, word }| {
            let plain = graph.collect(Shape::scalar(), [Term { coefficient: Rational::one(), scalars, word }]);
            let element = match plain.as_number() {
                Some(number) => algebra.basis(graph)[0].times(&number),
                None => self.atom_of(Node::Wedge(algebra, plain.id), shape),
            };
            sum + element.times(&coefficient)
        })
    }

    /// The components ⟨A, E_i⟩ = tr(AᵀE_i) in the basis of the algebra.
    pub fn components(self, algebra: Algebra) -> Expr<'g> {
        let shape = Shape::vector(algebra.dimension());
        if algebra.is_identification() {
            return self;
        }
        self.linear(shape, |plain| {
            if let Node::Wedge(other, inner) = &*plain.node()
                && *other == algebra
                && let Some(square) = algebra.uniform_gram()
            {
                return square * plain.graph.expr(*inner);
            }
            if !algebra.is_skew() {
                return plain.atom_of(Node::Components(algebra, plain.id), shape);
            }
            // the components of a skew group see only the skew part: one of A and −Aᵀ stands for both
            let Term { coefficient, scalars, word } = plain.transpose().factor();
            let sign = coefficient.clone();
            let word = plain.graph.collect(plain.shape(), [Term { coefficient: Rational::one(), scalars, word }]);
            match sign == integer(1) || sign == integer(-1) {
                true if word == plain && sign == integer(1) => plain.graph.zero(shape),
                true if word.id < plain.id => plain.atom_of(Node::Components(algebra, word.id), shape).times(&-sign),
                _ => plain.atom_of(Node::Components(algebra, plain.id), shape),
            }
        })
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
                left.atom_of(Node::Hadamard(a.id, b.id), shape)
            })
        })
    }

    /// The diagonal matrix of a vector.
    pub fn diagonal_matrix(self) -> Expr<'g> {
        let shape = Shape::square(self.shape().rows);
        self.linear(shape, |plain| match &*plain.node() {
            Node::Literal(entries) => {
                let entry = |(i, j): (usize, usize)| if i == j { entries[i].clone() } else { Rational::zero() };
                plain.graph.literal(shape, shape.positions().map(entry).collect())
            }
            _ => plain.atom_of(Node::DiagonalMatrix(plain.id), shape),
        })
    }

    /// The diagonal of a square matrix, as a vector.
    pub fn diagonal(self) -> Expr<'g> {
        let shape = Shape::vector(self.shape().rows);
        self.linear(shape, |plain| match &*plain.node() {
            Node::DiagonalMatrix(inner) => plain.graph.expr(*inner),
            _ if plain.is_identity() => plain.graph.literal(shape, vec![Rational::one(); shape.rows]),
            _ => plain.atom_of(Node::Diagonal(plain.id), shape),
        })
    }

    /// The entry in row i and column j, counted from zero.
    pub fn entry(self, i: usize, j: usize) -> Expr<'g> {
        self.block(i, j, Shape::scalar())
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
            Node::Literal(entries) => graph.literal(shape, positions().map(|k| entries[k].clone()).collect()),
            Node::Stack(entries) => graph.stack(shape, positions().map(|k| graph.expr(entries[k])).collect()),
            Node::Block(inner, r, c) => graph.expr(*inner).block(r + row, c + column, shape),
            Node::Embed(inner, r, c) => {
                let given = graph.shape(*inner);
                let (last_row, last_column) = (row + shape.rows, column + shape.columns);
                let inside =
                    row >= *r && column >= *c && last_row <= r + given.rows && last_column <= c + given.columns;
                let outside =
                    last_row <= *r || last_column <= *c || row >= r + given.rows || column >= c + given.columns;
                match (inside, outside) {
                    (true, _) => graph.expr(*inner).block(row - r, column - c, shape),
                    (_, true) => graph.zero(shape),
                    _ => self.atom_of(Node::Block(self.id, row, column), shape),
                }
            }
            Node::Sum(terms) if terms.len() == 1 && terms[0].word.is_empty() => {
                let one_at = |(i, j): (usize, usize)| integer((row + i == column + j) as i64);
                graph.literal(shape, shape.positions().map(one_at).collect())
            }
            _ => self.atom_of(Node::Block(self.id, row, column), shape),
        }
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
        if self.shape().is_scalar() {
            return self * self.graph.unit(shape, row, column);
        }
        self.linear(shape, |plain| plain.atom_of(Node::Embed(plain.id, row, column), shape))
    }

    /// An integer power of a scalar.
    pub fn powi(self, exponent: i32) -> Expr<'g> {
        self.power(rational(exponent as i64, 1))
    }

    /// The square root of a scalar.
    pub fn sqrt(self) -> Expr<'g> {
        self.power(rational(1, 2))
    }

    /// A rational power of a scalar. Powers of powers are merged only where that is true for every real value.
    pub fn power(self, exponent: Rational) -> Expr<'g> {
        assert!(self.shape().is_scalar(), "a power of `{self}`");
        let graph = self.graph;
        let Some(exponent) = small_exponent(&exponent) else {
            return (self.function(Function::Ln) * graph.number(exponent)).function(Function::Exp);
        };
        if exponent.is_zero() {
            return graph.integer(1);
        }
        if self.is_zero() && exponent > Exponent::zero() {
            return self;
        }
        let Term { coefficient, scalars, word: _ } = self.factor();
        let mut term = Term::number(Rational::one());
        match Graph::small_integer(&exponent) {
            Some(power) if !coefficient.is_zero() => {
                term.coefficient = num_traits::Pow::pow(&coefficient, power);
                let powers: Vec<(Id, Exponent)> = scalars.iter().map(|&(id, e)| (id, e * exponent)).collect();
                term.multiply_scalars(&powers);
            }
            _ => match self
                .as_number()
                .filter(|number| number.is_one() || (number.is_zero() && exponent > Exponent::zero()))
            {
                Some(number) => return graph.number(number),
                None => term.multiply_scalars(&[(self.id, exponent)]),
            },
        }
        graph.collect(Shape::scalar(), [term])
    }

    /// An elementary function of a scalar.
    pub fn function(self, function: Function) -> Expr<'g> {
        assert!(self.shape().is_scalar(), "a function of `{self}`");
        let graph = self.graph;
        let value_at_zero = match function {
            Function::Cos | Function::Cosh | Function::Exp => Some(1),
            Function::Sin | Function::Tan | Function::Asin | Function::Atan | Function::Sinh | Function::Tanh => {
                Some(0)
            }
            Function::Acos | Function::Ln => None,
        };
        match value_at_zero {
            Some(value) if self.is_zero() => graph.integer(value),
            _ if function == Function::Ln && self.is_identity() => graph.integer(0),
            _ => self.atom_of(Node::Function(function, self.id), Shape::scalar()),
        }
    }
}

/// An exponent with small numerator and denominator.
fn small_exponent(exponent: &Rational) -> Option<Exponent> {
    let numerator = i64::try_from(exponent.numer()).ok().filter(|n| n.abs() <= 1 << 20)?;
    let denominator = i64::try_from(exponent.denom()).ok().filter(|d| *d <= 1 << 20)?;
    Some(Exponent::new(numerator, denominator))
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
            Node::Sum(_) => expr.trace(),
            Node::Transpose(inner) => self.expr(*inner).trace(),
            Node::Wedge(algebra, _) if algebra.is_skew() => self.integer(0),
            Node::DiagonalMatrix(inner) => {
                let n = self.shape(*inner).rows;
                (0..n).map(|i| self.expr(*inner).entry(i, 0)).fold(self.integer(0), |sum, entry| sum + entry)
            }
            Node::Literal(entries) => {
                let n = self.shape(letter).rows;
                self.number((0..n).map(|i| entries[i * n + i].clone()).sum())
            }
            Node::Symbol(_) if self.has_property(letter, Property::Skew) => self.integer(0),
            _ => self.intern(Node::Trace(vec![letter]), Shape::scalar()),
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
        self.intern(Node::Trace(least), Shape::scalar()).times(&sign)
    }
}
