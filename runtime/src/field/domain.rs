//! A field on a lattice, before it has a step size.

#[cfg(feature = "alloc")]
use super::Mesh;
use super::edges::{Configured, Placed};
use super::{Alike, Field, FieldStepper, Grid, Lattice, MovingField, Population, Sides};
use crate::fields::getters;
use crate::parts::{Q, T};
use crate::{Clebsch, Error};
use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;

/// A field on a lattice. Made by [`Field::grid`].
///
/// ```
/// use clebsch::{Clebsch, Error, Field};
/// use nalgebra::Vector1;
///
/// /// A string, its displacement x.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action = |a: Translation<1>, x: Vector1| x + a,
///     cost   = |h, a| a.norm_squared() / (2 * h),
///     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// )]
/// struct Strand;
///
/// let ring = Strand.grid([100]).spacing([0.01]).periodic();
/// assert_eq!(ring.lattice().sites(), 100);
/// assert!(ring.stepper(0.005).is_ok());
///
/// let refused = Strand.grid([100]).spacing([0.0]).stepper(0.005).unwrap_err();
/// assert_eq!(refused, Error::Spacing { direction: 0, value: 0.0 });
/// ```
pub struct Domain<S: Clone, G, P: Population = Alike> {
    systems: P::Of<S>,
    lattice: G,
}

impl<S: Clone, G: Clone, P: Population> Clone for Domain<S, G, P> {
    fn clone(&self) -> Self {
        Self { systems: self.systems.clone(), lattice: self.lattice.clone() }
    }
}

impl<S: Clone, G: Debug, P: Population> Debug for Domain<S, G, P> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Domain").field("lattice", &self.lattice).finish_non_exhaustive()
    }
}

impl<S: Clebsch + Clone, G> Domain<S, G> {
    pub(super) fn new(system: S, lattice: G) -> Self {
        Self { systems: [system], lattice }
    }
}

impl<S: Clebsch + Clone, G, P: Population> Domain<S, G, P> {
    /// Sites with these parameters on a lattice.
    pub(super) fn of(systems: P::Of<S>, lattice: G) -> Self {
        Self { systems, lattice }
    }

    getters! {
        /// The places of the sites.
        ref lattice: G;
    }

    /// The sites without loads.
    pub(super) fn placed(&self) -> Placed<'_, S, G, P> {
        Placed { systems: self.systems.as_ref(), lattice: &self.lattice, load: None, population: PhantomData }
    }

    /// The declared sites.
    pub(super) fn systems(&self) -> &P::Of<S> {
        &self.systems
    }

    /// The sites with their configurations.
    pub(super) fn configured<'a>(&'a self, q: &'a [Q<S>]) -> Configured<'a, S, G, P> {
        Configured { systems: self.systems.as_ref(), lattice: &self.lattice, q, load: None, population: PhantomData }
    }

    /// The declared site with the parameters of a site; `None` if there is none of this number.
    #[inline]
    pub fn system(&self, site: usize) -> Option<&S> {
        self.systems.as_ref().get(P::number(site))
    }

    /// A stepper of step size `h`.
    ///
    /// # Errors
    /// [`Error::StepSize`], [`Error::EmptyGrid`], [`Error::Spacing`], and those of the parameters, as for
    /// [`Clebsch::stepper`].
    pub fn stepper(self, h: T<S>) -> Result<FieldStepper<S, G, P>, Error>
    where
        S: MovingField,
        G: Lattice<S>,
    {
        FieldStepper::new(self.systems, self.lattice, h)
    }
}

impl<S: Field<D> + Clone, P: Population, const D: usize> Domain<S, Grid<T<S>, D>, P> {
    /// The same with these spacings, in metres for SI units.
    #[must_use]
    pub fn spacing(self, spacing: [T<S>; D]) -> Self {
        Self { lattice: self.lattice.spacing(spacing), ..self }
    }

    /// The same with these sides in each direction.
    #[must_use]
    pub fn sides(self, sides: [Sides; D]) -> Self {
        Self { lattice: self.lattice.sides(sides), ..self }
    }

