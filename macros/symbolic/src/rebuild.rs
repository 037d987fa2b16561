//! Rewriting an expression from its leaves: substitution, expansion, dependence.

use std::collections::BTreeSet;

use num_traits::{One, Zero};

use crate::node::{Exponent, Id, Node, Term};
use crate::{Expr, Graph, Rational, Shape, Table};

impl Node {
    /// The identities of the direct children.
    pub(crate) fn children(&self) -> Vec<Id> {
        match self {
            Node::Symbol(_) | Node::Pi | Node::Literal(_) => Vec::new(),
            Node::Sum(terms) => {
                terms.iter().flat_map(|t| t.scalars.iter().map(|s| s.0).chain(t.word.iter().copied())).collect()
            }
            Node::Stack(ids) | Node::Word(ids) | Node::Trace(ids) | Node::Opaque(_, _, ids) => ids.clone(),
            Node::Hadamard(a, b) => vec![*a, *b],
            Node::Transpose(a)
            | Node::Inverse(a)
            | Node::Determinant(a)
            | Node::Function(_, a)
            | Node::Analytic(_, a)
            | Node::Block(a, _, _) => vec![*a],
            Node::Embed(a, _, _)
            | Node::DiagonalMatrix(a)
            | Node::Diagonal(a)
            | Node::Wedge(_, a)
            | Node::Components(_, a) => {
                vec![*a]
            }
        }
    }
}

impl<'g> Expr<'g> {
    /// All nodes that this expression is made of, children before parents, itself last.
    pub(crate) fn reachable(self) -> BTreeSet<Id> {
        let mut seen = BTreeSet::new();
        let mut open = vec![self.id];
        while let Some(id) = open.pop() {
            if seen.insert(id) {
                open.extend(self.graph.node(id).children());
            }
        }
        seen
    }

    /// The symbols that occur, in the order of their creation.
    pub fn symbols(self) -> Vec<Expr<'g>> {
        let reachable = self.reachable().into_iter().map(|id| self.graph.expr(id));
        reachable.filter(|expr| matches!(&*expr.node(), Node::Symbol(_))).collect()
    }

    /// Whether the symbol occurs.
    pub fn depends_on(self, symbol: Expr<'g>) -> bool {
        self.reachable().contains(&symbol.id)
    }

    /// Whether the inverse of a matrix occurs.
    pub fn has_inverse(self) -> bool {
        self.reachable().into_iter().any(|id| matches!(&*self.graph.node(id), Node::Inverse(_)))
    }

    /// Whether a root, an elementary function, a power series or a method of the user's occurs.
    pub fn has_functions(self) -> bool {
        let fractional =
            |terms: &[Term]| terms.iter().any(|term| term.scalars.iter().any(|(_, e)| e.as_integer().is_none()));
        self.reachable().into_iter().any(|id| match &*self.graph.node(id) {
            Node::Function(..) | Node::Analytic(..) | Node::Opaque(..) => true,
            Node::Sum(terms) => fractional(terms),
            _ => false,
        })
    }

    /// The expression with symbols replaced by expressions of the same shape.
    pub fn substitute(self, replacements: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
        let mut images: Table<Id, Expr<'g>> = replacements.iter().map(|(from, to)| (from.id, *to)).collect();
        for id in self.reachable() {
            if !images.contains(&id) {
                let image = self.graph.expr(id).rebuild(&images);
                images.insert(id, image);
            }
        }
        images[&self.id]
    }

    /// The same node over the images of its children.
    pub(crate) fn rebuild(self, images: &Table<Id, Expr<'g>>) -> Expr<'g> {
        let graph = self.graph;
        let node = self.node();
        if node.children().iter().all(|child| images[child].id == *child) {
            return self;
        }
        let product = |word: &[Id]| word.iter().map(|letter| images[letter]).reduce(|a, b| a * b);
        match &*node {
            Node::Symbol(_) | Node::Pi | Node::Literal(_) => self,
            Node::Sum(terms) => terms.iter().fold(graph.zero(self.shape()), |sum, term| {
                let powers = term.scalars.iter().map(|(base, e)| images[base].power(Rational::short(*e)));
                let scale = powers.fold(graph.number(term.coefficient.clone()), |product, power| product * power);
                let word = product(&term.word).unwrap_or_else(|| graph.identity(self.shape().rows));
                sum + scale * word
            }),
            Node::Stack(entries) => graph.stack(self.shape(), entries.iter().map(|entry| images[entry]).collect()),
            // by construction: words of `Word` and `Trace` nodes are not empty
            Node::Word(word) => product(word).expect("a word has letters"),
            Node::Trace(word) => product(word).expect("a word has letters").trace(),
            Node::Transpose(a) => images[a].transpose(),
            Node::Inverse(a) => images[a].inverse(),
            Node::Determinant(a) => images[a].determinant(),
            Node::Function(function, a) => images[a].function(*function),
            Node::Analytic(function, a) => images[a].analytic(*function),
            Node::Opaque(name, output, arguments) => {
                graph.opaque_of(*name, *output, arguments.iter().map(|a| images[a]).collect(), self.shape())
            }
            Node::Block(a, row, column) => images[a].block(*row, *column, self.shape()),
            Node::Embed(a, row, column) => images[a].embed(self.shape(), *row, *column),
            Node::Hadamard(a, b) => images[a].hadamard(images[b]),
            Node::DiagonalMatrix(a) => images[a].diagonal_matrix(),
            Node::Diagonal(a) => images[a].diagonal(),
            Node::Wedge(algebra, a) => images[a].wedge(*algebra),
            Node::Components(algebra, a) => images[a].components(*algebra),
        }
    }

    /// All products distributed over sums, and the relations between resolvents (I + aL)⁻¹ and their letter L applied.
    pub fn expand(self) -> Expr<'g> {
        let mut images: Table<Id, Expr<'g>> = Table::default();
        for id in self.reachable() {
            let image = self.graph.expr(id).expand_node(&images);
            images.insert(id, image);
        }
        images[&self.id]
    }

    /// As [`expand`](Self::expand), and inside roots and functions too: for limits, where cancellation is what is looked for.
    pub fn expand_all(self) -> Expr<'g> {
        let mut images: Table<Id, Expr<'g>> = Table::default();
        for id in self.reachable() {
            let expr = self.graph.expr(id);
            let rebuilt = expr.rebuild(&images);
            images.insert(id, rebuilt.expand());
        }
        images[&self.id]
    }

    /// Whether no reciprocal of zero occurs.
    pub fn is_defined(self) -> bool {
        let zero = self.graph.integer(0).id;
        let fails =
            |term: &Term| term.scalars.iter().any(|(base, exponent)| *base == zero && *exponent < Exponent::ZERO);
        !self
            .reachable()
            .into_iter()
            .any(|id| matches!(&*self.graph.node(id), Node::Sum(terms) if terms.iter().any(fails)))
    }

    fn expand_node(self, images: &Table<Id, Expr<'g>>) -> Expr<'g> {
        let graph = self.graph;
        match &*self.node() {
            Node::Function(..) => self,
            Node::Sum(terms) => terms
                .iter()
                .fold(graph.zero(self.shape()), |sum, term| sum + graph.expand_term(term, self.shape(), images)),
            Node::Word(word) => graph.expand_word(word, images, Shape::scalar()),
            Node::Trace(word) => {
                let n = graph.shape(word[0]).rows;
                graph.expand_word(word, images, Shape::square(n)).trace()
            }
            _ => self.rebuild(images),
        }
    }
}

