//! Slabs: some rows of a grid by themselves, with the rows of neighbours that their forces read.

use super::edges::Edge;
use super::{Domain, Field, Grid, Lattice, Population, Side, Sides};
use crate::fields::getters;
use crate::parts::{Mu, Q, T};
use crate::{Error, Scalar};
use core::ops::Range;

/// Some rows of a grid by themselves, as on one of many machines. A row is all sites with one place in the first direction.
///
/// Around its own rows a slab has those of neighbours, so far as forces [reach](Field::REACH). All rows stand in the order of the grid.
/// The sites of neighbours do not move here, as on a fixed side. [`FieldStepper::advance_exchanging`](super::FieldStepper::advance_exchanging) has them written.
///
/// So [`Domain::stable_step`] of a slab is that between fixed sides. With an exchange take that of the grid, or of a smaller one.
///
/// Made by [`Domain::slab`].
///
/// ```
/// # use clebsch::{Clebsch, Field};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     cost   = |h, a| a.norm_squared() / (2 * h),
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// # )]
/// # struct Strand;
/// let ring = Strand.grid([10]).periodic();
/// let part = ring.slab(0..4)?;
/// let slab = part.lattice();
/// // its own rows 0 to 3, row 4, and row 9, which is the neighbour before row 0
/// assert_eq!((slab.sites(), slab.own()), (6, 0..4));
/// assert_eq!((slab.place(4), slab.place(5)), (Some([4]), Some([9])));
/// assert_eq!((slab.row(9), slab.row(5)), (Some(5..6), None));
/// assert_eq!(slab.rows_before().collect::<Vec<_>>(), [9]);
/// assert_eq!(slab.rows_after().collect::<Vec<_>>(), [4]);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Slab<T, const D: usize> {
    grid: Grid<T, D>,
    rows: Range<usize>,
    reach: usize,
    /// The rows that are here: those from 0 on, and those of a range behind them.
    head: usize,
    tail: Range<usize>,
    /// The rows that are here as a grid. Those that are neighbours here and not in `grid` are both rows of others.
    local: Grid<T, D>,
    own: Range<usize>,
}

impl<T: Scalar, const D: usize> Slab<T, D> {
    /// These rows of a grid, with as many rows of neighbours on each side as `reach` says.
    fn new(grid: Grid<T, D>, rows: Range<usize>, reach: usize) -> Result<Self, Error> {
        grid.check()?;
        let mut sizes = grid.sizes();
        let mut sides = *grid.all_sides();
        let (Some(size), Some(side)) = (sizes.first_mut(), sides.first_mut()) else {
            return Err(Error::EmptyGrid { direction: 0, sites: 0 });
        };
        let all = *size;
        if rows.is_empty() || rows.end > all {
            return Err(Error::Rows { first: rows.start, end: rows.end, rows: all });
        }
        let (before, after) = (rows.start.checked_sub(reach), rows.end.saturating_add(reach));
        let (mut head, mut tail) = (0, before.unwrap_or(0)..after.min(all));
        match *side {
            Sides::Open(first, last) => {
                let there = |is_there: bool, side: Side| if is_there { side } else { Side::Free };
                *side = Sides::Open(there(tail.start == 0, first), there(tail.end == all, last));
            }
            Sides::Periodic => {
                let missing = reach.saturating_sub(rows.start);
                let beyond = after.saturating_sub(all);
                if rows.len().saturating_add(reach).saturating_add(reach) >= all {
                    tail = 0..all;
                } else if missing > 0 {
                    (head, tail) = (tail.end, all - missing..all);
                } else if beyond > 0 {
                    head = beyond;
                }
                if head == 0 && tail != (0..all) {
                    *side = Sides::Open(Side::Free, Side::Free);
                }
            }
        }
        *size = head + tail.len();
        let local = Grid::new(sizes).spacing(*grid.spacings()).sides(sides);
        let mut slab = Self { grid, rows, reach, head, tail, local, own: 0..0 };
        let start = slab.row(slab.rows.start).map_or(0, |row| row.start);
        slab.own = start..start + slab.rows.len() * slab.local.row();
        Ok(slab)
    }

    getters! {
        /// The grid of all rows.
        ref grid: Grid<T, D>;
    }

    /// The rows of the grid that are moved here.
    pub fn rows(&self) -> Range<usize> {
        self.rows.clone()
    }

    /// The number of all sites here, with those of neighbours.
    pub fn sites(&self) -> usize {
        self.local.sites()
    }

    /// The sites that are moved here.
    pub fn own(&self) -> Range<usize> {
        self.own.clone()
    }

    /// The place of a site in the grid; `None` if there is none of this number here.
    pub fn place(&self, site: usize) -> Option<[usize; D]> {
        let mut place = self.local.place(site)?;
        if let Some(row) = place.first_mut()
            && *row >= self.head
        {
            *row = *row - self.head + self.tail.start;
        }
        Some(place)
    }

    /// The sites here of a row of the grid; `None` if it is not here.
    pub fn row(&self, row: usize) -> Option<Range<usize>> {
        let local = if row < self.head {
            row
        } else if self.tail.contains(&row) {
            row - self.tail.start + self.head
        } else {
            return None;
        };
        let length = self.local.row();
        Some(local * length..(local + 1) * length)
    }

