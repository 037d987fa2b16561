//! The operations of kernels.

use std::fmt;

use clebsch_symbolic::{IntoList, Operation, Shape};

use super::scalar::is_unit;
use super::{Code, Kernel, MatrixOperation};

/// The operations of a kernel.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Default, Debug)]
pub struct Cost {
    /// Additions and subtractions.
    pub additions: usize,
    /// Multiplications.
    pub multiplications: usize,
    /// Divisions and reciprocals.
    pub divisions: usize,
    /// Square and other roots.
    pub roots: usize,
    /// Calls of elementary functions.
    pub calls: usize,
}

impl Kernel {
    /// The operations of this kernel.
    pub fn cost(&self) -> Cost {
        let mut cost = Cost::default();
        self.visit(&mut |code| cost = cost.plus(Cost::of(code)));
        cost
    }

    /// The operations in its code; an operation on matrices counts as one.
    pub fn length(&self) -> usize {
        let mut length = 0;
        self.visit(&mut |code| {
            let cost = Cost::of(code).total();
            length += if matches!(code, Code::Whole(_)) { cost.min(1) } else { cost };
        });
        length
    }
}

impl Cost {
    fn sums(additions: usize, multiplications: usize) -> Cost {
        Cost { additions, multiplications, ..Cost::default() }
    }

    /// The sum of two costs.
    pub fn plus(self, other: Cost) -> Cost {
        Cost {
            additions: self.additions + other.additions,
            multiplications: self.multiplications + other.multiplications,
            divisions: self.divisions + other.divisions,
            roots: self.roots + other.roots,
            calls: self.calls + other.calls,
        }
    }

    /// All operations.
    pub fn total(self) -> usize {
        self.additions + self.multiplications + self.divisions + self.roots + self.calls
    }

    /// The operations of a code without those of its parts.
    fn of(code: &Code) -> Cost {
        match code {
            Code::Sum(constant, terms) => {
                let scaled = terms.iter().filter(|(weight, _)| !is_unit(weight)).count();
                Cost::sums(terms.len() - 1 + usize::from(!constant.is_zero()), scaled)
            }
            Code::Product(factors) => {
                // a division takes the place of a multiplication
                let below = factors.iter().filter(|factor| matches!(factor, Code::Reciprocal(_))).count();
                Cost::sums(0, (factors.len() - 1).saturating_sub(below))
            }
            Code::Reciprocal(_) => Cost { divisions: 1, ..Cost::default() },
            Code::Root(..) => Cost { roots: 1, ..Cost::default() },
            // at worst: next to θ = 0 it is a polynomial
            Code::PerOnePlusCosine(_) => Cost { divisions: 1, roots: 1, ..Cost::sums(2, 0) },
            Code::Function(..) | Code::Call(..) => Cost { calls: 1, ..Cost::default() },
            Code::Whole(whole) => whole.cost,
            _ => Cost::default(),
        }
    }
}

impl MatrixOperation {
    /// Its operations, from the shape of its result and that of its first operand.
    pub(super) fn cost(&self, shape: Shape, first: Shape) -> Cost {
        let (n, all) = (shape.rows, shape.len());
        match self {
            MatrixOperation::Sum(weights) => {
                Cost::sums((weights.len() - 1) * all, weights.iter().filter(|weight| !is_unit(weight)).count() * all)
            }
            MatrixOperation::Scaled | MatrixOperation::Hadamard => Cost::sums(0, all),
            MatrixOperation::Shifted | MatrixOperation::SkewComponents | MatrixOperation::Axial => Cost::sums(n, 0),
            MatrixOperation::Product => Cost::sums(all * (first.columns - 1), all * first.columns),
            MatrixOperation::InertiaTimes => Cost::sums(n * (n - 1), n * n),
            MatrixOperation::SkewTimes => Cost::sums(n * n, n * (n - 1)),
            MatrixOperation::SkewOuter => Cost::sums(n, 2 * n),
            MatrixOperation::Pairing => Cost::sums(first.len(), first.len()),
            MatrixOperation::Trace => Cost::sums(first.rows, 0),
            MatrixOperation::Of(Operation::Inverse) => Cost { divisions: n, ..Cost::sums(n.pow(3), n.pow(3)) },
            MatrixOperation::Of(Operation::Determinant) => {
                let third = first.rows.pow(3) / 3;
                Cost { divisions: first.rows.pow(2) / 2, ..Cost::sums(third, third) }
            }
            // squarings and a rational approximation, twelve products
            MatrixOperation::Of(Operation::Analytic(_)) => {
                Cost { calls: 1, ..Cost::sums(12 * n.pow(2) * (n - 1), 12 * n.pow(3)) }
            }
            MatrixOperation::Value | MatrixOperation::Gradient(_) => Cost { calls: 1, ..Cost::default() },
            _ => Cost::default(),
        }
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            (self.additions, "+"),
            (self.multiplications, "×"),
            (self.divisions, "÷"),
            (self.roots, "√"),
            (self.calls, "f"),
        ];
        let text: Vec<String> =
            parts.iter().filter(|(count, _)| *count > 0).map(|(count, symbol)| format!("{count}{symbol}")).into_list();
        f.write_str(if text.is_empty() { "no operations".to_string() } else { text.join(" ") }.as_str())
    }
}