impl Graph {
    fn expand_term<'g>(&'g self, term: &Term, shape: Shape, images: &Table<Id, Expr<'g>>) -> Expr<'g> {
        let mut scale = self.number(term.coefficient.clone());
        for (base, exponent) in &term.scalars {
            scale =
                self.distribute(scale, self.expanded_power(self.expr(*base), images[base], *exponent), Shape::scalar());
        }
        let word = match term.word.is_empty() {
            true => self.identity(shape.rows),
            false => self.expand_word(&term.word, images, shape),
        };
        self.distribute(scale, word, shape)
    }

    /// Positive integer powers are multiplied out. The base of any other power stays as it was written: |x − y|² under a root
    /// must not become x² − 2xy + y², which cancels.
    fn expanded_power<'g>(&'g self, base: Expr<'g>, expanded: Expr<'g>, exponent: Exponent) -> Expr<'g> {
        match exponent.as_integer() {
            Some(count) if (0..=16).contains(&count) => {
                (0..count).fold(self.integer(1), |power, _| self.distribute(power, expanded, Shape::scalar()))
            }
            _ => base.power(Rational::short(exponent)),
        }
    }

    fn expand_word<'g>(&'g self, word: &[Id], images: &Table<Id, Expr<'g>>, shape: Shape) -> Expr<'g> {
        let mut product: Option<Expr<'g>> = None;
        for letter in word {
            let factor = images[letter];
            product = Some(match product {
                None => factor,
                Some(left) => self.distribute(left, factor, Shape::new(left.shape().rows, factor.shape().columns)),
            });
        }
        product.unwrap_or_else(|| self.identity(shape.rows))
    }

    /// The product of two expanded expressions, term by term.
    fn distribute<'g>(&'g self, left: Expr<'g>, right: Expr<'g>, shape: Shape) -> Expr<'g> {
        let mut sum = self.zero(shape);
        for a in left.terms() {
            for b in right.terms() {
                sum = sum + self.multiply_expanded(&a, &b, shape);
            }
        }
        sum
    }

    fn multiply_expanded(&self, a: &Term, b: &Term, shape: Shape) -> Expr<'_> {
        if let (Some(&last), Some(&first)) = (a.word.last(), b.word.first())
            && let Some(contraction) = self.resolvent_product(last, first)
        {
            let mut prefix = a.clone();
            prefix.word.pop();
            let mut suffix = b.clone();
            suffix.word.remove(0);
            let rows = self.word_rows(&prefix.word, self.shape(last).rows);
            let columns = self.word_columns(&suffix.word, self.shape(first).columns);
            let prefix = self.collect(Shape::new(rows, self.shape(last).rows), [prefix]);
            let suffix = self.collect(Shape::new(self.shape(first).columns, columns), [suffix]);
            let middle = self.distribute(prefix, contraction, Shape::new(rows, contraction.shape().columns));
            return self.distribute(middle, suffix, Shape::new(rows, columns));
        }
        self.multiply(a, b, shape)
    }

    fn word_rows(&self, word: &[Id], otherwise: usize) -> usize {
        word.first().map_or(otherwise, |&letter| self.shape(letter).rows)
    }

    fn word_columns(&self, word: &[Id], otherwise: usize) -> usize {
        word.last().map_or(otherwise, |&letter| self.shape(letter).columns)
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
        let Node::Inverse(inner) = &*self.node(letter) else { return None };
        let Node::Sum(terms) = &*self.node(*inner) else { return None };
        let [first, second] = terms.as_slice() else { return None };
        let unit = |term: &Term| term.scalars.is_empty() && term.word.is_empty() && term.coefficient.is_one();
        let (_, other) = if unit(first) { (first, second) } else { (second, first) };
        let plain = (unit(first) || unit(second)) && other.scalars.is_empty() && other.word.len() == 1;
        (plain && !other.coefficient.is_zero()).then(|| (other.coefficient.clone(), other.word[0]))
    }
}
