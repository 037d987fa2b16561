//! The algebra of terms: sums collect like terms, products merge scalar powers and reduce words of letters.

use std::cmp::Ordering;

use crate::blocks::common;
use crate::node::{Exponent, ExprNode, Id, Operation, Term};
use crate::rational::product;
use crate::{Expr, Graph, Group, IntoList, Property, Rational, Shape, integer, work};

impl Term {
    pub(crate) fn number(coefficient: Rational) -> Term {
        Term { coefficient, scalars: Vec::new(), word: Vec::new() }
    }

    /// The term without its word, and its word.
    pub(crate) fn split(self) -> (Term, Term) {
        let plain = Term { word: self.word, ..Term::number(Rational::one()) };
        (Term { word: Vec::new(), ..self }, plain)
    }

    /// The order of terms in sums: by their scalar powers, then by their words, like terms being equal.
    fn compare(&self, other: &Term) -> Ordering {
        let (left, right) = (self.scalars.as_slice(), other.scalars.as_slice());
        let mut k = 0;
        while k < left.len() && k < right.len() {
            let (a, b) = (left[k], right[k]);
            if a.0.0 != b.0.0 {
                return if a.0.0 < b.0.0 { Ordering::Less } else { Ordering::Greater };
            }
            match if a.1 == b.1 { Ordering::Equal } else { a.1.cmp(&b.1) } {
                Ordering::Equal => k += 1,
                order => return order,
            }
        }
        match left.len() {
            length if length < right.len() => Ordering::Less,
            length if length > right.len() => Ordering::Greater,
            _ if self.word.is_empty() && other.word.is_empty() => Ordering::Equal,
            _ => self.word.cmp(&other.word),
        }
    }

    /// Multiplies by scalar powers, keeping them sorted and without zero exponents.
    pub(crate) fn multiply_scalars(&mut self, scalars: &[(Id, Exponent)]) {
        if self.scalars.is_empty() {
            self.scalars.extend_from_slice(scalars);
            return;
        }
        for &(base, exponent) in scalars {
            match self.scalars.binary_search_by_key(&base, |&(id, _)| id) {
                Err(position) => self.scalars.insert(position, (base, exponent)),
                Ok(position) => {
                    let sum = self.scalars[position].1 + exponent;
                    self.scalars[position].1 = sum;
                    if sum.is_zero() {
                        self.scalars.remove(position);
                    }
                }
            }
        }
    }
}

/// The place of a term in a sorted sum of distinct ones, or the one that it would take.
fn place(sum: &[Term], term: &Term) -> Result<usize, usize> {
    let (mut low, mut high) = (0, sum.len());
    // most terms come last
    let mut middle = high.wrapping_sub(1);
    while low < high {
        match sum[middle].compare(term) {
            Ordering::Less => low = middle + 1,
            Ordering::Equal => return Ok(middle),
            Ordering::Greater => high = middle,
        }
        middle = low + (high - low) / 2;
    }
    Err(low)
}

/// Adds a term to a sorted sum of distinct ones, to a like term where there is one.
fn add(sum: &mut Vec<Term>, term: Term) {
    match place(sum, &term) {
        Ok(position) => sum[position].coefficient += term.coefficient,
        Err(position) => {
            // later terms move
            work::spend((sum.len() - position) / 32);
            sum.insert(position, term);
        }
    }
}

impl Graph {
    /// The sum of terms of one shape, like terms collected; a single plain letter is that letter.
    pub(crate) fn collect(&self, shape: Shape, terms: impl IntoIterator<Item = Term>) -> Expr<'_> {
        let mut sum: Vec<Term> = Vec::new();
        for term in terms {
            add(&mut sum, term);
        }
        self.settle(shape, sum)
    }

    /// The sum of expressions of one shape. Partial sums make no expressions: a long sum would have as many of them,
    /// and nearly as long.
    pub fn total<'g>(&'g self, shape: Shape, parts: impl IntoIterator<Item = Expr<'g>>) -> Expr<'g> {
        let mut sum: Vec<Term> = Vec::new();
        for part in parts {
            work::spend(4);
            for term in part.terms() {
                add(&mut sum, term);
            }
        }
        self.settle(shape, sum)
    }

    /// A scalar term as an expression.
    pub(crate) fn scalar(&self, term: Term) -> Expr<'_> {
        self.collect(Shape::scalar(), [term])
    }

    /// A term without its word.
    pub(crate) fn scale(&self, term: &Term) -> Expr<'_> {
        let Term { coefficient, scalars, word: _ } = term;
        self.scalar(Term { coefficient: coefficient.clone(), scalars: scalars.clone(), word: Vec::new() })
    }

    /// The sum of terms that are sorted and distinct.
    fn settle(&self, shape: Shape, mut terms: Vec<Term>) -> Expr<'_> {
        let mut has_zeros = false;
        for term in &terms {
            has_zeros |= term.coefficient.is_zero();
        }
        if has_zeros {
            terms.retain(|term| !term.coefficient.is_zero());
        }
        if let [Term { coefficient, scalars, word }] = terms.as_slice()
            && coefficient.is_one()
        {
            match (scalars.as_slice(), word.as_slice()) {
                ([], [letter]) => return self.expr(*letter),
                ([(base, exponent)], []) if exponent.is_one() && shape.is_scalar() => return self.expr(*base),
                _ => {}
            }
        }
        self.intern(ExprNode::Sum(terms), shape)
    }
}

