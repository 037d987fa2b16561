//! Implicit steps of a field along a line: the variational midpoint, F = G² with all forces at Φ_G(q).
//!
//! ```text
//! ℓd = Σ over sites of K(F) − h V(Φ_G q) − h Σ over edges of U(Φ_G q, Φ_G q⁺),    F = G²
//! s = T* ∂K(F) − N,    s + C s = h f(Φ_G q),    N⁺ = C (C N + h f)
//! ```
//! C carries a momentum along G. The step is symplectic, symmetric in time and of second order. It conserves the momenta of
//! symmetries, and is stable at any step size where the equations are linear. The equations of all sites are solved by Newton's
//! method with block tridiagonal elimination. It is damped by the natural monotonicity test.
//!
//! Source: Deuflhard, *Newton Methods for Nonlinear Problems*, Springer 2004, section 3.3 (the damping). Marsden and West, *Discrete
//! mechanics and variational integrators*, Acta Numerica 10 (2001), section 2.4 (the midpoint rule).

mod step;
mod tridiagonal;

use super::{
    Alike, Domain, Field, FieldSite, FieldState, FieldStepper, Grid, Lattice, MidpointSite, MovingField, Population,
    Sides,
};
use crate::parts::{Mu, Q, T, U};
use crate::{Clebsch, Conserved, Conserves, Error, Real, Scalar, SiteError, Time};
use alloc::vec::Vec;
use core::ops::Deref;
use nalgebra::SVector;
use num_traits::Zero;
use step::Step;
use tridiagonal::Tridiagonal;

/// Implicit steps of a field along a line. Made by [`Domain::midpoint`].
///
/// ```
/// use clebsch::{Clebsch, Field};
/// use nalgebra::Vector1;
///
/// /// A string of density 1 and tension 1, its displacement x.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action = |a: Translation<1>, x: Vector1| x + a,
///     cost   = |h, a| a.norm_squared() / (2 * h),
///     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
///     emit   = [midpoint],
/// )]
/// struct Strand;
///
/// // thirty times the step that explicit steps are stable with
/// let stepper = Strand.grid([101]).spacing([0.01]).fixed().midpoint(0.3)?;
/// let shape = |i: usize| Vector1::new((core::f64::consts::PI * i as f64 / 100.0).sin());
/// let mut state = stepper.state((0..101).map(shape).collect::<Vec<_>>(), vec![Vector1::zeros(); 101])?;
/// let energy = stepper.energy(&state)?;
/// stepper.advance(&mut state, 100)?;
/// assert!((stepper.energy(&state)? / energy - 1.0).abs() < 1e-10);
/// # Ok::<(), clebsch::SiteError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MidpointStepper<S: Clebsch + Clone, P: Population = Alike> {
    pub(super) field: FieldStepper<S, Grid<T<S>, 1>, P>,
}

/// The state of a field with implicit steps. It is also a [`FieldState`], and has the storage of the solver behind it.
///
/// ```
/// # use clebsch::{Clebsch, Field};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     cost   = |h, a| a.norm_squared() / (2 * h),
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// #     emit   = [midpoint],
/// # )]
/// # struct Strand;
/// let stepper = Strand.grid([3]).midpoint(0.1)?;
/// let mut state = stepper.state(vec![Vector1::zeros(); 3], vec![Vector1::new(1.0); 3])?;
/// stepper.step(&mut state)?;
/// assert_eq!((state.steps(), state.configuration().len()), (1, 3));
/// // linear equations take one linear system, and another one shows that it was enough
/// assert!(state.iterations() <= 2);
/// # Ok::<(), clebsch::SiteError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MidpointState<S: Clebsch, Points, Momenta, const M: usize> {
    sites: FieldState<Points, Momenta, S::Time>,
    work: Work<S, M>,
}

/// The storage of the solver.
#[derive(Clone, Debug)]
struct Work<S: Clebsch, const M: usize> {
    /// The Cayley coordinates of the half steps.
    halves: Vec<SVector<T<S>, M>>,
    /// Those that are tried; behind a step the momenta.
    tried: Vec<SVector<T<S>, M>>,
    midpoints: Vec<Q<S>>,
    correction: Vec<SVector<T<S>, M>>,
    /// The correction at the place that is tried, with the old matrix.
    next: Vec<SVector<T<S>, M>>,
    matrix: Tridiagonal<T<S>, M>,
    iterations: u32,
}

impl<S: Clebsch, Points, Momenta, const M: usize> Deref for MidpointState<S, Points, Momenta, M> {
    type Target = FieldState<Points, Momenta, S::Time>;

    fn deref(&self) -> &Self::Target {
        &self.sites
    }
}

impl<S: Clebsch, Points, Momenta, const M: usize> MidpointState<S, Points, Momenta, M> {
    /// The storage: configurations and momenta.
    pub fn into_storage(self) -> (Points, Momenta) {
        self.sites.into_storage()
    }

    /// The linear systems of the last step.
    pub fn iterations(&self) -> u32 {
        self.work.iterations
    }
}

impl<S: Field<1> + Clone, P: Population> Domain<S, Grid<T<S>, 1>, P> {
    /// An implicit stepper of step size `h`, for a field whose stable step is too short.
    ///
    /// # Errors
    /// As [`stepper`](Self::stepper).
    pub fn midpoint<const M: usize>(self, h: T<S>) -> Result<MidpointStepper<S, P>, Error>
    where
        S: MidpointSite<M> + MovingField,
    {
        Ok(MidpointStepper { field: self.stepper(h)? })
    }
}

