//! The nodes of the expression graph.
//!
//! Every expression is a *sum of terms*; a term is a rational coefficient times commuting scalar powers times a word of
//! matrix letters. Whatever is not a sum is an atom: a letter of a word when it is a matrix, a scalar factor when it is 1×1.

use std::rc::Rc;

use crate::table::{hash_of, mixed};
use crate::{Algebra, Elements, Expr, Fraction, Graph, Rational, Symbol, work};

/// The identity of a node in its graph.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) struct Id(pub(crate) u32);

pub(crate) type Exponent = Fraction;

/// coefficient · Π base^exponent · word; the empty word is the identity (the number one, if scalar).
#[derive(PartialEq, Eq, Hash, Debug)]
pub struct TermOf<C> {
    /// The rational factor.
    pub coefficient: Rational,
    /// Scalar factors with their exponents, which are not zero; in a graph sorted by identity.
    pub scalars: Vec<(C, Fraction)>,
    /// Matrix factors.
    pub word: Vec<C>,
}

pub(crate) type Term = TermOf<Id>;

/// A term as it is seen from outside of this crate.
pub type WordTerm<'g> = TermOf<Expr<'g>>;

/// An elementary function of one scalar.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
#[allow(missing_docs)]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    /// c_k(s) = Σ_j (−s)ʲ/(k + 2j)!: cos √s, sin √s/√s, (1 − cos √s)/s, …
    Stumpff(u8),
}

/// A function of a square matrix that is given by a power series.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Analytic {
    /// exp A.
    Exponential,
    /// φ(A) = Σ Aᵏ/(k + 1)!, (exp A − I)A⁻¹.
    Phi,
    /// The principal logarithm.
    Logarithm,
    /// The same of a rotation or a rigid motion in the plane or in space.
    MotionLogarithm,
}

/// An operation on one expression.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Debug)]
pub enum Operation {
    /// Aᵀ.
    Transpose,
    /// A⁻¹.
    Inverse,
    /// det A.
    Determinant,
    /// f(x).
    Function(Function),
    /// A power series of a matrix.
    Analytic(Analytic),
    /// The block that starts at (row, column).
    Block(usize, usize),
    /// A matrix placed at (row, column) of a zero matrix.
    Embed(usize, usize),
    /// The diagonal matrix of a vector.
    DiagonalMatrix,
    /// The diagonal of a matrix.
    Diagonal,
    /// Σ v_i E_i.
    Wedge(Algebra),
    /// The vector of ⟨A, E_i⟩.
    Components(Algebra),
}

/// The outermost operation of an expression over its children. The graph stores the shape separately.
#[derive(PartialEq, Eq, Hash, Debug)]
pub enum NodeOf<C> {
    /// A symbol.
    Symbol(Rc<Symbol>),
    /// π.
    Pi,
    /// A sum of terms.
    Sum(Vec<TermOf<C>>),
    /// A matrix of numbers, row by row.
    Literal(Vec<Rational>),
    /// A matrix of scalars, row by row.
    Stack(Vec<C>),
    /// A product of at least two letters that is 1×1.
    Word(Vec<C>),
    /// The trace of a product of letters.
    Trace(Vec<C>),
    /// The result of a method of the user for some arguments: 0 for its value, i + 1 for the gradient with respect to
    /// argument i.
    Opaque(Rc<str>, usize, Vec<C>),
    /// The product entry by entry.
    Hadamard(C, C),
    /// An operation on one expression.
    Of(Operation, C),
}

pub(crate) type ExprNode = NodeOf<Id>;

/// A node as other crates see it: the lowering to scalars walks over it.
pub type View<'g> = NodeOf<Expr<'g>>;

impl Operation {
    /// Whether f(a A + b B) = a f(A) + b f(B) for numbers a and b.
    pub(crate) fn is_linear(self) -> bool {
        match self {
            Operation::Transpose | Operation::Block(..) | Operation::Embed(..) => true,
            Operation::DiagonalMatrix | Operation::Diagonal | Operation::Wedge(_) | Operation::Components(_) => true,
            Operation::Inverse | Operation::Determinant | Operation::Function(_) | Operation::Analytic(_) => false,
        }
    }
}