    /// The same, periodic in each direction.
    #[must_use]
    pub fn periodic(self) -> Self {
        Self { lattice: self.lattice.periodic(), ..self }
    }

    /// The same with free sides in each direction.
    #[must_use]
    pub fn free(self) -> Self {
        Self { lattice: self.lattice.free(), ..self }
    }

    /// The same with fixed sides in each direction: their sites do not move.
    #[must_use]
    pub fn fixed(self) -> Self {
        Self { lattice: self.lattice.fixed(), ..self }
    }
}

#[cfg(feature = "alloc")]
impl<S: Field<D> + Clone, const D: usize> Domain<S, Grid<T<S>, D>> {
    /// The same with parameters for each site by its place. The energy of an edge has those of the site at its start.
    ///
    /// ```
    /// use clebsch::{Clebsch, Field};
    /// use nalgebra::Vector1;
    ///
    /// /// A string of beads, its displacement x.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action = |a: Translation<1>, x: Vector1| x + a,
    ///     cost   = |h, a| self.mass * a.norm_squared() / (2 * h),
    ///     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx),
    /// )]
    /// struct Beads { mass: f64 }
    ///
    /// // half a mass at each end
    /// let mass = |[i]: [usize; 1]| Beads { mass: if i == 0 || i == 9 { 0.5 } else { 1.0 } };
    /// let stepper = Beads { mass: 1.0 }.grid([10]).various(mass).stepper(0.1)?;
    /// let state = stepper.state(vec![Vector1::zeros(); 10], vec![Vector1::new(1.0); 10])?;
    /// assert_eq!(stepper.energy(&state)?, 8.0 / 2.0 + 2.0);
    /// # Ok::<(), clebsch::SiteError>(())
    /// ```
    pub fn various(self, mut site: impl FnMut([usize; D]) -> S) -> Domain<S, Grid<T<S>, D>, super::Various> {
        // sizes that are refused have no sites
        let sites = if self.lattice.check_sizes().is_ok() { self.lattice.sites() } else { 0 };
        let systems = (0..sites).map(|index| site(self.lattice.split(index))).collect();
        Domain { systems, lattice: self.lattice }
    }
}

#[cfg(feature = "alloc")]
impl<S: Field<1> + Clone, P: Population> Domain<S, Mesh<T<S>>, P> {
    /// The same with fixed sites at the border: they do not move.
    #[must_use]
    pub fn fixed(mut self) -> Self {
        let is_border: alloc::vec::Vec<bool> =
            (0..self.lattice.sites()).map(|site| self.lattice.is_border(site)).collect();
        self.lattice = self.lattice.fixed_where(|site| is_border.get(site).copied().unwrap_or(false));
        self
    }

    /// The same with fixed sites where `is_fixed` says so, and no others.
    #[must_use]
    pub fn fixed_where(mut self, is_fixed: impl FnMut(usize) -> bool) -> Self {
        self.lattice = self.lattice.fixed_where(is_fixed);
        self
    }

    /// The same with a weight for each edge by its ends, as [`Mesh::weights`].
    #[must_use]
    pub fn weights(mut self, weight: impl FnMut([usize; 2]) -> T<S>) -> Self {
        self.lattice = self.lattice.weights(weight);
        self
    }

    /// The same with the weights of linear finite elements, as [`Mesh::cotangent_weights`].
    ///
    /// # Errors
    /// [`Error::FaceSize`] for a face that is no triangle.
    pub fn cotangent_weights(mut self) -> Result<Self, Error> {
        self.lattice = self.lattice.cotangent_weights()?;
        Ok(self)
    }
}

#[cfg(feature = "alloc")]
impl<S: Field<1> + Clone> Domain<S, Mesh<T<S>>> {
    /// The same with parameters for each site by its number. The energy of an edge has those of the site at its start.
    pub fn various(self, site: impl FnMut(usize) -> S) -> Domain<S, Mesh<T<S>>, super::Various> {
        Domain { systems: (0..self.lattice.sites()).map(site).collect(), lattice: self.lattice }
    }
}
