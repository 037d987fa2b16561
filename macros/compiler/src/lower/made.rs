//! Kernels of given expressions: each by itself, one below the other in one vector, or as matrices.

use clebsch_symbolic::{Elements, Expr, IntoList, Shape, work};

use super::form::has_quaternions;
use super::kernel::kernel;
use super::{Grid, Hoisted, Hoisting, Kernel, SEARCHES, Scalar, Scalars, matrices};
use crate::derive::{FormulaTable, Heat, Id, MatrixForm, SystemFormulas};

/// Makes the kernels of formulas. Their order counts: it is that in which scalars are numbered.
pub(super) struct Maker<'a, 'g> {
    pub(super) system: &'a SystemFormulas<'g>,
    pub(super) rows: &'a FormulaTable<'g>,
    /// Formulas that steps of this system compute, and those of other systems do not.
    pub(super) of_steps: Vec<Id>,
    pub(super) scalars: Scalars,
    /// The values that steppers compute once.
    pub(super) hoisted: Hoisted,
    pub(super) table: Vec<(Id, Kernel)>,
}

impl<'a, 'g> Maker<'a, 'g> {
    pub(super) fn new(system: &'a SystemFormulas<'g>, rows: &'a FormulaTable<'g>) -> Maker<'a, 'g> {
        let (mut scalars, hoisted) = (Scalars::default(), Hoisted::default());
        scalars.searches = SEARCHES.min(work::left());
        Maker { system, rows, of_steps: Vec::new(), scalars, hoisted, table: Vec::new() }
    }

    /// Makes a kernel.
    pub(super) fn add(&mut self, id: Id, kernel: impl FnOnce(&mut Scalars, &mut Hoisted) -> Kernel) {
        self.table.push((id, kernel(&mut self.scalars, &mut self.hoisted)));
    }

    pub(super) fn has(&self, id: Id) -> bool {
        self.table.iter().any(|(other, _)| *other == id)
    }

    /// Makes the kernels of formulas, one after the other; one without outputs where a system does not have the formula.
    pub(super) fn rows(&mut self, ids: impl IntoIterator<Item = Id>) {
        for id in ids {
            let kernel = self.of_row(id);
            self.table.push((id, kernel));
        }
    }

    /// The same of those formulas that a system has.
    pub(super) fn known_rows(&mut self, ids: impl IntoIterator<Item = Id>) {
        let rows = self.rows;
        self.rows(ids.into_iter().filter(|id| rows.value(*id).is_some()));
    }

    /// The kernel of a formula: numbers in one list, momenta in one vector, anything else in an output for each expression.
    fn of_row(&mut self, id: Id) -> Kernel {
        let value = self.rows.value(id).unwrap_or_default();
        if self.is_for_people(id) {
            return match id {
                Id::ConservedMomenta => matrices::short_list(value),
                _ if is_stacked(id) => matrices::short_kernel(&matrices::below(value)),
                _ => matrices::short_kernel(value),
            };
        }
        // the kernels of methods of the constants
        let is_of_step = match id {
            Id::MomentumAfter(_) => self.of_steps.contains(&id),
            Id::SplittingKick | Id::SplittingGradient | Id::Guess | Id::Mobility => true,
            Id::Monitor | Id::MonitoredKick | Id::MonitorSlope => true,
            _ => id.substep().is_some(),
        };
        let hoisting = if is_of_step { Hoisting::Constants(&mut self.hoisted) } else { Hoisting::Nothing };
        let make = if is_stacked(id) { stack } else { separate };
        make(&mut self.scalars, value, hoisting)
    }

    /// Whether the kernel of a formula is matrix code in one expression or a few, which a person can read.
    fn is_for_people(&self, id: Id) -> bool {
        let is_asked_for = id.entry().heat == Heat::Cold && !self.of_steps.contains(&id);
        is_asked_for && !has_quaternions(&self.system.model)
    }

