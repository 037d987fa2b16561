//! Many bodies, side by side.

mod chunk;

use super::Drive;
use crate::fields::debug_fields;
use crate::{Body, Clebsch, Clock, Conserved, Conserves, Declared, Error, Method, Scalar, Space, State, Stepper, Time};
use alloc::vec::Vec;
use chunk::Chunk;
use core::convert::Infallible;
use core::fmt::{self, Debug, Display, Formatter};

/// Many bodies of one declaration, as many side by side as its scalar has lanes.
///
/// Each body is stepped as it would be alone, with the same bits. One whose step fails stays where it is and tells [why](Self::failures).
///
/// ```
/// use clebsch::{Clebsch, F64x8, Scalar};
/// use nalgebra::{Matrix3, Vector3};
///
/// /// A body that turns freely, over any scalar.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action         = |F: SO<3>, R: SO<3>| R * F,
///     lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
///     discretization = moser_veselov,
/// )]
/// pub struct Rock<T: Scalar> {
///     /// Principal moments of inertia, kg·m².
///     pub moments: Vector3<T>,
/// }
///
/// let rock = Rock { moments: Vector3::new(1.0, 2.0, 2.5).map(F64x8::splat) };
/// let spins = (0..1000).map(|i| (Matrix3::identity(), Vector3::new(0.1, 2.0, 1e-3 * f64::from(i))));
/// let mut rocks = rock.stepper(F64x8::splat(0.01))?.ensemble(spins)?;
/// rocks.advance(100);
/// assert_eq!(rocks.failures().count(), 0);
/// for (attitude, momentum) in rocks.bodies() {
///     assert!(((attitude * momentum).x - 0.1).abs() < 1e-12);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Needs the feature `alloc`; the lanes need `lanes`. With the scalar `f64` bodies are stepped one by one.
pub struct Ensemble<S: Clebsch, M: Method<S> = Declared> {
    /// One for all chunks, or one for each.
    steppers: Vec<Stepper<S, M>>,
    chunks: Vec<Chunk<State<S, M>>>,
    bodies: usize,
    steps: u64,
}

/// A body that cannot be taken, or be stepped further.
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let starts = [(Vector1::zeros(), Vector1::new(2.0)), (Vector1::zeros(), Vector1::new(f64::NAN))];
/// let failure = Particle { mass: 2.0 }.into_stepper(0.5)?.ensemble(starts).unwrap_err();
/// assert_eq!(failure.body, 1);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    /// The body, counted from 0.
    pub body: usize,
    /// The number of steps that it has made.
    pub step: u64,
    /// Why.
    pub error: Error,
}

impl Display for Failure {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "body {} after step {}: {}", self.body, self.step, self.error)
    }
}

impl core::error::Error for Failure {}

debug_fields!(Ensemble<S, M> where [S: Clebsch + Debug, M: Method<S>]: steppers, chunks, bodies, steps);

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// This stepper with bodies at (q, N): stepped in place. Parameters and step size may differ between lanes: body i is in lane i mod [`LANES`](Scalar::LANES).
    ///
    /// # Errors
    /// The first body that [`state`](Self::state) refuses, and why.
    pub fn ensemble(self, bodies: impl IntoIterator<Item = Body<S>>) -> Result<Ensemble<S, M>, Failure> {
        Ensemble::gathered(Vec::from([self]), &bodies.into_iter().collect::<Vec<_>>())
    }
}

impl<S: Clebsch, M: Method<S>> Ensemble<S, M> {
    /// Bodies at (q, N) with parameters of their own: `stepper` makes that of the bodies whose numbers it is given, one for each lane.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Ensemble, F64x8, Scalar};
    /// # use nalgebra::Vector3;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action    = |a: Translation<3>, x: Vector3| x + a,
    /// #     cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
    /// #     potential = |x| x.norm_squared() / 2,
    /// # )]
    /// # pub struct Bob<T: Scalar> { pub mass: T }
    /// let masses = [1.0, 2.0, 3.0];
    /// let starts = masses.map(|_| (Vector3::x(), Vector3::y()));
    /// let bobs = Ensemble::with_parameters(starts, |bodies| {
    ///     Bob { mass: F64x8::from_lanes(|lane| masses[bodies[lane]]) }.stepper(F64x8::splat(0.1))
    /// })?;
    /// assert_eq!(bobs.energy(2), Some(1.0 / 6.0 + 0.5));
    /// # Ok::<(), clebsch::Failure>(())
    /// ```
    ///
    /// # Errors
    /// As [`Stepper::ensemble`], and those of `stepper`, with the first body of the lanes.
    pub fn with_parameters(
        bodies: impl IntoIterator<Item = Body<S>>,
        mut stepper: impl FnMut(&[usize]) -> Result<Stepper<S, M>, Error>,
    ) -> Result<Self, Failure> {
        let bodies: Vec<_> = bodies.into_iter().collect();
        let mut steppers = Vec::new();
        for first in (0..bodies.len()).step_by(S::Scalar::LANES) {
            let numbers: Vec<usize> = (0..S::Scalar::LANES).map(|lane| (first + lane).min(bodies.len() - 1)).collect();
            steppers.push(stepper(&numbers).map_err(|error| Failure { body: first, step: 0, error })?);
        }
        Self::gathered(steppers, &bodies)
    }