impl<C: Copy> NodeOf<C> {
    /// Hands the direct children on, one after the other.
    pub fn each_child(&self, mut visit: impl FnMut(C)) {
        match self {
            NodeOf::Symbol(_) | NodeOf::Pi | NodeOf::Literal(_) => {}
            NodeOf::Sum(terms) => {
                for term in terms {
                    term.scalars.iter().for_each(|(base, _)| visit(*base));
                    term.word.iter().for_each(|letter| visit(*letter));
                }
            }
            NodeOf::Stack(parts) | NodeOf::Word(parts) | NodeOf::Trace(parts) | NodeOf::Opaque(_, _, parts) => {
                parts.iter().for_each(|part| visit(*part));
            }
            NodeOf::Hadamard(a, b) => [a, b].into_iter().for_each(|factor| visit(*factor)),
            NodeOf::Of(_, a) => visit(*a),
        }
    }

    /// The same node over the images of its children.
    pub(crate) fn map<D>(&self, image: impl Fn(C) -> D) -> NodeOf<D> {
        let all = |parts: &[C]| parts.each(|part| image(*part));
        match self {
            NodeOf::Symbol(symbol) => NodeOf::Symbol(symbol.clone()),
            NodeOf::Pi => NodeOf::Pi,
            NodeOf::Sum(terms) => NodeOf::Sum(terms.each(|term| term.map(&image))),
            NodeOf::Literal(entries) => NodeOf::Literal(entries.clone()),
            NodeOf::Stack(entries) => NodeOf::Stack(all(entries)),
            NodeOf::Word(word) => NodeOf::Word(all(word)),
            NodeOf::Trace(word) => NodeOf::Trace(all(word)),
            NodeOf::Opaque(name, output, arguments) => NodeOf::Opaque(name.clone(), *output, all(arguments)),
            NodeOf::Hadamard(a, b) => NodeOf::Hadamard(image(*a), image(*b)),
            NodeOf::Of(operation, a) => NodeOf::Of(*operation, image(*a)),
        }
    }
}

impl ExprNode {
    pub(crate) fn all_children(&self, property: impl Fn(Id) -> bool) -> bool {
        let mut all = true;
        self.each_child(|child| all = all && property(child));
        all
    }

    /// A hash. That of a sum is made in one function: without optimisation the derived one is ten calls for each number.
    pub(crate) fn hashed(&self) -> u64 {
        let ExprNode::Sum(terms) = self else { return hash_of(self) };
        let (terms, mut hash, mut k) = (terms.as_slice(), 0, 0);
        while k < terms.len() {
            let Term { coefficient, scalars, word } = &terms[k];
            hash = match coefficient.as_fraction() {
                Some(fraction) => hashed_fraction(hash, fraction),
                None => mixed(hash, hash_of(coefficient)),
            };
            let (scalars, mut j) = (scalars.as_slice(), 0);
            while j < scalars.len() {
                hash = hashed_fraction(mixed(hash, scalars[j].0.0 as u64), scalars[j].1);
                j += 1;
            }
            let (word, mut j) = (word.as_slice(), 0);
            while j < word.len() {
                hash = mixed(hash, !(word[j].0 as u64));
                j += 1;
            }
            k += 1;
        }
        // the upper bits are the better mixed ones
        hash ^ (hash >> 32)
    }

    /// Whether it equals another node: as `==`, which without optimisation is ten calls for each number.
    pub(crate) fn is_same(&self, other: &ExprNode) -> bool {
        let (ExprNode::Sum(terms), ExprNode::Sum(others)) = (self, other) else { return self == other };
        let (terms, others) = (terms.as_slice(), others.as_slice());
        let mut k = 0;
        while k < terms.len() && k < others.len() && terms[k].is_same(&others[k]) {
            k += 1;
        }
        k == terms.len() && k == others.len()
    }

