//! The nodes of the expression graph.
//!
//! Every expression is a *sum of terms*; a term is a rational coefficient times commuting scalar powers times a word of
//! matrix letters. Whatever is not a sum is an atom: a letter of a word when it is a matrix, a scalar factor when it is 1×1.

use crate::fraction::Fraction;
use crate::{Algebra, Rational};

/// The identity of a node in its graph.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) struct Id(pub(crate) u32);

/// The index of a symbol in its graph.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) struct SymbolId(pub(crate) u32);

/// The index of a method of the user's in its graph.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct OpaqueId(pub(crate) u32);

/// The exponent of a scalar factor.
pub(crate) type Exponent = Fraction;

/// A coefficient times scalar powers times a word; the empty word is the identity (the number one, if scalar).
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Term {
    pub(crate) coefficient: Rational,
    /// Sorted by identity, exponents not zero.
    pub(crate) scalars: Vec<(Id, Exponent)>,
    pub(crate) word: Vec<Id>,
}

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
}

/// An expression without its shape, which the graph keeps beside it.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) enum ExprNode {
    Symbol(SymbolId),
    Pi,
    Sum(Vec<Term>),
    Literal(Vec<Rational>),
    Stack(Vec<Id>),
    /// A product of at least two letters that is 1×1.
    Word(Vec<Id>),
    /// The trace of a product of letters.
    Trace(Vec<Id>),
    Transpose(Id),
    Inverse(Id),
    Determinant(Id),
    Function(Function, Id),
    /// A power series of a matrix.
    Analytic(Analytic, Id),
    /// What a method of the user's gives for some arguments: 0 for its value, i + 1 for the gradient with respect to argument i.
    Opaque(OpaqueId, usize, Vec<Id>),
    /// The block that starts at (row, column).
    Block(Id, usize, usize),
    /// A matrix placed at (row, column) of a zero matrix.
    Embed(Id, usize, usize),
    Hadamard(Id, Id),
    DiagonalMatrix(Id),
    Diagonal(Id),
    /// Σ v_i E_i.
    Wedge(Algebra, Id),
    /// The vector of ⟨A, E_i⟩.
    Components(Algebra, Id),
}

impl ExprNode {
    /// About the work that it takes to make it once its parts are there.
    pub(crate) fn size(&self) -> usize {
        2 + match self {
            ExprNode::Sum(terms) => terms.iter().map(Term::size).sum(),
            ExprNode::Literal(entries) => entries.iter().map(|entry| 1 + entry.digits()).sum(),
            ExprNode::Stack(parts) | ExprNode::Word(parts) | ExprNode::Trace(parts) | ExprNode::Opaque(_, _, parts) => {
                parts.len()
            }
            _ => 0,
        }
    }
}

impl Term {
    fn size(&self) -> usize {
        1 + self.coefficient.digits() + (self.scalars.len() + self.word.len()) / 4
    }
}

impl Function {
    /// The functions that a declaration can name, by their names in Rust.
    pub const ALL: [(&'static str, Function); 11] = [
        ("sin", Function::Sin),
        ("cos", Function::Cos),
        ("tan", Function::Tan),
        ("asin", Function::Asin),
        ("acos", Function::Acos),
        ("atan", Function::Atan),
        ("sinh", Function::Sinh),
        ("cosh", Function::Cosh),
        ("tanh", Function::Tanh),
        ("exp", Function::Exp),
        ("ln", Function::Ln),
    ];

    /// The name in Rust, `sin`; that of all Stumpff functions is one.
    pub fn name(self) -> &'static str {
        let known = Function::ALL.iter().find(|(_, function)| *function == self);
        known.map_or("stumpff", |(name, _)| name)
    }

    /// A number that no other function has.
    pub(crate) fn code(self) -> u64 {
        match self {
            Function::Stumpff(k) => 100 + u64::from(k),
            _ => Function::ALL.iter().position(|(_, function)| *function == self).unwrap_or(0) as u64,
        }
    }
}
