//! Grids: how many sites a field has in each direction, how far they are apart, and where they end.

use crate::fields::getters;
use crate::{Error, Scalar};

/// A side of a grid.
///
/// ```
/// use clebsch::{Sides, Side};
///
/// // a string that hangs from its first site
/// let hanging = Sides::Open(Side::Fixed, Side::Free);
/// assert_ne!(hanging, Sides::Periodic);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// There is no edge beyond it.
    Free,
    /// Its sites do not move.
    Fixed,
}

/// How a grid ends in a direction.
///
/// ```
/// use clebsch::{Sides, Grid, Side};
///
/// let tube: Grid<f64, 2> = Grid::new([16, 8]).sides([Sides::Periodic, Sides::Open(Side::Free, Side::Fixed)]);
/// assert!(!tube.is_fixed(0) && tube.is_fixed(7));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// The last site is the neighbour before the first one.
    Periodic,
    /// The side of the first sites, and that of the last ones.
    Open(Side, Side),
}

impl Sides {
    /// Whether the site at a place in this direction is on a fixed side.
    #[inline]
    fn fixes(self, place: usize, size: usize) -> bool {
        match self {
            Sides::Periodic => false,
            Sides::Open(first, last) => {
                (place == 0 && first == Side::Fixed) || (place + 1 == size && last == Side::Fixed)
            }
        }
    }

    /// The places before and after one.
    #[inline]
    fn around(self, place: usize, size: usize) -> [Option<usize>; 2] {
        let is_ring = self == Sides::Periodic;
        let before = place.checked_sub(1).or_else(|| if is_ring { size.checked_sub(1) } else { None });
        let after = if place + 1 < size {
            Some(place + 1)
        } else if is_ring {
            Some(0)
        } else {
            None
        };
        [before, after]
    }
}

/// A grid in D directions. The sites of the last direction stand next to each other.
///
/// ```
/// use clebsch::Grid;
///
/// let grid: Grid<f64, 2> = Grid::new([3, 4]).spacing([0.5, 0.25]).periodic();
/// assert_eq!(grid.sites(), 12);
/// assert_eq!(grid.index([1, 2]), Some(6));
/// assert_eq!(grid.place(6), Some([1, 2]));
/// assert_eq!(grid.index([3, 0]), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid<T, const D: usize> {
    sizes: [usize; D],
    spacing: [T; D],
    sides: [Sides; D],
}

impl<T: Scalar, const D: usize> Grid<T, D> {
    /// So many sites in each direction, free at its ends, with the spacing 1.
    pub fn new(sizes: [usize; D]) -> Self {
        Self { sizes, spacing: [T::one(); D], sides: [Sides::Open(Side::Free, Side::Free); D] }
    }

    /// The same with these spacings.
    #[must_use]
    pub fn spacing(self, spacing: [T; D]) -> Self {
        Self { spacing, ..self }
    }

    /// The same with these sides in each direction.
    #[must_use]
    pub fn sides(self, sides: [Sides; D]) -> Self {
        Self { sides, ..self }
    }

    /// The same, periodic in each direction.
    #[must_use]
    pub fn periodic(self) -> Self {
        self.sides([Sides::Periodic; D])
    }

    /// The same with free ends in each direction.
    #[must_use]
    pub fn free(self) -> Self {
        self.sides([Sides::Open(Side::Free, Side::Free); D])
    }

    /// The same with fixed ends in each direction.
    #[must_use]
    pub fn fixed(self) -> Self {
        self.sides([Sides::Open(Side::Fixed, Side::Fixed); D])
    }

    getters! {
        /// The number of sites in each direction.
        copy sizes: [usize; D];
    }

    /// The spacings of all directions.
    #[inline]
    pub fn spacings(&self) -> &[T; D] {
        &self.spacing
    }

    /// The sides of all directions.
    #[inline]
    pub fn all_sides(&self) -> &[Sides; D] {
        &self.sides
    }

    /// The number of all sites, at most that of the largest `usize`.
    #[inline]
    pub fn sites(&self) -> usize {
        self.sizes.iter().fold(1, |all: usize, size| all.saturating_mul(*size))
    }

