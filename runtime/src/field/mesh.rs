//! Meshes: vertices and oriented faces, at whose edges a field has its energy.

use super::edges::Edge;
use super::lattice::times;
use super::{Field, Lattice};
use crate::parts::{Mu, Q, T};
use crate::{Error, Real, Scalar, Space};
use alloc::vec::Vec;
use nalgebra::SVector;
use num_traits::Zero;

/// The least number of corners of a face.
const CORNERS: usize = 3;

/// Vertices, and faces as lists of them in cyclic order. Its edges are those of its faces.
///
/// Neighbouring faces run through their common edge in opposite directions: the mesh is oriented. An edge starts where the first of
/// its faces enters it. Faces may have any number of corners. A vertex that no face has is a site without neighbours.
///
/// ```
/// use clebsch::{Error, Mesh};
/// use nalgebra::{Vector2, Vector3};
///
/// // the surface of a tetrahedron
/// let vertices = [Vector3::<f64>::zeros(), Vector3::x(), Vector3::y(), Vector3::z()];
/// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let mesh = Mesh::new(&vertices, &faces)?;
/// assert_eq!((mesh.sites(), mesh.edges().count(), mesh.faces().count()), (4, 6, 4));
/// assert!((0..4).all(|site| !mesh.is_border(site)));
///
/// // the second one runs through the common edge as the first does
/// let square = [Vector2::<f64>::zeros(), Vector2::x(), Vector2::y(), Vector2::new(1.0, 1.0)];
/// let refused = Mesh::new(&square, &[[0, 1, 2], [1, 2, 3]]);
/// assert_eq!(refused, Err(Error::FlippedFace { face: 1, from: 1, to: 2 }));
/// # Ok::<(), Error>(())
/// ```
///
/// Source: Marsden, Patrick and Shkoller, *Multisymplectic geometry, variational integrators, and nonlinear PDEs*,
/// Communications in Mathematical Physics 199 (1998), §5.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh<T> {
    edges: Vec<Side<T>>,
    /// The edges at each site, one after the other: their numbers, and which end the site is.
    at: Vec<(usize, usize)>,
    /// Where those of each site start, and where the last ones end.
    starts: Vec<usize>,
    /// The corners of all faces, one face after the other.
    corners: Vec<usize>,
    /// Where each face ends.
    ends: Vec<usize>,
    sites: Vec<Site<T>>,
}

/// An edge of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side<T> {
    ends: [usize; 2],
    length: T,
    weight: T,
    /// ½ (cot α + cot β) of the angles opposite to it.
    cotangent: T,
    is_border: bool,
}

/// A vertex of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Site<T> {
    is_border: bool,
    is_fixed: bool,
    /// Its share of the areas of the faces around it.
    area: T,
}

/// A side of a face: its direction, and the angle opposite to it.
struct Seen<T> {
    ends: [usize; 2],
    face: usize,
    cotangent: T,
}

impl<T: Real> Mesh<T> {
    /// The mesh of these vertices and faces, with all edges of weight 1. `vertices` are places in a space of any dimension. The
    /// length of an edge is the distance of its ends.
    ///
    /// # Errors
    /// [`Error::FaceCorner`], [`Error::FaceSize`], [`Error::FlippedFace`] or [`Error::EdgeLength`].
    pub fn new<const K: usize>(vertices: &[SVector<T, K>], faces: &[impl AsRef<[usize]>]) -> Result<Self, Error> {
        let site = Site { is_border: false, is_fixed: false, area: T::zero() };
        let mut mesh = Self {
            edges: Vec::new(),
            at: Vec::new(),
            starts: Vec::new(),
            corners: Vec::new(),
            ends: Vec::new(),
            sites: alloc::vec![site; vertices.len()],
        };
        let mut seen = Vec::new();
        for (face, corners) in faces.iter().map(AsRef::as_ref).enumerate() {
            check_face(face, corners, vertices.len())?;
            mesh.add_face(face, corners, vertices, &mut seen);
        }
        mesh.join(seen, vertices)?;
        mesh.link();
        Ok(mesh)
    }

    /// Adds a face: its corners, its area and its sides.
    fn add_face<const K: usize>(
        &mut self,
        face: usize,
        corners: &[usize],
        vertices: &[SVector<T, K>],
        seen: &mut Vec<Seen<T>>,
    ) {
        self.corners.extend_from_slice(corners);
        self.ends.push(self.corners.len());
        let vertex = |k: usize| {
            let corner = corners.get(k % corners.len()).copied().unwrap_or(0);
            (corner, vertices.get(corner).copied().unwrap_or_else(SVector::zeros))
        };
        let number = T::from_ratio(corners.len() as i64, 1);
        let center = (0..corners.len()).fold(SVector::<T, K>::zeros(), |sum, k| sum + vertex(k).1) / number;
        let mut area = T::zero();
        for k in 0..corners.len() {
            let ((from, a), (to, b)) = (vertex(k), vertex(k + 1));
            area += twice_area(&(a - center), &(b - center)) / T::from_ratio(2, 1);
            let opposite = vertex(k + 2).1;
            let (u, v) = (a - opposite, b - opposite);
            let cotangent = if corners.len() == CORNERS { u.dot(&v) / twice_area(&u, &v) } else { T::zero() };
            seen.push(Seen { ends: [from, to], face, cotangent: cotangent / T::from_ratio(2, 1) });
        }
        for corner in corners {
            if let Some(site) = self.sites.get_mut(*corner) {
                site.area += area / number;
            }
        }
    }

