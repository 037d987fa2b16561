//! How the leaves of a product nest: a leaf, a tuple or an array of such.

use super::access::{Access, Part};

/// The nesting of leaves, which are numbered from left to right.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Structure {
    /// The leaf with this number.
    Leaf(usize),
    /// A tuple `(A, B)`.
    Tuple(Vec<Structure>),
    /// An array `[A; 2]`.
    Array(Vec<Structure>),
}

impl Structure {
    /// The number of leaves.
    pub fn leaves(&self) -> usize {
        match self {
            Structure::Leaf(_) => 1,
            Structure::Tuple(parts) | Structure::Array(parts) => parts.iter().map(Structure::leaves).sum(),
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
            Structure::Leaf(_) => return accessors.push(prefix),
            Structure::Tuple(parts) => (parts, Part::Field),
            Structure::Array(parts) => (parts, Part::Index),
        };
        for (position, part) in parts.iter().enumerate() {
            part.collect(prefix.then(step(position)), accessors);
        }
    }

    /// The same nesting with its leaves numbered from `offset` on.
    pub(super) fn shifted(&self, offset: usize) -> Structure {
        let shift = |parts: &[Structure]| parts.iter().map(|part| part.shifted(offset)).collect();
        match self {
            Structure::Leaf(leaf) => Structure::Leaf(leaf + offset),
            Structure::Tuple(parts) => Structure::Tuple(shift(parts)),
            Structure::Array(parts) => Structure::Array(shift(parts)),
        }
    }
}
