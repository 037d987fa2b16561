//! The edges at a site, one by one.

use super::lattice::{rows_of, summed};
use super::{FieldSite, Grid, Lattice, Population};
use crate::parts::{Mu, Q, T};
use crate::space::plus;
use crate::stepper::check_on_orbit;
use crate::{Clebsch, Error, Scalar, SiteError, Space};
use core::marker::PhantomData;
use core::ops::Range;
use num_traits::Zero;

/// An edge of a lattice: its direction, and the numbers of the sites at its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// From 0 on.
    pub direction: usize,
    /// The site that it starts from, and the neighbour that it ends at.
    pub ends: [usize; 2],
    /// Its number in a mesh; 0 in a grid.
    pub number: usize,
}

/// The sites of a field: their parameters, their places, and loads on them.
pub(super) struct Placed<'a, S: Clebsch, G, P> {
    pub systems: &'a [S],
    pub lattice: &'a G,
    /// A force on each site that does not depend on its configuration.
    pub load: Option<&'a [Mu<S>]>,
    pub population: PhantomData<P>,
}

impl<S: Clebsch, G, P> Placed<'_, S, G, P> {
    /// The sites with their configurations.
    pub fn at<'b>(&'b self, q: &'b [Q<S>]) -> Configured<'b, S, G, P> {
        let Placed { systems, lattice, load, population } = *self;
        Configured { systems, lattice, load, q, population }
    }
}

/// The sites of a field with their configurations.
pub(super) struct Configured<'a, S: Clebsch, G, P> {
    pub systems: &'a [S],
    pub lattice: &'a G,
    pub load: Option<&'a [Mu<S>]>,
    pub q: &'a [Q<S>],
    pub population: PhantomData<P>,
}

impl<'a, S: FieldSite, G: Lattice<S>, P: Population> Configured<'a, S, G, P> {
    /// The parameters and the configuration of a site.
    pub fn site(&self, site: usize) -> Option<(&'a S, &'a Q<S>)> {
        Some((self.systems.get(P::number(site))?, self.q.get(site)?))
    }

    /// The parameters of an edge, those of the site that it starts from, and the configurations at its ends.
    pub fn ends(&self, Edge { ends: [site, next], .. }: Edge) -> Option<(&'a S, [&'a Q<S>; 2])> {
        let (system, q) = self.site(site)?;
        Some((system, [q, self.q.get(next)?]))
    }
}

impl<S, G, P: Population> Configured<'_, S, G, P>
where
    S: FieldSite,
    G: Lattice<S>,
{
    /// There is a configuration for each site, and it is one.
    pub(super) fn check_sites(&self) -> Result<(), SiteError> {
        let (found, sites) = (self.q.len(), self.lattice.sites());
        if found != sites {
            return Err(Error::NumberOfSites { found, sites }.into());
        }
        for site in 0..sites {
            let Some((system, q)) = self.site(site) else { continue };
            check_on_orbit(q, system.orbit_defect(q)).map_err(|error| SiteError { site: Some(site), error })?;
        }
        Ok(())
    }

    /// The force on a site at the time 0: of its potential, of all edges, and its load.
    pub(super) fn force_at(&self, site: usize) -> Mu<S> {
        let Some(first) = self.systems.first() else { return Space::origin() };
        let system = |site| self.systems.get(P::number(site)).unwrap_or(first);
        let force = self.lattice.force(system, T::<S>::zero(), self.q, site);
        self.load.and_then(|load| load.get(site)).map_or(force, |load| plus(&force, load))
    }

    /// The energy of all sites and edges at a time, in joules. Loads have none.
    pub(super) fn energy(&self, t: T<S>) -> T<S> {
        summed(rows_of(self.lattice.own(), self.lattice.row_length()).map(|row| self.energy_of(t, row)))
    }

    /// The energy of some sites, and of the edges that start there.
    pub(super) fn energy_of(&self, t: T<S>, row: Range<usize>) -> T<S> {
        let Some(first) = self.systems.first() else { return T::<S>::zero() };
        let potential = |site| self.site(site).map_or_else(T::<S>::zero, |(system, q)| system.potential(t, q));
        let sites = row.clone().map(|site| self.lattice.share(site) * potential(site));
        summed(sites) + self.lattice.energy(|site| self.systems.get(P::number(site)).unwrap_or(first), self.q, row)
    }

    /// The energy of a site and of its edges, if it stood at `q`. Behind it is the sum of the sizes of all terms, which tells its rounding.
    pub(super) fn energy_at(&self, site: usize, q: &Q<S>) -> (T<S>, T<S>) {
        let Some((system, _)) = self.site(site) else { return (T::<S>::zero(), T::<S>::zero()) };
        let mut energy = self.lattice.share(site) * system.potential(T::<S>::zero(), q);
        let mut size = energy.abs();
        self.lattice.visit_edges(site, |edge, end| {
            let Some((system, mut ends)) = self.ends(edge) else { return };
            // an edge from the site to itself is visited for each end
            let is_own = edge.ends == [site; 2];
            if is_own && end == 1 {
                return;
            }
            for (place, number) in ends.iter_mut().zip(edge.ends) {
                if number == site {
                    *place = q;
                }
            }
            let own = self.lattice.energy_of_edge(system, edge, ends);
            energy += own;
            size += own.abs();
        });
        (energy, size)
    }
}

impl<T: Scalar, const D: usize> Grid<T, D> {
    /// Visits the edges at a site, each with the end that the site is: 0 or 1.
    pub(super) fn visit_edges(&self, site: usize, mut visit: impl FnMut(Edge, usize)) {
        let place = self.split(site);
        for direction in 0..D {
            let [before, after] = self.around(site, &place, direction);
            if let Some(before) = before {
                visit(Edge { direction, ends: [before, site], number: 0 }, 1);
            }
            if let Some(after) = after {
                visit(Edge { direction, ends: [site, after], number: 0 }, 0);
            }
        }
    }
}
