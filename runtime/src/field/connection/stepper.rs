//! Steps of a connection: of the elements of edges and the momenta of sites.

use super::identity;
use crate::field::{Alike, CellComplex, ConnectedField, Domain, FieldState, FieldStepper, MovingField, Population};
use crate::fields::getters;
use crate::parts::{Mu, Q, RestOf, T};
use crate::stepper::check_on_orbit;
use crate::{Clebsch, Error, SiteError, Space};
use alloc::vec::Vec;

/// A connection on a lattice with a step size. Made by [`Domain::connection`].
///
/// ```
/// use clebsch::{Clebsch, Field};
/// use nalgebra::{Rotation3, Vector3};
///
/// /// The chiral model: rotations along a line, each with a spring to the next.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action = |F: SO<3>, R: SO<3>| R * F,
///     cost   = |h, F| (F - I).norm_squared() / (4 * h),
///     space  = |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
///     emit   = [connection],
/// )]
/// struct Chiral;
///
/// let chain = Chiral.grid([8]).spacing([0.5]).periodic();
/// let turn = |site: usize| Rotation3::new(Vector3::new((site as f64).sin(), 0.3, 0.0)).into_inner();
/// let (q, mu): (Vec<_>, Vec<_>) = ((0..8).map(turn).collect(), vec![Vector3::z() * 0.2; 8]);
/// let (by_sites, by_edges) = (chain.clone().stepper(0.1)?, chain.connection(0.1)?);
/// let mut sites = by_sites.state(q.clone(), mu.clone())?;
/// let mut edges = by_edges.state(chain.edge_elements(&q)?, mu)?;
/// by_sites.advance(&mut sites, 100)?;
/// by_edges.advance(&mut edges, 100)?;
///
/// // the same motion, but for the place of the whole
/// let expected = chain.edge_elements(sites.configuration())?;
/// assert!(expected.iter().zip(edges.elements()).all(|(a, b)| (a - b).amax() < 1e-12));
/// # Ok::<(), clebsch::SiteError>(())
/// ```
pub struct ConnectionStepper<S: Clebsch + Clone, G, P: Population = Alike> {
    domain: Domain<S, G, P>,
    stepper: FieldStepper<S, G, P>,
}

/// The state of a connection: the group element W of each edge, and the momentum N of each site.
///
/// ```
/// # use clebsch::{Clebsch, Field};
/// # use nalgebra::{Matrix2, Vector1};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |F: SO<2>, R: SO<2>| R * F,
/// #     cost   = |h, F| (F - I).norm_squared() / (4 * h),
/// #     space  = |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
/// #     emit   = [connection],
/// # )]
/// # struct Angles;
/// let stepper = Angles.grid([4]).periodic().connection(0.1)?;
/// let mut state = stepper.state(vec![Matrix2::identity(); 4], vec![Vector1::new(0.1); 4])?;
/// stepper.step(&mut state)?;
/// assert_eq!((state.elements().len(), state.momentum().len(), state.steps()), (4, 4, 1));
/// # Ok::<(), clebsch::SiteError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ConnectionState<S: Clebsch> {
    pub(in crate::field) elements: Vec<Q<S>>,
    /// The momenta of all sites. In a part of a step the configurations are the motions F.
    pub(in crate::field) sites: FieldState<Vec<Q<S>>, Vec<Mu<S>>, S::Time>,
}

impl<S: Clebsch<Time: PartialEq>> PartialEq for ConnectionState<S> {
    fn eq(&self, other: &Self) -> bool {
        self.elements == other.elements && self.sites == other.sites
    }
}

impl<S: Clebsch> ConnectionState<S> {
    /// The group elements of all edges, by their numbers.
    pub fn elements(&self) -> &[Q<S>] {
        &self.elements
    }

    /// The momenta of all sites.
    pub fn momentum(&self) -> &[Mu<S>] {
        self.sites.momentum()
    }

    /// The number of steps that it has made, at most 2⁶⁴ − 1.
    pub fn steps(&self) -> u64 {
        self.sites.steps()
    }
}

impl<S: Clebsch + Clone, G: Clone, P: Population> Domain<S, G, P> {
    /// A stepper of step size `h` for the elements of edges, without configurations.
    ///
    /// # Errors
    /// As [`stepper`](Self::stepper).
    pub fn connection(&self, h: T<S>) -> Result<ConnectionStepper<S, G, P>, Error>
    where
        S: ConnectedField + MovingField,
        G: CellComplex<S>,
    {
        Ok(ConnectionStepper { domain: self.clone(), stepper: self.clone().stepper(h)? })
    }
}