    /// The number of the site at a place; `None` outside of the grid.
    pub fn index(&self, place: [usize; D]) -> Option<usize> {
        let is_inside = place.iter().zip(&self.sizes).all(|(place, size)| place < size);
        let next = |index: usize, (place, size): (&usize, &usize)| index.checked_mul(*size)?.checked_add(*place);
        place.iter().zip(&self.sizes).try_fold(0, next).filter(|_| is_inside)
    }

    /// The place of a site; `None` if there is none of this number.
    pub fn place(&self, index: usize) -> Option<[usize; D]> {
        (index < self.sites()).then(|| self.split(index))
    }

    /// The place of a site that is there.
    #[inline]
    pub(super) fn split(&self, mut index: usize) -> [usize; D] {
        let mut place = [0; D];
        for (place, &size) in place.iter_mut().zip(&self.sizes).rev() {
            *place = index.checked_rem(size).unwrap_or(0);
            index = index.checked_div(size).unwrap_or(0);
        }
        place
    }

    /// Whether a site does not move.
    pub fn is_fixed(&self, index: usize) -> bool {
        self.fixes(&self.split(index))
    }

    /// Whether the site at a place does not move.
    #[inline]
    pub(super) fn fixes(&self, place: &[usize; D]) -> bool {
        (0..D).any(|d| self.sides[d].fixes(place[d], self.sizes[d]))
    }

    /// The place of the first site of the next line.
    #[inline]
    pub(super) fn next_line(&self, place: &mut [usize; D]) {
        let mut places = place.iter_mut().zip(&self.sizes).rev();
        if let Some((last, _)) = places.next() {
            *last = 0;
        }
        for (place, &size) in places {
            *place += 1;
            if *place < size {
                return;
            }
            *place = 0;
        }
    }

    /// The number of sites that stand next to each other.
    #[inline]
    pub(super) fn line(&self) -> usize {
        self.sizes.last().copied().unwrap_or(1)
    }

    /// The number of sites with one place in the first direction.
    #[inline]
    pub(super) fn row(&self) -> usize {
        self.sizes.iter().skip(1).fold(1, |all: usize, size| all.saturating_mul(*size))
    }

    /// Whether a site may be fixed at all.
    pub(super) fn has_fixed(&self) -> bool {
        let is_fixed =
            |sides: &Sides| matches!(sides, Sides::Open(first, last) if [*first, *last].contains(&Side::Fixed));
        self.sides.iter().any(is_fixed)
    }

    /// The numbers of the sites before and after one in a direction.
    #[inline]
    pub(super) fn around(&self, index: usize, place: &[usize; D], direction: usize) -> [Option<usize>; 2] {
        let stride = self.sizes.iter().skip(direction + 1).fold(1, |all: usize, size| all.saturating_mul(*size));
        let (own, size) = (place[direction], self.sizes[direction]);
        let start = index - own * stride;
        self.sides[direction].around(own, size).map(|place| place.map(|place| start + place * stride))
    }

    /// There is a site, and each has a number.
    ///
    /// # Errors
    /// [`Error::EmptyGrid`].
    pub(super) fn check_sizes(&self) -> Result<(), Error> {
        let sites = self.sizes.iter().try_fold(1_usize, |all, &size| all.checked_mul(size));
        if sites.is_some_and(|sites| sites > 0) {
            return Ok(());
        }
        let direction = self.sizes.iter().position(|&size| size == 0).unwrap_or(0);
        Err(Error::EmptyGrid { direction, sites: self.sizes.get(direction).copied().unwrap_or(0) })
    }

    /// The sizes and the spacings can be those of a grid.
    ///
    /// # Errors
    /// [`Error::EmptyGrid`] or [`Error::Spacing`].
    pub(super) fn check(&self) -> Result<(), Error> {
        self.check_sizes()?;
        for (direction, spacing) in self.spacing.iter().enumerate() {
            for value in (0..T::LANES).map(|lane| spacing.lane(lane).to_f64()) {
                if !(value.is_finite() && value > 0.0) {
                    return Err(Error::Spacing { direction, value });
                }
            }
        }
        Ok(())
    }
}