    /// Makes edges of the sides of faces: two of opposite directions, or one on the border.
    fn join<const K: usize>(&mut self, mut seen: Vec<Seen<T>>, vertices: &[SVector<T, K>]) -> Result<(), Error> {
        // sides between the same vertices follow each other, the first one first
        seen.sort_by_key(|side| (side.ends.iter().min().copied(), side.ends.iter().max().copied(), side.face));
        for Seen { ends, face, cotangent } in seen {
            let [from, to] = ends;
            match self.edges.last_mut() {
                Some(last) if last.ends == [to, from] && last.is_border => {
                    last.is_border = false;
                    last.cotangent += cotangent;
                }
                Some(last) if last.ends == ends || last.ends == [to, from] => {
                    return Err(Error::FlippedFace { face, from, to });
                }
                _ => {
                    let length = match (vertices.get(from), vertices.get(to)) {
                        (Some(a), Some(b)) => (b - a).dot(&(b - a)).sqrt(),
                        _ => T::zero(),
                    };
                    if !(length.is_finite() && length > T::zero()) {
                        return Err(Error::EdgeLength { from, to, value: length.to_f64() });
                    }
                    self.edges.push(Side { ends, length, weight: T::one(), cotangent, is_border: true });
                }
            }
        }
        Ok(())
    }

    /// Finds the edges at each site.
    fn link(&mut self) {
        let mut at: Vec<(usize, (usize, usize))> = Vec::with_capacity(2 * self.edges.len());
        for (number, side) in self.edges.iter().enumerate() {
            for (end, site) in side.ends.into_iter().enumerate() {
                at.push((site, (number, end)));
                if let Some(site) = self.sites.get_mut(site) {
                    site.is_border |= side.is_border;
                }
            }
        }
        at.sort_by_key(|(site, _)| *site);
        self.starts = (0..=self.sites.len()).map(|site| at.partition_point(|(other, _)| *other < site)).collect();
        self.at = at.into_iter().map(|(_, edge)| edge).collect();
    }
}

impl<T: Scalar> Mesh<T> {
    /// The number of vertices.
    #[inline]
    pub fn sites(&self) -> usize {
        self.sites.len()
    }

    /// The edges, each by the sites that it starts from and ends at.
    pub fn edges(&self) -> impl Iterator<Item = [usize; 2]> {
        self.edges.iter().map(|side| side.ends)
    }

    /// The faces, each by its corners in cyclic order.
    pub fn faces(&self) -> impl Iterator<Item = &[usize]> {
        let starts = core::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, end)| self.corners.get(start..*end).unwrap_or_default())
    }

    /// Whether a site is at an edge that belongs to one face alone.
    pub fn is_border(&self, site: usize) -> bool {
        self.sites.get(site).is_some_and(|site| site.is_border)
    }

    /// Whether a site does not move.
    pub fn is_fixed(&self, site: usize) -> bool {
        self.sites.get(site).is_some_and(|site| site.is_fixed)
    }

    /// The share of a site of the areas of the faces around it: an equal part of each for all of its corners. 0 if there is none of
    /// this number.
    pub fn area(&self, site: usize) -> T {
        self.sites.get(site).map_or_else(T::zero, |site| site.area)
    }

    /// The same with fixed sites where `is_fixed` says so, and no others.
    #[must_use]
    pub fn fixed_where(mut self, mut is_fixed: impl FnMut(usize) -> bool) -> Self {
        self.sites.iter_mut().enumerate().for_each(|(number, site)| site.is_fixed = is_fixed(number));
        self
    }

    /// The same with a weight for each edge by its ends: its energy and its forces are multiplied by it.
    #[must_use]
    pub fn weights(mut self, mut weight: impl FnMut([usize; 2]) -> T) -> Self {
        self.edges.iter_mut().for_each(|side| side.weight = weight(side.ends));
        self
    }

    /// The same with the weights ½ (cot α + cot β) of the angles opposite to an edge: those of linear finite elements.
    ///
    /// ```
    /// use clebsch::Mesh;
    /// use nalgebra::Vector2;
    ///
    /// // a square of two triangles: its diagonal is opposite to right angles
    /// let corners = [Vector2::zeros(), Vector2::x(), Vector2::new(1.0, 1.0), Vector2::y()];
    /// let mesh = Mesh::new(&corners, &[[0, 1, 2], [0, 2, 3]])?.cotangent_weights()?;
    /// assert!((mesh.weight([0, 2])? - 0.0_f64).abs() < 1e-15);
    /// assert!((mesh.weight([1, 0])? - 0.5).abs() < 1e-15);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// Source: Pinkall and Polthier, *Computing discrete minimal surfaces and their conjugates*, Experimental Mathematics 2 (1993).
    ///
    /// # Errors
    /// [`Error::FaceSize`] for a face that is no triangle.
    pub fn cotangent_weights(mut self) -> Result<Self, Error> {
        let wrong = self.faces().enumerate().find(|(_, corners)| corners.len() != CORNERS);
        if let Some((face, corners)) = wrong {
            return Err(Error::FaceSize { face, corners: corners.len() });
        }
        self.edges.iter_mut().for_each(|side| side.weight = side.cotangent);
        Ok(self)
    }

    /// The weight of the edge between two sites, in either direction.
    ///
    /// # Errors
    /// [`Error::NoEdge`] if there is none.
    pub fn weight(&self, [from, to]: [usize; 2]) -> Result<T, Error> {
        let is_it = |side: &&Side<T>| side.ends == [from, to] || side.ends == [to, from];
        self.edges.iter().find(is_it).map(|side| side.weight).ok_or(Error::NoEdge { from, to })
    }

    /// The edges at a site by their numbers, with the end that it is.
    #[inline]
    fn edges_at(&self, site: usize) -> &[(usize, usize)] {
        let bound = |number: usize| self.starts.get(number).copied();
        let all = bound(site).zip(bound(site + 1)).and_then(|(start, end)| self.at.get(start..end));
        all.unwrap_or_default()
    }
}

