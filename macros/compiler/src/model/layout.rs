//! How the leaves of a product nest, and how each is reached.

use clebsch_symbolic::{Elements, IntoList};
use std::fmt;

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
            Layout::Tuple(parts) | Layout::Array(parts) => parts.iter().flat_map(Layout::numbers).into_list(),
        }
    }

    /// Its description, for messages.
    pub(super) fn describe(&self) -> String {
        match self {
            Layout::Leaf(_) => "no tuple".to_string(),
            Layout::Tuple(parts) => format!("a tuple of {}", parts.len()),
            Layout::Array(parts) => format!("an array of {}", parts.len()),
        }
    }

    /// How each leaf is reached, in order: `.0`, `[1]`, `.0[1]`.
    pub fn accessors(&self) -> Vec<Access> {
        let (parts, step): (_, fn(usize) -> Part) = match self {
            Layout::Leaf(_) => return vec![Access::default()],
            Layout::Tuple(parts) => (parts, Part::Field),
            Layout::Array(parts) => (parts, Part::Index),
        };
        let within = |(position, part): (usize, &Layout)| -> Vec<Access> {
            part.accessors().each(|access| access.within(step(position)))
        };
        parts.iter().enumerate().flat_map(within).into_list()
    }

    /// The same nesting with its leaves numbered from `offset` on.
    pub(super) fn shifted(&self, offset: usize) -> Layout {
        let shift = |parts: &[Layout]| parts.each(|part| part.shifted(offset));
        match self {
            Layout::Leaf(leaf) => Layout::Leaf(leaf + offset),
            Layout::Tuple(parts) => Layout::Tuple(shift(parts)),
            Layout::Array(parts) => Layout::Array(shift(parts)),
        }
    }
}

/// The parts to go through, from the outside in: `.0[1]`. It is empty for a single leaf.
#[derive(Clone, PartialEq, Eq, Hash, Debug, Default)]
pub struct Access(Vec<Part>);

/// One part of an access.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Debug)]
pub enum Part {
    /// A field of a tuple, `.0`.
    Field(usize),
    /// An entry of an array, `[1]`.
    Index(usize),
    /// The entry of an array of N for the site at a place of a power, by the number of the place.
    Site(usize),
}

impl Access {
    /// The parts, from the outside in.
    pub fn parts(&self) -> &[Part] {
        &self.0
    }

    /// Whether there are no parts: the value itself is the leaf.
    pub fn is_whole(&self) -> bool {
        self.0.is_empty()
    }

    /// A field of a tuple.
    pub(super) fn field(position: usize) -> Access {
        Access(vec![Part::Field(position)])
    }

    /// The same access inside a part.
    #[must_use]
    pub(super) fn within(&self, part: Part) -> Access {
        Access([&[part], self.0.as_slice()].concat())
    }

    /// The place of the site whose entry this is, if it is one.
    pub fn site(&self) -> Option<usize> {
        if let Some(Part::Site(place)) = self.0.first() { Some(*place) } else { None }
    }

    /// The access from the entry of a site on.
    #[must_use]
    pub fn inside_site(&self) -> Access {
        let parts = self.0.iter().copied();
        Access(parts.filter(|part| !matches!(part, Part::Site(_))).into_list())
    }
}

/// As it is written after the name of the value, `.0[1]`.
impl fmt::Display for Access {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|part| match part {
            Part::Field(position) => write!(f, ".{position}"),
            Part::Index(position) => write!(f, "[{position}]"),
            Part::Site(place) => write!(f, "[at{place}]"),
        })
    }
}
