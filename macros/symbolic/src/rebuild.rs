//! Rewriting an expression from its leaves: substitution, expansion, dependence.

use crate::memory::{self, Images, Map};
use crate::node::{Exponent, ExprNode, Id, Operation, Term};
use crate::work::{self, Exhausted};
use crate::{Elements, Expr, Graph, IntoList, Rational, Shape, Table};

impl<'g> Expr<'g> {
    /// All nodes that this expression is made of, children before parents, itself last.
    pub(crate) fn reachable(self) -> Vec<Id> {
        self.reachable_where(|_| true)
    }

    /// The nodes that this expression is made of, as far as there is a way to them over nodes that are wanted.
    pub(crate) fn reachable_where(self, wanted: impl Fn(Id) -> bool) -> Vec<Id> {
        // children come before their parents: read off in order, a bit for each, the reached ones need no sorting
        let mut seen = vec![0_u64; self.id.0 as usize / 64 + 1];
        let (mut count, mut open) = (0, vec![self.id]);
        while let Some(id) = open.pop() {
            let (word, bit) = (id.0 as usize / 64, 1 << (id.0 % 64));
            if seen[word] & bit == 0 && wanted(id) {
                seen[word] |= bit;
                count += 1;
                self.graph.node(id).each_child(|child| open.push(child));
            }
        }
        work::spend(10 + (count + seen.len()) / 4);
        let mut reached = Vec::with_capacity(count);
        for (word, mut bits) in seen.into_iter().enumerate() {
            while bits != 0 {
                reached.push(Id(64 * word as u32 + bits.trailing_zeros()));
                bits &= bits - 1;
            }
        }
        reached
    }

    /// Whether a node occurs that passes a test.
    fn has(self, test: impl Fn(&ExprNode) -> bool) -> bool {
        self.reachable().into_iter().any(|id| test(&self.graph.node(id)))
    }

    /// Whether a scalar factor occurs, as base and exponent, that passes a test.
    fn has_factor(self, test: impl Fn(Id, Exponent) -> bool) -> bool {
        let passes = |term: &Term| term.scalars.iter().any(|(base, exponent)| test(*base, *exponent));
        self.has(|node| matches!(node, ExprNode::Sum(terms) if terms.iter().any(passes)))
    }

