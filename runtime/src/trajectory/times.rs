//! The states of a trajectory at given times.

use super::{Inputs, NoInputs, Trajectory};
use crate::fields::debug_fields;
use crate::parameters::check_finite;
use crate::scheme::Scheme;
use crate::{Clebsch, Clock, Declared, Error, Method, Real, Scalar, State, Stepper, Time};
use core::borrow::Borrow;
use core::fmt::Debug;
use core::iter::FusedIterator;
use num_traits::{One, Zero};

/// The states of a [`Trajectory`] at given times, made by [`at`](Trajectory::at) and [`every`](Trajectory::every). After an
/// error it yields nothing more.
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// let mut timed = stepper.trajectory(start).at([0.25, 3.0]);
/// assert_eq!(timed.next(), Some(stepper.step_for(&start, 0.25)));
/// assert_eq!(timed.next().and_then(Result::ok).map(|state| state.configuration().x), Some(9.0));
/// assert_eq!(timed.next(), None);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Timed<'a, S: Clebsch, I, M: Method<S> = Declared, U = NoInputs> {
    stepper: &'a Stepper<S, M>,
    /// The last step's end that is not after the last time.
    node: State<S, M>,
    clock: Clock<S::Scalar>,
    times: I,
    /// The last time, that of the start at first.
    last: S::Scalar,
    has_failed: bool,
    inputs: U,
    /// The input of the step from the node, once it has been asked for.
    input: Option<S::Input>,
    /// The end of that step, where its time is looked for.
    ahead: Option<State<S, M>>,
}

/// The times t₀ + kΔ, k = 0, 1, 2, …, of a [`Timed`] that [`every`](Trajectory::every) makes.
///
/// ```
/// # use clebsch::{Clebsch, Multiples, Timed};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// let frames: Timed<'_, Particle, Multiples<f64>> = stepper.trajectory(start).every(0.125);
/// assert_eq!(frames.take(2).count(), 2);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Multiples<T> {
    start: T,
    interval: T,
    number: u64,
}

impl<T: Real> Iterator for Multiples<T> {
    type Item = T;

    #[inline]
    fn next(&mut self) -> Option<T> {
        let time = self.start + T::from_f64(self.number as f64) * self.interval;
        self.number = self.number.saturating_add(1);
        Some(time)
    }
}

impl<'a, S: Clebsch<Scalar: Real>, M: Method<S>, U: Inputs<S, M>> Trajectory<'a, S, M, U> {
    /// The states at these times, one for each: a slice, a vector or any iterator of times, in the order of the steps.
    ///
    /// A time between the ends of two steps is reached by one step of a smaller size from the end before, as by
    /// [`Stepper::step_for`]. So its state has the order of the method, and its conserved momenta are exact. The steps
    /// themselves stay as they are, whatever times are asked for. So do the bits of their ends.
    ///
    /// Times count from the start of the trajectory. Where the time matters they are those of the states.
    /// Equal times give equal states.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<1>, x: Vector1| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
    /// # )]
    /// # struct Spring { mass: f64, stiffness: f64 }
    /// # use nalgebra::Vector1;
    /// let stepper = Spring { mass: 2.0, stiffness: 8.0 }.into_stepper(0.01)?;
    /// let start = stepper.state(Vector1::new(0.5), Vector1::zeros())?;
    /// let times = [0.0, 0.1234, 1.0, 2.7182];
    /// for (time, state) in times.iter().zip(stepper.trajectory(start).at(&times)) {
    ///     assert!((state?.configuration().x - 0.5 * (2.0 * time).cos()).abs() < 1e-3);
    /// }
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// Each state may be an error: [`Error::NotFinite`] for its time, [`Error::TimeOrder`] where it is before the last one, and those of
    /// [`Stepper::step`]. [`Error::Monitor`] where steps do not change the time any more.
    pub fn at<I>(self, times: I) -> Timed<'a, S, I::IntoIter, M, U>
    where
        I: IntoIterator<Item: Borrow<S::Scalar>>,
    {
        let Self { stepper, state: node, has_failed, inputs, .. } = self;
        let last = node.time.now();
        let (clock, times) = (Clock::at(last), times.into_iter());
        Timed { stepper, node, clock, times, last, has_failed, inputs, input: None, ahead: None }
    }

