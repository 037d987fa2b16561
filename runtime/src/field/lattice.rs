//! Lattices: which sites there are, and which edges join them.

use super::FieldSite;
use super::edges::Edge;
use crate::parts::{Mu, Q, T};
use crate::space::plus;
use crate::{Error, Scalar, Space};
use core::ops::Range;
use num_traits::{One, Zero};

/// The places of the sites of a field, and the edges between them: a [`Grid`](crate::Grid), or a mesh.
///
/// ```
/// # use clebsch::{Clebsch, Grid, Lattice};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     cost   = |h, a| a.norm_squared() / (2 * h),
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// # )]
/// # struct Strand;
/// fn sites<G: Lattice<Strand>>(lattice: &G) -> usize {
///     lattice.sites()
/// }
///
/// assert_eq!(sites(&Grid::new([12])), 12);
/// ```
pub trait Lattice<S: FieldSite>: Clone {
    /// The number of sites.
    fn sites(&self) -> usize;

    /// Whether a site does not move.
    fn is_fixed(&self, site: usize) -> bool;

    /// Whether any site does not move.
    fn has_fixed(&self) -> bool;

    /// Whether this can be the lattice of a field.
    ///
    /// # Errors
    /// [`Error::EmptyGrid`] or [`Error::Spacing`].
    fn check(&self) -> Result<(), Error>;

    /// The sites that are moved here: all of them as provided.
    #[doc(hidden)]
    fn own(&self) -> Range<usize> {
        0..self.sites()
    }

    /// The number of sites in a row. Sums are added row by row.
    #[doc(hidden)]
    fn row_length(&self) -> usize {
        RUN
    }

    /// The number of sites in a row, if forces on a row read no rows but those next to it. The first and the last row are neighbours.
    /// Forces on a part of the sites then cost no more than their part. `None` as provided.
    #[doc(hidden)]
    fn rows_of_neighbours(&self, _are_alike: bool) -> Option<usize> {
        None
    }

    /// How many sites of the declaration a site stands for: its potential is multiplied by it. 1 as provided.
    #[doc(hidden)]
    fn share(&self, _site: usize) -> T<S> {
        T::<S>::one()
    }

    /// Adds the forces at a time, times a weight, to the momenta of the sites from a number on. `site` gives the parameters of a
    /// site, which may be alike.
    #[doc(hidden)]
    fn kick<'s>(
        &self,
        (site, _): (impl Fn(usize) -> &'s S + Copy, bool),
        (t, weight): (T<S>, T<S>),
        q: &[Q<S>],
        (first, mu): (usize, &mut [Mu<S>]),
    ) where
        S: 's,
    {
        for (number, mu) in (first..).zip(mu) {
            if !self.is_fixed(number) {
                let force = self.force(site, t, q, number);
                *mu = mu.zip_map(&force, |mu, force| mu + weight * force);
            }
        }
    }

    /// The force on a site at a time: that of its potential, and those of all edges.
    #[doc(hidden)]
    fn force<'s>(&self, site: impl Fn(usize) -> &'s S + Copy, t: T<S>, q: &[Q<S>], number: usize) -> Mu<S>
    where
        S: 's,
    {
        let Some(own) = q.get(number) else { return Space::origin() };
        let mut force = Space::origin();
        if S::HAS_POTENTIAL {
            force = times::<S>(&site(number).force_on_site(t, own), self.share(number));
        }
        self.visit_edges(number, |edge, end| {
            let [from, to] = edge.ends;
            let (Some(a), Some(b)) = (q.get(from), q.get(to)) else { return };
            let (own, next) = self.forces(site(from), edge, [a, b]);
            force = plus(&force, if end == 0 { &own } else { &next });
        });
        force
    }

    /// The energy of the edges that start at some sites.
    #[doc(hidden)]
    fn energy<'s>(&self, site: impl Fn(usize) -> &'s S + Copy, q: &[Q<S>], starts: Range<usize>) -> T<S>
    where
        S: 's,
    {
        summed(starts.map(|number| {
            let mut energy = T::<S>::zero();
            self.visit_edges(number, |edge, end| {
                let [from, to] = edge.ends;
                if let (0, Some(a), Some(b)) = (end, q.get(from), q.get(to)) {
                    energy += self.energy_of_edge(site(from), edge, [a, b]);
                }
            });
            energy
        }))
    }

    /// Visits the edges at a site, each with the end that the site is: 0 or 1.
    #[doc(hidden)]
    fn visit_edges(&self, site: usize, visit: impl FnMut(Edge, usize));

    /// The energy of an edge.
    #[doc(hidden)]
    fn energy_of_edge(&self, system: &S, edge: Edge, q: [&Q<S>; 2]) -> T<S>;

    /// The forces of an edge on its ends.
    #[doc(hidden)]
    fn forces(&self, system: &S, edge: Edge, q: [&Q<S>; 2]) -> (Mu<S>, Mu<S>);

    /// The changes of these forces by small motions of the ends.
    #[doc(hidden)]
    fn forces_along(&self, system: &S, edge: Edge, q: [&Q<S>; 2], motions: [&Mu<S>; 2]) -> (Mu<S>, Mu<S>);
}

/// A force times a weight.
pub(super) fn times<S: FieldSite>(force: &Mu<S>, weight: T<S>) -> Mu<S> {
    force.zip_map(force, |force, _| weight * force)
}

/// The rows of some sites, each of so many; the last one may be shorter.
pub(super) fn rows_of(sites: Range<usize>, length: usize) -> impl Iterator<Item = Range<usize>> {
    let end = sites.end;
    sites.step_by(length.max(1)).map(move |start| start..start.saturating_add(length.max(1)).min(end))
}

/// The most numbers that are added one after the other.
const RUN: usize = 256;

/// The sum of many numbers. Runs are added by themselves first, so that less is rounded away.
#[derive(Clone, Copy)]
pub(super) struct Sum<T> {
    total: T,
    run: T,
    count: usize,
}

impl<T: Scalar> Sum<T> {
    pub(super) fn none() -> Self {
        Self { total: T::zero(), run: T::zero(), count: 0 }
    }

    pub(super) fn add(&mut self, number: T) {
        self.run += number;
        self.count += 1;
        if self.count == RUN {
            self.total += self.run;
            (self.run, self.count) = (T::zero(), 0);
        }
    }

    pub(super) fn value(&self) -> T {
        self.total + self.run
    }
}

/// The sum of many numbers, as [`Sum`].
pub(super) fn summed<T: Scalar>(numbers: impl Iterator<Item = T>) -> T {
    let mut sum = Sum::none();
    numbers.for_each(|number| sum.add(number));
    sum.value()
}