    /// The rows of the grid before those of this slab, so far as forces reach, in their order. Beyond an open side there is none.
    pub fn rows_before(&self) -> impl Iterator<Item = usize> + use<T, D> {
        let (start, all, is_ring) = (self.rows.start, self.all_rows(), self.is_ring());
        (1..=self.reach).rev().filter_map(move |distance| {
            start.checked_sub(distance).or_else(|| if is_ring { (start + all).checked_sub(distance) } else { None })
        })
    }

    /// The rows of the grid after those of this slab, so far as forces reach, in their order. Beyond an open side there is none.
    pub fn rows_after(&self) -> impl Iterator<Item = usize> + use<T, D> {
        let (end, all, is_ring) = (self.rows.end, self.all_rows(), self.is_ring());
        (end..end.saturating_add(self.reach)).filter_map(move |row| {
            if row < all {
                Some(row)
            } else if is_ring {
                row.checked_sub(all)
            } else {
                None
            }
        })
    }

    /// The number of rows of the grid.
    fn all_rows(&self) -> usize {
        self.grid.sizes().first().copied().unwrap_or(0)
    }

    /// Whether the last row of the grid is the neighbour before the first one.
    fn is_ring(&self) -> bool {
        self.grid.all_sides().first() == Some(&Sides::Periodic)
    }
}

impl<S: Field<D>, const D: usize> Lattice<S> for Slab<T<S>, D> {
    fn sites(&self) -> usize {
        Slab::sites(self)
    }

    fn own(&self) -> Range<usize> {
        Slab::own(self)
    }

    fn is_fixed(&self, site: usize) -> bool {
        !self.own.contains(&site) || self.local.is_fixed(site)
    }

    fn has_fixed(&self) -> bool {
        Grid::has_fixed(&self.local)
    }

    fn check(&self) -> Result<(), Error> {
        Grid::check(&self.local)
    }

    fn kick<'s>(
        &self,
        site: (impl Fn(usize) -> &'s S + Copy, bool),
        at: (T<S>, T<S>),
        q: &[Q<S>],
        mu: (usize, &mut [Mu<S>]),
    ) where
        S: 's,
    {
        self.local.kick(site, at, q, mu);
    }

    fn row_length(&self) -> usize {
        self.local.row()
    }

    fn energy<'s>(&self, site: impl Fn(usize) -> &'s S + Copy, q: &[Q<S>], starts: Range<usize>) -> T<S>
    where
        S: 's,
    {
        self.local.energy(site, q, starts)
    }

    fn visit_edges(&self, site: usize, visit: impl FnMut(Edge, usize)) {
        self.local.visit_edges(site, visit);
    }

    fn energy_of_edge(&self, system: &S, edge: Edge, q: [&Q<S>; 2]) -> T<S> {
        self.local.energy_of_edge(system, edge, q)
    }

    fn forces(&self, system: &S, edge: Edge, q: [&Q<S>; 2]) -> (Mu<S>, Mu<S>) {
        self.local.forces(system, edge, q)
    }

    fn forces_along(&self, system: &S, edge: Edge, q: [&Q<S>; 2], motions: [&Mu<S>; 2]) -> (Mu<S>, Mu<S>) {
        self.local.forces_along(system, edge, q, motions)
    }
}

impl<S: Field<D> + Clone, P: Population, const D: usize> Domain<S, Grid<T<S>, D>, P> {
    /// Some rows of this field by themselves, as on one of many machines. See [`Slab`].
    ///
    /// # Errors
    /// [`Error::Rows`] for no row, or for rows that are not there; [`Error::EmptyGrid`] and [`Error::Spacing`].
    pub fn slab(&self, rows: Range<usize>) -> Result<Domain<S, Slab<T<S>, D>, P>, Error> {
        let slab = Slab::new(*self.lattice(), rows, S::REACH)?;
        let number = |site| slab.place(site).and_then(|place| self.lattice().index(place));
        let systems = P::some(self.systems(), (0..slab.sites()).filter_map(number));
        Ok(Domain::of(systems, slab))
    }
}

#[cfg(feature = "alloc")]
impl<S: Field<D> + Clone, const D: usize> Domain<S, Slab<T<S>, D>> {
    /// The same with parameters for each site by its place in the grid. The energy of an edge has those of the site at its start.
    ///
    /// Sites of neighbours have parameters here too.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Field};
    /// # use nalgebra::Vector1;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action = |a: Translation<1>, x: Vector1| x + a,
    /// #     cost   = |h, a| self.mass * a.norm_squared() / (2 * h),
    /// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx),
    /// # )]
    /// # struct Beads { mass: f64 }
    /// let part = Beads { mass: 1.0 }.grid([10]).slab(5..10)?.various(|[i]| Beads { mass: 1.0 + i as f64 });
    /// assert_eq!(part.system(0).map(|bead| bead.mass), Some(5.0)); // row 4, the neighbour before row 5
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    pub fn various(self, mut site: impl FnMut([usize; D]) -> S) -> Domain<S, Slab<T<S>, D>, super::Various> {
        let places = (0..self.lattice().sites()).filter_map(|number| self.lattice().place(number));
        Domain::of(places.map(&mut site).collect(), self.lattice().clone())
    }
}
