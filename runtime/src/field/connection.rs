//! Discrete connections: the group elements of edges in place of configurations.
//!
//! A configuration q has the element W with q⁺ = Φ_W(q) at each edge. The energies of edges and the kinetic energy
//! of a motion F depend on these alone, if nothing reads q. A motion F of each site changes W of an edge from a to b:
//!
//! ```text
//! W ← F_a⁻¹ W F_b   for a right action,    W ← F_b W F_a⁻¹   for a left one
//! ```
//!
//! Source: theory of discrete connections as in Leok, Marsden and Weinstein, *A discrete theory of connections on principal bundles*
//! (2005), for trivial bundles.

mod stepper;

pub use stepper::{ConnectionState, ConnectionStepper};

use super::complex::Passed;
use super::{CellComplex, ConnectedField, Domain, Population};
use crate::parts::{Mu, Q, T};
use crate::space::{larger, plus};
use crate::{Clebsch, Error, Mask, Scalar, SiteError, Space};
use alloc::vec::Vec;
use num_traits::Zero;

/// The identity of the group.
fn identity<S: ConnectedField>() -> Q<S> {
    S::element(&Space::origin())
}

/// The largest difference of two elements.
fn distance<S: ConnectedField>(a: &Q<S>, b: &Q<S>) -> T<S> {
    a.zip_map(b, |a, b| a - b).max_abs()
}

impl<S: Clebsch + Clone, G, P: Population> Domain<S, G, P> {
    /// The elements of all edges of a configuration, by their numbers; the identity where there is no edge.
    ///
    /// ```
    /// use clebsch::{Clebsch, Field};
    /// use nalgebra::{Rotation3, Vector3};
    ///
    /// /// Rotations in a sheet.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action = |F: SO<3>, R: SO<3>| R * F,
    ///     space  = [|dx, W| (W - I).norm_squared() / (4 * dx), |dy, W| (W - I).norm_squared() / (4 * dy)],
    ///     emit   = [connection],
    /// )]
    /// struct Sheet;
    ///
    /// let sheet = Sheet.grid([3, 3]);
    /// let turn = |site: usize| Rotation3::new(Vector3::new(0.1 * site as f64, 0.2, -0.05 * (site * site) as f64)).into_inner();
    /// let q: Vec<_> = (0..9).map(turn).collect();
    /// let elements = sheet.edge_elements(&q)?;
    /// assert!(sheet.flatness(&elements)? < 1e-14);
    ///
    /// let again = sheet.reconstruct(&elements, (4, q[4]), 1e-12)?;
    /// assert!(q.iter().zip(&again).all(|(q, again)| (q - again).amax() < 1e-14));
    /// # Ok::<(), clebsch::SiteError>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NumberOfSites`]; [`Error::OffOrbit`] and [`Error::NotFinite`] with the site of a configuration.
    pub fn edge_elements(&self, q: &[Q<S>]) -> Result<Vec<Q<S>>, SiteError>
    where
        S: ConnectedField,
        G: CellComplex<S>,
    {
        let field = self.configured(q);
        field.check_sites()?;
        let mut elements = alloc::vec![identity::<S>(); self.lattice().edge_numbers()];
        for site in 0..q.len() {
            self.lattice().visit_edges(site, |edge, end| {
                let Some((system, [q, next])) = field.ends(edge).filter(|_| end == 0) else { return };
                if let Some(element) = elements.get_mut(self.lattice().number(&edge)) {
                    *element = system.edge_element(q, next);
                }
            });
        }
        Ok(elements)
    }
}

