//! The state of a power in storage of the user's choice.

use super::Drive;
use crate::fields::getters;
use crate::parameters::check_finite;
use crate::power::{Point, Power, SiteMomentum};
use crate::scheme::{At, AtOf, AtSite, InStorage, JoinedInStorage, Scheme, Stored};
use crate::space::plus;
use crate::stepper::{check_on_orbit, check_violation};
use crate::{Clebsch, Clock, Conserves, Error, Scalar, Space, Stepper, Time};
use core::fmt::{self, Display, Formatter};
use core::iter::once;
use core::mem::swap;
use num_traits::Zero;

/// The memory of [`Sites`]: for each site a configuration q and a momentum N, and room for the next state.
///
/// `Points` and `Momenta` are arrays, slices or vectors of one configuration or momentum for each site.
///
/// ```
/// # use clebsch::{Clebsch, SiteStorage};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action    = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
/// #     cost      = |h, a| (0..N).map(|i| a[i].norm_squared() / (2 * h)).sum(),
/// #     potential = |x| (0..N).map(|i| (x[(i + 1) % N] - x[i]).norm_squared() / 2).sum(),
/// # )]
/// # struct Ring<const N: usize>;
/// // slices of memory that was given
/// let mut points = [[Vector1::zeros(); 8]; 3];
/// let mut momenta = [[Vector1::new(2.0); 8]; 4];
/// let [q, q1, q2] = &mut points;
/// let [n, n1, n2, n3] = &mut momenta;
/// let storage = SiteStorage {
///     configuration: &mut q[..],
///     momentum: &mut n[..],
///     more_points: [&mut q1[..], &mut q2[..]],
///     more_momenta: [&mut n1[..], &mut n2[..], &mut n3[..]],
/// };
/// Ring::<8>.into_stepper(0.5)?.sites(storage)?.advance(3)?;
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SiteStorage<Points, Momenta> {
    /// The configurations to start from.
    pub configuration: Points,
    /// The momenta to start from.
    pub momentum: Momenta,
    /// Room for the next configurations and for the gradient of the potential, in this order. The content does not
    /// matter.
    pub more_points: [Points; 2],
    /// Room for the next momenta and for the kicks of this state and the next, in this order. The content does not
    /// matter.
    pub more_momenta: [Momenta; 3],
}

impl<Points: Clone, Momenta: Clone> SiteStorage<Points, Momenta> {
    /// Vectors or arrays, with room as large: all that is ever allocated.
    pub fn of(configuration: Points, momentum: Momenta) -> Self {
        let more_points = [configuration.clone(), configuration.clone()];
        let more_momenta = [momentum.clone(), momentum.clone(), momentum.clone()];
        Self { configuration, momentum, more_points, more_momenta }
    }
}

/// An error at a site.
///
/// ```
/// # use clebsch::{Clebsch, SiteStorage};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action    = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
/// #     cost      = |h, a| (0..N).map(|i| a[i].norm_squared() / (2 * h)).sum(),
/// #     potential = |x| (0..N).map(|i| (x[(i + 1) % N] - x[i]).norm_squared() / 2).sum(),
/// # )]
/// # struct Ring<const N: usize>;
/// let (places, mut momenta) = (vec![Vector1::zeros(); 8], vec![Vector1::new(2.0); 8]);
/// momenta[5].x = f64::INFINITY;
/// let error = Ring::<8>.into_stepper(0.5)?.sites(SiteStorage::of(places, momenta)).unwrap_err();
/// assert_eq!(error.site, Some(5));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiteError {
    /// The site, where it is one.
    pub site: Option<usize>,
    /// The error at this site.
    pub error: Error,
}

impl Display for SiteError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.site {
            Some(site) => write!(f, "at site {site}: {}", self.error),
            None => write!(f, "{}", self.error),
        }
    }
}

impl core::error::Error for SiteError {}

impl From<SiteError> for Error {
    fn from(error: SiteError) -> Self {
        error.error
    }
}