    /// Gives names to scalars that constants are made of.
    pub(super) fn name(&mut self, named: &[(String, Expr<'g>)]) {
        for (name, value) in named {
            let scalar = self.scalars.grid(*value).entries[0];
            self.scalars.names.push((scalar, name.clone()));
        }
    }

    /// The kernel of momenta of a step.
    pub(super) fn stack(&mut self, vectors: &[Expr<'g>]) -> Kernel {
        stack(&mut self.scalars, vectors, Hoisting::Constants(&mut self.hoisted))
    }

    /// The kernel of matrices without anything taken out.
    pub(super) fn matrices(&mut self, id: Id, forms: &[MatrixForm<'g>]) {
        self.add(id, |scalars, _| of_matrices(scalars, forms, Hoisting::Nothing));
    }
}

/// Whether the expressions of a formula are momenta or lists of numbers, which stand one below the other.
fn is_stacked(id: Id) -> bool {
    use Id::*;
    let is_of_step = matches!(
        id,
        StartKick(_)
            | EndKick(_)
            | RestKick(_)
            | StartForce(_)
            | MovingForce(_)
            | EndForce(_)
            | Reaction(_)
            | Projection(_)
            | MomentumAfter(_)
    );
    let is_momentum = matches!(id, MomentumMap | Coadjoint | Legendre | LegendreNext | MomentumComponents | Inertia);
    let is_of_scheme =
        matches!(id, SynchronizedMomentum | Gyroscopic | SplittingKick | MonitoredKick | MonitorSlope | Guess);
    is_of_step || is_momentum || is_of_scheme || matches!(id, ConservedMomenta | Bounds | BoundPrices)
}

/// Several expressions, one output each, nothing taken out.
pub(super) fn plain(scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Kernel {
    separate(scalars, expressions, Hoisting::Nothing)
}

/// One matrix, unrolled in matrix code too.
pub(super) fn entry_by_entry(scalars: &mut Scalars, matrix: Expr<'_>) -> Kernel {
    let output = (*scalars.grid(matrix)).clone();
    kernel(scalars, &[output], Hoisting::Nothing)
}

/// Several expressions, one output each.
pub(super) fn separate(scalars: &mut Scalars, expressions: &[Expr<'_>], hoisting: Hoisting<'_>) -> Kernel {
    let forms: Vec<MatrixForm<'_>> = expressions.each(|&expr| MatrixForm::Whole(expr));
    of_matrices(scalars, &forms, hoisting)
}

/// Vectors, one after the other in one output.
pub(super) fn stack(scalars: &mut Scalars, vectors: &[Expr<'_>], hoisting: Hoisting<'_>) -> Kernel {
    if scalars.keeps_matrices {
        return matrices::kernel(&matrices::below(vectors));
    }
    let outputs = [Grid::vector(entries(scalars, vectors))];
    kernel(scalars, &outputs, hoisting)
}

/// Matrices, one output each: in matrix code if all of them have a form in matrices.
pub(super) fn of_matrices(scalars: &mut Scalars, forms: &[MatrixForm<'_>], hoisting: Hoisting<'_>) -> Kernel {
    if let Some(wholes) = MatrixForm::wholes(forms).filter(|_| scalars.keeps_matrices) {
        return matrices::kernel(&wholes);
    }
    let outputs: Vec<Grid> = forms.each(|form| output(scalars, form));
    kernel(scalars, &outputs, hoisting)
}

fn output(scalars: &mut Scalars, matrix: &MatrixForm<'_>) -> Grid {
    match matrix {
        MatrixForm::Whole(expression) => (*scalars.grid(*expression)).clone(),
        MatrixForm::Entries(shape, parts) => Grid { shape: *shape, entries: entries(scalars, parts) },
        MatrixForm::Columns(columns) => {
            let columns: Vec<Vec<Scalar>> = columns.each(|parts| entries(scalars, parts));
            let shape = Shape::new(columns.first().map_or(0, Vec::len), columns.len());
            Grid { shape, entries: shape.positions().map(|(i, j)| columns[j][i]).into_list() }
        }
    }
}

/// The entries of expressions, one after the other.
pub(super) fn entries(scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Vec<Scalar> {
    expressions.iter().flat_map(|&expr| scalars.grid(expr).entries.clone()).into_list()
}
