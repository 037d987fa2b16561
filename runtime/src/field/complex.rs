//! Lattices with numbered edges and faces.

use super::edges::Edge;
use super::{Field, FieldSite, Grid, Lattice, Mesh};
use crate::Clebsch;
use alloc::vec::Vec;

/// An edge on a path: its number, and whether the path runs along it from its start to its end.
pub(super) type Passed = (usize, bool);

/// A lattice whose edges and faces have numbers: a [`Grid`] or a [`Mesh`].
///
/// The edge of a grid that starts at a site has the number D times that of the site, plus its direction. An edge that is not there, at
/// a side, has a number too. Faces of a grid are its squares. Edges and faces of a mesh are in the order of [`Mesh::edges`] and
/// [`Mesh::faces`].
///
/// ```
/// # use clebsch::{Clebsch, Field};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |F: SO<3>, R: SO<3>| R * F,
/// #     space  = [|dx, W| (W - I).norm_squared() / (4 * dx), |dy, W| (W - I).norm_squared() / (4 * dy)],
/// #     emit   = [connection],
/// # )]
/// # struct Sheet;
/// let sheet = Sheet.grid([3, 4]);
/// assert_eq!(sheet.edge_numbers(), 2 * 12);
/// assert_eq!(sheet.edge_between(1, 2), Some((2 * 1 + 1, true)));
/// assert_eq!(sheet.edge_between(4, 0), Some((0, false)));
/// ```
pub trait CellComplex<S: FieldSite>: Lattice<S> {
    /// How many numbers edges have.
    #[doc(hidden)]
    fn edge_numbers(&self) -> usize;

    /// The number of an edge.
    #[doc(hidden)]
    fn number(&self, edge: &Edge) -> usize;

    /// Visits the edges around each face.
    #[doc(hidden)]
    fn visit_faces(&self, visit: impl FnMut(&[Passed]));

    /// The edge from a site to another by its number, and whether it starts at the first; the first one if there are several.
    #[doc(hidden)]
    fn edge_between(&self, from: usize, to: usize) -> Option<(usize, bool)> {
        let mut found = None;
        if from < self.sites() {
            self.visit_edges(from, |edge, end| {
                if edge.ends[1 - end] == to && found.is_none() {
                    found = Some((self.number(&edge), end == 0));
                }
            });
        }
        found
    }
}

impl<S: Field<D>, const D: usize> CellComplex<S> for Grid<<S as Clebsch>::Scalar, D> {
    fn edge_numbers(&self) -> usize {
        Grid::sites(self).saturating_mul(D)
    }

    fn number(&self, edge: &Edge) -> usize {
        edge.ends[0] * D + edge.direction
    }

    fn visit_faces(&self, mut visit: impl FnMut(&[Passed])) {
        let next = |site: usize, d: usize| self.around(site, &self.split(site), d)[1];
        for site in 0..Grid::sites(self) {
            for (i, j) in (0..D).flat_map(|i| (i + 1..D).map(move |j| (i, j))) {
                let (Some(along), Some(across)) = (next(site, i), next(site, j)) else { continue };
                let number = |site: usize, d: usize| site * D + d;
                visit(&[
                    (number(site, i), true),
                    (number(along, j), true),
                    (number(across, i), false),
                    (number(site, j), false),
                ]);
            }
        }
    }
}

impl<S: Field<1>> CellComplex<S> for Mesh<<S as Clebsch>::Scalar> {
    fn edge_numbers(&self) -> usize {
        self.edges().count()
    }

    fn number(&self, edge: &Edge) -> usize {
        edge.number
    }

    fn visit_faces(&self, mut visit: impl FnMut(&[Passed])) {
        let mut sides = Vec::new();
        for corners in self.faces() {
            let next = corners.iter().cycle().skip(1);
            sides.clear();
            sides.extend(
                corners.iter().zip(next).filter_map(|(from, to)| CellComplex::<S>::edge_between(self, *from, *to)),
            );
            visit(&sides);
        }
    }
}