/// The face has so many vertices, all of them known and no two the same.
fn check_face(face: usize, corners: &[usize], vertices: usize) -> Result<(), Error> {
    if let Some(&vertex) = corners.iter().find(|vertex| **vertex >= vertices) {
        return Err(Error::FaceCorner { face, vertex, vertices });
    }
    let is_new = |(k, vertex): (usize, &usize)| !corners.iter().take(k).any(|other| other == vertex);
    let different = corners.iter().enumerate().filter(|corner| is_new(*corner)).count();
    if different < CORNERS || different < corners.len() {
        return Err(Error::FaceSize { face, corners: different });
    }
    Ok(())
}

/// |u × v| in a space of any dimension.
fn twice_area<T: Real, const K: usize>(u: &SVector<T, K>, v: &SVector<T, K>) -> T {
    let (uu, vv, uv) = (u.dot(u), v.dot(v), u.dot(v));
    let squared = uu * vv - uv * uv;
    if squared > T::zero() { squared.sqrt() } else { T::zero() }
}

impl<S: Field<1>> Lattice<S> for Mesh<T<S>> {
    fn sites(&self) -> usize {
        Mesh::sites(self)
    }

    fn is_fixed(&self, site: usize) -> bool {
        Mesh::is_fixed(self, site)
    }

    fn has_fixed(&self) -> bool {
        self.sites.iter().any(|site| site.is_fixed)
    }

    fn check(&self) -> Result<(), Error> {
        if self.sites.is_empty() {
            return Err(Error::EmptyGrid { direction: 0, sites: 0 });
        }
        for Side { ends: [from, to], weight, .. } in &self.edges {
            if !Space::<T<S>>::all_finite(weight) {
                return Err(Error::EdgeWeight { from: *from, to: *to, value: weight.lane(0).to_f64() });
            }
        }
        Ok(())
    }

    fn visit_edges(&self, site: usize, mut visit: impl FnMut(Edge, usize)) {
        for &(number, end) in self.edges_at(site) {
            if let Some(side) = self.edges.get(number) {
                visit(Edge { direction: 0, ends: side.ends, number }, end);
            }
        }
    }

    fn energy_of_edge(&self, system: &S, edge: Edge, [q, next]: [&Q<S>; 2]) -> T<S> {
        let Some(Side { length, weight, .. }) = self.edges.get(edge.number) else { return T::<S>::zero() };
        *weight * system.edge_energy(0, &[*length], q, next)
    }

    fn forces(&self, system: &S, edge: Edge, [q, next]: [&Q<S>; 2]) -> (Mu<S>, Mu<S>) {
        let Some(Side { length, weight, .. }) = self.edges.get(edge.number) else {
            return (Space::origin(), Space::origin());
        };
        scaled::<S>(system.edge_forces(0, &[*length], q, next), *weight)
    }

    fn forces_along(
        &self,
        system: &S,
        edge: Edge,
        [q, next]: [&Q<S>; 2],
        [motion, next_motion]: [&Mu<S>; 2],
    ) -> (Mu<S>, Mu<S>) {
        let Some(Side { length, weight, .. }) = self.edges.get(edge.number) else {
            return (Space::origin(), Space::origin());
        };
        scaled::<S>(system.edge_forces_along(0, &[*length], q, next, motion, next_motion), *weight)
    }
}

/// Both forces times the weight of their edge.
fn scaled<S: Field<1>>((own, next): (Mu<S>, Mu<S>), weight: T<S>) -> (Mu<S>, Mu<S>) {
    (times::<S>(&own, weight), times::<S>(&next, weight))
}
