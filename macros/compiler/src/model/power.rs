//! Powers: a group Gᴺ that acts site by site on Qᴺ, with a const generic N.
//!
//! The site is a system of its own, which the other stages derive as they derive any other. The potential ties the
//! sites to each other. It is a sum of terms, and each is the same formula at every index of its sums. A formula names
//! the sites that it reads by *places*, `q[i]`, `q[(i + 1) % N]`, and is differentiated once.

#[cfg(test)]
mod tests;

use std::fmt;

use clebsch_symbolic::{Expr, Graph, IntoList, Property, Rational, Role, Shape};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::ToTokens;

use super::Written;

/// The number of sites of a power: a const generic, or a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Length {
    /// N
    Generic(Ident),
    /// A number.
    Number(usize),
}

impl Length {
    /// Whether it is the const generic with this name.
    pub(super) fn is_named(&self, name: &str) -> bool {
        matches!(self, Length::Generic(own) if own == name)
    }

    /// The expression that stands for it in ranges and indices.
    pub(super) fn count<'g>(&self, graph: &'g Graph) -> Expr<'g> {
        match self {
            Length::Generic(name) => graph.symbol(&name.to_string(), Shape::scalar(), Role::Sites, Property::General),
            Length::Number(count) => graph.integer(*count as i64),
        }
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Length::Generic(name) => name.fmt(f),
            Length::Number(count) => count.fmt(f),
        }
    }
}

impl ToTokens for Length {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        match self {
            Length::Generic(name) => name.to_tokens(tokens),
            Length::Number(count) => Literal::usize_unsuffixed(*count).to_tokens(tokens),
        }
    }
}

/// One site that terms read.
#[derive(Clone, PartialEq, Eq)]
pub struct SiteIndex<'g> {
    /// Its index, a linear expression in the indices of sums and in N.
    pub index: Expr<'g>,
    /// Whether the index is taken modulo N.
    pub wraps: bool,
}

/// The range of the index of a sum: from the first expression up to and without the second.
pub type Range<'g> = (Expr<'g>, Expr<'g>);

/// A term of a sum over sites, and the sums around it.
#[derive(Clone, PartialEq, Debug)]
pub struct Term<'g> {
    /// The range of each sum, the outermost first.
    pub ranges: Vec<Range<'g>>,
    /// The formula.
    pub value: Expr<'g>,
}

/// The constraint of a power: joints of one site, of two neighbours, or of two sites of a tree.
#[derive(Clone)]
pub struct Joints<'g> {
    /// The joints.
    pub all: Vec<Joint<'g>>,
    /// The most rows that have the same site as their later one.
    pub rows: usize,
    /// Whether a joint reads the last site and the first one.
    pub is_ring: bool,
    /// Whether a joint reads two sites that are no neighbours.
    pub is_tree: bool,
    /// The rows of all joints that close a loop in a tree.
    pub loops: usize,
}

/// An equation φ = 0 for each index of its range.
#[derive(Clone)]
pub struct Joint<'g> {
    /// φ, a column of scalars.
    pub term: Term<'g>,
    /// The place of the later site that it reads.
    pub own: usize,
    /// The place of its parent, an earlier site; `None` where it reads one site.
    pub before: Option<usize>,
    /// The number of its first row: among those of its later site, or among those of all loops.
    pub first: usize,
    /// Whether it closes a loop in a tree: its later site hangs from another one.
    pub is_loop: bool,
    /// The equation as it was written.
    pub written: Written,
}

impl Joint<'_> {
    /// The number of its rows.
    pub fn count(&self) -> usize {
        self.term.value.shape().rows
    }
}

impl Term<'_> {
    /// The ranges of its indices, `i in 0..N, j in i + 1..N`; empty if there is no sum.
    pub fn indices(&self) -> String {
        let of_depth = |(depth, (from, to)): (usize, &Range<'_>)| format!("{} in {from}..{to}", index_name(depth));
        self.ranges.iter().enumerate().map(of_depth).into_list().join(", ")
    }
}

/// The name of the index of a sum inside `depth` others.
pub(super) fn index_name(depth: usize) -> String {
    ["i", "j", "k", "l"].get(depth).map_or_else(|| format!("i{depth}"), ToString::to_string)
}

impl<'g> SiteIndex<'g> {
    /// As a closure writes it, `(i + 1) % N`.
    pub fn text(&self, length: &Length) -> String {
        let index = &self.index;
        match (self.wraps, index.as_symbol()) {
            (false, _) => index.to_string(),
            (true, Some(_)) => format!("{index} % {length}"),
            (true, None) => format!("({index}) % {length}"),
        }
    }
}

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

    /// Whether an expression can be declared as an index or as the end of a range. It has this form, with numbers of
    /// less than 32 bits.
    pub(super) fn is_declarable(expr: Expr<'_>) -> bool {
        let is_small = |number: &i64| number.unsigned_abs() < 1 << 32;
        Linear::of(expr).is_some_and(|linear| {
            is_small(&linear.constant) && is_small(&linear.sites) && linear.indices.iter().all(is_small)
        })
    }
}

fn whole(number: Rational) -> Option<i64> {
    if let Some((value, 1)) = number.parts() { Some(value) } else { None }
}

/// The least N from which on 0 ≤ index < N for all indices in their ranges: 1, or 6 for `q[5]`. `None` if there is none.
pub(super) fn sites_for<'g>(index: Expr<'g>, sites: Expr<'g>, ranges: &[Range<'g>]) -> Option<i64> {
    let graph = index.graph();
    // c + n N ≥ 0 for every N ≥ 1
    let is_never_negative = |linear: &Linear| linear.sites >= 0 && linear.constant.saturating_add(linear.sites) >= 0;
    least(index, ranges).filter(is_never_negative)?;
    let above = least(sites - graph.integer(1) - index, ranges)?;
    match above {
        _ if is_never_negative(&above) => Some(1),
        Linear { constant, sites: 1, .. } => constant.checked_neg(),
        _ => None,
    }
}

/// The least value over all indices in their ranges, the innermost first, as a function of N.
fn least<'g>(mut expr: Expr<'g>, ranges: &[Range<'g>]) -> Option<Linear> {
    let graph = expr.graph();
    for (depth, (from, to)) in ranges.iter().enumerate().rev() {
        let is_index = |symbol: &Expr<'g>| symbol.role() == Some(Role::Site(depth));
        let Some(symbol) = expr.symbols().into_iter().find(is_index) else { continue };
        let slope = expr.gradient(symbol).as_number()?;
        let end = if slope < Rational::zero() { *to - graph.integer(1) } else { *from };
        expr = expr.substitute(&[(symbol, end)]);
    }
    Linear::of(expr).filter(|linear| linear.indices.iter().all(|&coefficient| coefficient == 0))
}