/// A power whose state is in storage of the user's choice: many sites that no stack would hold.
///
/// A step has the cost and the result of [`Stepper::step`], to the last bit. It writes to the other state: if it fails,
/// the state is unchanged.
///
/// ```
/// # use clebsch::{Clebsch, SiteStorage};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action    = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
/// #     cost      = |h, a| (0..N).map(|i| a[i].norm_squared() / (2 * h)).sum(),
/// #     potential = |x| (0..N).map(|i| (x[(i + 1) % N] - x[i]).norm_squared() / 2).sum(),
/// # )]
/// # struct Ring<const N: usize>;
/// let (places, momenta) = (vec![Vector1::zeros(); 1000], vec![Vector1::new(2.0); 1000]);
/// let mut ring = Ring::<1000>.into_stepper(0.5)?.sites(SiteStorage::of(places, momenta))?;
/// ring.advance(3)?;
/// assert_eq!(ring.configuration()[999].x, 3.0); // all move alike
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sites<P: Clebsch, Points, Momenta, const N: usize, Rooms = NoJoints> {
    stepper: Stepper<P>,
    time: P::Time,
    steps: u64,
    storage: SiteStorage<Points, Momenta>,
    room: Rooms,
    /// The time at which the room has the factors of the joints, if it has them at this configuration.
    factored: Option<P::Scalar>,
}

/// The room of sites without joints: none.
///
/// ```
/// # use clebsch::{Clebsch, NoJoints, SiteStorage, Sites};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action    = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
/// #     cost      = |h, a| (0..N).map(|i| a[i].norm_squared() / (2 * h)).sum(),
/// #     potential = |x| (0..N).map(|i| (x[(i + 1) % N] - x[i]).norm_squared() / 2).sum(),
/// # )]
/// # struct Ring<const N: usize>;
/// type Storage = Vec<Vector1<f64>>;
/// let storage = SiteStorage::of(vec![Vector1::zeros(); 8], vec![Vector1::new(2.0); 8]);
/// let ring: Sites<Ring<8>, Storage, Storage, 8, NoJoints> = Ring::<8>.into_stepper(0.5)?.sites(storage)?;
/// assert_eq!(ring.steps(), 0);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct NoJoints;

impl<R> AsMut<[R]> for NoJoints {
    fn as_mut(&mut self) -> &mut [R] {
        &mut []
    }
}

/// q, N and the kick at which a step starts.
type Start<'a, P> = (&'a <P as Clebsch>::Configuration, &'a <P as Clebsch>::Momentum, &'a <P as Clebsch>::Momentum);
/// The sum of all numbers of a state.
type Summed<P> = Result<<P as Clebsch>::Scalar, SiteError>;

/// The multipliers of the joints of a site of P.
type Multipliers<P, const N: usize> = <<P as Clebsch>::Scheme as JoinedInStorage<P, N>>::Multipliers;
/// Those of its equations that close loops.
type LoopMultipliers<P, const N: usize> = <<P as Clebsch>::Scheme as JoinedInStorage<P, N>>::OfLoops;

/// The room that the sites of P need for their joints.
type Room<P, const N: usize> = <<P as Clebsch>::Scheme as InStorage<P, N>>::Room;

impl From<AtSite> for SiteError {
    fn from((site, error): AtSite) -> Self {
        Self { site: Some(site), error }
    }
}

/// A slice as the array of N entries that it is.
fn array<V, const N: usize>(slice: &[V]) -> Result<&[V; N], SiteError> {
    slice.try_into().map_err(|_| wrong_length::<N>(slice.len()))
}

/// The same of a slice to write to.
fn array_mut<V, const N: usize>(slice: &mut [V]) -> Result<&mut [V; N], SiteError> {
    let found = slice.len();
    slice.try_into().map_err(|_| wrong_length::<N>(found))
}

fn wrong_length<const N: usize>(found: usize) -> SiteError {
    SiteError { site: None, error: Error::NumberOfSites { found, sites: N } }
}

impl<P: Clebsch> Stepper<P> {
    /// This stepper with the state of all sites of a power, after the checks that [`state`](Self::state) makes: stepped in place.
    ///
    /// # Errors
    /// [`Error::NumberOfSites`] where a part of the storage has another length than N, and those of [`state`](Self::state), with the site.
    pub fn sites<Points, Momenta, const N: usize>(
        self,
        storage: SiteStorage<Points, Momenta>,
    ) -> Result<Sites<P, Points, Momenta, N>, SiteError>
    where
        P: Power<N>,
        Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
        Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
    {
        const {
            assert!(
                size_of::<Room<P, N>>() == 0,
                "these sites have joints: write `stepper.joined_sites(storage, room)` with the room `vec![stepper.joint(); N]`"
            );
        }
        self.joined_sites(storage, NoJoints)
    }

