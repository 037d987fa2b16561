//! Powers: a group Gᴺ that acts site by site on Qᴺ, with a const generic N.
//!
//! The site is a system of its own, which the other stages derive as they derive any other. What ties sites to each other is the potential: a sum of
//! terms, each the same formula at every index that its sums run through. A formula names the sites that it reads by *places*, `q[i]`,
//! `q[(i + 1) % N]`, and is differentiated once.

pub(super) mod bounds;
#[cfg(test)]
mod tests;

use clebsch_symbolic::Expr;

pub use bounds::Linear;

/// One site that terms read.
#[derive(Clone, PartialEq, Eq)]
pub struct SiteIndex<'g> {
    /// Its index, a linear expression in the indices of sums and in N.
    pub index: Expr<'g>,
    /// Whether the index is taken modulo N.
    pub wraps: bool,
}

/// A term of a sum over sites, and the sums around it.
#[derive(Clone, Debug)]
pub struct Term<'g> {
    /// What the index of each sum runs through, the outermost first: from the first expression up to and without the second.
    pub ranges: Vec<(Expr<'g>, Expr<'g>)>,
    /// The formula.
    pub value: Expr<'g>,
}

impl Term<'_> {
    /// What its indices run through, `i in 0..N, j in i + 1..N`; nothing where there is no sum.
    pub fn indices(&self) -> String {
        let of_depth =
            |(depth, (from, to)): (usize, &(Expr<'_>, Expr<'_>))| format!("{} in {from}..{to}", index_name(depth));
        self.ranges.iter().enumerate().map(of_depth).collect::<Vec<_>>().join(", ")
    }
}

/// What the index of a sum inside `depth` others is called.
pub(super) fn index_name(depth: usize) -> String {
    match depth {
        0..=3 => ["i", "j", "k", "l"][depth].to_string(),
        _ => format!("i{depth}"),
    }
}

impl<'g> SiteIndex<'g> {
    /// As a closure writes it, `(i + 1) % N`.
    pub fn text(&self) -> String {
        if !self.wraps {
            return self.index.to_string();
        }
        match self.index.as_symbol() {
            Some(_) => format!("{} % N", self.index),
            None => format!("({}) % N", self.index),
        }
    }
}
