//! Derivatives: gradients by reverse accumulation, directional derivatives by the product rule.

use crate::memory::{self, Images, Map};
use crate::node::{Analytic, Exponent, ExprNode, Function, Id, Term};
use crate::{Expr, Rational, Shape, Table};

impl<'g> Expr<'g> {
    /// The gradient of a scalar with respect to a symbol: the matrix G of the symbol's shape with df = ⟨G, dx⟩ = tr(GᵀdX).
    pub fn gradient(self, symbol: Expr<'g>) -> Expr<'g> {
        assert!(self.shape().is_scalar(), "the gradient of `{self}`, which is not a scalar");
        let mut adjoints: Table<Id, Option<Expr<'g>>> = Table::default();
        adjoints.insert(self.id, Some(self.graph.integer(1)));
        for id in self.reachable().into_iter().rev() {
            if id != symbol.id
                && let Some(adjoint) = adjoints.entry(id).take()
            {
                self.graph.expr(id).pull_back(adjoint, &mut |child, contribution| {
                    let entry = adjoints.entry(child);
                    let known = entry.unwrap_or_else(|| contribution.graph.zero(contribution.shape()));
                    *entry = Some(known + contribution);
                });
            }
        }
        adjoints.entry(symbol.id).unwrap_or_else(|| self.graph.zero(symbol.shape()))
    }

    /// Hands the adjoint of this node on to its children: `add(child, Ā)` with ⟨Ā_node, d node⟩ = Σ ⟨Ā, d child⟩.
    fn pull_back(self, adjoint: Expr<'g>, add: &mut impl FnMut(Id, Expr<'g>)) {
        let graph = self.graph;
        let expr = |id: &Id| graph.expr(*id);
        match &*self.node() {
            ExprNode::Symbol(_) | ExprNode::Pi | ExprNode::Literal(_) => {}
            ExprNode::Sum(terms) => terms.iter().for_each(|term| self.pull_back_term(term, adjoint, add)),
            ExprNode::Word(word) => self.pull_back_word(word, adjoint, add),
            ExprNode::Trace(word) => {
                let n = graph.shape(word[0]).rows;
                self.pull_back_word(word, adjoint * graph.identity(n), add);
            }
            ExprNode::Stack(entries) => {
                for ((i, j), entry) in self.shape().positions().zip(entries) {
                    add(*entry, adjoint.entry(i, j));
                }
            }
            ExprNode::Transpose(a) => add(*a, adjoint.transpose()),
            ExprNode::Inverse(a) => add(*a, -(self.transpose() * adjoint * self.transpose())),
            ExprNode::Determinant(a) => add(*a, adjoint * self * expr(a).inverse().transpose()),
            ExprNode::Function(function, a) => add(*a, adjoint * function.derivative(expr(a), self)),
            // the adjoint of D ↦ Df(A)D with respect to tr(AᵀB) is G ↦ Df(Aᵀ)G
            ExprNode::Analytic(function, a) => add(*a, expr(a).transpose().analytic_slope(*function, adjoint)),
            ExprNode::Opaque(name, output, arguments) => {
                assert_eq!(*output, 0, "the second derivative of a method");
                for (index, argument) in arguments.iter().enumerate() {
                    let gradient = graph.opaque_of(*name, index + 1, self.arguments(arguments), graph.shape(*argument));
                    add(*argument, adjoint * gradient);
                }
            }
            ExprNode::Block(a, row, column) => add(*a, adjoint.embed(graph.shape(*a), *row, *column)),
            ExprNode::Embed(a, row, column) => add(*a, adjoint.block(*row, *column, graph.shape(*a))),
            ExprNode::Hadamard(a, b) => {
                add(*a, adjoint.hadamard(expr(b)));
                add(*b, adjoint.hadamard(expr(a)));
            }
            ExprNode::DiagonalMatrix(a) => add(*a, adjoint.diagonal()),
            ExprNode::Diagonal(a) => add(*a, adjoint.diagonal_matrix()),
            ExprNode::Wedge(algebra, a) => add(*a, adjoint.components(*algebra)),
            ExprNode::Components(algebra, a) => add(*a, adjoint.wedge(*algebra)),
        }
    }