    /// About the work that it takes to make it once its parts are there.
    pub(crate) fn size(&self) -> usize {
        2 + match self {
            ExprNode::Sum(terms) => {
                let mut size = 0;
                for term in terms {
                    // long terms are copied more often than they are made
                    let factors = term.scalars.len() + term.word.len();
                    size += 1 + term.coefficient.digits() + factors / 4 + factors * factors / 256;
                }
                size
            }
            ExprNode::Literal(entries) => entries.iter().map(|entry| 1 + entry.digits()).sum::<usize>() / 4,
            ExprNode::Stack(parts) | ExprNode::Word(parts) | ExprNode::Trace(parts) | ExprNode::Opaque(_, _, parts) => {
                parts.len()
            }
            _ => 0,
        }
    }
}

/// A hash with one more fraction.
#[inline(always)]
fn hashed_fraction(hash: u64, fraction: Fraction) -> u64 {
    let (numerator, denominator) = fraction.parts();
    mixed(mixed(hash, numerator as u64), denominator as u64)
}

impl Term {
    fn is_same(&self, other: &Term) -> bool {
        let is_equal = match (self.coefficient.as_fraction(), other.coefficient.as_fraction()) {
            (Some(a), Some(b)) => a.parts().0 == b.parts().0 && a.parts().1 == b.parts().1,
            _ => self.coefficient == other.coefficient,
        };
        is_equal && self.is_like(other)
    }

    /// Whether it is the same but for its coefficient.
    fn is_like(&self, other: &Term) -> bool {
        let (scalars, others) = (self.scalars.as_slice(), other.scalars.as_slice());
        let (word, letters) = (self.word.as_slice(), other.word.as_slice());
        let mut k = 0;
        if scalars.len() != others.len() || word.len() != letters.len() {
            return false;
        }
        while k < scalars.len() {
            let ((base, exponent), (other, another)) = (scalars[k], others[k]);
            let ((a, b), (c, d)) = (exponent.parts(), another.parts());
            if base.0 != other.0 || a != c || b != d {
                return false;
            }
            k += 1;
        }
        k = 0;
        while k < word.len() && word[k].0 == letters[k].0 {
            k += 1;
        }
        k == word.len()
    }
}

impl<C: Copy> Clone for TermOf<C> {
    fn clone(&self) -> TermOf<C> {
        TermOf { coefficient: self.coefficient.clone(), scalars: copied(&self.scalars), word: copied(&self.word) }
    }
}

/// A list with the same elements. Without optimisation most lists, which are empty, are copied for nothing.
#[inline(always)]
fn copied<A: Copy>(list: &[A]) -> Vec<A> {
    if list.is_empty() { Vec::new() } else { list.to_vec() }
}

impl<C: Copy> TermOf<C> {
    pub(crate) fn map<D>(&self, image: impl Fn(C) -> D) -> TermOf<D> {
        TermOf {
            coefficient: self.coefficient.clone(),
            scalars: self.scalars.each(|(base, exponent)| (image(*base), *exponent)),
            word: self.word.each(|letter| image(*letter)),
        }
    }

    /// The term without its word, over the images of its bases.
    pub(crate) fn scale_over<'g>(&self, graph: &'g Graph, image: impl Fn(C) -> Expr<'g>) -> Expr<'g> {
        work::spend(4 * self.scalars.len());
        let mut product = graph.number(self.coefficient.clone());
        for (base, exponent) in &self.scalars {
            let base = image(*base);
            let power = if exponent.is_one() { base } else { base.power(Rational::short(*exponent)) };
            product = product * power;
        }
        product
    }
}

impl<'g> WordTerm<'g> {
    /// The product of its number, its scalars and its letters.
    pub fn product(&self, graph: &'g Graph) -> Expr<'g> {
        self.word.iter().fold(self.scale(graph), |product, letter| product * *letter)
    }

    /// The term without its word.
    pub fn scale(&self, graph: &'g Graph) -> Expr<'g> {
        self.scale_over(graph, |base| base)
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
        self.terms().each(|term| term.map(|id| self.graph.expr(id)))
    }

    /// The outermost operation.
    pub fn view(self) -> View<'g> {
        self.node().map(|id| self.graph.expr(id))
    }
}

impl Function {
    /// The name in Rust, `sin`; that of all Stumpff functions is one.
    pub fn name(self) -> String {
        match self {
            Function::Stumpff(_) => "stumpff".into(),
            _ => format!("{self:?}").to_lowercase(),
        }
    }
}