impl<S, P: Population, const M: usize> MidpointStepper<S, P>
where
    S: Field<1> + MidpointSite<M> + Clebsch<Momentum = SVector<T<S>, M>> + Clone,
    T<S>: Real,
{
    /// The state with a configuration and a momentum for each site. Where the time matters it starts at 0.
    ///
    /// The momenta of sites on a fixed side are not read; they are 0 in the state.
    ///
    /// # Errors
    /// As [`FieldStepper::state`].
    pub fn state<Points, Momenta>(
        &self,
        configuration: Points,
        momentum: Momenta,
    ) -> Result<MidpointState<S, Points, Momenta, M>, SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        Ok(self.with_work(self.field.state(configuration, momentum)?))
    }

    /// The state of these sites, with the storage of the solver. Nothing in it matters to the next step.
    pub(super) fn with_work<Points, Momenta>(
        &self,
        sites: FieldState<Points, Momenta, S::Time>,
    ) -> MidpointState<S, Points, Momenta, M>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        let count = self.field.lattice().sites();
        let zeros = || alloc::vec![SVector::from_element(T::<S>::zero()); count];
        let is_ring = self.field.lattice().all_sides()[0] == Sides::Periodic;
        let work = Work {
            halves: zeros(),
            tried: zeros(),
            midpoints: sites.configuration().as_ref().to_vec(),
            correction: zeros(),
            next: zeros(),
            matrix: Tridiagonal::new(count, is_ring),
            iterations: 0,
        };
        MidpointState { sites, work }
    }

    /// One step, in place.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn step<Points, Momenta>(&self, state: &mut MidpointState<S, Points, Momenta, M>) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        self.advance(state, 1)
    }

    /// So many steps, in place. A step that fails leaves the state as it was before this step.
    ///
    /// # Errors
    /// * [`Error::NotConverged`] for a step that Newton's method does not find, with the site of the largest correction. Its residual is
    ///   the size of this correction, in radians and metres. A smaller step is found more easily.
    /// * [`Error::NotFinite`] for a step after which the state or the time is not finite.
    /// * [`Error::NumberOfSites`] for the state of another field.
    pub fn advance<Points, Momenta>(
        &self,
        state: &mut MidpointState<S, Points, Momenta, M>,
        steps: u64,
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        self.advanced(state, steps, None)
    }

    /// One step, in place, during which the input of the forces on each site is that of `inputs`.
    ///
    /// # Errors
    /// As [`advance`](Self::advance). [`Error::NumberOfSites`] for inputs of another number, and [`Error::NotFinite`] for one that is
    /// not finite, with the site.
    pub fn step_with<Points, Momenta>(
        &self,
        state: &mut MidpointState<S, Points, Momenta, M>,
        inputs: &[U<S>],
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        self.field.check_inputs(inputs)?;
        self.advanced(state, 1, Some(inputs))
    }

    fn advanced<Points, Momenta>(
        &self,
        state: &mut MidpointState<S, Points, Momenta, M>,
        steps: u64,
        inputs: Option<&[U<S>]>,
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        let MidpointState { sites, work } = state;
        let (q, mu) = (sites.configuration.as_mut(), sites.momentum.as_mut());
        self.field.check_lengths(q, mu)?;
        let (found, expected) = (work.halves.len(), self.field.lattice().sites());
        if found != expected {
            return Err(Error::NumberOfSites { found, sites: expected }.into());
        }
        for _ in 0..steps {
            let after = sites.time.after_step(self.step_size());
            if !after.now().is_finite() {
                return Err(Error::NotFinite { name: "the time after the step" }.into());
            }
            let step = Step { field: &self.field, t: sites.time.now(), inputs, q, mu };
            step.solve(work)?;
            step.arrive(work)?;
            for i in (0..q.len()).filter(|i| !self.field.lattice().is_fixed(*i)) {
                (q[i], mu[i]) = (work.midpoints[i], work.tried[i]);
            }
            sites.time = after;
            sites.steps = sites.steps.saturating_add(1);
        }
        Ok(())
    }
}

impl<S: FieldSite + Clone, P: Population> MidpointStepper<S, P>
where
    Grid<T<S>, 1>: Lattice<S>,
{
    /// The places of the sites.
    pub fn lattice(&self) -> &Grid<T<S>, 1> {
        self.field.lattice()
    }

    /// The declared site with the parameters of a site; `None` if there is none of this number.
    pub fn system(&self, site: usize) -> Option<&S> {
        self.field.system(site)
    }

    /// The step size h, seconds in SI units.
    pub fn step_size(&self) -> T<S> {
        self.field.step_size()
    }

    /// The energy, as [`FieldStepper::energy`].
    ///
    /// # Errors
    /// [`Error::NumberOfSites`] for the state of another field.
    pub fn energy<Points, Momenta>(&self, state: &FieldState<Points, Momenta, S::Time>) -> Result<T<S>, SiteError>
    where
        Points: AsRef<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]>,
    {
        self.field.energy(state)
    }

    /// The momenta that no step changes, as [`FieldStepper::conserved`].
    ///
    /// # Errors
    /// [`Error::NumberOfSites`] for the state of another field.
    pub fn conserved<Points, Momenta, const K: usize>(
        &self,
        state: &FieldState<Points, Momenta, S::Time>,
    ) -> Result<Conserved<T<S>, K>, SiteError>
    where
        S: Conserves<Conserved = Conserved<T<S>, K>>,
        Points: AsRef<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]>,
    {
        self.field.conserved(state)
    }
}
