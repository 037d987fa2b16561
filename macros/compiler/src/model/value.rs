//! The possible values of an expression of a closure: a matrix, the identity of a size that is still open, a tuple, an
//! array.

use clebsch_symbolic::{Elements, Expr};

use super::Layout;
use super::power::{Range, Term};

#[derive(Clone, PartialEq, Debug)]
pub(super) enum Value<'g> {
    /// A matrix; scalars are 1×1.
    Matrix(Expr<'g>),
    /// A scalar times the identity; the other operand gives its size.
    Identity(Expr<'g>),
    /// A quaternion, by its coordinates i, j, k, w.
    Quaternion(Expr<'g>),
    Tuple(Vec<Value<'g>>),
    Array(Vec<Value<'g>>),
    /// One value for each site of a power, `q`: its kind, and the value of the site itself.
    PerSite(Each, Box<Value<'g>>),
    /// The indices from the first up to and without the second, `0..N`.
    Range(Expr<'g>, Expr<'g>),
    /// An index modulo N, `(i + 1) % N`.
    Wrapped(Expr<'g>),
    /// A value for each index of a range.
    Sequence(Range<'g>, Box<Value<'g>>),
    Sum(Vec<Term<'g>>),
}

impl<'g> Value<'g> {
    /// A leaf of the configuration, a parameter or a group element.
    pub fn leaf(expr: Expr<'g>, is_quaternion: bool) -> Value<'g> {
        if is_quaternion { Value::Quaternion(expr) } else { Value::Matrix(expr) }
    }

    /// The value for each site of a power, where there is one; this is that of the site itself.
    pub fn of_each(self, each: Each, is_power: bool) -> Value<'g> {
        if is_power { Value::PerSite(each, Box::new(self)) } else { self }
    }

    /// Nests values as a layout says.
    pub fn nested(layout: &Layout, leaves: &[Value<'g>]) -> Value<'g> {
        let parts = |parts: &[Layout]| parts.each(|part| Value::nested(part, leaves));
        match layout {
            Layout::Leaf(leaf) => leaves[*leaf].clone(),
            Layout::Tuple(inner) => Value::Tuple(parts(inner)),
            Layout::Array(inner) => Value::Array(parts(inner)),
        }
    }

    /// Takes a value apart as a layout nests; or says, leaf by leaf, which value was found and which was expected.
    pub fn leaves(
        &self,
        layout: &Layout,
        leaf: &impl Fn(&Value<'g>, usize) -> Result<Expr<'g>, String>,
    ) -> Result<Vec<Expr<'g>>, (String, String)> {
        match (self, layout) {
            (value, Layout::Leaf(k)) => {
                leaf(value, *k).map(|expr| vec![expr]).map_err(|needed| (value.describe(), needed))
            }
            (Value::Tuple(values), Layout::Tuple(parts)) | (Value::Array(values), Layout::Array(parts))
                if values.len() == parts.len() =>
            {
                let leaves = values.iter().zip(parts).map(|(value, part)| value.leaves(part, leaf));
                Ok(leaves.collect::<Result<Vec<_>, _>>()?.concat())
            }
            (value, layout) => Err((value.describe(), layout.describe())),
        }
    }

    pub fn matrix(&self) -> Option<Expr<'g>> {
        if let Value::Matrix(expr) = self { Some(*expr) } else { None }
    }

    /// Whether operators are of such values.
    pub fn is_operand(&self) -> bool {
        matches!(self, Value::Matrix(_) | Value::Identity(_) | Value::Quaternion(_) | Value::Sum(_))
    }

    /// The terms of a sum over sites, or a scalar as its only one.
    pub fn terms(&self) -> Option<Vec<Term<'g>>> {
        match self {
            Value::Sum(terms) => Some(terms.clone()),
            Value::Matrix(value) if value.shape().is_scalar() => Some(vec![Term { ranges: Vec::new(), value: *value }]),
            _ => None,
        }
    }

    /// Its description, for messages: `3x3`, `a pair`.
    pub fn describe(&self) -> String {
        match self {
            Value::Matrix(expr) if expr.shape().is_scalar() => "a scalar".into(),
            Value::Matrix(expr) => expr.shape().to_string(),
            Value::Identity(_) => "a multiple of `I`, of unknown size".into(),
            Value::Quaternion(_) => "a quaternion".into(),
            Value::Tuple(parts) => format!("a tuple of {}", parts.len()),
            Value::Array(parts) => format!("an array of {}", parts.len()),
            Value::PerSite(..) => "a value for each site".into(),
            Value::Range(from, to) => format!("the range {from}..{to}"),
            Value::Wrapped(_) => "an index".into(),
            Value::Sequence((from, to), _) => format!("a value for each of {from}..{to}"),
            Value::Sum(_) => "a sum over sites".into(),
        }
    }
}

/// The kinds of values that each site has one of.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub(super) enum Each {
    /// The group element or the velocity.
    Motion,
    /// The input of forces.
    Input,
    /// The configuration.
    Configuration,
    /// A field, by its number among those that are read.
    Field(usize),
}