    /// The same of sites with joints, whose room is given: [`joint`](Self::joint) for each site. Its content does not matter.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error, SiteStorage};
    /// # use nalgebra::Vector2;
    /// /// Beads on rods of length 1, the first of which is fixed.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
    ///     lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
    ///     constraint = |x| [
    ///         x[0] == Vector2::zeros(),
    ///         (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
    ///     ],
    /// )]
    /// struct Rope<const N: usize>;
    ///
    /// let stepper = Rope::<3>.into_stepper(0.1)?;
    /// let places = vec![Vector2::zeros(), Vector2::x(), Vector2::x() * 2.0];
    /// let momenta = vec![Vector2::zeros(), Vector2::y(), Vector2::y() * 2.0];
    /// let room = vec![stepper.joint(); 3];
    /// let mut rope = stepper.joined_sites(SiteStorage::of(places, momenta), room)?;
    /// rope.advance(1000)?;
    /// let end = rope.configuration();
    /// assert!(((end[2] - end[1]).norm() - 1.0).abs() < 1e-14);
    ///
    /// // the last rod is too long
    /// let stepper = Rope::<3>.into_stepper(0.1)?;
    /// let places = vec![Vector2::zeros(), Vector2::x(), Vector2::x() * 2.5];
    /// let room = vec![stepper.joint(); 3];
    /// let refused = stepper.joined_sites(SiteStorage::of(places, vec![Vector2::zeros(); 3]), room).unwrap_err();
    /// assert_eq!(refused.site, Some(2));
    /// assert!(matches!(refused.error, Error::OffConstraint { .. }));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`sites`](Self::sites). [`Error::OffConstraint`], [`Error::ConstraintViolated`] and [`Error::DependentConstraints`], with the site.
    pub fn joined_sites<Points, Momenta, Rooms, const N: usize>(
        self,
        storage: SiteStorage<Points, Momenta>,
        room: Rooms,
    ) -> Result<Sites<P, Points, Momenta, N, Rooms>, SiteError>
    where
        P: Power<N>,
        Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
        Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
        Rooms: AsMut<[Room<P, N>]>,
    {
        self.prepared_sites(storage, room, |_| Ok(()))
    }

    /// The same from the velocities ξ that `storage` has in the place of the momenta.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error, SiteStorage};
    /// # use nalgebra::Vector2;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
    /// #     lagrangian = |v| (0..N).map(|i| self.mass * v[i].norm_squared() / 2).sum(),
    /// #     constraint = |x| [
    /// #         x[0] == Vector2::zeros(),
    /// #         (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
    /// #     ],
    /// # )]
    /// # struct Rope<const N: usize> { mass: f64 }
    /// // a straight rope turns about its first bead, with 1 rad/s
    /// let stepper = Rope::<3> { mass: 0.2 }.into_stepper(0.1)?;
    /// let places = vec![Vector2::zeros(), Vector2::x(), Vector2::x() * 2.0];
    /// let velocities = vec![Vector2::zeros(), Vector2::y(), Vector2::y() * 2.0];
    /// let room = vec![stepper.joint(); 3];
    /// let rope = stepper.joined_sites_moving(SiteStorage::of(places, velocities), room)?;
    /// assert_eq!(rope.momentum()[2], Vector2::y() * 0.4);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`joined_sites`](Self::joined_sites).
    pub fn joined_sites_moving<Points, Momenta, Rooms, const N: usize>(
        self,
        storage: SiteStorage<Points, Momenta>,
        room: Rooms,
    ) -> Result<Sites<P, Points, Momenta, N, Rooms>, SiteError>
    where
        P: Power<N, Scheme: JoinedInStorage<P, N>>,
        Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
        Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
        Rooms: AsMut<[Room<P, N>]>,
    {
        self.prepared_sites(storage, room, |sites| {
            let (q, velocities) = (sites.storage.configuration.as_ref(), sites.storage.momentum.as_mut());
            P::Scheme::momenta_of_velocities(sites.stepper.at(sites.time.now()), array(q)?, array_mut(velocities)?);
            Ok(())
        })
    }

