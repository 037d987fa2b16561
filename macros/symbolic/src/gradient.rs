//! Derivatives: gradients by reverse accumulation, directional derivatives by the product rule, and linear parts.

use crate::memory::{self, Images, Map};
use crate::node::{Analytic, Exponent, ExprNode, Function, Id, Operation, Term};
use crate::{Elements, Expr, Graph, IntoList, Rational, Shape, Table, indexed, work};

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
            ExprNode::Opaque(name, output, arguments) => {
                for (index, argument) in arguments.iter().enumerate() {
                    add(*argument, adjoint * graph.slope_of_opaque(name, *output, arguments, index));
                }
            }
            ExprNode::Hadamard(a, b) => {
                add(*a, adjoint.hadamard(graph.expr(*b)));
                add(*b, adjoint.hadamard(graph.expr(*a)));
            }
            ExprNode::Of(operation, a) => add(*a, self.pull_back_operation(*operation, graph.expr(*a), adjoint)),
        }
    }

    fn pull_back_operation(self, operation: Operation, a: Expr<'g>, adjoint: Expr<'g>) -> Expr<'g> {
        let dual = match operation {
            Operation::Inverse => return -(self.transpose() * adjoint * self.transpose()),
            Operation::Determinant => return adjoint * self * a.inverse().transpose(),
            Operation::Function(function) => return adjoint * function.derivative(a, self),
            // the adjoint of D ↦ Df(A)D with respect to tr(AᵀB) is G ↦ Df(Aᵀ)G
            Operation::Analytic(function) => return a.transpose().analytic_slope(function, adjoint),
            Operation::Transpose => Operation::Transpose,
            Operation::Block(row, column) => Operation::Embed(row, column),
            Operation::Embed(row, column) => Operation::Block(row, column),
            Operation::DiagonalMatrix => Operation::Diagonal,
            Operation::Diagonal => Operation::DiagonalMatrix,
            Operation::Wedge(algebra) => Operation::Components(algebra),
            Operation::Components(algebra) => Operation::Wedge(algebra),
        };
        adjoint.apply(dual, a.shape())
    }

    fn pull_back_term(self, term: &Term, adjoint: Expr<'g>, add: &mut impl FnMut(Id, Expr<'g>)) {
        let scale = self.graph.scale(term);
        if !term.word.is_empty() {
            self.pull_back_word(&term.word, scale * adjoint, add);
        }
        for (base, exponent) in &term.scalars {
            add(*base, adjoint.pairing(self.slope_of_term(term, *base, *exponent)));
        }
    }

    /// The derivative of a term with respect to one of its scalar factors.
    fn slope_of_term(self, term: &Term, base: Id, exponent: Exponent) -> Expr<'g> {
        let mut slope = term.clone();
        slope.coefficient *= Rational::short(exponent);
        slope.multiply_scalars(&[(base, -Exponent::ONE)]);
        self.graph.collect(self.shape(), [slope])
    }

    fn pull_back_word(self, word: &[Id], adjoint: Expr<'g>, add: &mut impl FnMut(Id, Expr<'g>)) {
        let graph = self.graph;
        let transposed: Vec<Expr<'g>> = word.each(|&letter| graph.expr(letter).transpose());
        for (position, letter) in word.iter().enumerate() {
            let left = transposed[..position].iter().copied().reduce(|product, letter| letter * product);
            let right = transposed[position + 1..].iter().rev().copied().reduce(|product, letter| product * letter);
            let with_left = left.map_or(adjoint, |left| left * adjoint);
            add(*letter, right.map_or(with_left, |right| with_left * right));
        }
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
        let zero = graph.zero(self.shape());
        let tangent = |part: &Id| tangents.of(graph, part);
        let node = self.node();
        if node.all_children(|child| tangent(&child).is_zero()) {
            return zero;
        }
        match &*node {
            ExprNode::Symbol(_) | ExprNode::Pi | ExprNode::Literal(_) => zero,
            ExprNode::Sum(terms) => {
                graph.total(self.shape(), terms.iter().map(|term| self.push_forward_term(term, tangents)))
            }
            ExprNode::Word(word) => self.push_forward_word(word, tangents),
            ExprNode::Trace(word) => self.push_forward_word(word, tangents).trace(),
            ExprNode::Stack(entries) => graph.stack(self.shape(), entries.each(tangent)),
            ExprNode::Opaque(name, output, arguments) => {
                let slope = |index| graph.slope_of_opaque(name, *output, arguments, index);
                let term = |index: usize| slope(index).pairing(tangent(&arguments[index]));
                (0..arguments.len()).map(term).fold(zero, |sum, term| sum + term)
            }
            ExprNode::Hadamard(a, b) => tangent(a).hadamard(graph.expr(*b)) + graph.expr(*a).hadamard(tangent(b)),
            ExprNode::Of(operation, a) => {
                let (a, tangent) = (graph.expr(*a), tangent(a));
                match operation {
                    Operation::Inverse => -(self * tangent * self),
                    Operation::Determinant => self * (a.inverse() * tangent).trace(),
                    Operation::Function(function) => function.derivative(a, self) * tangent,
                    Operation::Analytic(function) => a.analytic_slope(*function, tangent),
                    linear => tangent.apply(*linear, self.shape()),
                }
            }
        }
    }

    fn push_forward_term(self, term: &Term, tangents: &Images) -> Expr<'g> {
        let graph = self.graph;
        work::spend(8 * (term.scalars.len() + term.word.len()));
        let mut sum = graph.zero(self.shape());
        for (base, exponent) in &term.scalars {
            sum = sum + tangents.of(graph, base) * self.slope_of_term(term, *base, *exponent);
        }
        if !term.word.is_empty() {
            sum = sum + graph.scale(term) * self.push_forward_word(&term.word, tangents);
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

/// For a longer vector all directions are looked at together first, before the derivatives are taken along each.
const LONG: usize = 16;

impl<'g> Expr<'g> {
    /// The matrix A with `self` = A·v, for an expression that is linear in the vector symbol v.
    pub fn matrix_of_linear(self, vector: Expr<'g>) -> Expr<'g> {
        let graph = self.graph;
        let shape = Shape::new(self.shape().rows, vector.shape().rows);
        let expanded = self.expand();
        let mut sum = graph.zero(shape);
        for term in expanded.terms() {
            let whole = graph.collect(self.shape(), [term.clone()]);
            let mut matrix = term;
            let trailing = matrix.word.pop() == Some(vector.id);
            let mut factors = matrix.word.iter().chain(matrix.scalars.iter().map(|(base, _)| base));
            let linear = trailing && !factors.any(|&factor| graph.expr(factor).depends_on(vector));
            sum = sum + if linear { graph.collect(shape, [matrix]) } else { whole.jacobian(vector) };
        }
        sum
    }

    /// The matrix of derivatives of a vector expression, column by column.
    pub fn jacobian(self, vector: Expr<'g>) -> Expr<'g> {
        let graph = self.graph;
        let shape = Shape::new(self.shape().rows, vector.shape().rows);
        if shape.columns > LONG
            && let Some(factor) = self.over(vector)
        {
            return factor * graph.identity(shape.rows);
        }
        let column = |j| self.differential(&[(vector, graph.unit(vector.shape(), j, 0))]);
        let columns: Vec<Expr<'g>> = indexed(shape.columns, column);
        graph.stack(shape, shape.positions().map(|(i, j)| columns[j].entry(i, 0)).into_list())
    }

    /// s, where the expression is the multiple s·v of a vector v that s does not depend on, as it is written.
    pub fn over(self, vector: Expr<'g>) -> Option<Expr<'g>> {
        let graph = self.graph;
        let mut sum = graph.integer(0);
        for term in self.terms() {
            let scale = graph.scale(&term);
            if term.word != [vector.id] || scale.depends_on(vector) {
                return None;
            }
            sum = sum + scale;
        }
        Some(sum)
    }

    /// The least exponent with which a scalar symbol occurs among the terms of the expanded expression; `None` for zero.
    pub fn least_exponent(self, scalar: Expr<'g>) -> Option<Rational> {
        let exponent = |term: &Term| {
            let found = term.scalars.iter().find(|(base, _)| *base == scalar.id);
            found.map_or(Exponent::ZERO, |(_, exponent)| *exponent)
        };
        self.expand().terms().iter().map(exponent).min().map(Rational::short)
    }
}

impl Graph {
    /// The gradient of a method's value with respect to one of its arguments.
    fn slope_of_opaque(&self, name: &str, output: usize, arguments: &[Id], index: usize) -> Expr<'_> {
        assert_eq!(output, 0, "the second derivative of a method");
        self.opaque(name, index + 1, &self.exprs(arguments), self.shape(arguments[index]))
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