    /// The symbols that occur, in the order of their creation.
    pub fn symbols(self) -> Vec<Expr<'g>> {
        let reachable = self.reachable().into_iter().map(|id| self.graph.expr(id));
        reachable.filter(|expr| matches!(&*expr.node(), ExprNode::Symbol(_))).into_list()
    }

    /// Whether the symbol occurs.
    pub fn depends_on(self, symbol: Expr<'g>) -> bool {
        self.reachable_where(|id| id >= symbol.id).contains(&symbol.id)
    }

    /// The degree in a symbol of a polynomial, before terms cancel. Quotients count by their numerator, inverses as
    /// the matrix itself.
    pub fn degree(self, symbol: Expr<'g>) -> u32 {
        let mut degrees: Table<Id, u32> = Table::default();
        for id in self.reachable() {
            let node = self.graph.node(id);
            let of = |part: &Id| degrees.get(part).copied().unwrap_or(0);
            let product = |parts: &[Id]| parts.iter().fold(0, |sum, part| of(part).saturating_add(sum));
            let largest = |parts: &[Id]| parts.iter().map(of).max().unwrap_or(0);
            let power = |(base, exponent): &(Id, Exponent)| of(base).saturating_mul(exponent.floor().max(0) as u32);
            let scalars = |term: &Term| term.scalars.iter().map(power).fold(0, u32::saturating_add);
            let degree = match &*node {
                _ if id == symbol.id => 1,
                ExprNode::Sum(terms) => {
                    let of_term = |term: &Term| scalars(term).saturating_add(product(&term.word));
                    terms.iter().map(of_term).max().unwrap_or(0)
                }
                ExprNode::Word(parts) | ExprNode::Trace(parts) => product(parts),
                ExprNode::Hadamard(a, b) => product(&[*a, *b]),
                ExprNode::Of(Operation::Determinant, a) => {
                    of(a).saturating_mul(self.graph.expr(*a).shape().rows as u32)
                }
                ExprNode::Of(_, a) => of(a),
                ExprNode::Stack(parts) | ExprNode::Opaque(_, _, parts) => largest(parts),
                ExprNode::Symbol(_) | ExprNode::Pi | ExprNode::Literal(_) => 0,
            };
            degrees.insert(id, degree);
        }
        degrees.get(&self.id).copied().unwrap_or(0)
    }

    /// Whether the inverse of a matrix occurs.
    pub fn has_inverse(self) -> bool {
        self.has(|node| matches!(node, ExprNode::Of(Operation::Inverse, _)))
    }

    /// Whether it divides by an expression in one of these symbols, or takes the inverse of a matrix in them. If the
    /// divisor vanishes, it has a pole.
    pub fn has_poles_in(self, symbols: &[Expr<'g>]) -> bool {
        let depends = |id: Id| symbols.iter().any(|symbol| self.graph.expr(id).depends_on(*symbol));
        self.has(|node| matches!(node, ExprNode::Of(Operation::Inverse, matrix) if depends(*matrix)))
            || self.has_factor(|base, exponent| exponent.is_negative() && depends(base))
    }

    /// Whether a method of the user's occurs: it has no second derivative.
    pub fn has_methods(self) -> bool {
        self.has(|node| matches!(node, ExprNode::Opaque(..)))
    }

    /// Whether a root, an elementary function, a power series or a method of the user's occurs.
    pub fn has_functions(self) -> bool {
        let is_function = |node: &ExprNode| {
            matches!(node, ExprNode::Of(Operation::Function(_) | Operation::Analytic(_), _) | ExprNode::Opaque(..))
        };
        self.has(is_function) || self.has_factor(|_, exponent| !exponent.is_integer())
    }

    /// Whether no functions, roots or irrational numbers occur.
    pub fn is_rational(self) -> bool {
        !self.has_functions() && !self.has(|node| *node == ExprNode::Pi)
    }

    /// Whether no reciprocal of zero occurs.
    pub fn is_defined(self) -> bool {
        let zero = self.graph.integer(0).id;
        !self.has_factor(|base, exponent| base == zero && exponent.is_negative())
    }

    /// The expression with symbols replaced by expressions of the same shape.
    pub fn substitute(self, replacements: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
        let replacements = memory::pairs(replacements);
        let images = self.graph.images(Map::Substitution(replacements.clone()));
        replacements.iter().for_each(|(from, to)| images.set(*from, *to));
        self.mapped(&images, |part| part.rebuild(&images))
    }

    /// The same node over the images of its children.
    pub(crate) fn rebuild(self, images: &Images) -> Expr<'g> {
        let graph = self.graph;
        let node = self.node();
        if node.all_children(|child| images.get(child) == Some(child)) {
            return self;
        }
        let image = |part: &Id| images.of(graph, part);
        let all = |parts: &[Id]| parts.each(image);
        let product = |word: &[Id]| word.iter().map(image).reduce(|a, b| a * b);
        match &*node {
            ExprNode::Symbol(_) | ExprNode::Pi | ExprNode::Literal(_) => self,
            ExprNode::Sum(terms) => {
                let image = |term: &Term| {
                    let scale = term.scale_over(graph, |base| image(&base));
                    let word = product(&term.word).unwrap_or_else(|| graph.identity(self.shape().rows));
                    scale * word
                };
                graph.total(self.shape(), terms.iter().map(image))
            }
            ExprNode::Stack(entries) => graph.stack(self.shape(), all(entries)),
            // by construction: words of `Word` and `Trace` nodes are not empty
            ExprNode::Word(word) => product(word).expect("a word has letters"),
            ExprNode::Trace(word) => product(word).expect("a word has letters").trace(),
            ExprNode::Opaque(name, output, arguments) => graph.opaque(name, *output, &all(arguments), self.shape()),
            ExprNode::Hadamard(a, b) => image(a).hadamard(image(b)),
            ExprNode::Of(operation, a) => image(a).apply(*operation, self.shape()),
        }
    }

    /// The operation on this expression, with a result of the given shape.
    pub(crate) fn apply(self, operation: Operation, shape: Shape) -> Expr<'g> {
        match operation {
            Operation::Transpose => self.transpose(),
            Operation::Inverse => self.inverse(),
            Operation::Determinant => self.determinant(),
            Operation::Function(function) => self.function(function),
            Operation::Analytic(function) => self.analytic(function),
            Operation::Block(row, column) => self.block(row, column, shape),
            Operation::Embed(row, column) => self.embed(shape, row, column),
            Operation::DiagonalMatrix => self.diagonal_matrix(),
            Operation::Diagonal => self.diagonal(),
            Operation::Wedge(algebra) => self.wedge(algebra),
            Operation::Components(algebra) => self.components(algebra),
        }
    }

    /// All products distributed over sums, and the relations between resolvents (I + aL)⁻¹ and their letter L applied.
    pub fn expand(self) -> Expr<'g> {
        let images = &self.graph.expanded;
        self.mapped(images, |part| part.expand_node(images))
    }

    /// As [`expand`](Self::expand), where that takes so much work at most. Otherwise it stays as it is, also where it occurs again.
    pub fn expand_within(self, units: u64) -> Expr<'g> {
        if self.is_long() {
            return self;
        }
        work::within(units, || self.expand()).unwrap_or_else(|Exhausted| {
            self.graph.long.set(self.id, self.id);
            self
        })
    }

    /// Whether [`expand_within`](Self::expand_within) has left it as it is.
    pub fn is_long(self) -> bool {
        self.graph.long.get(self.id).is_some()
    }

    /// As [`expand`](Self::expand), and inside roots and functions too: for limits, where cancellation is the goal.
    pub fn expand_all(self) -> Expr<'g> {
        let images = Images::default();
        self.mapped(&images, |part| part.rebuild(&images).expand())
    }

    fn expand_node(self, images: &Images) -> Expr<'g> {
        let graph = self.graph;
        match &*self.node() {
            ExprNode::Of(Operation::Function(_), _) => self,
            ExprNode::Sum(terms) => {
                let shape = self.shape();
                graph.total(shape, terms.iter().map(|term| graph.expand_term(term, shape, images)))
            }
            ExprNode::Word(word) => graph.expand_word(word, images, Shape::scalar()),
            ExprNode::Trace(word) => {
                let n = graph.shape(word[0]).rows;
                graph.expand_word(word, images, Shape::square(n)).trace()
            }
            _ => self.rebuild(images),
        }
    }
}