    /// The same from the nearest state, as [`project`](Self::project) finds it: `storage` need not obey the joints.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error, SiteStorage};
    /// # use nalgebra::Vector2;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
    /// #     lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
    /// #     constraint = |x| [
    /// #         x[0] == Vector2::zeros(),
    /// #         (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
    /// #     ],
    /// # )]
    /// # struct Rope<const N: usize>;
    /// // the rods are too long by a tenth
    /// let stepper = Rope::<3>.into_stepper(0.1)?;
    /// let places = vec![Vector2::zeros(), Vector2::x() * 1.1, Vector2::x() * 2.2];
    /// let room = vec![stepper.joint(); 3];
    /// let rope = stepper.projected_joined_sites(SiteStorage::of(places, vec![Vector2::y(); 3]), room)?;
    /// assert!((rope.configuration()[2] - Vector2::x() * 2.0).norm() < 1e-15);
    /// assert_eq!(rope.momentum()[0], Vector2::zeros()); // it is fixed
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`joined_sites`](Self::joined_sites), and [`Error::FarFromConstraint`].
    pub fn projected_joined_sites<Points, Momenta, Rooms, const N: usize>(
        self,
        storage: SiteStorage<Points, Momenta>,
        room: Rooms,
    ) -> Result<Sites<P, Points, Momenta, N, Rooms>, SiteError>
    where
        P: Power<N, Scheme: JoinedInStorage<P, N>>,
        Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
        Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
        Rooms: AsMut<[Room<P, N>]>,
    {
        self.prepared_sites(storage, room, |sites| {
            sites.check_each()?;
            let SiteStorage { configuration, momentum, .. } = &mut sites.storage;
            let state = (array_mut(configuration.as_mut())?, array_mut(momentum.as_mut())?);
            Ok(P::Scheme::to_joints(sites.stepper.at(sites.time.now()), state, sites.room.as_mut())?)
        })
    }

    /// Sites in storage of the right size, whose state is checked after `prepare`.
    fn prepared_sites<Points, Momenta, Rooms, const N: usize>(
        self,
        storage: SiteStorage<Points, Momenta>,
        mut room: Rooms,
        prepare: impl FnOnce(&mut Sites<P, Points, Momenta, N, Rooms>) -> Result<(), SiteError>,
    ) -> Result<Sites<P, Points, Momenta, N, Rooms>, SiteError>
    where
        P: Power<N>,
        Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
        Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
        Rooms: AsMut<[Room<P, N>]>,
    {
        let points = once(&storage.configuration).chain(&storage.more_points).map(|one| one.as_ref().len());
        let momenta = once(&storage.momentum).chain(&storage.more_momenta).map(|one| one.as_ref().len());
        if let Some(found) = points.chain(momenta).find(|&found| found != N) {
            return Err(wrong_length::<N>(found));
        }
        // sites without joints need no room
        let found = room.as_mut().len();
        if size_of::<Room<P, N>>() > 0 && found != N {
            return Err(wrong_length::<N>(found));
        }
        let mut sites = Sites { stepper: self, time: Time::at(Zero::zero()), steps: 0, storage, room, factored: None };
        prepare(&mut sites)?;
        sites.check()?;
        sites.start_kick()?;
        Ok(sites)
    }

    /// The room of one joint, as [`joined_sites`](Self::joined_sites) takes it for each site.
    pub fn joint<const N: usize>(&self) -> Room<P, N>
    where
        P: Power<N>,
    {
        Default::default()
    }
}

