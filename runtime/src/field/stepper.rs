//! Steps of all sites of a field, in place.

use super::edges::Configured;
use super::lattice::{Sum, rows_of, summed};
use super::{Alike, FieldSite, Lattice, Population};
use crate::fields::getters;
use crate::parts::{Mu, Q, T, U};
use crate::scheme::{At, Constants, OfOrderEight, OfOrderFour, OfOrderSix, Scheme, Sizes, moved};
use crate::space::plus;
use crate::stepper::{check_momentum, check_on_orbit, check_step_size};
use crate::{Clebsch, Conserved, Conserves, Declared, Error, Method, Scalar, SiteError, Space, Time};
use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;
use core::ops::Range;
use num_traits::Zero;

/// The most sizes of the parts of a step: those of order 8.
const SIZES: usize = 9;

/// A field on a lattice with a step size.
///
/// Made by [`Domain::stepper`](super::Domain::stepper). One stepper serves any number of states.
///
/// ```
/// # use clebsch::{Clebsch, Field};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     cost   = |h, a| a.norm_squared() / (2 * h),
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// # )]
/// # struct Strand;
/// let stepper = Strand.grid([4]).spacing([0.5]).periodic().stepper(0.1)?;
/// let mut state = stepper.state([Vector1::zeros(); 4], [Vector1::new(2.0); 4])?;
/// stepper.advance(&mut state, 10)?;
/// assert!((state.configuration()[3].x - 2.0).abs() < 1e-14); // all move alike
/// # Ok::<(), clebsch::SiteError>(())
/// ```
#[derive(Clone)]
pub struct FieldStepper<S: Clebsch + Clone, G, P: Population = Alike> {
    systems: P::Of<S>,
    h: T<S>,
    lattice: G,
    stages: [Option<Stage<S, P>>; SIZES],
}

impl<S: Clebsch + Clone, G: Debug, P: Population> Debug for FieldStepper<S, G, P> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("FieldStepper").field("h", &self.h).field("lattice", &self.lattice).finish_non_exhaustive()
    }
}

/// A part of a step: γ_i h with the constants of steps of this size. These are γ_1, …, γ_k, and the same backwards.
#[derive(Clone)]
struct Stage<S: Clebsch, P: Population> {
    h: T<S>,
    constants: P::Of<Constants<S>>,
}

/// The state of a field: a configuration q and a momentum N for each site, in storage of the user's choice.
///
/// `Points` and `Momenta` are vectors, arrays or slices of one configuration or momentum for each site.
///
/// ```
/// # use clebsch::{Clebsch, Field};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     cost   = |h, a| a.norm_squared() / (2 * h),
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// # )]
/// # struct Strand;
/// let stepper = Strand.grid([3]).stepper(0.1)?;
/// let (mut places, mut momenta) = ([Vector1::zeros(); 3], [Vector1::new(1.0); 3]);
/// let mut state = stepper.state(&mut places[..], &mut momenta[..])?;
/// stepper.step(&mut state)?;
/// assert_eq!((state.steps(), state.momentum().len()), (1, 3));
/// # Ok::<(), clebsch::SiteError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldState<Points, Momenta, Time = ()> {
    pub(super) configuration: Points,
    pub(super) momentum: Momenta,
    pub(super) time: Time,
    pub(super) steps: u64,
    /// The error after which the state is that of no time.
    pub(super) failed: Option<SiteError>,
}

impl<Points, Momenta, C> FieldState<Points, Momenta, C> {
    /// The storage: configurations and momenta.
    pub fn into_storage(self) -> (Points, Momenta) {
        (self.configuration, self.momentum)
    }

    getters! {
        /// The configurations of all sites.
        ref configuration: Points;
        /// The momenta of all sites.
        ref momentum: Momenta;
        /// The number of steps that it has made, at most 2⁶⁴ − 1.
        copy steps: u64;
    }
}

impl<Points, Momenta, C> FieldState<Points, Momenta, C> {
    /// The time t; 0 for a field that does not depend on it.
    pub fn time<T: Scalar>(&self) -> T
    where
        C: Time<T>,
    {
        self.time.now()
    }
}

