//! How the leaves of a product nest: a leaf, a tuple or an array of such.

use super::access::{Access, Part};

/// The nesting of leaves, which are numbered from left to right.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Layout {
    /// The leaf with this number.
    Leaf(usize),
    /// A tuple `(A, B)`.
    Tuple(Vec<Layout>),
    /// An array `[A; 2]`.
    Array(Vec<Layout>),
}

impl Layout {
    /// The number of leaves.
    pub fn leaves(&self) -> usize {
        self.numbers().len()
    }

    /// The numbers of the leaves, in order.
    pub(super) fn numbers(&self) -> Vec<usize> {
        match self {
            Layout::Leaf(leaf) => vec![*leaf],
            Layout::Tuple(parts) | Layout::Array(parts) => parts.iter().flat_map(Layout::numbers).collect(),
        }
    }

    /// What it is, for messages.
    pub(super) fn describe(&self) -> String {
        match self {
            Layout::Leaf(_) => "no tuple".to_string(),
            Layout::Tuple(parts) => format!("a tuple of {}", parts.len()),
            Layout::Array(parts) => format!("an array of {}", parts.len()),
        }
    }

    /// How each leaf is reached, in order: `.0`, `[1]`, `.0[1]`.
    pub fn accessors(&self) -> Vec<Access> {
        let mut accessors = Vec::new();
        self.collect(Access::default(), &mut accessors);
        accessors
    }

    fn collect(&self, prefix: Access, accessors: &mut Vec<Access>) {
        let (parts, step): (_, fn(usize) -> Part) = match self {
            Layout::Leaf(_) => return accessors.push(prefix),
            Layout::Tuple(parts) => (parts, Part::Field),
            Layout::Array(parts) => (parts, Part::Index),
        };
        for (position, part) in parts.iter().enumerate() {
            part.collect(prefix.then(step(position)), accessors);
        }
    }

    /// The same nesting with its leaves numbered from `offset` on.
    pub(super) fn shifted(&self, offset: usize) -> Layout {
        let shift = |parts: &[Layout]| parts.iter().map(|part| part.shifted(offset)).collect();
        match self {
            Layout::Leaf(leaf) => Layout::Leaf(leaf + offset),
            Layout::Tuple(parts) => Layout::Tuple(shift(parts)),
            Layout::Array(parts) => Layout::Array(shift(parts)),
        }
    }
}