    /// The states at the times t₀, t₀ + Δ, t₀ + 2Δ, …, the start first. Endless; see [`at`](Self::at).
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
    /// # struct Particle { mass: f64 }
    /// # use nalgebra::Vector1;
    /// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
    /// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
    /// // frames of a film, eight in a second
    /// let places: Result<Vec<f64>, _> =
    ///     stepper.trajectory(start).every(0.125).take(4).map(|state| Ok(state?.configuration().x)).collect();
    /// assert_eq!(places, Ok::<_, clebsch::Error>(vec![0.0, 0.375, 0.75, 1.125]));
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`at`](Self::at). An interval against the direction of the steps is [`Error::TimeOrder`], in place of the second state.
    pub fn every(self, interval: S::Scalar) -> Timed<'a, S, Multiples<S::Scalar>, M, U> {
        let start = self.state.time.now();
        self.at(Multiples { start, interval, number: 0 })
    }
}

impl<S, M: Method<S>, I: Iterator<Item: Borrow<S::Scalar>>, U: Inputs<S, M>> Timed<'_, S, I, M, U>
where
    S: Clebsch<Scalar: Real>,
{
    /// The state at a time that is not before the last one, from the end of the last step before.
    fn reach(&mut self, time: S::Scalar) -> Result<State<S, M>, Error> {
        check_finite("the time", &time)?;
        let h = self.stepper.h;
        // how far a is behind b in the direction of the steps
        let behind = |a: S::Scalar, b: S::Scalar| if h < Zero::zero() { a - b } else { b - a };
        if behind(self.last, time) < Zero::zero() {
            return Err(Error::TimeOrder { time: time.to_f64(), before: self.last.to_f64() });
        }
        self.last = time;
        // two times that differ by rounding are the same
        let rounding = S::Scalar::from_ratio(2, 1) * S::Scalar::EPSILON * (time.abs() + h.abs());
        if M::Scheme::now(&self.node.left).is_some() {
            return self.reach_by_size(time, behind);
        }
        loop {
            let ahead = self.clock.after_step(h);
            if behind(time, ahead.now()) > rounding {
                break;
            }
            let input = self.input_of_step();
            self.node = self.stepper.step_with(&self.node, &input)?;
            (self.clock, self.input) = (ahead, None);
        }
        let left = time - self.clock.now();
        if left.abs() <= rounding {
            return Ok(self.node);
        }
        let input = self.input_of_step();
        self.stepper.step_for_with(&self.node, left, &input)
    }

    /// The same where steps take other times than h: the part of the last step that ends there is a root.
    fn reach_by_size(
        &mut self,
        time: S::Scalar,
        behind: impl Fn(S::Scalar, S::Scalar) -> S::Scalar,
    ) -> Result<State<S, M>, Error> {
        let h = self.stepper.h;
        let missing = |state: &State<S, M>| behind(state.time.now(), time);
        loop {
            let (node, input) = (self.node, self.input_of_step());
            if missing(&node).is_zero() {
                return Ok(node);
            }
            let next = match self.ahead {
                Some(next) => next,
                None => self.stepper.step_with(&node, &input)?,
            };
            self.ahead = Some(next);
            let took = next.time.now() - node.time.now();
            if took.is_zero() {
                return Err(Error::Monitor { value: 0.0 });
            }
            // two times that differ by rounding are the same
            let rounding = S::Scalar::from_ratio(2, 1) * S::Scalar::EPSILON * (time.abs() + took.abs());
            if missing(&node) <= rounding {
                return Ok(node);
            }
            if missing(&next) < -rounding {
                let ends = [(S::Scalar::zero(), missing(&node)), (S::Scalar::one(), missing(&next))];
                return reached(ends, rounding, |part| {
                    let state = self.stepper.step_for_with(&node, part * h, &input)?;
                    Ok((state, missing(&state)))
                });
            }
            (self.node, self.input, self.ahead) = (next, None, None);
        }
    }

    /// The input of the step from the node.
    fn input_of_step(&mut self) -> S::Input {
        *self.input.get_or_insert_with(|| self.inputs.input(&self.node))
    }
}

/// Secants that are tried before the bracket is halved each second time: then it ends, whatever the function is.
const SECANTS: u32 = 8;