impl<'g> Expr<'g> {
    /// The terms whose sum this is; an atom is one term.
    pub(crate) fn terms(self) -> Vec<Term> {
        match &*self.node() {
            ExprNode::Sum(terms) => terms.clone(),
            _ => vec![self.atom()],
        }
    }

    /// This expression as a single factor.
    fn atom(self) -> Term {
        let term = Term::number(Rational::one());
        match self.shape().is_scalar() {
            true => Term { scalars: vec![(self.id, Exponent::ONE)], ..term },
            false => Term { word: vec![self.id], ..term },
        }
    }

    /// A single term: the only one of the sum, or all of the expression as a factor.
    pub(crate) fn factor(self) -> Term {
        match &*self.node() {
            ExprNode::Sum(terms) if terms.len() == 1 => terms[0].clone(),
            _ => self.atom(),
        }
    }

    /// self + coefficient · other.
    pub(crate) fn sum(self, other: Expr<'g>, coefficient: Rational) -> Expr<'g> {
        assert_eq!(self.shape(), other.shape(), "a sum of `{self}` and `{other}`");
        if other.is_zero() {
            return self;
        }
        if self.is_zero() {
            return other.times(&coefficient);
        }
        let mut sum = self.terms();
        for mut term in other.terms() {
            term.coefficient = product(&term.coefficient, &coefficient);
            add(&mut sum, term);
        }
        self.graph.settle(self.shape(), sum)
    }

    /// coefficient · self, distributed over a sum.
    pub(crate) fn times(self, coefficient: &Rational) -> Expr<'g> {
        if coefficient.is_one() {
            return self;
        }
        let mut terms = self.terms();
        for term in &mut terms {
            term.coefficient = product(&term.coefficient, coefficient);
        }
        self.graph.settle(self.shape(), terms)
    }

    /// Each term of the sum times a scalar, which meets the powers that the terms hold of it.
    pub fn times_each(self, scalar: Expr<'g>) -> Expr<'g> {
        let terms = self.terms().into_iter().map(|term| self.graph.collect(self.shape(), [term]) * scalar);
        self.graph.total(self.shape(), terms)
    }

    /// The product of matrices, or of a scalar and anything.
    pub(crate) fn product(self, other: Expr<'g>) -> Expr<'g> {
        let (left, right) = (self.shape(), other.shape());
        let shape = match (left.is_scalar(), right.is_scalar()) {
            (true, _) => right,
            (_, true) => left,
            _ => {
                assert!(left.columns == right.rows, "a product of `{self}` and `{other}`");
                Shape::new(left.rows, right.columns)
            }
        };
        if self.is_zero() || other.is_zero() {
            return self.graph.zero(shape);
        }
        if let Some(number) = self.as_number() {
            return other.times(&number);
        }
        if let Some(number) = other.as_number() {
            return self.times(&number);
        }
        self.graph.multiplied(self.factor(), &other.factor(), shape)
    }
}

impl Graph {
    /// The product of two terms as an expression of the given shape.
    pub(crate) fn multiply(&self, left: &Term, right: &Term, shape: Shape) -> Expr<'_> {
        self.multiplied(left.clone(), right, shape)
    }

    fn multiplied(&self, mut term: Term, right: &Term, shape: Shape) -> Expr<'_> {
        if !right.coefficient.is_one() {
            term.coefficient = product(&term.coefficient, &right.coefficient);
        }
        term.multiply_scalars(&right.scalars);
        let mut word = std::mem::take(&mut term.word);
        if !right.word.is_empty() {
            word.extend_from_slice(&right.word);
        }
        match word.is_empty() {
            true if term.coefficient.is_zero() => self.zero(shape),
            true => self.settle(shape, vec![term]),
            false => self.with_word(term, &word, shape),
        }
    }