/// The configurations and the momenta of sites.
pub(super) type Sites<'s, S> = (&'s mut [Q<S>], &'s mut [Mu<S>]);

/// A part of a step: its number, and the time at which it starts.
#[derive(Clone, Copy)]
pub(super) struct Part<T> {
    number: usize,
    t: T,
}

/// The configurations and the momenta of a state.
type Parts<'s, S> = (&'s [Q<S>], &'s [Mu<S>]);

/// The error at a site.
fn at<V>(site: usize, result: Result<V, Error>) -> Result<V, SiteError> {
    result.map_err(|error| SiteError { site: Some(site), error })
}

impl From<Error> for SiteError {
    fn from(error: Error) -> Self {
        SiteError { site: None, error }
    }
}

impl<S: FieldSite + Clone, G: Lattice<S>, P: Population> FieldStepper<S, G, P> {
    pub(super) fn new(systems: P::Of<S>, lattice: G, h: T<S>) -> Result<Self, Error> {
        lattice.check()?;
        check_step_size(h)?;
        let sizes: &[f64] = match S::ORDER_OF_FIELD {
            4 => &OfOrderFour::SIZES,
            6 => &OfOrderSix::SIZES,
            8 => &OfOrderEight::SIZES,
            _ => &[1.0],
        };
        let mut stages = [const { None }; SIZES];
        for (stage, &size) in stages.iter_mut().zip(sizes) {
            let h = T::<S>::from_f64(size) * h;
            let constants = P::each(&systems, |_, system: &S| S::Scheme::constants(system, h))?;
            *stage = Some(Stage { h, constants });
        }
        Ok(Self { systems, h, lattice, stages })
    }

    getters! {
        /// The places of the sites.
        ref lattice: G;
    }

    /// The declared site with the parameters of a site; `None` if there is none of this number.
    #[inline]
    pub fn system(&self, site: usize) -> Option<&S> {
        self.systems.as_ref().get(P::number(site))
    }

    /// The step size h, seconds in SI units.
    #[inline]
    pub fn step_size(&self) -> T<S> {
        self.h
    }

    /// The sites with their configurations.
    pub(super) fn configured<'a>(&'a self, q: &'a [Q<S>]) -> Configured<'a, S, G, P> {
        Configured { systems: self.systems.as_ref(), lattice: &self.lattice, q, load: None, population: PhantomData }
    }

    /// A stepper of another step size.
    pub(super) fn of_step_size(&self, h: T<S>) -> Result<Self, Error> {
        Self::new(self.systems.clone(), self.lattice.clone(), h)
    }

    /// The step of a composed one with its size and constants; `None` after the last.
    fn stage(&self, number: usize) -> Option<&Stage<S, P>> {
        let count = self.stages.iter().flatten().count();
        let index = if number < count { number } else { (2 * count).checked_sub(number + 2)? };
        self.stages.get(index)?.as_ref()
    }