    fn gathered(steppers: Vec<Stepper<S, M>>, bodies: &[Body<S>]) -> Result<Self, Failure> {
        let mut chunks = Vec::new();
        for (number, chunk) in bodies.chunks(S::Scalar::LANES).enumerate() {
            let Some(stepper) = from(&steppers, number).first() else { break };
            chunks.push(Chunk::new(stepper, number * S::Scalar::LANES, chunk)?);
        }
        Ok(Self { steppers, chunks, bodies: bodies.len(), steps: 0 })
    }

    /// One step of every body.
    pub fn step(&mut self) {
        self.advance(1);
    }

    /// So many steps of every body, a few after the other: those whose numbers are near are near in memory.
    pub fn advance(&mut self, steps: u64) {
        for (group, chunks) in self.chunks.chunks_mut(chunk::TOGETHER).enumerate() {
            Chunk::advance(chunks, from(&self.steppers, group * chunk::TOGETHER), self.steps, steps);
        }
        self.steps = self.steps.saturating_add(steps);
    }

    /// The number of bodies.
    pub fn len(&self) -> usize {
        self.bodies
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.bodies == 0
    }

    /// The number of steps that it has made, at most 2⁶⁴ − 1.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// (q, N) of a body, the last that it reached; `None` where there is no such body.
    pub fn body(&self, body: usize) -> Option<Body<S>> {
        self.at(body).map(|(_, chunk, lane)| chunk.state_of(lane).lane(lane))
    }

    /// (q, N) of all bodies.
    pub fn bodies(&self) -> Bodies<'_, S, M> {
        Bodies { ensemble: self, next: 0 }
    }

    /// Puts a body somewhere else, at the present time; one that had failed goes on from there.
    ///
    /// # Errors
    /// Those of [`Stepper::state`], and [`Error::NoBody`]. The body stays as it was.
    pub fn set_body(&mut self, body: usize, (q, mu): Body<S>) -> Result<(), Error> {
        let error = Error::NoBody { body, bodies: self.bodies };
        let stepper = self.at(body).ok_or(error)?.0;
        let state = chunk::alone(stepper, &(q, mu))?;
        let (number, lane) = (body / S::Scalar::LANES, body % S::Scalar::LANES);
        self.chunks.get_mut(number).ok_or(error)?.put(lane, state);
        Ok(())
    }

    /// Adds an impulse Δμ to the momentum of a body, as [`Stepper::kick`] does; one that had failed goes on with it.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
    /// # struct Particle { mass: f64 }
    /// # use nalgebra::Vector1;
    /// let starts = [(Vector1::zeros(), Vector1::new(2.0)); 3];
    /// let mut particles = Particle { mass: 2.0 }.into_stepper(0.5)?.ensemble(starts)?;
    /// particles.kick(1, Vector1::new(-4.0))?;
    /// particles.step();
    /// let places: Vec<f64> = particles.bodies().map(|(x, _)| x.x).collect();
    /// assert_eq!(places, [0.5, -0.5, 0.5]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Stepper::kick`], and [`Error::NoBody`]. The body stays as it was.
    pub fn kick(&mut self, body: usize, impulse: <S::Momentum as Space<S::Scalar>>::Lane) -> Result<(), Error> {
        let error = Error::NoBody { body, bodies: self.bodies };
        let (stepper, chunk, lane) = self.at(body).ok_or(error)?;
        let alone = chunk::in_all_lanes(chunk.state_of(lane), lane);
        let kicked = stepper.kick(&alone, S::Momentum::side_by_side(|_| impulse))?;
        self.chunks.get_mut(body / S::Scalar::LANES).ok_or(error)?.put(lane, kicked);
        Ok(())
    }

    /// Kinetic energy plus potential of a body, as [`Stepper::energy`].
    pub fn energy(&self, body: usize) -> Option<<S::Scalar as Scalar>::Lane> {
        let (stepper, chunk, lane) = self.at(body)?;
        Some(Scalar::lane(stepper.energy(chunk.state_of(lane)), lane))
    }

    /// The bodies that have failed, and why.
    pub fn failures(&self) -> impl Iterator<Item = Failure> + '_ {
        self.chunks.iter().flat_map(Chunk::failures)
    }

    /// Why a body has failed; `None` where it has not.
    pub fn failure(&self, body: usize) -> Option<Failure> {
        self.at(body)?.1.failures().find(|failure| failure.body == body)
    }

    /// Where a body is.
    fn at(&self, body: usize) -> Option<Place<'_, S, M>> {
        let number = body / S::Scalar::LANES;
        let chunk = self.chunks.get(number).filter(|_| body < self.bodies)?;
        Some((from(&self.steppers, number).first()?, chunk, body % S::Scalar::LANES))
    }
}

