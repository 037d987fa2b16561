//! Matrices of blocks, such as those of SE(n), entry by entry: a person writes them in place of views and embeddings.

use clebsch_symbolic::{Elements, Expr, IntoList, Operation, Rational, Shape, integer};

use super::{Matrices, entry, linear};
use crate::lower::{Code, Input, MatrixOperation, Whole};

impl Matrices {
    /// The operation that a matrix is the result of.
    pub(super) fn operation_of<'a>(&'a self, code: &'a Code) -> Option<&'a Whole> {
        match code {
            Code::Local(index) => self.operation_of(self.locals.value(*index)),
            Code::Whole(whole) => Some(whole),
            _ => None,
        }
    }

    /// Entry (i, j) of a matrix, in that which it is a part of.
    pub(super) fn entry(&self, a: &Code, i: usize, j: usize) -> Code {
        let Some(whole) = self.operation_of(a).filter(|_| self.joins_blocks) else { return entry(a, i, j) };
        match &whole.operation {
            MatrixOperation::Argument(first) => Code::Read(Input { row: i, column: j, ..first.clone() }),
            MatrixOperation::Entries => whole.operands[i * whole.shape.columns + j].clone(),
            MatrixOperation::Zero => Code::Number(integer(0)),
            MatrixOperation::Of(Operation::Transpose) => self.entry(&whole.operands[0], j, i),
            MatrixOperation::Of(Operation::Block(row, column)) => self.entry(&whole.operands[0], row + i, column + j),
            MatrixOperation::Hat => match (3 + j - i) % 3 {
                0 => Code::Number(integer(0)),
                1 => linear(integer(0), vec![(integer(-1), self.entry(&whole.operands[0], 3 - i - j, 0))]),
                _ => self.entry(&whole.operands[0], 3 - i - j, 0),
            },
            _ => entry(a, i, j),
        }
    }

    /// Whether the entries of a matrix are made one by one.
    pub(super) fn is_listed(&self, code: &Code) -> bool {
        self.operation_of(code).is_some_and(|whole| match whole.operation {
            MatrixOperation::Entries | MatrixOperation::Zero | MatrixOperation::Hat => true,
            MatrixOperation::Of(Operation::Transpose) => self.is_listed(&whole.operands[0]),
            _ => false,
        })
    }

    /// Whether they are made one by one, or are those of a larger matrix.
    pub(super) fn is_read(&self, code: &Code) -> bool {
        self.is_listed(code)
            || self.operation_of(code).is_some_and(|whole| match whole.operation {
                MatrixOperation::Of(Operation::Block(..)) => true,
                MatrixOperation::Of(Operation::Transpose) => self.is_read(&whole.operands[0]),
                _ => false,
            })
    }

    /// A block in a matrix of zeros.
    pub(super) fn embedded(&mut self, a: Expr<'_>, (row, column): (usize, usize), shape: Shape) -> Code {
        let (inner, a) = (a.shape(), self.value(a));
        let entry = |(i, j): (usize, usize)| {
            let within = i.checked_sub(row).zip(j.checked_sub(column));
            let within = within.filter(|(i, j)| *i < inner.rows && *j < inner.columns);
            match within {
                None => Code::Number(integer(0)),
                Some(_) if inner.is_scalar() => a.clone(),
                Some((i, j)) => self.entry(&a, i, j),
            }
        };
        let entries = shape.positions().map(entry).into_list();
        self.entries(shape, entries)
    }

    /// The entries of a sum of matrices that are all built entry by entry, or of vectors if one of them is.
    pub(super) fn joined(&self, shape: Shape, parts: &[(Rational, Code)]) -> Option<Vec<Code>> {
        let mut listed = parts.iter().map(|(_, part)| self.is_listed(part));
        let is_joined = if shape.is_column() {
            listed.any(|listed| listed)
        } else {
            // x^ alone has a function
            let is_hat = |part| self.operation_of(part).is_some_and(|whole| whole.operation == MatrixOperation::Hat);
            listed.all(|listed| listed) && !parts.iter().all(|(_, part)| is_hat(part))
        };
        let sum = |(i, j): (usize, usize)| total(parts.each(|(weight, part)| (weight.clone(), self.entry(part, i, j))));
        (self.joins_blocks && is_joined).then(|| shape.positions().map(sum).into_list())
    }
}

/// Σ weight · code, without terms that are 0.
pub(super) fn total(terms: Vec<(Rational, Code)>) -> Code {
    let (mut constant, mut rest) = (integer(0), Vec::new());
    for (weight, term) in terms {
        match term {
            Code::Number(value) => constant += weight * value,
            term => rest.push((weight, term)),
        }
    }
    linear(constant, rest)
}

/// weight · code.
pub(super) fn times(weight: &Code, code: Code) -> Code {
    match code {
        Code::Number(value) if value == integer(0) => Code::Number(value),
        Code::Number(value) => linear(integer(0), vec![(value, weight.clone())]),
        code => Code::Product(vec![weight.clone(), code]),
    }
}
