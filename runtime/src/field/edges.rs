//! The edges at a site, one by one.

use super::{FieldSite, Grid, Lattice, Population};
use crate::parts::Q;
use crate::{Clebsch, Scalar};
use core::marker::PhantomData;

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

/// The sites of a field: their parameters, their places and their configurations.
pub(super) struct Configured<'a, S: Clebsch, G, P> {
    pub systems: &'a [S],
    pub lattice: &'a G,
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
