//! Looking into an expression from outside of this crate: what the lowering to scalars walks over.

use crate::node::{Analytic, ExprNode, Function, Id, Term};
use crate::{Algebra, Expr, Rational, Symbol};

/// The outermost operation of an expression.
#[derive(Clone, Debug)]
pub enum View<'g> {
    /// A symbol.
    Symbol(Symbol),
    /// π.
    Pi,
    /// A sum of terms.
    Sum(Vec<WordTerm<'g>>),
    /// A matrix of numbers, row by row.
    Literal(Vec<Rational>),
    /// A matrix of scalars, row by row.
    Stack(Vec<Expr<'g>>),
    /// A product of letters that is 1×1.
    Word(Vec<Expr<'g>>),
    /// The trace of a product of letters.
    Trace(Vec<Expr<'g>>),
    /// Aᵀ.
    Transpose(Expr<'g>),
    /// A⁻¹.
    Inverse(Expr<'g>),
    /// det A.
    Determinant(Expr<'g>),
    /// f(x).
    Function(Function, Expr<'g>),
    /// A power series of a matrix.
    Analytic(Analytic, Expr<'g>),
    /// What a method of the user's gives, by its name: 0 for its value, i + 1 for the gradient with respect to argument i.
    Opaque(String, usize, Vec<Expr<'g>>),
    /// The block at (row, column).
    Block(Expr<'g>, usize, usize),
    /// A matrix in a zero matrix at (row, column).
    Embed(Expr<'g>, usize, usize),
    /// The product entry by entry.
    Hadamard(Expr<'g>, Expr<'g>),
    /// The diagonal matrix of a vector.
    DiagonalMatrix(Expr<'g>),
    /// The diagonal of a matrix.
    Diagonal(Expr<'g>),
    /// Σ v_i E_i.
    Wedge(Algebra, Expr<'g>),
    /// The vector of ⟨A, E_i⟩.
    Components(Algebra, Expr<'g>),
}

/// coefficient · Π base^(numerator/denominator) · word; the empty word is the identity.
#[derive(Clone, Debug)]
pub struct WordTerm<'g> {
    /// The rational factor.
    pub coefficient: Rational,
    /// Scalar factors with numerator and denominator of their exponents.
    pub scalars: Vec<(Expr<'g>, (i64, i64))>,
    /// Matrix factors.
    pub word: Vec<Expr<'g>>,
}

impl<'g> WordTerm<'g> {
    /// The term without its word.
    pub fn scale(&self, graph: &'g crate::Graph) -> Expr<'g> {
        let number = graph.number(self.coefficient.clone());
        let power = |(base, (numerator, denominator)): &(Expr<'g>, (i64, i64))| {
            base.power(crate::rational(*numerator, *denominator))
        };
        self.scalars.iter().map(power).fold(number, |product, power| product * power)
    }

    /// The terms of `inner`, each times the scalars of this term.
    pub fn over(&self, inner: Expr<'g>) -> Vec<WordTerm<'g>> {
        let mut terms = inner.word_terms();
        for term in &mut terms {
            term.coefficient *= &self.coefficient;
            term.scalars.extend(self.scalars.iter().copied());
        }
        terms
    }
}

impl<'g> Expr<'g> {
    /// The terms whose sum this is.
    pub fn word_terms(self) -> Vec<WordTerm<'g>> {
        self.terms().into_iter().map(|term| self.word_term(term)).collect()
    }

    fn word_term(self, term: Term) -> WordTerm<'g> {
        WordTerm {
            coefficient: term.coefficient,
            scalars: term.scalars.into_iter().map(|(base, e)| (self.graph.expr(base), e.parts())).collect(),
            word: self.exprs(&term.word),
        }
    }

    fn exprs(self, ids: &[Id]) -> Vec<Expr<'g>> {
        ids.iter().map(|&id| self.graph.expr(id)).collect()
    }

    /// The outermost operation.
    pub fn view(self) -> View<'g> {
        let expr = |id: &Id| self.graph.expr(*id);
        match &*self.node() {
            ExprNode::Symbol(id) => View::Symbol(self.graph.symbol_data(*id)),
            ExprNode::Pi => View::Pi,
            ExprNode::Sum(_) => View::Sum(self.word_terms()),
            ExprNode::Literal(entries) => View::Literal(entries.clone()),
            ExprNode::Stack(entries) => View::Stack(self.exprs(entries)),
            ExprNode::Word(word) => View::Word(self.exprs(word)),
            ExprNode::Trace(word) => View::Trace(self.exprs(word)),
            ExprNode::Transpose(a) => View::Transpose(expr(a)),
            ExprNode::Inverse(a) => View::Inverse(expr(a)),
            ExprNode::Determinant(a) => View::Determinant(expr(a)),
            ExprNode::Function(function, a) => View::Function(*function, expr(a)),
            ExprNode::Analytic(function, a) => View::Analytic(*function, expr(a)),
            ExprNode::Opaque(name, output, arguments) => {
                View::Opaque(self.graph.opaque_name(*name), *output, self.exprs(arguments))
            }
            ExprNode::Block(a, row, column) => View::Block(expr(a), *row, *column),
            ExprNode::Embed(a, row, column) => View::Embed(expr(a), *row, *column),
            ExprNode::Hadamard(a, b) => View::Hadamard(expr(a), expr(b)),
            ExprNode::DiagonalMatrix(a) => View::DiagonalMatrix(expr(a)),
            ExprNode::Diagonal(a) => View::Diagonal(expr(a)),
            ExprNode::Wedge(algebra, a) => View::Wedge(*algebra, expr(a)),
            ExprNode::Components(algebra, a) => View::Components(*algebra, expr(a)),
        }
    }
}