    /// The parameters of the sites from one on in their order, with the constants of one part of a step.
    fn all<'a>(&'a self, first: usize, stage: &'a Stage<S, P>) -> impl Iterator<Item = (&'a S, &'a Constants<S>)> {
        let (systems, constants) = (self.systems.as_ref(), stage.constants.as_ref());
        (first..self.lattice.sites()).map_while(|i| Some((systems.get(P::number(i))?, constants.get(P::number(i))?)))
    }

    /// The state with a configuration and a momentum for each site. Where the time matters it starts at 0.
    ///
    /// The momenta of sites on a fixed side are not read; they are 0 in the state.
    ///
    /// # Errors
    /// [`Error::NumberOfSites`] for storage of another length than there are sites, and those of
    /// [`Stepper::state`](crate::Stepper::state), with the site.
    pub fn state<Points, Momenta>(
        &self,
        configuration: Points,
        momentum: Momenta,
    ) -> Result<FieldState<Points, Momenta, S::Time>, SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        let time = Time::at(Zero::zero());
        let mut state = FieldState { configuration, momentum, time, steps: 0, failed: None };
        self.check_sites(&mut state)?;
        Ok(state)
    }

    /// There are a configuration and a momentum for each site, and they can be those of a state. Momenta of sites that do not move become 0.
    pub(super) fn check_sites<Points, Momenta>(
        &self,
        state: &mut FieldState<Points, Momenta, S::Time>,
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        let (q, mu) = (state.configuration.as_ref(), state.momentum.as_mut());
        self.check_lengths(q, mu)?;
        self.clear_fixed(mu);
        for (i, ((q, mu), system)) in q.iter().zip(&*mu).zip(self.each()).enumerate() {
            at(i, check_momentum(system, q, mu).and_then(|()| system.check_kinetic_energy(state.time.now(), q)))?;
        }
        Ok(())
    }

    /// The parameters of all sites in their order.
    pub(super) fn each(&self) -> impl Iterator<Item = &S> {
        let systems = self.systems.as_ref();
        (0..self.lattice.sites()).map_while(|i| systems.get(P::number(i)))
    }

    pub(super) fn check_lengths(&self, q: &[Q<S>], mu: &[Mu<S>]) -> Result<(), SiteError> {
        let sites = self.lattice.sites();
        match [q.len(), mu.len()].into_iter().find(|&found| found != sites) {
            Some(found) => Err(Error::NumberOfSites { found, sites }.into()),
            None => Ok(()),
        }
    }

    /// There is an input for each site, and all are finite.
    pub(super) fn check_inputs(&self, inputs: &[U<S>]) -> Result<(), SiteError> {
        let (found, sites) = (inputs.len(), self.lattice.sites());
        if found != sites {
            return Err(Error::NumberOfSites { found, sites }.into());
        }
        match inputs.iter().position(|u| !u.all_finite()) {
            Some(site) => at(site, Err(Error::NotFinite { name: "the input" })),
            None => Ok(()),
        }
    }

    /// The momenta of sites that do not move, to 0.
    pub(super) fn clear_fixed(&self, mu: &mut [Mu<S>]) {
        if self.lattice.has_fixed() || self.lattice.own().len() < mu.len() {
            let fixed = mu.iter_mut().enumerate().filter(|(i, _)| self.lattice.is_fixed(*i));
            fixed.for_each(|(_, mu)| *mu = Space::origin());
        }
    }

    /// One step, in place.
    ///
    /// # Errors
    /// Those of [`Stepper::step`](crate::Stepper::step), with the site. The state is then that of no time: each further step gives the same error.
    pub fn step<Points, Momenta>(&self, state: &mut FieldState<Points, Momenta, S::Time>) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        self.advance(state, 1)
    }

    /// So many steps, in place. Kicks that follow each other are one.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn advance<Points, Momenta>(
        &self,
        state: &mut FieldState<Points, Momenta, S::Time>,
        steps: u64,
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        let block = self.lattice.rows_of_neighbours(P::ARE_ALIKE).map(|row| BLOCK.div_ceil(row.max(1)) * row);
        self.tried(state, steps, |at, part, (q, mu)| match (part, block) {
            (Some(part), Some(block)) if block > 0 && q.len() > 3 * block => self.pass(at, part, block, (q, mu)),
            _ => self.kick_then_drift(at, part, (q, mu), None),
        })
    }

    /// A kick of all sites and their drift in one pass through memory, block after block. A block drifts once its neighbours have their
    /// kicks, which read its configurations.
    fn pass(&self, at: (T<S>, T<S>), part: Part<T<S>>, block: usize, (q, mu): Sites<'_, S>) -> Result<(), SiteError> {
        let sites = q.len();
        let range = |number: usize| number * block..((number + 1) * block).min(sites);
        let drift = |number: usize, (q, mu): Sites<'_, S>| {
            let range = range(number);
            let moved = (q.get_mut(range.clone()).unwrap_or_default(), mu.get_mut(range.clone()).unwrap_or_default());
            self.drift(part, range.start, moved, None)
        };
        let last = sites.div_ceil(block) - 1;
        for number in 0..=last {
            let range = range(number);
            self.kick(at, q, (range.start, mu.get_mut(range).unwrap_or_default()));
            if number > 1
                && let Err(error) = drift(number - 1, (&mut *q, &mut *mu))
            {
                // of several sites the first one is named
                return drift(0, (q, mu)).and(Err(error));
            }
        }
        drift(0, (&mut *q, &mut *mu))?;
        drift(last, (q, mu))
    }

    /// A kick of the sites that are moved here, and then their drift where there is one.
    fn kick_then_drift(
        &self,
        at: (T<S>, T<S>),
        part: Option<Part<T<S>>>,
        (q, mu): Sites<'_, S>,
        inputs: Option<&[U<S>]>,
    ) -> Result<(), SiteError> {
        self.kick_own(at, q, mu);
        let Some(part) = part else { return Ok(()) };
        let (first, own) = self.own((q, mu));
        self.drift(part, first, own, inputs)
    }

    /// [`advance`](Self::advance) of a part of a field, whose neighbours are moved elsewhere: see [`Slab`](crate::Slab).
    ///
    /// After each move of its own sites `exchange` gets the configurations of all sites here, and the result of the move. It hands its own
    /// sites on, writes those of neighbours, and gives the result that counts. At the start the state has the sites of neighbours as
    /// they are then.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Field};
    /// # use nalgebra::Vector1;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action = |a: Translation<1>, x: Vector1| x + a,
    /// #     cost   = |h, a| a.norm_squared() / (2 * h),
    /// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
    /// # )]
    /// # struct Strand;
    /// let grid = Strand.grid([6]).periodic();
    /// let (upper, lower) = (grid.slab(0..3)?.stepper(0.1)?, grid.slab(3..6)?.stepper(0.1)?);
    /// // rows 3 to 5 do the same as rows 0 to 2, so that each part knows its neighbours
    /// let height = |row: usize| Vector1::new((row % 3) as f64);
    /// let start = [0, 1, 2, 3, 5].map(height);
    /// let mut part = upper.state(start, [Vector1::zeros(); 5])?;
    /// upper.advance_exchanging(&mut part, 100, |q, result| {
    ///     (q[3], q[4]) = (q[0], q[2]);
    ///     result
    /// })?;
    /// let mut whole = grid.stepper(0.1)?.state([0, 1, 2, 3, 4, 5].map(height), [Vector1::zeros(); 6])?;
    /// # let grid = Strand.grid([6]).periodic().stepper(0.1)?;
    /// grid.advance(&mut whole, 100)?;
    /// assert_eq!(part.configuration()[..3], whole.configuration()[..3]);
    /// # Ok::<(), clebsch::SiteError>(())
    /// ```
    ///
    /// # Errors
    /// As [`step`](Self::step), and those of `exchange`.
    pub fn advance_exchanging<Points, Momenta>(
        &self,
        state: &mut FieldState<Points, Momenta, S::Time>,
        steps: u64,
        mut exchange: impl FnMut(&mut [Q<S>], Result<(), SiteError>) -> Result<(), SiteError>,
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        self.tried(state, steps, |at, part, (q, mu)| {
            let result = self.kick_then_drift(at, part, (&mut *q, mu), None);
            if part.is_some() { exchange(q, result) } else { result }
        })
    }

    /// The sites that are moved here, from a number on.
    fn own<'s>(&self, (q, mu): Sites<'s, S>) -> (usize, Sites<'s, S>) {
        let own = self.lattice.own();
        (own.start, (q.get_mut(own.clone()).unwrap_or_default(), mu.get_mut(own).unwrap_or_default()))
    }

    /// Adds the forces at a time, times `weight`, to the momenta of the sites that are moved here.
    fn kick_own(&self, at: (T<S>, T<S>), q: &[Q<S>], mu: &mut [Mu<S>]) {
        let own = self.lattice.own();
        self.kick(at, q, (own.start, mu.get_mut(own).unwrap_or_default()));
    }

    /// One step, in place, during which the input of the forces on each site is that of `inputs`.
    ///
    /// # Errors
    /// As [`step`](Self::step). [`Error::NumberOfSites`] for inputs of another number, and [`Error::NotFinite`] for one that is
    /// not finite, with the site; the state is then unchanged.
    pub fn step_with<Points, Momenta>(
        &self,
        state: &mut FieldState<Points, Momenta, S::Time>,
        inputs: &[U<S>],
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        self.check_inputs(inputs)?;
        self.tried(state, 1, |at, part, sites| self.kick_then_drift(at, part, sites, Some(inputs)))
    }

    /// One step, in place, with a visit of the configurations before each kick of this weight.
    pub(super) fn step_visited<Points, Momenta>(
        &self,
        state: &mut FieldState<Points, Momenta, S::Time>,
        mut visit: impl FnMut(T<S>, &[Q<S>]),
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        self.tried(state, 1, |at, part, (q, mu)| {
            visit(at.1, q);
            self.kick_then_drift(at, part, (q, mu), None)
        })
    }

    /// Steps made of passes: a kick of all sites, with the drift after it but for the last one. A pass that fails is noted in the state.
    pub(super) fn tried<Points, Momenta>(
        &self,
        state: &mut FieldState<Points, Momenta, S::Time>,
        steps: u64,
        pass: impl FnMut((T<S>, T<S>), Option<Part<T<S>>>, Sites<'_, S>) -> Result<(), SiteError>,
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        if let Some(error) = state.failed {
            return Err(error);
        }
        let result = self.advanced(state, steps, pass);
        state.failed = result.err();
        result
    }

    fn advanced<Points, Momenta>(
        &self,
        state: &mut FieldState<Points, Momenta, S::Time>,
        steps: u64,
        mut pass: impl FnMut((T<S>, T<S>), Option<Part<T<S>>>, Sites<'_, S>) -> Result<(), SiteError>,
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        let FieldState { configuration, momentum, time, steps: made, .. } = state;
        let (q, mu) = (configuration.as_mut(), momentum.as_mut());
        let half = T::<S>::from_f64(0.5);
        let Some(first) = self.stage(0).map(|stage| stage.h).filter(|_| steps > 0) else { return Ok(()) };
        self.check_lengths(q, mu)?;
        // the kick that is next
        let mut at = (time.now(), half * first);
        for step in 1..=steps {
            let after = time.after_step(self.step_size());
            if !after.now().is_finite() {
                return Err(Error::NotFinite { name: "the time after the step" }.into());
            }
            let mut part = Part { number: 0, t: time.now() };
            while let Some(stage) = self.stage(part.number) {
                pass(at, Some(part), (&mut *q, &mut *mu))?;
                part.number += 1;
                // the kick at the end of this part of a step and that at the start of the next are one
                let next = match self.stage(part.number) {
                    Some(next) => {
                        part.t += stage.h;
                        next.h
                    }
                    None => {
                        part.t = after.now();
                        if step < steps { first } else { Zero::zero() }
                    }
                };
                at = (part.t, half * (stage.h + next));
            }
            *time = after;
            *made = made.saturating_add(1);
        }
        pass(at, None, (&mut *q, &mut *mu))?;
        // the last kick pushes all sites
        self.clear_fixed(mu);
        check_finite_sites(0, (q, mu), mu)
    }

    /// Adds the forces at a time, times `weight`, to the momenta of the sites from one on.
    fn kick(&self, (t, weight): (T<S>, T<S>), q: &[Q<S>], mu: (usize, &mut [Mu<S>])) {
        let systems = self.systems.as_ref();
        let Some(first) = systems.first() else { return };
        let site = |site| systems.get(P::number(site)).unwrap_or(first);
        self.lattice.kick((site, P::ARE_ALIKE), (t, weight), q, mu);
    }

    /// Moves the sites from one on, each by itself.
    pub(super) fn drift(
        &self,
        Part { number, t }: Part<T<S>>,
        first: usize,
        (q, mu): Sites<'_, S>,
        inputs: Option<&[U<S>]>,
    ) -> Result<(), SiteError> {
        let Some(stage) = self.stage(number) else { return Ok(()) };
        let (has_fixed, none) = (self.lattice.has_fixed(), U::<S>::origin());
        match self.all(first, stage).next() {
            // the loops that most fields have, without a question about each site
            Some((system, constants)) if P::ARE_ALIKE && !has_fixed && inputs.is_none() => {
                let at = At::new(system, constants, t);
                let alone = S::Scheme::whole(constants);
                let drifts_alone =
                    q.first().zip(mu.first()).is_some_and(|(q, mu)| system.drifted(alone, q, mu).is_some());
                // few at a time, which are still near when they are checked
                for (number, (q, mu)) in q.chunks_mut(FEW).zip(mu.chunks_mut(FEW)).enumerate() {
                    let first = first + number * FEW;
                    if drifts_alone {
                        // without a branch for each site, so that some are moved side by side
                        for (q, mu) in q.iter_mut().zip(&*mu) {
                            *q = system.drifted(alone, q, mu).unwrap_or(*q);
                        }
                        let mut is_finite = S::MENDS || are_finite(q);
                        if S::MENDS {
                            for q in &mut *q {
                                let is_found;
                                (*q, is_found) = S::mended(*q);
                                is_finite &= is_found;
                            }
                        }
                        if !is_finite {
                            return Err(failed::<S>(at, first, (q, mu)));
                        }
                        continue;
                    }
                    for (i, (q, mu)) in (first..).zip(q.iter_mut().zip(&mut *mu)) {
                        drift_of_site(at, (q, mu), &none).map_err(|error| (i, error))?;
                    }
                    check_finite_sites(first, (q, mu), q)?;
                }
                Ok(())
            }
            _ => {
                let sites = q.iter_mut().zip(&mut *mu).zip(self.all(first, stage));
                for (i, ((q, mu), (system, constants))) in (first..).zip(sites) {
                    if has_fixed && self.lattice.is_fixed(i) {
                        *mu = Space::origin();
                        continue;
                    }
                    let u = inputs.and_then(|inputs| inputs.get(i)).unwrap_or(&none);
                    drift_of_site(At::new(system, constants, t), (q, mu), u).map_err(|error| (i, error))?;
                }
                check_finite_sites(first, (q, mu), q)
            }
        }
    }

    /// The kinetic energies of all sites, their potentials, and the energies of all edges, in joules.
    ///
    /// # Errors
    /// [`Error::NumberOfSites`] for the state of another field.
    pub fn energy<Points, Momenta>(&self, state: &FieldState<Points, Momenta, S::Time>) -> Result<T<S>, SiteError>
    where
        Points: AsRef<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]>,
    {
        Ok(self.total(self.energy_of_rows(state)?))
    }

    /// The energies of the sites that are moved here, row by row, each with the energies of the edges that start there, in joules.
    ///
    /// In a grid the sites of a row have one place in the first direction. [`energy`](Self::energy) is the [`total`](Self::total).
    ///
    /// # Errors
    /// As [`energy`](Self::energy).
    pub fn energy_of_rows<'s, Points, Momenta>(
        &'s self,
        state: &'s FieldState<Points, Momenta, S::Time>,
    ) -> Result<impl Iterator<Item = T<S>> + 's, SiteError>
    where
        Points: AsRef<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]>,
    {
        let ((q, mu), t) = (self.parts(state)?, state.time.now());
        let field = self.configured(q);
        Ok(self.rows().map(move |row| self.kinetic_energy_of(row.clone(), t, (q, mu)) + field.energy_of(t, row)))
    }

    /// The sum of numbers of all rows in their order, with the bits of [`energy`](Self::energy) and of [`conserved`](Self::conserved).
    pub fn total(&self, of_rows: impl IntoIterator<Item = T<S>>) -> T<S> {
        summed(of_rows.into_iter())
    }

    /// The sites that are moved here, row by row.
    fn rows(&self) -> impl Iterator<Item = Range<usize>> + use<S, G, P> {
        rows_of(self.lattice.own(), self.lattice.row_length())
    }

    /// The kinetic energies of all sites.
    #[cfg(feature = "alloc")]
    pub(super) fn kinetic_energy<Points, Momenta>(
        &self,
        state: &FieldState<Points, Momenta, S::Time>,
    ) -> Result<T<S>, SiteError>
    where
        Points: AsRef<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]>,
    {
        let (sites, t) = (self.parts(state)?, state.time.now());
        Ok(summed(self.rows().map(|row| self.kinetic_energy_of(row, t, sites))))
    }

    /// The kinetic energies of some sites.
    fn kinetic_energy_of(&self, row: Range<usize>, t: T<S>, (q, mu): Parts<'_, S>) -> T<S> {
        let Some(stage) = self.stage(0) else { return Zero::zero() };
        let of_row = |start: usize| q.iter().zip(mu).skip(start).take(row.len());
        summed(of_row(row.start).zip(self.all(row.start, stage)).map(|((q, mu), (system, constants))| {
            <Declared as Method<S>>::kinetic_energy(system, S::Scheme::whole(constants), t, q, mu)
        }))
    }

    /// The momenta that no step changes, sums over all sites. A side that is fixed, or a lattice that is not the same
    /// everywhere, may change them.
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
        Ok(added(self.conserved_of_rows(state)?))
    }

    /// The momenta that no step changes, sums over the sites that are moved here, row by row as [`energy_of_rows`](Self::energy_of_rows).
    ///
    /// # Errors
    /// As [`conserved`](Self::conserved).
    pub fn conserved_of_rows<'s, Points, Momenta, const K: usize>(
        &'s self,
        state: &'s FieldState<Points, Momenta, S::Time>,
    ) -> Result<impl Iterator<Item = Conserved<T<S>, K>> + 's, SiteError>
    where
        S: Conserves<Conserved = Conserved<T<S>, K>>,
        Points: AsRef<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]>,
    {
        let (q, mu) = self.parts(state)?;
        let momentum = |site: usize| Some(self.system(site)?.conserved(q.get(site)?, mu.get(site)?));
        Ok(self.rows().map(move |row| added(row.filter_map(momentum))))
    }

    pub(super) fn parts<'s, Points, Momenta>(
        &self,
        state: &'s FieldState<Points, Momenta, S::Time>,
    ) -> Result<Parts<'s, S>, SiteError>
    where
        Points: AsRef<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]>,
    {
        let (q, mu) = (state.configuration.as_ref(), state.momentum.as_ref());
        self.check_lengths(q, mu)?;
        Ok((q, mu))
    }
}