    /// `term · word`, the word reduced.
    pub(crate) fn with_word(&self, mut term: Term, letters: &[Id], shape: Shape) -> Expr<'_> {
        let mut word = Vec::new();
        letters.iter().for_each(|&letter| self.push_letter(&mut term, &mut word, letter));
        if word.iter().any(|&letter| self.expr(letter).is_zero()) || term.coefficient.is_zero() {
            return self.zero(shape);
        }
        // cut where an inner dimension is one
        for segment in word.chunk_by(|_, next| self.shape(*next).rows != 1) {
            let (first, last) = (self.shape(segment[0]), self.shape(segment[segment.len() - 1]));
            if first.rows != 1 || last.columns != 1 {
                term.word.extend(segment);
                continue;
            }
            let scalar = self.scalar_word(segment);
            if scalar.is_zero() {
                return self.zero(shape);
            }
            let factor = scalar.factor();
            term.coefficient = product(&term.coefficient, &factor.coefficient);
            term.multiply_scalars(&factor.scalars);
        }
        match term.word.as_slice() {
            [letter] if term.scalars.is_empty() => self.expr(*letter).times(&term.coefficient),
            _ => self.settle(shape, vec![term]),
        }
    }

    /// Appends a letter: a letter that is a single term is merged, neighbours that cancel are dropped, literals are multiplied.
    fn push_letter(&self, term: &mut Term, word: &mut Vec<Id>, letter: Id) {
        if let ExprNode::Sum(terms) = &*self.node(letter)
            && let [inner] = terms.as_slice()
        {
            term.coefficient = product(&term.coefficient, &inner.coefficient);
            term.multiply_scalars(&inner.scalars);
            inner.word.iter().for_each(|&letter| self.push_letter(term, word, letter));
            return;
        }
        match word.last().and_then(|&last| self.merge(last, letter)) {
            None => word.push(letter),
            Some(merged) => {
                word.pop();
                self.push_letter(term, word, merged.id);
            }
        }
    }

    /// The product of two neighbouring letters, where it is simpler than the pair.
    fn merge(&self, left: Id, right: Id) -> Option<Expr<'_>> {
        let inverse = |a: Id, b: Id| match &*self.node(a) {
            ExprNode::Of(Operation::Transpose, inner) => *inner == b && self.is_orthogonal(b),
            ExprNode::Of(Operation::Inverse, inner) => *inner == b,
            _ => false,
        };
        if inverse(left, right) || inverse(right, left) || self.are_orthonormal(left, right) {
            return Some(self.identity(self.shape(left).rows));
        }
        if left == right && matches!(self.expr(left).property(), Property::Projector(_)) {
            return Some(self.expr(left));
        }
        let shape = Shape::new(self.shape(left).rows, self.shape(right).columns);
        let embedded = |(operation, inner): (&Operation, &Id)| match operation {
            Operation::Embed(row, column) => Some((self.expr(*inner), *row, *column)),
            _ => None,
        };
        match (&*self.node(left), &*self.node(right)) {
            (ExprNode::Literal(a), ExprNode::Literal(b)) => {
                let inner = a.len() / shape.rows;
                let product = |i: usize, j: usize, k: usize| &a[i * inner + k] * &b[k * shape.columns + j];
                let entry = |(i, j)| (0..inner).map(|k| product(i, j, k)).sum::<Rational>();
                Some(self.literal(shape, shape.positions().map(entry).into_list()))
            }
            (ExprNode::Of(first, a), ExprNode::Of(second, b)) => {
                let ((a, row, column), (b, other_row, other_column)) =
                    embedded((first, a)).zip(embedded((second, b)))?;
                let part = self.overlap((a, column), (b, other_row), Expr::block);
                Some(part.embed(shape, row, other_column))
            }
            (ExprNode::Literal(_), ExprNode::Of(operation, b)) => {
                let (b, row, column) = embedded((operation, b))?;
                let columns = self.expr(left).block(0, row, Shape::new(shape.rows, b.shape().rows));
                let (first, part) = self.sparse_rows(columns)?;
                Some((part * b).embed(shape, first, column))
            }
            (ExprNode::Of(operation, a), ExprNode::Literal(_)) => {
                let (a, row, column) = embedded((operation, a))?;
                let rows = self.expr(right).block(column, 0, Shape::new(a.shape().columns, shape.columns));
                let (first, part) = self.sparse_rows(rows.transpose())?;
                Some((a * part.transpose()).embed(shape, row, first))
            }
            _ => None,
        }
        .filter(|product| !product.shape().is_scalar() || product.as_number().is_none())
    }

    /// The product of A, whose columns stand from `column` on, and B, whose rows stand from `row` on. Only columns and
    /// rows that meet count.
    pub(crate) fn overlap<'g>(
        &'g self,
        (a, column): (Expr<'g>, usize),
        (b, row): (Expr<'g>, usize),
        block: impl Fn(Expr<'g>, usize, usize, Shape) -> Expr<'g>,
    ) -> Expr<'g> {
        let (left, right) = (a.shape(), b.shape());
        let inner = common((column, left.columns), (row, right.rows));
        if inner.is_empty() {
            return self.zero(Shape::new(left.rows, right.columns));
        }
        let a = block(a, 0, inner.start - column, Shape::new(left.rows, inner.len()));
        a * block(b, inner.start - row, 0, Shape::new(inner.len(), right.columns))
    }

    /// The rows of a matrix of numbers between the first and the last that are not zero, with the index of the first.
    /// Zero has no such rows; `None` if these are all rows.
    fn sparse_rows<'g>(&'g self, literal: Expr<'g>) -> Option<(usize, Expr<'g>)> {
        let shape = literal.shape();
        let mut filled = (0..shape.rows).filter(|i| !literal.block(*i, 0, Shape::new(1, shape.columns)).is_zero());
        let Some(first) = filled.next() else { return Some((0, literal)) };
        let rows = filled.next_back().unwrap_or(first) + 1 - first;
        (rows < shape.rows).then(|| (first, literal.block(first, 0, Shape::new(rows, shape.columns))))
    }

    /// Whether the letters are Xᵀ and X of orthonormal columns.
    fn are_orthonormal(&self, left: Id, right: Id) -> bool {
        *self.node(left) == ExprNode::Of(Operation::Transpose, right)
            && self.expr(right).property() == Property::Orthonormal
    }

    pub(crate) fn is_orthogonal(&self, id: Id) -> bool {
        self.is_rotation_or(id, Group::is_orthogonal)
    }

    /// Whether this is the symbol of a rotation or of an element of a group that passes a test.
    pub(crate) fn is_rotation_or(&self, id: Id, test: fn(Group) -> bool) -> bool {
        match self.expr(id).property() {
            Property::Element(group) => test(group),
            property => property == Property::Orthogonal,
        }
    }

    /// The 1×1 product of a word, written in the one of its two readings that comes first.
    fn scalar_word(&self, word: &[Id]) -> Expr<'_> {
        match word {
            [only] => return self.expr(*only),
            [a, b] => {
                if let (ExprNode::Literal(a), ExprNode::Literal(b)) = (&*self.node(*a), &*self.node(*b)) {
                    return self.number(a.iter().zip(b).map(|(a, b)| a * b).sum());
                }
                let is_square = *self.node(*a) == ExprNode::Of(Operation::Transpose, *b);
                if is_square && self.expr(*b).property() == Property::Unit {
                    return self.integer(1);
                }
            }
            _ => {}
        }
        let (sign, reversed) = self.transposed_word(word).unwrap_or_else(|| (Rational::one(), word.to_vec()));
        match reversed.as_slice().cmp(word) {
            Ordering::Less => self.intern(ExprNode::Word(reversed), Shape::scalar()).times(&sign),
            Ordering::Equal if sign == integer(-1) => self.integer(0),
            _ => self.intern(ExprNode::Word(word.to_vec()), Shape::scalar()),
        }
    }

    /// The transposed letters in reverse order, with a sign; `None` if a letter's transpose is not plus or minus a letter.
    pub(crate) fn transposed_word(&self, word: &[Id]) -> Option<(Rational, Vec<Id>)> {
        let mut sign = Rational::one();
        let mut reversed = Vec::with_capacity(word.len());
        for &letter in word.iter().rev() {
            let factor = self.expr(letter).transpose().factor();
            match (factor.scalars.as_slice(), factor.word.as_slice()) {
                ([], [transposed]) => reversed.push(*transposed),
                _ => return None,
            }
            sign *= factor.coefficient;
        }
        Some((sign, reversed))
    }
}
