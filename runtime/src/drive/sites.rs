//! The state of a power in storage of the user's choice.

use super::Drive;
use crate::power::{Point, Power, SiteMomentum};
use crate::scheme::Scheme;
use crate::{Clebsch, Clock, Conserves, Error, Scalar, Space, Stepper, Time};
use core::fmt::{self, Display, Formatter};

/// Where [`Sites`] keep what they need: for each site a configuration q and a momentum N, and room for the next state.
///
/// `Points` and `Momenta` are arrays, slices or vectors of one configuration or momentum for each site.
#[derive(Clone, Debug)]
pub struct SiteStorage<Points, Momenta> {
    /// The configurations to start from.
    pub configuration: Points,
    /// The momenta to start from.
    pub momentum: Momenta,
    /// Room for the next configurations and for the gradient of the potential; what is in it does not matter.
    pub more_points: [Points; 2],
    /// Room for the next momenta and for the kicks of two states; what is in it does not matter.
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiteError {
    /// The site, where it is one.
    pub site: Option<usize>,
    /// What is wrong there.
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
/// A step costs and computes what [`Stepper::step`] does, to the last bit; it reads one state and writes the other, so that the state is
/// what it was where a step fails.
#[derive(Clone, Debug)]
pub struct Sites<P, Points, Momenta, const N: usize>
where
    P: Clebsch,
{
    stepper: Stepper<P>,
    time: P::Time,
    steps: u64,
    /// q, q of the next state, ∂V/∂q
    points: [Points; 3],
    /// N, N of the next state, kick, kick of the next state
    momenta: [Momenta; 4],
}

/// A slice as the array that it is, of N entries.
macro_rules! sites {
    ($slice:expr, $n:ident) => {
        match $slice.try_into() {
            Ok(array) => array,
            Err(_) => {
                return Err(SiteError { site: None, error: Error::NumberOfSites { found: $slice.len(), sites: $n } })
            }
        }
    };
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
        Sites::new(self, storage)
    }
}

impl<P, Points, Momenta, const N: usize> Sites<P, Points, Momenta, N>
where
    P: Power<N>,
    Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
    Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
{
    fn new(stepper: Stepper<P>, storage: SiteStorage<Points, Momenta>) -> Result<Self, SiteError> {
        let SiteStorage { configuration, momentum, more_points: [p1, p2], more_momenta: [m1, m2, m3] } = storage;
        let (points, momenta) = ([configuration, p1, p2], [momentum, m1, m2, m3]);
        let time = Time::at(num_traits::Zero::zero());
        let mut sites = Self { stepper, time, steps: 0, points, momenta };
        let lengths = (sites.points.iter().map(|one| one.as_ref().len()))
            .chain(sites.momenta.iter().map(|one| one.as_ref().len()));
        if let Some(found) = { lengths }.find(|&found| found != N) {
            return Err(SiteError { site: None, error: Error::NumberOfSites { found, sites: N } });
        }
        sites.check()?;
        sites.kick()?;
        Ok(sites)
    }

    /// Each site as a state of its own.
    fn check(&self) -> Result<(), SiteError> {
        let h = self.stepper.step_size();
        for (i, (q, mu)) in self.configuration().iter().zip(self.momentum()).enumerate() {
            let at = |error| SiteError { site: Some(i), error };
            let site = self.stepper.system().site(i).into_stepper(h).map_err(at)?;
            site.state(*q, *mu).map_err(at)?;
        }
        Ok(())
    }

    /// The kick at the configuration, for the steps that start there.
    fn kick(&mut self) -> Result<(), SiteError> {
        let [q, _, gradient] = &mut self.points;
        let [_, next, kick, _] = &mut self.momenta;
        let (q, gradient): (&[Point<P, N>; N], &mut [Point<P, N>; N]) =
            (sites!(q.as_ref(), N), sites!(gradient.as_mut(), N));
        let kick: &mut [SiteMomentum<P, N>; N] = sites!(kick.as_mut(), N);
        // what is in the room for the next momenta does not matter
        let next: &mut [SiteMomentum<P, N>; N] = sites!(next.as_mut(), N);
        let weight = self.stepper.step_size() * Scalar::from_f64(if P::ORDER == 1 { 0.0 } else { -0.5 });
        self.stepper.system().kick_into(self.time.now(), q, weight, gradient, kick, next);
        Ok(())
    }

    /// One step.
    ///
    /// # Errors
    /// Those of [`Stepper::step`], with the site; the state is what it was.
    pub fn step(&mut self) -> Result<(), SiteError> {
        let (system, h) = (self.stepper.system(), self.stepper.step_size());
        let [q, next, gradient] = &mut self.points;
        let [mu, moved, kick, next_kick] = &mut self.momenta;
        let (q, next): (&[Point<P, N>; N], &mut [Point<P, N>; N]) = (sites!(q.as_ref(), N), sites!(next.as_mut(), N));
        let gradient: &mut [Point<P, N>; N] = sites!(gradient.as_mut(), N);
        let (mu, kick): (&[SiteMomentum<P, N>; N], &[SiteMomentum<P, N>; N]) =
            (sites!(mu.as_ref(), N), sites!(kick.as_ref(), N));
        let (moved, next_kick): (&mut [SiteMomentum<P, N>; N], &mut [SiteMomentum<P, N>; N]) =
            (sites!(moved.as_mut(), N), sites!(next_kick.as_mut(), N));
        let t = self.time.now();
        let first = P::ORDER == 1;
        let start = if first { None } else { Some(kick) };
        if let Err((site, error)) = system.drift_into(
            P::constants_of_sites(P::Scheme::whole(self.stepper.constants())),
            t,
            q,
            mu,
            start,
            next,
            moved,
        ) {
            return Err(SiteError { site: Some(site), error });
        }
        let time = self.time.after_step(h);
        if !time.now().is_finite() {
            return Err(SiteError { site: None, error: Error::NotFinite { name: "the time after the step" } });
        }
        let weight = h * Scalar::from_f64(if first { -1.0 } else { -0.5 });
        if !system.kick_into(t + h, next, weight, gradient, next_kick, moved).is_finite()
            && let Some(error) = not_finite(next, moved, next_kick)
        {
            return Err(error);
        }
        self.points.swap(0, 1);
        self.momenta.swap(0, 1);
        self.momenta.swap(2, 3);
        (self.time, self.steps) = (time, self.steps.saturating_add(1));
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
        self.points[0].as_ref()
    }

    /// The momenta N of all sites.
    pub fn momentum(&self) -> &[SiteMomentum<P, N>] {
        self.momenta[0].as_ref()
    }

    /// The system with its step size.
    pub fn stepper(&self) -> &Stepper<P> {
        &self.stepper
    }

    /// The number of steps that it has made, at most 2⁶⁴ − 1.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The storage, with the present state in front.
    pub fn into_storage(self) -> SiteStorage<Points, Momenta> {
        let ([configuration, p1, p2], [momentum, m1, m2, m3]) = (self.points, self.momenta);
        SiteStorage { configuration, momentum, more_points: [p1, p2], more_momenta: [m1, m2, m3] }
    }

    /// The kinetic energy of all sites plus the potential.
    ///
    /// # Errors
    /// None, but where the storage has changed its length.
    pub fn energy(&self) -> Result<P::Scalar, SiteError> {
        let q: &[Point<P, N>; N] = sites!(self.configuration(), N);
        let mu: &[SiteMomentum<P, N>; N] = sites!(self.momentum(), N);
        let (system, t) = (self.stepper.system(), self.time.now());
        Ok(system.power_kinetic_energy(P::constants_of_sites(P::Scheme::whole(self.stepper.constants())), t, q, mu)
            + system.potential_of_sites(t, q))
    }

    /// The conserved momenta, sums over all sites.
    ///
    /// # Errors
    /// None, but where the storage has changed its length.
    pub fn conserved(&self) -> Result<P::Conserved, SiteError>
    where
        P: Conserves + Clebsch<Configuration = [Point<P, N>; N], Momentum = [SiteMomentum<P, N>; N]>,
    {
        let q: &[Point<P, N>; N] = sites!(self.configuration(), N);
        let mu: &[SiteMomentum<P, N>; N] = sites!(self.momentum(), N);
        Ok(self.stepper.system().conserved(q, mu))
    }
}

impl<P, Points, Momenta, const N: usize> Drive for Sites<P, Points, Momenta, N>
where
    P: Power<N>,
    Points: AsRef<[Point<P, N>]> + AsMut<[Point<P, N>]>,
    Momenta: AsRef<[SiteMomentum<P, N>]> + AsMut<[SiteMomentum<P, N>]>,
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

/// The first site whose state is not finite, with the first of its parts that is not.
#[cold]
fn not_finite<T: Scalar, Q: Space<T>, M: Space<T>>(q: &[Q], mu: &[M], kick: &[M]) -> Option<SiteError> {
    q.iter().zip(mu).zip(kick).enumerate().find_map(|(i, ((q, mu), kick))| {
        let name = match (q.is_finite(), kick.is_finite(), mu.is_finite()) {
            (true, true, true) => return None,
            (false, ..) => "the configuration after the step",
            (_, false, _) => "the gradient of the potential after the step",
            _ => "the momentum after the step",
        };
        Some(SiteError { site: Some(i), error: Error::NotFinite { name } })
    })
}

impl<P, Points, Momenta, const N: usize> Sites<P, Points, Momenta, N>
where
    P: Power<N> + Clebsch<Time = Clock<<P as Clebsch>::Scalar>>,
{
    /// The time t of the configuration, in the unit of the step size.
    pub fn time(&self) -> P::Scalar {
        Time::now(&self.time)
    }
}