/// The sums of momenta.
fn added<T: Scalar, const K: usize>(momenta: impl Iterator<Item = Conserved<T, K>>) -> Conserved<T, K> {
    let (mut names, mut sums) = ([""; K], [Sum::none(); K]);
    for momentum in momenta {
        names = *momentum.names();
        for (sum, (_, momentum)) in sums.iter_mut().zip(momentum.iter()) {
            sum.add(momentum);
        }
    }
    Conserved::new(names, sums.map(|sum| sum.value()))
}

/// Moves a site by itself, with the input u of its forces.
#[inline]
fn drift_of_site<S: Clebsch>(
    at: At<'_, S, Declared, Constants<S>>,
    (q, mu): (&mut Q<S>, &mut Mu<S>),
    u: &U<S>,
) -> Result<(), Error> {
    let (next, momentum) = moved::<S>(at, (q, mu), u)?;
    if S::MAY_LEAVE_ORBIT {
        check_on_orbit(&next, at.system.orbit_defect(&next))?;
    }
    (*q, *mu) = (next, momentum);
    Ok(())
}

/// The error of the first site that has moved to no configuration. Its momentum is that before the move.
#[cold]
fn failed<S: FieldSite>(
    at: At<'_, S, Declared, Constants<S>>,
    first: usize,
    (q, mu): (&[Q<S>], &[Mu<S>]),
) -> SiteError {
    let error = Error::NotFinite { name: "the state after a step" };
    for (site, (q, mu)) in (first..).zip(q.iter().zip(mu)) {
        if !S::mended(*q).1 {
            return (site, moved::<S>(at, (q, mu), &U::<S>::origin()).err().unwrap_or(error)).into();
        }
    }
    error.into()
}

