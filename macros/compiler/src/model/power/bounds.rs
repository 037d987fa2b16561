//! Whether an index is always that of a site.

use clebsch_symbolic::{Expr, Rational, Role, Zero};

/// c + n N + Σ b_k i_k with whole numbers, i_k the index of the k-th sum.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Linear {
    /// c
    pub constant: i64,
    /// n
    pub sites: i64,
    /// b_k
    pub indices: Vec<i64>,
}

impl Linear {
    /// An expression in this form, if it has it.
    pub fn of(expr: Expr<'_>) -> Option<Linear> {
        let graph = expr.graph();
        let mut linear = Linear { constant: 0, sites: 0, indices: Vec::new() };
        let mut rest = expr;
        for symbol in expr.symbols() {
            let coefficient = whole(expr.gradient(symbol).as_number()?)?;
            match symbol.as_symbol()?.role {
                Role::Sites => linear.sites = coefficient,
                Role::Site(depth) => {
                    linear.indices.resize(linear.indices.len().max(depth + 1), 0);
                    linear.indices[depth] = coefficient;
                }
                _ => return None,
            }
            rest = rest.substitute(&[(symbol, graph.integer(0))]);
        }
        linear.constant = whole(rest.as_number()?)?;
        Some(linear)
    }

    /// Whether an expression can be declared as an index or as the end of a range: in this form, with numbers of less than 32 bits.
    pub(in crate::model) fn is_declarable(expr: Expr<'_>) -> bool {
        let is_small = |number: &i64| number.unsigned_abs() < 1 << 32;
        Linear::of(expr).is_some_and(|linear| {
            is_small(&linear.constant) && is_small(&linear.sites) && linear.indices.iter().all(is_small)
        })
    }
}

fn whole(number: Rational) -> Option<i64> {
    match number.parts() {
        Some((value, 1)) => Some(value),
        _ => None,
    }
}

/// Whether 0 ≤ index < N for every N ≥ 1 and all indices in their ranges.
pub(in crate::model) fn is_inside<'g>(index: Expr<'g>, sites: Expr<'g>, ranges: &[(Expr<'g>, Expr<'g>)]) -> bool {
    let graph = index.graph();
    let above = sites - graph.integer(1) - index;
    [index, above].into_iter().all(|expr| least(expr, ranges).is_some_and(|least| is_never_negative(&least)))
}

/// The least value over all indices in their ranges, the innermost first, as a function of N.
fn least<'g>(mut expr: Expr<'g>, ranges: &[(Expr<'g>, Expr<'g>)]) -> Option<Linear> {
    let graph = expr.graph();
    for (depth, (from, to)) in ranges.iter().enumerate().rev() {
        let is_index = |symbol: &Expr<'g>| symbol.as_symbol().is_some_and(|data| data.role == Role::Site(depth));
        let Some(symbol) = expr.symbols().into_iter().find(is_index) else { continue };
        let slope = expr.gradient(symbol).as_number()?;
        let end = if slope < Rational::zero() { *to - graph.integer(1) } else { *from };
        expr = expr.substitute(&[(symbol, end)]);
    }
    Linear::of(expr).filter(|linear| linear.indices.iter().all(|&coefficient| coefficient == 0))
}

/// c + n N ≥ 0 for every N ≥ 1.
fn is_never_negative(linear: &Linear) -> bool {
    linear.sites >= 0 && linear.constant.saturating_add(linear.sites) >= 0
}