#[cfg(feature = "rayon")]
impl<S: Clebsch, M: Method<S>> Ensemble<S, M>
where
    State<S, M>: Send,
    Stepper<S, M>: Sync,
{
    /// [`advance`](Self::advance) on all threads of the present pool, with the same bits.
    ///
    /// Needs the feature `rayon`.
    pub fn par_advance(&mut self, steps: u64) {
        use rayon::prelude::*;
        /// The least number of groups of chunks that a thread takes at a time.
        const SHARE: usize = 4;
        let (first, steppers) = (self.steps, &self.steppers);
        self.chunks.par_chunks_mut(chunk::TOGETHER).enumerate().with_min_len(SHARE).for_each(|(group, chunks)| {
            Chunk::advance(chunks, from(steppers, group * chunk::TOGETHER), first, steps);
        });
        self.steps = self.steps.saturating_add(steps);
    }
}

/// The stepper, the chunk and the lane of a body.
type Place<'a, S, M> = (&'a Stepper<S, M>, &'a Chunk<State<S, M>>, usize);

/// The bodies of an [`Ensemble`], each by (q, N).
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let starts = [(Vector1::zeros(), Vector1::new(2.0)), (Vector1::zeros(), Vector1::new(4.0))];
/// let mut particles = Particle { mass: 2.0 }.into_stepper(0.5)?.ensemble(starts)?;
/// particles.step();
/// let places: Vec<f64> = particles.bodies().map(|(x, _)| x.x).collect();
/// assert_eq!(places, [0.5, 1.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Bodies<'a, S: Clebsch, M: Method<S> = Declared> {
    ensemble: &'a Ensemble<S, M>,
    next: usize,
}

impl<S: Clebsch, M: Method<S>> Clone for Bodies<'_, S, M> {
    fn clone(&self) -> Self {
        Self { ensemble: self.ensemble, next: self.next }
    }
}

debug_fields!(Bodies<'_, S, M> where [S: Clebsch + Debug, M: Method<S>]: ensemble, next);

impl<S: Clebsch, M: Method<S>> Iterator for Bodies<'_, S, M> {
    type Item = Body<S>;

    fn next(&mut self) -> Option<Body<S>> {
        let body = self.ensemble.body(self.next)?;
        self.next += 1;
        Some(body)
    }
}

/// A body that fails keeps no other, so that no step of all fails: [`Ensemble::failures`] tells.
impl<S: Clebsch, M: Method<S>> Drive for Ensemble<S, M> {
    type State<'a>
        = Bodies<'a, S, M>
    where
        Self: 'a;
    type Error = Infallible;

    fn step(&mut self) -> Result<(), Infallible> {
        Self::step(self);
        Ok(())
    }

    fn advance(&mut self, steps: u64) -> Result<(), Infallible> {
        Self::advance(self, steps);
        Ok(())
    }

    fn state(&self) -> Bodies<'_, S, M> {
        self.bodies()
    }

    fn steps(&self) -> u64 {
        Self::steps(self)
    }
}

impl<S, M: Method<S>, const K: usize> Ensemble<S, M>
where
    S: Conserves<Conserved = Conserved<<S as Clebsch>::Scalar, K>>,
{
    /// The momenta of a body that no step changes, as [`Stepper::conserved`].
    pub fn conserved(&self, body: usize) -> Option<Conserved<<S::Scalar as Scalar>::Lane, K>> {
        let (stepper, chunk, lane) = self.at(body)?;
        Some(stepper.conserved(chunk.state_of(lane)).lane(lane))
    }
}

impl<S: Clebsch<Time = Clock<<S as Clebsch>::Scalar>>, M: Method<S>> Ensemble<S, M> {
    /// The time of a body, of the last state that it reached.
    pub fn time(&self, body: usize) -> Option<<S::Scalar as Scalar>::Lane> {
        let (_, chunk, lane) = self.at(body)?;
        Some(Scalar::lane(Time::now(&chunk.state_of(lane).time), lane))
    }
}

/// The steppers from that of chunk `number` on, or the one that all have.
fn from<S: Clebsch, M: Method<S>>(steppers: &[Stepper<S, M>], number: usize) -> &[Stepper<S, M>] {
    if steppers.len() == 1 { steppers } else { steppers.get(number..).unwrap_or_default() }
}