/// The sites that are moved before they are checked.
const FEW: usize = 64;

/// The least number of sites in a block that drifts while it is near.
const BLOCK: usize = 512;

/// All numbers of the sites from one on are finite where those of `checked` are: their configurations after they have moved, or
/// their momenta. A momentum that is not finite leaves no configuration finite.
#[inline]
fn check_finite_sites<T: Scalar, Q: Space<T>, Mu: Space<T>>(
    first: usize,
    (q, mu): (&[Q], &[Mu]),
    checked: &[impl Space<T>],
) -> Result<(), SiteError> {
    if are_finite(checked) {
        return Ok(());
    }
    let wrong = q.iter().zip(mu).position(|(q, mu)| !(q.all_finite() && mu.all_finite()));
    wrong.map_or(Ok(()), |site| at(first + site, Err(Error::NotFinite { name: "the state after a step" })))
}

/// The values whose sums are made side by side, where they are short: no addition waits for the one before.
const ABREAST: usize = 4;
/// The most bytes of a short value.
const SHORT: usize = 32;

/// Whether the sums of some values are finite, component by component. Where a number is not, its sum is not.
#[inline]
fn are_finite<T: Scalar, V: Space<T>>(values: &[V]) -> bool {
    if size_of::<V>() > SHORT {
        return values.iter().fold(V::origin(), |sum, value| plus(&sum, value)).all_finite();
    }
    let mut sums = [V::origin(); ABREAST];
    let rows = values.chunks_exact(ABREAST);
    let others = rows.remainder();
    for row in rows {
        sums.iter_mut().zip(row).for_each(|(sum, value)| *sum = plus(sum, value));
    }
    sums.iter_mut().zip(others).for_each(|(sum, value)| *sum = plus(sum, value));
    sums.iter().all(Space::all_finite)
}

