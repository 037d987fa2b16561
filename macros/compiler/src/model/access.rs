//! How a leaf of a product is reached.

use std::fmt;

/// The parts to go through, from the outside in: `.0[1]`. None for what is a single leaf.
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

    /// The same access with one more part inside.
    #[must_use]
    pub(super) fn then(&self, part: Part) -> Access {
        Access(self.0.iter().copied().chain([part]).collect())
    }

    /// The same access inside the entry for the site at a place.
    #[must_use]
    pub(super) fn at_site(&self, place: usize) -> Access {
        Access([Part::Site(place)].into_iter().chain(self.0.iter().copied()).collect())
    }

    /// The place of the site whose entry this is, if it is one.
    pub fn site(&self) -> Option<usize> {
        match self.0.first() {
            Some(Part::Site(place)) => Some(*place),
            _ => None,
        }
    }

    /// The access from the entry of a site on.
    #[must_use]
    pub fn inside_site(&self) -> Access {
        let parts = self.0.iter().copied();
        Access(parts.filter(|part| !matches!(part, Part::Site(_))).collect())
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