impl Graph {
    fn expand_term<'g>(&'g self, term: &Term, shape: Shape, images: &Images) -> Expr<'g> {
        let mut scale = self.number(term.coefficient.clone());
        for (base, exponent) in &term.scalars {
            let power = self.expanded_power(self.expr(*base), images.of(self, base), *exponent);
            scale = self.distribute(scale, power, Shape::scalar());
        }
        let word = self.expand_word(&term.word, images, shape);
        self.distribute(scale, word, shape)
    }

    /// Positive integer powers are multiplied out. The base of any other power stays as it was written: |x − y|² under a root
    /// must not become x² − 2xy + y², which cancels.
    fn expanded_power<'g>(&'g self, base: Expr<'g>, expanded: Expr<'g>, exponent: Exponent) -> Expr<'g> {
        match exponent.parts() {
            (count @ 0..=16, 1) => {
                (0..count).fold(self.integer(1), |power, _| self.distribute(power, expanded, Shape::scalar()))
            }
            _ => base.power(Rational::short(exponent)),
        }
    }

    fn expand_word<'g>(&'g self, word: &[Id], images: &Images, shape: Shape) -> Expr<'g> {
        let letters = word.iter().map(|letter| images.of(self, letter));
        let product = |left: Expr<'g>, right: Expr<'g>| {
            self.distribute(left, right, Shape::new(left.shape().rows, right.shape().columns))
        };
        letters.reduce(product).unwrap_or_else(|| self.identity(shape.rows))
    }

    /// The product of two expanded expressions, term by term.
    fn distribute<'g>(&'g self, left: Expr<'g>, right: Expr<'g>, shape: Shape) -> Expr<'g> {
        let (left, right) = (left.terms(), right.terms());
        let pairs = left.iter().flat_map(|a| right.iter().map(move |b| (a, b)));
        self.total(shape, pairs.map(|(a, b)| self.multiply_expanded(a, b, shape)))
    }

    fn multiply_expanded(&self, a: &Term, b: &Term, shape: Shape) -> Expr<'_> {
        let contraction =
            a.word.last().zip(b.word.first()).and_then(|(last, first)| self.resolvent_product(*last, *first));
        let Some(contraction) = contraction else { return self.multiply(a, b, shape) };
        // the neighbours are square matrices of one size
        let (n, mut prefix, mut suffix) = (contraction.shape().rows, a.clone(), b.clone());
        prefix.word.pop();
        suffix.word.remove(0);
        let rows = prefix.word.first().map_or(n, |&letter| self.shape(letter).rows);
        let columns = suffix.word.last().map_or(n, |&letter| self.shape(letter).columns);
        let prefix = self.collect(Shape::new(rows, n), [prefix]);
        let suffix = self.collect(Shape::new(n, columns), [suffix]);
        let middle = self.distribute(prefix, contraction, Shape::new(rows, n));
        self.distribute(middle, suffix, Shape::new(rows, columns))
    }

    /// (I + aL)⁻¹ L = (I − (I + aL)⁻¹)/a, and (I + aL)⁻¹ (I + bL)⁻¹ = (a (I + aL)⁻¹ − b (I + bL)⁻¹)/(a − b).
    fn resolvent_product(&self, left: Id, right: Id) -> Option<Expr<'_>> {
        let identity = self.identity(self.shape(left).rows);
        let contract = |(a, resolvent): (Rational, Id)| (identity - self.expr(resolvent)).times(&a.recip());
        match (self.resolvent(left), self.resolvent(right)) {
            (Some((a, letter)), None) if letter == right => Some(contract((a, left))),
            (None, Some((b, letter))) if letter == left => Some(contract((b, right))),
            (Some((a, one)), Some((b, other))) if one == other && a != b => {
                let difference = &a - &b;
                Some((self.expr(left).times(&a) - self.expr(right).times(&b)).times(&difference.recip()))
            }
            _ => None,
        }
    }

    /// The pair (a, L), if the letter is (I + aL)⁻¹.
    fn resolvent(&self, letter: Id) -> Option<(Rational, Id)> {
        let ExprNode::Of(Operation::Inverse, inner) = &*self.node(letter) else { return None };
        let ExprNode::Sum(terms) = &*self.node(*inner) else { return None };
        let [first, second] = terms.as_slice() else { return None };
        let unit = |term: &Term| term.scalars.is_empty() && term.word.is_empty() && term.coefficient.is_one();
        let (_, other) = if unit(first) { (first, second) } else { (second, first) };
        let plain = (unit(first) || unit(second)) && other.scalars.is_empty() && other.word.len() == 1;
        (plain && !other.coefficient.is_zero()).then(|| (other.coefficient.clone(), other.word[0]))
    }
}