impl<P, Points, Momenta, Rooms, const N: usize> Sites<P, Points, Momenta, N, Rooms>
where
    P: Power<N>,
    Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
    Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
    Rooms: AsMut<[Room<P, N>]>,
{
    /// Each site as a state of its own.
    fn check_each(&self) -> Result<(), SiteError> {
        let h = self.stepper.step_size();
        for (i, (q, mu)) in self.configuration().iter().zip(self.momentum()).enumerate() {
            let site = self.stepper.system().site(i).into_stepper(h).and_then(|site| site.state(*q, *mu));
            site.map_err(|error| SiteError { site: Some(i), error })?;
        }
        Ok(())
    }

    /// The same, and the joints of all of them.
    fn check(&mut self) -> Result<(), SiteError> {
        self.check_each()?;
        let state = (array(self.storage.configuration.as_ref())?, array(self.storage.momentum.as_ref())?);
        Ok(P::Scheme::check(self.stepper.at(self.time.now()), state, self.room.as_mut())?)
    }

    /// The kick at the configuration, for the steps that start there.
    fn start_kick(&mut self) -> Result<(), SiteError> {
        let SiteStorage { configuration: q, more_points: [_, gradient], more_momenta: [next, kick, _], .. } =
            &mut self.storage;
        let (q, mu) = (array_mut(q.as_mut())?, array_mut(next.as_mut())?);
        let (kick, gradient) = (array_mut(kick.as_mut())?, array_mut(gradient.as_mut())?);
        let factored = &mut None;
        P::Scheme::start(self.stepper.at(self.time.now()), Stored { q, mu, kick, gradient, factored });
        Ok(())
    }

    /// One step.
    ///
    /// # Errors
    /// Those of [`Stepper::step`], with the site. After an error the state is unchanged.
    pub fn step(&mut self) -> Result<(), SiteError> {
        self.stepped(None)
    }

    /// One step during which the input of the forces is `u`, as [`Stepper::step_with`] makes it.
    ///
    /// # Errors
    /// Those of [`Stepper::step_with`], with the site. After an error the state is unchanged.
    pub fn step_with(&mut self, u: &P::Input) -> Result<(), SiteError> {
        check_input::<P>(u)?;
        self.stepped(Some(u))
    }

    /// One step; an input that is not given is 0.
    fn stepped(&mut self, u: Option<&P::Input>) -> Result<(), SiteError> {
        self.stepped_by(|at, from, next, room| Ok(P::Scheme::step_from(at, from, u, next, room)?))
    }

    /// One step as `step` makes it, from a state to the place of another. It gives the sum of all numbers of the new state.
    #[inline(always)]
    fn stepped_by(
        &mut self,
        step: impl FnOnce(AtOf<'_, P, P::Scheme>, Start<'_, P>, Stored<'_, P>, &mut [Room<P, N>]) -> Summed<P>,
    ) -> Result<(), SiteError> {
        let time = self.time.after_step(self.stepper.step_size());
        if !time.now().is_finite() {
            return Err(SiteError { site: None, error: Error::NotFinite { name: "the time after the step" } });
        }
        let SiteStorage { configuration, momentum, more_points, more_momenta } = &mut self.storage;
        let ([next, gradient], [moved, kick, next_kick]) = (more_points, more_momenta);
        let from = (array(configuration.as_ref())?, array(momentum.as_ref())?, array(kick.as_ref())?);
        let (q, mu) = (array_mut(next.as_mut())?, array_mut(moved.as_mut())?);
        let (kick, gradient) = (array_mut(next_kick.as_mut())?, array_mut(gradient.as_mut())?);
        // after an error the room has those of another configuration
        let mut factored = self.factored.take();
        let next_state = Stored { q, mu, kick, gradient, factored: &mut factored };
        let sum = step(self.stepper.at(self.time.now()), from, next_state, self.room.as_mut())?;
        if !sum.is_finite()
            && let Some(error) = not_finite(next.as_ref(), moved.as_ref(), next_kick.as_ref())
        {
            return Err(error);
        }
        if P::MAY_LEAVE_ORBIT {
            for (i, q) in next.as_ref().iter().enumerate() {
                check_on_orbit(q, self.stepper.system().site(i).orbit_defect(q))
                    .map_err(|error| SiteError { site: Some(i), error })?;
            }
        }
        let SiteStorage { configuration, momentum, more_points: [next, _], more_momenta: [moved, kick, next_kick] } =
            &mut self.storage;
        swap(configuration, next);
        swap(momentum, moved);
        swap(kick, next_kick);
        (self.time, self.steps, self.factored) = (time, self.steps.saturating_add(1), factored);
        Ok(())
    }

    /// So many steps.
    ///
    /// # Errors
    /// Those of [`step`](Self::step); the state is the one before the step that failed.
    pub fn advance(&mut self, steps: u64) -> Result<(), SiteError> {
        (0..steps).try_for_each(|_| self.step())
    }

    /// The configurations q of all sites.
    pub fn configuration(&self) -> &[Point<P, N>] {
        self.storage.configuration.as_ref()
    }

    /// The momenta N of all sites.
    pub fn momentum(&self) -> &[SiteMomentum<P, N>] {
        self.storage.momentum.as_ref()
    }

    getters! {
        /// The system with its step size.
        ref stepper: Stepper<P>;
        /// The number of steps that it has made, at most 2⁶⁴ − 1.
        copy steps: u64;
    }

    /// The storage, with the present state in front.
    pub fn into_storage(self) -> SiteStorage<Points, Momenta> {
        self.storage
    }

    /// The kinetic energy of all sites plus the potential.
    ///
    /// # Errors
    /// None, but where the storage has changed its length.
    pub fn energy(&self) -> Result<P::Scalar, SiteError> {
        let (q, mu) = (array(self.configuration())?, array(self.momentum())?);
        let At { system, constants, t, .. } = self.stepper.at(self.time.now());
        Ok(system.power_kinetic_energy(P::Scheme::whole(constants), t, q, mu) + system.potential_of_sites(t, q))
    }

    /// The conserved momenta, sums over all sites.
    ///
    /// # Errors
    /// None, but where the storage has changed its length.
    pub fn conserved(&self) -> Result<P::Conserved, SiteError>
    where
        P: Conserves,
    {
        Ok(self.stepper.system().conserved(array(self.configuration())?, array(self.momentum())?))
    }
}

/// Where the sites have no joints.
impl<P, Points, Momenta, const N: usize> Sites<P, Points, Momenta, N>
where
    P: Power<N>,
    Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
    Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
{
    /// Adds an impulse Δμ to the momentum of a site, as [`Stepper::kick`] does.
    ///
    /// ```
    /// # use clebsch::{Clebsch, SiteStorage};
    /// # use nalgebra::Vector1;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action    = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
    /// #     cost      = |h, a| (0..N).map(|i| a[i].norm_squared() / (2 * h)).sum(),
    /// #     potential = |x| (0..N).map(|i| (x[(i + 1) % N] - x[i]).norm_squared() / 2).sum(),
    /// # )]
    /// # struct Ring<const N: usize>;
    /// let (places, momenta) = (vec![Vector1::zeros(); 8], vec![Vector1::zeros(); 8]);
    /// let mut ring = Ring::<8>.into_stepper(0.1)?.sites(SiteStorage::of(places, momenta))?;
    /// ring.kick(3, Vector1::new(2.0))?;
    /// ring.step()?;
    /// assert_eq!(ring.configuration()[3].x, 0.2);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NoSite`], [`Error::NotFinite`] and [`Error::OutsideMomentumSpace`] as for
    /// [`Stepper::kick`]. The state is unchanged.
    pub fn kick(&mut self, site: usize, impulse: SiteMomentum<P, N>) -> Result<(), SiteError> {
        let at_site = |error| SiteError { site: Some(site), error };
        let q = self.storage.configuration.as_ref().get(site);
        let mu = self.storage.momentum.as_mut().get_mut(site);
        let (Some(q), Some(mu)) = (q, mu) else { return Err(at_site(Error::NoSite { site, sites: N })) };
        check_finite("the impulse", &impulse).map_err(at_site)?;
        let defect = self.stepper.system().site(site).isotropy_defect(q, &impulse);
        check_violation(defect, &impulse).map_err(at_site)?;
        let kicked = plus(mu, &impulse);
        check_finite("the momentum after the kick", &kicked).map_err(at_site)?;
        *mu = kicked;
        Ok(())
    }
}

/// Where the sites are joined.
impl<P, Points, Momenta, Rooms, const N: usize> Sites<P, Points, Momenta, N, Rooms>
where
    P: Power<N, Scheme: JoinedInStorage<P, N>>,
    Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
    Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
    Rooms: AsMut<[Room<P, N>]>,
{
    /// The multipliers λ of the joints at this state, as [`Stepper::reactions`] has them: a vector for each site, written to
    /// `multipliers`. Returns those of the equations that close loops.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error, SiteStorage};
    /// # use nalgebra::{Vector1, Vector2};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
    /// #     lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
    /// #     potential  = |x| (0..N).map(|i| 10 * x[i].y).sum(),
    /// #     constraint = |x| [
    /// #         x[0].norm() == 1,
    /// #         (1..N).map(|i| (x[i] - x[i - 1]).norm() == 1),
    /// #     ],
    /// # )]
    /// # struct Rope<const N: usize>;
    /// // beads of 1 kg hang at rest: each rod carries those below it, 10 N each
    /// let stepper = Rope::<3>.into_stepper(0.1)?;
    /// let places = vec![-Vector2::y(), -Vector2::y() * 2.0, -Vector2::y() * 3.0];
    /// let room = vec![stepper.joint(); 3];
    /// let mut rope = stepper.joined_sites(SiteStorage::of(places, vec![Vector2::zeros(); 3]), room)?;
    /// let mut pulls = vec![Vector1::zeros(); 3];
    /// rope.reactions(&mut pulls)?;
    /// assert!((pulls[0].x + 30.0).abs() < 1e-13 && (pulls[2].x + 10.0).abs() < 1e-13);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NumberOfSites`] where `multipliers` has another length than N, [`Error::DependentConstraints`] with a site,
    /// [`Error::NotFinite`] where numbers overflow.
    pub fn reactions(&mut self, multipliers: &mut [Multipliers<P, N>]) -> Result<LoopMultipliers<P, N>, SiteError> {
        self.reactions_under(&Space::origin(), multipliers)
    }

    /// The same while the input of the forces is `u`.
    ///
    /// # Errors
    /// As [`reactions`](Self::reactions), and [`Error::NotFinite`] where the input is not.
    pub fn reactions_under(
        &mut self,
        u: &P::Input,
        multipliers: &mut [Multipliers<P, N>],
    ) -> Result<LoopMultipliers<P, N>, SiteError> {
        check_input::<P>(u)?;
        check_room::<_, N>(multipliers)?;
        let SiteStorage { configuration: q, momentum: mu, more_points: [_, gradient], more_momenta: [moved, _, kick] } =
            &mut self.storage;
        let state = (array(q.as_ref())?, array(mu.as_ref())?);
        let free = (array_mut(gradient.as_mut())?, array_mut(moved.as_mut())?, array_mut(kick.as_mut())?);
        let at = self.stepper.at(self.time.now());
        self.factored = None;
        let loops = P::Scheme::reactions(at, state, u, self.room.as_mut(), free, multipliers)?;
        check_reactions(multipliers, &loops)?;
        Ok(loops)
    }

    /// One step, as [`step`](Self::step), with the reactions of that step, as [`Stepper::step_with_reactions`] has them.
    /// They are the impulses of the joints divided by h, in units of force. A vector for each site is written to `multipliers`.
    /// Returns those of the equations that close loops.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error, SiteStorage};
    /// # use nalgebra::{Vector1, Vector2};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
    /// #     lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
    /// #     potential  = |x| (0..N).map(|i| 10 * x[i].y).sum(),
    /// #     constraint = |x| [
    /// #         x[0].norm() == 1,
    /// #         (1..N).map(|i| (x[i] - x[i - 1]).norm() == 1),
    /// #     ],
    /// # )]
    /// # struct Rope<const N: usize>;
    /// // a straight rope swings through its lowest point, 1 rad/s: its first rod carries all weights and centripetal forces
    /// let stepper = Rope::<3>.into_stepper(1e-3)?;
    /// let places = vec![-Vector2::y(), -Vector2::y() * 2.0, -Vector2::y() * 3.0];
    /// let velocities = vec![Vector2::x(), Vector2::x() * 2.0, Vector2::x() * 3.0];
    /// let room = vec![stepper.joint(); 3];
    /// let mut rope = stepper.joined_sites_moving(SiteStorage::of(places, velocities), room)?;
    /// let mut pulls = vec![Vector1::zeros(); 3];
    /// rope.step_with_reactions(&mut pulls)?;
    /// assert!((pulls[0].x + 3.0 * 10.0 + 1.0 + 2.0 + 3.0).abs() < 1e-4);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`step`](Self::step), [`Error::NumberOfSites`] where `multipliers` has another length than N, and
    /// [`Error::NotFinite`] where the reactions overflow. After an error the state is unchanged.
    pub fn step_with_reactions(
        &mut self,
        multipliers: &mut [Multipliers<P, N>],
    ) -> Result<LoopMultipliers<P, N>, SiteError> {
        self.step_with_reactions_under(&Space::origin(), multipliers)
    }

    /// The same while the input of the forces is `u`, as [`step_with`](Self::step_with).
    ///
    /// # Errors
    /// As [`step_with_reactions`](Self::step_with_reactions), and [`Error::NotFinite`] where the input is not.
    pub fn step_with_reactions_under(
        &mut self,
        u: &P::Input,
        multipliers: &mut [Multipliers<P, N>],
    ) -> Result<LoopMultipliers<P, N>, SiteError> {
        check_input::<P>(u)?;
        check_room::<_, N>(multipliers)?;
        let per_step = self.stepper.step_size().recip();
        let mut loops = LoopMultipliers::<P, N>::origin();
        multipliers.iter_mut().for_each(|of_site| *of_site = Space::origin());
        self.stepped_by(|at, (q, mu, kick), next, room| {
            next.q.copy_from_slice(q);
            next.mu.copy_from_slice(mu);
            next.kick.copy_from_slice(kick);
            let (_, sum) = P::Scheme::step_with_reactions(at, Some(u), next, room, (&mut *multipliers, &mut loops))?;
            multipliers.iter_mut().for_each(|of_site| *of_site = of_site.zip_map(of_site, |sum, _| sum * per_step));
            loops = loops.zip_map(&loops, |sum, _| sum * per_step);
            check_reactions(multipliers, &loops)?;
            Ok(sum)
        })?;
        Ok(loops)
    }
}

/// An input that is finite.
fn check_input<P: Clebsch>(u: &P::Input) -> Result<(), SiteError> {
    if u.all_finite() {
        return Ok(());
    }
    Err(SiteError { site: None, error: Error::NotFinite { name: "the input" } })
}

/// Room for the multipliers of N sites.
fn check_room<V, const N: usize>(multipliers: &[V]) -> Result<(), SiteError> {
    if multipliers.len() == N { Ok(()) } else { Err(wrong_length::<N>(multipliers.len())) }
}

/// Reactions that are finite.
fn check_reactions<T: Scalar, V: Space<T>, L: Space<T>>(multipliers: &[V], loops: &L) -> Result<(), SiteError> {
    let site = multipliers.iter().position(|of_site| !of_site.all_finite());
    if site.is_none() && loops.all_finite() {
        return Ok(());
    }
    Err(SiteError { site, error: Error::NotFinite { name: "the reactions of the constraint" } })
}

impl<P, Points, Momenta, Rooms, const N: usize> Drive for Sites<P, Points, Momenta, N, Rooms>
where
    P: Power<N>,
    Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
    Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
    Rooms: AsMut<[Room<P, N>]>,
{
    /// The configurations q and the momenta N of all sites.
    type State<'a>
        = (&'a [Point<P, N>], &'a [SiteMomentum<P, N>])
    where
        Self: 'a;
    type Error = SiteError;

    fn step(&mut self) -> Result<(), SiteError> {
        Self::step(self)
    }

    fn advance(&mut self, steps: u64) -> Result<(), SiteError> {
        Self::advance(self, steps)
    }

    fn state(&self) -> Self::State<'_> {
        (self.configuration(), self.momentum())
    }

    fn steps(&self) -> u64 {
        Self::steps(self)
    }
}

/// The first site whose state is not finite, and the quantity of it that is not.
#[cold]
fn not_finite<T: Scalar, Q: Space<T>, M: Space<T>>(q: &[Q], mu: &[M], kick: &[M]) -> Option<SiteError> {
    q.iter().zip(mu).zip(kick).enumerate().find_map(|(i, ((q, mu), kick))| {
        let name = match (q.all_finite(), kick.all_finite(), mu.all_finite()) {
            (true, true, true) => return None,
            (false, ..) => "the configuration after the step",
            (_, false, _) => "the gradient of the potential after the step",
            _ => "the momentum after the step",
        };
        Some(SiteError { site: Some(i), error: Error::NotFinite { name } })
    })
}

impl<P, Points, Momenta, Rooms, const N: usize> Sites<P, Points, Momenta, N, Rooms>
where
    P: Power<N> + Clebsch<Time = Clock<<P as Clebsch>::Scalar>>,
{
    /// The time t of the configuration, in the unit of the step size.
    pub fn time(&self) -> P::Scalar {
        Time::now(&self.time)
    }
}
