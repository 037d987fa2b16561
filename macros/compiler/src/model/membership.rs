//! Whether an expression lies on a group for all values of its symbols.

use clebsch_symbolic::{Chart, Expr, Group, One, Operation, View, identity};

/// What is known.
#[derive(Copy, Clone, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It does.
    Inside,
    /// It does not.
    Outside,
    /// That is not decided here.
    Open,
}

/// Whether an expression lies on a group: as a product of its elements, or by its equations.
pub(super) fn lies_on(expr: Expr<'_>, group: Group) -> Verdict {
    if is_product(expr, group) {
        return Verdict::Inside;
    }
    let graph = expr.graph();
    let mut equations = group.equations(expr);
    let by_basis = group.is_declared() && equations.is_empty();
    let affine = by_basis && group.chart(graph) == Chart::Affine;
    if affine {
        // F − I is an element of the algebra
        let increment = expr - graph.identity(expr.shape().rows);
        equations.push(increment - group.wedge(group.projected_coordinates(increment)));
    }
    if !equations.into_iter().all(identity::vanishes) {
        return Verdict::Outside;
    }
    // the equations of SU(n) are those of U(n)
    let is_open = matches!(group, Group::SpecialUnitary(_)) || (by_basis && !affine);
    if is_open { Verdict::Open } else { Verdict::Inside }
}

/// Whether an expression is made of elements of a group by products and inverses.
fn is_product(expr: Expr<'_>, group: Group) -> bool {
    match expr.view() {
        View::Symbol(symbol) => symbol.property == group.element_property() && symbol.shape == group.element_shape(),
        View::Of(Operation::Inverse, inner) => is_product(inner, group),
        View::Of(Operation::Transpose, inner) => group.is_orthogonal() && is_product(inner, group),
        View::Sum(terms) => match terms.as_slice() {
            [term] => {
                let letters = term.word.iter().all(|letter| is_product(*letter, group));
                letters && term.coefficient.is_one() && term.scalars.is_empty()
            }
            _ => false,
        },
        _ => false,
    }
}