    fn pull_back_term(self, term: &Term, adjoint: Expr<'g>, add: &mut impl FnMut(Id, Expr<'g>)) {
        let graph = self.graph;
        let scalars_only = Term { word: Vec::new(), ..term.clone() };
        let scale = graph.collect(Shape::scalar(), [scalars_only]);
        if !term.word.is_empty() {
            self.pull_back_word(&term.word, scale * adjoint, add);
        }
        for (base, exponent) in &term.scalars {
            let mut rest = Term { word: term.word.clone(), ..term.clone() };
            rest.coefficient *= Rational::short(*exponent);
            rest.multiply_scalars(&[(*base, -Exponent::ONE)]);
            let rest = graph.collect(self.shape(), [rest]);
            add(*base, adjoint.pairing(rest));
        }
    }

    fn pull_back_word(self, word: &[Id], adjoint: Expr<'g>, add: &mut impl FnMut(Id, Expr<'g>)) {
        let graph = self.graph;
        let transposed: Vec<Expr<'g>> = word.iter().map(|&letter| graph.expr(letter).transpose()).collect();
        for position in 0..word.len() {
            let left = transposed[..position]
                .iter()
                .fold(None, |product: Option<Expr<'g>>, &t| Some(product.map_or(t, |p| t * p)));
            let right = transposed[position + 1..]
                .iter()
                .rev()
                .fold(None, |product: Option<Expr<'g>>, &t| Some(product.map_or(t, |p| p * t)));
            let with_left = left.map_or(adjoint, |l| l * adjoint);
            add(word[position], right.map_or(with_left, |r| with_left * r));
        }
    }

    fn arguments(self, ids: &[Id]) -> Vec<Expr<'g>> {
        ids.iter().map(|id| self.graph.expr(*id)).collect()
    }

    /// Df(A)D, the upper right block of f((A D; 0 A)).
    pub(crate) fn analytic_slope(self, function: Analytic, direction: Expr<'g>) -> Expr<'g> {
        let (n, square) = (self.shape().rows, self.shape());
        let double = Shape::square(2 * n);
        let doubled = self.embed(double, 0, 0) + direction.embed(double, 0, n) + self.embed(double, n, n);
        doubled.analytic(function).block(0, n, square)
    }

    /// The derivative in the direction in which the symbols move: d/dε of the expression at x + ε dx.
    pub fn differential(self, directions: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
        let tangents = self.graph.images(Map::Differential(memory::pairs(directions)));
        self.mapped(&tangents, |part| match directions.iter().find(|(symbol, _)| *symbol == part) {
            Some((_, direction)) => *direction,
            None => part.push_forward(&tangents),
        })
    }

    fn push_forward(self, tangents: &Images) -> Expr<'g> {
        let graph = self.graph;
        let expr = |id: &Id| graph.expr(*id);
        let zero = graph.zero(self.shape());
        let tangent = |part: &Id| tangents.of(graph, part);
        if self.node().all_children(|child| tangent(&child).is_zero()) {
            return zero;
        }
        match &*self.node() {
            ExprNode::Symbol(_) | ExprNode::Pi | ExprNode::Literal(_) => zero,
            ExprNode::Sum(terms) => {
                graph.total(self.shape(), terms.iter().map(|term| self.push_forward_term(term, tangents)))
            }
            ExprNode::Word(word) => self.push_forward_word(word, tangents),
            ExprNode::Trace(word) => self.push_forward_word(word, tangents).trace(),
            ExprNode::Stack(entries) => graph.stack(self.shape(), entries.iter().map(tangent).collect()),
            ExprNode::Transpose(a) => tangent(a).transpose(),
            ExprNode::Inverse(a) => -(self * tangent(a) * self),
            ExprNode::Determinant(a) => self * (expr(a).inverse() * tangent(a)).trace(),
            ExprNode::Function(function, a) => function.derivative(expr(a), self) * tangent(a),
            ExprNode::Analytic(function, a) => expr(a).analytic_slope(*function, tangent(a)),
            ExprNode::Opaque(name, output, arguments) => {
                assert_eq!(*output, 0, "the second derivative of a method");
                let gradient = |(index, argument): (usize, &Id)| {
                    let shape = graph.shape(*argument);
                    graph.opaque_of(*name, index + 1, self.arguments(arguments), shape).pairing(tangent(argument))
                };
                arguments.iter().enumerate().map(gradient).fold(zero, |sum, term| sum + term)
            }
            ExprNode::Block(a, row, column) => tangent(a).block(*row, *column, self.shape()),
            ExprNode::Embed(a, row, column) => tangent(a).embed(self.shape(), *row, *column),
            ExprNode::Hadamard(a, b) => tangent(a).hadamard(expr(b)) + expr(a).hadamard(tangent(b)),
            ExprNode::DiagonalMatrix(a) => tangent(a).diagonal_matrix(),
            ExprNode::Diagonal(a) => tangent(a).diagonal(),
            ExprNode::Wedge(algebra, a) => tangent(a).wedge(*algebra),
            ExprNode::Components(algebra, a) => tangent(a).components(*algebra),
        }
    }

    fn push_forward_term(self, term: &Term, tangents: &Images) -> Expr<'g> {
        let graph = self.graph;
        let mut sum = graph.zero(self.shape());
        for (base, exponent) in &term.scalars {
            let mut rest = term.clone();
            rest.coefficient *= Rational::short(*exponent);
            rest.multiply_scalars(&[(*base, -Exponent::ONE)]);
            sum = sum + tangents.of(graph, base) * graph.collect(self.shape(), [rest]);
        }
        if !term.word.is_empty() {
            let scale = graph.collect(Shape::scalar(), [Term { word: Vec::new(), ..term.clone() }]);
            sum = sum + scale * self.push_forward_word(&term.word, tangents);
        }
        sum
    }

    fn push_forward_word(self, word: &[Id], tangents: &Images) -> Expr<'g> {
        let graph = self.graph;
        let moved = |position: usize| {
            let letters = word
                .iter()
                .enumerate()
                .map(|(k, letter)| if k == position { tangents.of(graph, letter) } else { graph.expr(*letter) });
            letters.reduce(|a, b| a * b)
        };
        // by construction: a word has at least one letter
        (0..word.len()).filter_map(moved).reduce(|a, b| a + b).expect("a word has letters")
    }
}

impl Function {
    /// f′(x), given x and f(x).
    fn derivative<'g>(self, x: Expr<'g>, value: Expr<'g>) -> Expr<'g> {
        let one = x.graph.integer(1);
        match self {
            Function::Sin => x.function(Function::Cos),
            Function::Cos => -x.function(Function::Sin),
            Function::Tan => one + value * value,
            Function::Asin => (one - x * x).sqrt().powi(-1),
            Function::Acos => -(one - x * x).sqrt().powi(-1),
            Function::Atan => (one + x * x).powi(-1),
            Function::Sinh => x.function(Function::Cosh),
            Function::Cosh => x.function(Function::Sinh),
            Function::Tanh => one - value * value,
            Function::Exp => value,
            Function::Ln => x.powi(-1),
            // c_k′ = ½(k c_{k+2} − c_{k+1})
            Function::Stumpff(k) => {
                let next = |j: u8| x.function(Function::Stumpff(k + j));
                (i64::from(k) * next(2) - next(1)) / 2
            }
        }
    }
}
