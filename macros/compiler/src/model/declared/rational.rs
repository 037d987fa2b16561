//! What can be followed exactly: expressions without functions, roots or irrational numbers.

use clebsch_symbolic::{Expr, View};

/// Whether an expression has no functions, roots or irrational numbers in it.
pub(super) fn is_rational(expr: Expr<'_>) -> bool {
    let all = |parts: &[Expr<'_>]| parts.iter().all(|part| is_rational(*part));
    match expr.view() {
        View::Symbol(_) | View::Literal(_) => true,
        View::Sum(terms) => terms.iter().all(|term| {
            all(&term.word)
                && term.scalars.iter().all(|(base, (_, denominator))| *denominator == 1 && is_rational(*base))
        }),
        View::Stack(parts) | View::Word(parts) | View::Trace(parts) => all(&parts),
        View::Transpose(a)
        | View::Inverse(a)
        | View::Determinant(a)
        | View::Block(a, ..)
        | View::Embed(a, ..)
        | View::DiagonalMatrix(a)
        | View::Diagonal(a)
        | View::Wedge(_, a)
        | View::Components(_, a) => is_rational(a),
        View::Hadamard(a, b) => all(&[a, b]),
        _ => false,
    }
}