impl<S, G, P: Population> Domain<S, G, P>
where
    S: ConnectedField + Clone,
    G: CellComplex<S>,
{
    /// How many numbers edges have: see [`CellComplex`].
    pub fn edge_numbers(&self) -> usize {
        self.lattice().edge_numbers()
    }

    /// The edge from a site to another by its number, and whether it starts at the first; the first one if there are several. `None`
    /// for sites that are no neighbours.
    pub fn edge_between(&self, from: usize, to: usize) -> Option<(usize, bool)> {
        self.lattice().edge_between(from, to)
    }

    /// The product of the elements along edges that follow each other, times another element.
    fn product(&self, system: &S, elements: &[Q<S>], start: Q<S>, path: &[Passed]) -> Q<S> {
        path.iter().fold(start, |product, (number, is_forward)| {
            let Some(element) = elements.get(*number) else { return product };
            if *is_forward {
                return system.act(element, &product);
            }
            system.act(&system.edge_element(element, &identity::<S>()), &product)
        })
    }

    /// There is an element for each edge. Returns a system for their products.
    fn checked(&self, elements: &[Q<S>]) -> Result<&S, Error> {
        let (found, edges) = (elements.len(), self.lattice().edge_numbers());
        if found != edges {
            return Err(Error::NumberOfEdges { found, edges });
        }
        self.system(0).ok_or(Error::NumberOfSites { found: 0, sites: self.lattice().sites() })
    }

    /// The curvature of each face: the product Ω of the elements around it, from its first corner. It is the identity where the
    /// connection is flat.
    ///
    /// # Errors
    /// [`Error::NumberOfEdges`].
    pub fn curvature(&self, elements: &[Q<S>]) -> Result<Vec<Q<S>>, Error> {
        let system = self.checked(elements)?;
        let mut all = Vec::new();
        self.lattice().visit_faces(|path| all.push(self.product(system, elements, identity::<S>(), path)));
        Ok(all)
    }

    /// The largest entry of Ω − I of all faces: the distance from a flat connection.
    ///
    /// # Errors
    /// [`Error::NumberOfEdges`].
    pub fn flatness(&self, elements: &[Q<S>]) -> Result<T<S>, Error> {
        let curvature = self.curvature(elements)?;
        Ok(curvature.iter().fold(T::<S>::zero(), |all, own| larger(all, distance::<S>(own, &identity::<S>()))))
    }

    /// The holonomy of a closed path: the product of the elements along it, from its first site and back to it.
    ///
    /// Flat connections have the identity around every path that can be contracted. Around a hole it may be another element.
    ///
    /// ```
    /// use clebsch::{Clebsch, Field};
    /// use nalgebra::Rotation2;
    ///
    /// /// Rotations in the plane around a ring.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action = |F: SO<2>, R: SO<2>| R * F,
    ///     space  = |ds, W| (W - I).norm_squared() / (4 * ds),
    ///     emit   = [connection],
    /// )]
    /// struct Ring;
    ///
    /// let ring = Ring.grid([6]).periodic();
    /// let elements = vec![Rotation2::new(0.1).into_inner(); 6];
    /// let around = ring.holonomy(&elements, &[0, 1, 2, 3, 4, 5])?;
    /// assert!((around - Rotation2::new(0.6).into_inner()).amax() < 1e-15);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NumberOfEdges`], and [`Error::NoEdge`] between sites that are no neighbours.
    pub fn holonomy(&self, elements: &[Q<S>], path: &[usize]) -> Result<Q<S>, Error> {
        let system = self.checked(elements)?;
        let next = path.iter().cycle().skip(1);
        let side =
            |(&from, &to): (&usize, &usize)| self.lattice().edge_between(from, to).ok_or(Error::NoEdge { from, to });
        let sides = path.iter().zip(next).map(side).collect::<Result<Vec<Passed>, Error>>()?;
        Ok(self.product(system, elements, identity::<S>(), &sides))
    }

    /// The configuration with these elements and with the configuration of a site, along a tree of shortest paths from that site.
    /// Every other edge is compared with its element.
    ///
    /// # Errors
    /// * [`Error::NumberOfEdges`]; [`Error::OffOrbit`] and [`Error::NotFinite`] of the given configuration, with its site.
    /// * [`Error::NotFlat`] with the first edge whose element differs by more than `tolerance` from that of its ends. There is no such
    ///   configuration then: a face nearby has a curvature, or the way goes around a hole.
    /// * [`Error::Unreached`] with the first site that no path of edges reaches.
    pub fn reconstruct(
        &self,
        elements: &[Q<S>],
        (start, q): (usize, Q<S>),
        tolerance: T<S>,
    ) -> Result<Vec<Q<S>>, SiteError> {
        let system = self.checked(elements)?;
        let sites = self.lattice().sites();
        let at = |site, error| SiteError { site: Some(site), error };
        crate::stepper::check_on_orbit(&q, system.orbit_defect(&q)).map_err(|error| at(start, error))?;
        let (mut all, mut reached, mut queue) = (alloc::vec![q; sites], alloc::vec![false; sites], Vec::new());
        if let Some(reached) = reached.get_mut(start) {
            *reached = true;
            queue.push(start);
        }
        let mut done = 0;
        while let Some(&site) = queue.get(done) {
            done += 1;
            self.lattice().visit_edges(site, |edge, end| {
                let (from, to) = (edge.ends[end], edge.ends[1 - end]);
                let Some(own) = all.get(from).copied().filter(|_| reached.get(to) == Some(&false)) else { return };
                let next = self.product(system, elements, own, &[(self.lattice().number(&edge), end == 0)]);
                if let (Some(q), Some(reached)) = (all.get_mut(to), reached.get_mut(to)) {
                    (*q, *reached) = (next, true);
                    queue.push(to);
                }
            });
        }
        if let Some(site) = reached.iter().position(|reached| !reached) {
            return Err(at(site, Error::Unreached { site, from: start }));
        }
        self.check_elements(elements, &all, tolerance)?;
        Ok(all)
    }

    /// The elements are those of a configuration, up to a tolerance.
    fn check_elements(&self, elements: &[Q<S>], q: &[Q<S>], tolerance: T<S>) -> Result<(), SiteError> {
        let field = self.configured(q);
        let mut first = None;
        for site in 0..q.len() {
            self.lattice().visit_edges(site, |edge, end| {
                let Some((system, [q, next])) = field.ends(edge).filter(|_| end == 0 && first.is_none()) else {
                    return;
                };
                let Some(element) = elements.get(self.lattice().number(&edge)) else { return };
                let off = distance::<S>(element, &system.edge_element(q, next));
                if !off.at_most(tolerance).all() {
                    first = Some((edge.ends, off));
                }
            });
        }
        let Some(([from, to], off)) = first else { return Ok(()) };
        let (distance, tolerance) = (off.lane(0).to_f64(), tolerance.lane(0).to_f64());
        Err(SiteError { site: Some(from), error: Error::NotFlat { from, to, distance, tolerance } })
    }

    /// The momenta m(W) at the start and at the end of each edge, by its number: its two discrete Legendre transforms.
    ///
    /// Motions V of the ends change the energy U of an edge by θ⁺(V) − θ⁻(V), its two forms of Poincaré and Cartan:
    ///
    /// ```text
    /// θ⁻(V) = m_start · V_start,    θ⁺(V) = m_end · V_end
    /// ```
    ///
    /// A site is at rest where the momenta of the edges that start there and of those that end there have the same sum.
    ///
    /// # Errors
    /// [`Error::NumberOfEdges`].
    pub fn edge_momenta(&self, elements: &[Q<S>]) -> Result<Vec<[Mu<S>; 2]>, Error> {
        self.checked(elements)?;
        let mut all = alloc::vec![[Mu::<S>::origin(); 2]; elements.len()];
        self.visit_forces(elements, |number, _, (own, next)| {
            if let Some(momenta) = all.get_mut(number) {
                *momenta = [own, next.zip_map(&next, |next, _| -next)];
            }
        });
        Ok(all)
    }

    /// The force on each site: the sum of the momenta of edges that start there, less that of edges that end there. The discrete
    /// equations of Euler and Lagrange say that it vanishes at sites that are free to move and at rest.
    ///
    /// # Errors
    /// [`Error::NumberOfEdges`].
    pub fn forces_of_edges(&self, elements: &[Q<S>]) -> Result<Vec<Mu<S>>, Error> {
        self.checked(elements)?;
        let mut all = alloc::vec![Mu::<S>::origin(); self.lattice().sites()];
        self.visit_forces(elements, |_, ends, (own, next)| {
            for (site, force) in ends.into_iter().zip([own, next]) {
                if let Some(sum) = all.get_mut(site) {
                    *sum = plus(sum, &force);
                }
            }
        });
        Ok(all)
    }

    /// Visits each edge with its number, its ends and the forces on them.
    fn visit_forces(&self, elements: &[Q<S>], mut visit: impl FnMut(usize, [usize; 2], (Mu<S>, Mu<S>))) {
        let start = identity::<S>();
        for site in 0..self.lattice().sites() {
            let Some(system) = self.system(site) else { return };
            self.lattice().visit_edges(site, |edge, end| {
                let number = self.lattice().number(&edge);
                let Some(element) = elements.get(number).filter(|_| end == 0) else { return };
                visit(number, edge.ends, self.lattice().forces(system, edge, [&start, element]));
            });
        }
    }

    /// The energy of all edges.
    fn energy_of_elements(&self, elements: &[Q<S>]) -> T<S> {
        let start = identity::<S>();
        super::lattice::summed((0..self.lattice().sites()).map(|site| {
            let mut energy = T::<S>::zero();
            let Some(system) = self.system(site) else { return energy };
            self.lattice().visit_edges(site, |edge, end| {
                if let Some(element) = elements.get(self.lattice().number(&edge)).filter(|_| end == 0) {
                    energy += self.lattice().energy_of_edge(system, edge, [&start, element]);
                }
            });
            energy
        }))
    }
}