/// The state at the root of a function that is positive at the first end and negative at the other, up to `rounding`.
///
/// The search of events closes its bracket to ε of the step, with twice as many evaluations. Here the value ends it.
fn reached<X, T: Real>(
    ends: [(T, T); 2],
    rounding: T,
    mut evaluate: impl FnMut(T) -> Result<(X, T), Error>,
) -> Result<X, Error> {
    let ([mut a, mut b], mut points, mut count) = (ends.map(|end| end.0), ends, 0);
    loop {
        let [before, last] = points;
        let secant = last.0 - last.1 * ((last.0 - before.0) / (last.1 - before.1));
        let is_tried = count < SECANTS || count % 2 == 0;
        // not NaN either
        let is_inside = a < secant && secant < b;
        let part = if is_tried && is_inside { secant } else { a + (b - a) * T::from_ratio(1, 2) };
        let (state, value) = evaluate(part)?;
        if value.abs() <= rounding || b - a <= T::EPSILON + T::EPSILON {
            return Ok(state);
        }
        if value > T::zero() {
            a = part;
        } else {
            b = part;
        }
        (points, count) = ([last, (part, value)], count + 1);
    }
}

impl<S, M: Method<S>, I: Iterator<Item: Borrow<S::Scalar>>, U: Inputs<S, M>> Iterator for Timed<'_, S, I, M, U>
where
    S: Clebsch<Scalar: Real>,
{
    type Item = Result<State<S, M>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.has_failed {
            return None;
        }
        let time = *self.times.next()?.borrow();
        let reached = self.reach(time);
        self.has_failed = reached.is_err();
        Some(reached)
    }
}

impl<S, M: Method<S>, I: FusedIterator<Item: Borrow<S::Scalar>>, U: Inputs<S, M>> FusedIterator
    for Timed<'_, S, I, M, U>
where
    S: Clebsch<Scalar: Real>,
{
}

/// The states of a [`Timed`] with their times, made by [`Timed::with_times`].
///
/// ```
/// # use clebsch::{Clebsch, Multiples, WithTimes};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// let timed: WithTimes<'_, Particle, Multiples<f64>> = stepper.trajectory(start).every(0.125).with_times();
/// for pair in timed.take(100) {
///     let (time, state) = pair?;
///     assert_eq!(state.configuration().x, 3.0 * time);
/// }
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct WithTimes<'a, S: Clebsch, I, M: Method<S> = Declared, U = NoInputs>(Timed<'a, S, I, M, U>);

impl<S, M: Method<S>, I: Iterator<Item: Borrow<S::Scalar>>, U: Inputs<S, M>> Iterator for WithTimes<'_, S, I, M, U>
where
    S: Clebsch<Scalar: Real>,
{
    type Item = Result<(S::Scalar, State<S, M>), Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let state = self.0.next()?;
        Some(state.map(|state| (self.0.last, state)))
    }
}

impl<S, M: Method<S>, I: FusedIterator<Item: Borrow<S::Scalar>>, U: Inputs<S, M>> FusedIterator
    for WithTimes<'_, S, I, M, U>
where
    S: Clebsch<Scalar: Real>,
{
}

impl<S: Clebsch, M: Method<S>, I: Clone, U: Clone> Clone for WithTimes<'_, S, I, M, U> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

debug_fields!(WithTimes<'_, S, I, M, U> where [S: Clebsch, I: Debug, M: Method<S>, U]: 0);

impl<'a, S: Clebsch, M: Method<S>, I, U> Timed<'a, S, I, M, U> {
    /// The same states, each with its time: `(time, state)`.
    pub fn with_times(self) -> WithTimes<'a, S, I, M, U> {
        WithTimes(self)
    }
}

impl<S: Clebsch, M: Method<S>, I, U> Timed<'_, S, I, M, U> {
    /// The end of the last step that has been made: after an error, the state before the step that failed.
    pub fn state(&self) -> &State<S, M> {
        &self.node
    }
}

impl<S: Clebsch, M: Method<S>, I: Clone, U: Clone> Clone for Timed<'_, S, I, M, U> {
    fn clone(&self) -> Self {
        Self { times: self.times.clone(), inputs: self.inputs.clone(), ..*self }
    }
}

debug_fields!(Timed<'_, S, I, M, U> where [S: Clebsch, I: Debug, M: Method<S>, U]: node, clock, times, last, has_failed);
