//! Coarse grids: some of the rows of a grid, with edges as long as the way between them.

use crate::field::edges::Edge;
use crate::field::lattice::times;
use crate::field::{Field, Grid, Lattice, Side, Sides};
use crate::parts::{Mu, Q, T};
use crate::{Error, Scalar};
use alloc::vec::Vec;

/// The rows of a grid in one direction, in units of those of the finest grid.
#[derive(Clone)]
struct Rows<T> {
    /// The length of the edge from each row to the next one.
    lengths: Vec<T>,
    /// How many rows each stands for.
    shares: Vec<T>,
}

/// A place between two rows of a coarser grid: their numbers, and the weights of linear interpolation.
pub(super) type Between<T> = [(usize, T); 2];

/// A grid whose edges have lengths of their own.
///
/// The edges of a coarse grid are fewer than those of the finest one. Each stands for as many as lie side by side, and its energy is
/// multiplied by their number. So does each site for its potential. These numbers are the sums of the weights of interpolation.
#[derive(Clone)]
pub(super) struct Coarse<T, const D: usize> {
    grid: Grid<T, D>,
    rows: [Rows<T>; D],
    /// The power of its length that the energy of an edge lacks, in each direction.
    powers: [i32; D],
}

impl<T: Scalar, const D: usize> Coarse<T, D> {
    /// The finest one.
    pub fn finest(grid: Grid<T, D>) -> Self {
        let ones = |size| alloc::vec![T::one(); size];
        let rows = grid.sizes().map(|size| Rows { lengths: ones(size), shares: ones(size) });
        Self { grid, rows, powers: [0; D] }
    }

    /// The same for energies of edges that grow with their length ℓ as 1/ℓ, after they are multiplied by these powers of it.
    pub fn scaled(self, powers: [i32; D]) -> Self {
        Self { powers, ..self }
    }

    pub fn grid(&self) -> &Grid<T, D> {
        &self.grid
    }

    /// Whether a coarser grid has fewer rows in a direction, and one that moves.
    pub fn can_coarsen(&self, direction: usize) -> bool {
        let (size, sides) = (self.grid.sizes()[direction], self.grid.all_sides()[direction]);
        let rows = chosen(size, sides).len();
        let fixed = match sides {
            Sides::Periodic => 0,
            Sides::Open(first, last) => [first, last].iter().filter(|side| **side == Side::Fixed).count(),
        };
        fixed < rows && rows < size
    }

    /// The grid with every second row of some directions, and the place of each row between those of the coarser one.
    pub fn coarser(&self, coarsens: [bool; D]) -> (Self, [Vec<Between<T>>; D]) {
        let mut coarse = self.clone();
        let mut sizes = self.grid.sizes();
        let places = core::array::from_fn(|d| {
            if !coarsens[d] {
                return (0..sizes[d]).map(|row| [(row, T::one()), (row, T::zero())]).collect();
            }
            let sides = self.grid.all_sides()[d];
            let rows = chosen(sizes[d], sides);
            let goes_on = sides == Sides::Periodic || rows.len() == 1;
            let (rows, places) = self.rows[d].coarser(&rows, goes_on);
            sizes[d] = rows.shares.len();
            coarse.rows[d] = rows;
            places
        });
        coarse.grid = Grid::new(sizes).spacing(*self.grid.spacings()).sides(*self.grid.all_sides());
        (coarse, places)
    }

    /// How many rows of the directions but one a place stands for.
    fn share_across(&self, place: &[usize; D], but: Option<usize>) -> T {
        let share = |d: usize| self.rows[d].shares.get(place[d]).copied().unwrap_or(T::one());
        (0..D).filter(|d| Some(*d) != but).fold(T::one(), |product, d| product * share(d))
    }

    /// The spacings of an edge, and its weight.
    fn edge(&self, Edge { direction, ends: [site, _], .. }: Edge) -> ([T; D], T) {
        let place = self.grid.split(site);
        let mut spacing = *self.grid.spacings();
        let length = self.rows[direction].lengths.get(place[direction]).copied().unwrap_or(T::one());
        spacing[direction] *= length;
        (spacing, self.share_across(&place, Some(direction)) * length.powi(self.powers[direction]))
    }
}

/// Every second row, and the last one of a grid that ends. Two free rows become one.
fn chosen(size: usize, sides: Sides) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..size).step_by(2).collect();
    let is_pair = size == 2 && sides == Sides::Open(Side::Free, Side::Free);
    if sides != Sides::Periodic && size > 0 && size.is_multiple_of(2) && !is_pair {
        rows.push(size - 1);
    }
    rows
}

impl<T: Scalar> Rows<T> {
    /// Those that are chosen, and each row between two of them. Behind the last one there may be rows that belong to it.
    fn coarser(&self, chosen: &[usize], goes_on: bool) -> (Self, Vec<Between<T>>) {
        let (size, count) = (self.shares.len(), chosen.len());
        let mut coarse = Self { lengths: Vec::with_capacity(count), shares: alloc::vec![T::zero(); count] };
        let mut places = Vec::with_capacity(size);
        for (number, &row) in chosen.iter().enumerate() {
            let end = chosen.get(number + 1).copied().unwrap_or(if goes_on { size } else { row + 1 });
            let inside = self.lengths.get(row..end).unwrap_or_default();
            let length = inside.iter().fold(T::zero(), |sum, length| sum + *length);
            coarse.lengths.push(length);
            let (next, mut passed) = ((number + 1) % count, T::zero());
            for own in inside {
                let part = passed / length;
                places.push([(number, T::one() - part), (next, part)]);
                passed += *own;
            }
        }
        for (share, between) in self.shares.iter().zip(&places) {
            for (number, weight) in between {
                if let Some(sum) = coarse.shares.get_mut(*number) {
                    *sum += *weight * *share;
                }
            }
        }
        (coarse, places)
    }
}

impl<S: Field<D>, const D: usize> Lattice<S> for Coarse<T<S>, D> {
    fn sites(&self) -> usize {
        self.grid.sites()
    }

    fn is_fixed(&self, site: usize) -> bool {
        self.grid.is_fixed(site)
    }

    fn has_fixed(&self) -> bool {
        self.grid.has_fixed()
    }

    fn check(&self) -> Result<(), Error> {
        self.grid.check()
    }

    fn share(&self, site: usize) -> T<S> {
        self.share_across(&self.grid.split(site), None)
    }

    fn visit_edges(&self, site: usize, visit: impl FnMut(Edge, usize)) {
        self.grid.visit_edges(site, visit);
    }

    fn energy_of_edge(&self, system: &S, edge: Edge, [q, next]: [&Q<S>; 2]) -> T<S> {
        let (spacing, weight) = self.edge(edge);
        weight * system.edge_energy(edge.direction, &spacing, q, next)
    }

    fn forces(&self, system: &S, edge: Edge, [q, next]: [&Q<S>; 2]) -> (Mu<S>, Mu<S>) {
        let (spacing, weight) = self.edge(edge);
        let (own, other) = system.edge_forces(edge.direction, &spacing, q, next);
        (times::<S>(&own, weight), times::<S>(&other, weight))
    }

    fn forces_along(
        &self,
        system: &S,
        edge: Edge,
        [q, next]: [&Q<S>; 2],
        [motion, next_motion]: [&Mu<S>; 2],
    ) -> (Mu<S>, Mu<S>) {
        let (spacing, weight) = self.edge(edge);
        let (own, other) = system.edge_forces_along(edge.direction, &spacing, q, next, motion, next_motion);
        (times::<S>(&own, weight), times::<S>(&other, weight))
    }
}
