//! What an expression of a closure may be: a matrix, the identity of a size that is still open, a tuple, an array.

use clebsch_symbolic::{Expr, Shape};

use super::Layout;
use super::power::Term;

/// The value of an expression.
#[derive(Clone, Debug)]
pub(super) enum Value<'g> {
    /// A matrix; scalars are 1×1.
    Matrix(Expr<'g>),
    /// A scalar times the identity, whose size comes from what it meets.
    Identity(Expr<'g>),
    /// A quaternion, by its coordinates i, j, k, w.
    Quaternion(Expr<'g>),
    Tuple(Vec<Value<'g>>),
    Array(Vec<Value<'g>>),
    /// One value for each site of a power, `q`.
    PerSite(PerSite<'g>),
    /// The indices from the first up to and without the second, `0..N`.
    Range(Expr<'g>, Expr<'g>),
    /// An index modulo N, `(i + 1) % N`.
    Wrapped(Expr<'g>),
    /// A value for each index of a range.
    Sequence((Expr<'g>, Expr<'g>), Box<Value<'g>>),
    /// A sum over sites.
    Sum(Vec<Term<'g>>),
}

impl<'g> Value<'g> {
    /// A leaf of the configuration, a parameter or a group element.
    pub fn leaf(expr: Expr<'g>, is_quaternion: bool) -> Value<'g> {
        if is_quaternion { Value::Quaternion(expr) } else { Value::Matrix(expr) }
    }

    /// Nests values as a structure says.
    pub fn nested(structure: &Layout, leaves: &[Value<'g>]) -> Value<'g> {
        let parts = |parts: &[Layout]| parts.iter().map(|part| Value::nested(part, leaves)).collect();
        match structure {
            Layout::Leaf(leaf) => leaves[*leaf].clone(),
            Layout::Tuple(inner) => Value::Tuple(parts(inner)),
            Layout::Array(inner) => Value::Array(parts(inner)),
        }
    }

    /// The matrix, if it is one.
    pub fn matrix(&self) -> Option<Expr<'g>> {
        match self {
            Value::Matrix(expr) => Some(*expr),
            _ => None,
        }
    }

    /// The shape, if it is known.
    pub fn shape(&self) -> Option<Shape> {
        self.matrix().map(Expr::shape)
    }

    /// What it is, for messages: `3x3`, `a pair`.
    pub fn describe(&self) -> String {
        match self {
            Value::Matrix(expr) if expr.shape().is_scalar() => "a scalar".into(),
            Value::Matrix(expr) => expr.shape().to_string(),
            Value::Identity(_) => "a multiple of `I`, of unknown size".into(),
            Value::Quaternion(_) => "a quaternion".into(),
            Value::Tuple(parts) => format!("a tuple of {}", parts.len()),
            Value::Array(parts) => format!("an array of {}", parts.len()),
            Value::PerSite(_) => "a value for each site".into(),
            Value::Range(from, to) => format!("the range {from}..{to}"),
            Value::Wrapped(_) => "an index".into(),
            Value::Sequence((from, to), _) => format!("a value for each of {from}..{to}"),
            Value::Sum(_) => "a sum over sites".into(),
        }
    }
}

/// A value of which there is one for each site.
#[derive(Clone, Debug)]
pub(super) struct PerSite<'g> {
    /// What it is.
    pub of: Each,
    /// That of the site itself.
    pub own: Box<Value<'g>>,
}

/// What there is one of for each site.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub(super) enum Each {
    /// The group element or the velocity.
    Motion,
    /// The configuration.
    Configuration,
    /// A field, by its number among those that are read.
    Field(usize),
}