/// The sites that one thread takes at a time: few, so that no thread waits long for the last share of another.
#[cfg(feature = "rayon")]
const SHARE: usize = 1024;
/// The same where forces on a part of the sites cost more than their part.
#[cfg(feature = "rayon")]
const LARGE_SHARE: usize = 4096;

#[cfg(feature = "rayon")]
impl<S: FieldSite + Clone, G: Lattice<S>, P: Population> FieldStepper<S, G, P>
where
    Self: Sync,
    T<S>: Send + Sync,
    Q<S>: Send + Sync,
    Mu<S>: Send + Sync,
{
    /// [`advance`](Self::advance) on all threads of the present pool, with the same bits.
    ///
    /// Needs the feature `rayon`.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn par_advance<Points, Momenta>(
        &self,
        state: &mut FieldState<Points, Momenta, S::Time>,
        steps: u64,
    ) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        use rayon::prelude::*;
        let costs_its_part = self.lattice.rows_of_neighbours(P::ARE_ALIKE).is_some();
        let share = if costs_its_part { SHARE } else { LARGE_SHARE };
        let kick = |at: (T<S>, T<S>), q: &[Q<S>], mu: &mut [Mu<S>]| {
            let own = self.lattice.own();
            let first = own.start;
            let shares = mu.get_mut(own).unwrap_or_default().par_chunks_mut(share).enumerate();
            shares.for_each(|(number, mu)| self.kick(at, q, (first + number * share, mu)));
        };
        let drift = |part: Part<T<S>>, sites: Sites<'_, S>| {
            let (first, (q, mu)) = self.own(sites);
            let shares = q.par_chunks_mut(share).zip(mu.par_chunks_mut(share)).enumerate();
            let errors = shares.map(|(number, sites)| self.drift(part, first + number * share, sites, None).err());
            errors.reduce(|| None, Option::or).map_or(Ok(()), Err)
        };
        self.tried(state, steps, |at, part, (q, mu)| {
            kick(at, q, mu);
            part.map_or(Ok(()), |part| drift(part, (q, mu)))
        })
    }
}