impl<S, G, P: Population> ConnectionStepper<S, G, P>
where
    S: ConnectedField + Clone,
    G: CellComplex<S>,
{
    getters! {
        /// The field, with the places of its sites.
        ref domain: Domain<S, G, P>;
    }

    /// The state with an element for each edge and a momentum for each site. Elements of edges that are not there are the identity then.
    ///
    /// # Errors
    /// * [`Error::NumberOfEdges`] and [`Error::NumberOfSites`].
    /// * [`Error::OffOrbit`] and [`Error::NotFinite`] of an element, with the site from which its edge starts.
    /// * Those of [`FieldStepper::state`] for momenta.
    pub fn state(&self, mut elements: Vec<Q<S>>, momentum: Vec<Mu<S>>) -> Result<ConnectionState<S>, SiteError> {
        self.domain.checked(&elements)?;
        let (lattice, mut is_there, mut wrong) = (self.domain.lattice(), alloc::vec![false; elements.len()], None);
        for site in 0..lattice.sites() {
            let Some(system) = self.domain.system(site) else { continue };
            lattice.visit_edges(site, |edge, end| {
                let number = lattice.number(&edge);
                let Some(element) = elements.get(number).filter(|_| end == 0 && wrong.is_none()) else { return };
                is_there[number] = true;
                wrong = check_on_orbit(element, system.orbit_defect(element)).err().map(|error| (site, error));
            });
        }
        if let Some((site, error)) = wrong {
            return Err(SiteError { site: Some(site), error });
        }
        let absent = elements.iter_mut().zip(is_there).filter(|(_, is_there)| !is_there);
        absent.for_each(|(element, _)| *element = identity::<S>());
        let sites = self.stepper.state(alloc::vec![identity::<S>(); lattice.sites()], momentum)?;
        Ok(ConnectionState { elements, sites })
    }

    /// One step, in place.
    ///
    /// # Errors
    /// As [`FieldStepper::step`].
    pub fn step(&self, state: &mut ConnectionState<S>) -> Result<(), SiteError> {
        self.advance(state, 1)
    }

    /// So many steps, in place.
    ///
    /// # Errors
    /// As [`FieldStepper::advance`].
    pub fn advance(&self, state: &mut ConnectionState<S>, steps: u64) -> Result<(), SiteError> {
        let ConnectionState { elements, sites } = state;
        // sites move from the identity, so that their configurations are their motions
        let mut have_moved = false;
        let result = self.stepper.tried(sites, steps, |(_, weight), part, (motions, mu)| {
            if have_moved {
                self.carry(elements, motions);
            }
            self.kick(elements, weight, mu);
            have_moved = part.is_some();
            let Some(part) = part else { return Ok(()) };
            motions.fill(identity::<S>());
            self.stepper.drift(part, 0, (motions, mu), None)
        });
        sites.configuration.fill(identity::<S>());
        result
    }

    /// The elements of edges whose ends have moved.
    fn carry(&self, elements: &mut [Q<S>], motions: &[Q<S>]) {
        for site in 0..motions.len() {
            let Some(system) = self.domain.system(site) else { return };
            self.domain.lattice().visit_edges(site, |edge, end| {
                let [start, next] = edge.ends.map(|end| motions.get(end));
                let element = elements.get_mut(self.domain.lattice().number(&edge)).filter(|_| end == 0);
                if let (Some(element), Some(start), Some(next)) = (element, start, next) {
                    let moved = system.edge_element(start, &system.act(next, element));
                    *element = S::on_space(moved, RestOf::<S>::origin()).0;
                }
            });
        }
    }

    /// Adds the forces of all edges, times a weight, to the momenta of sites that move.
    fn kick(&self, elements: &[Q<S>], weight: T<S>, mu: &mut [Mu<S>]) {
        self.domain.visit_forces(elements, |_, ends, (own, next)| {
            for (site, force) in ends.into_iter().zip([own, next]) {
                if let Some(mu) = mu.get_mut(site) {
                    *mu = mu.zip_map(&force, |mu, force| mu + weight * force);
                }
            }
        });
        self.stepper.clear_fixed(mu);
    }

    /// The kinetic energies of all sites and the energies of all edges, in joules.
    ///
    /// # Errors
    /// [`Error::NumberOfEdges`] and [`Error::NumberOfSites`] for the state of another field.
    pub fn energy(&self, state: &ConnectionState<S>) -> Result<T<S>, SiteError> {
        self.domain.checked(&state.elements)?;
        Ok(self.stepper.kinetic_energy(&state.sites)? + self.domain.energy_of_elements(&state.elements))
    }
}
