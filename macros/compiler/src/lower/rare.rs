//! Formulas that no step runs: matrix code in one expression or a few, which a person can read.

use clebsch_symbolic::Expr;

use super::made::{plain, stack};
use super::{Hoisting, Kernel, Scalars, matrices};
use crate::derive::Formulas;
use crate::lower::form::has_quaternions;

/// How the formulas of a system are written that are computed when someone asks for them.
pub(super) struct Rare {
    /// Quaternions have no code with whole matrices.
    writes_entries: bool,
}

impl Rare {
    pub(super) fn of(formulas: &Formulas<'_>) -> Rare {
        Rare { writes_entries: has_quaternions(formulas) }
    }

    /// One output for each expression.
    pub(super) fn kernel(&self, scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Kernel {
        if self.writes_entries { plain(scalars, expressions) } else { matrices::short_kernel(expressions) }
    }

    /// Vectors, one after the other in one output.
    pub(super) fn stack(&self, scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Kernel {
        if self.writes_entries {
            stack(scalars, expressions, Hoisting::Nothing)
        } else {
            matrices::short_stack(expressions)
        }
    }

    /// Numbers, one after the other in one output.
    pub(super) fn list(&self, scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Kernel {
        if self.writes_entries {
            stack(scalars, expressions, Hoisting::Nothing)
        } else {
            matrices::short_list(expressions)
        }
    }
}
