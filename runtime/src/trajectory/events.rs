//! Events: the times at which functions of the state cross zero.

mod search;

use super::{Inputs, NoInputs, Trajectory};
use crate::scheme::Scheme;
use crate::space::larger;
use crate::{Clebsch, Clock, Declared, Error, Method, Real, Scalar, State, Stepper, Time};
use core::fmt::{self, Debug, Formatter};
use num_traits::{One, Zero};
use search::{Found, dip, root};

/// The value of a function of the state, and the direction in which it has to cross zero to be an event.
///
/// ```
/// use clebsch::Crossing;
///
/// // the ground, 0.1 m below, is hit from above
/// let ground = |height: f64| Crossing::Falling(height + 0.1);
/// assert_eq!(ground(0.4), Crossing::Falling(0.5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crossing<T> {
    /// From below zero to above.
    Rising(T),
    /// From above zero to below.
    Falling(T),
    /// In either direction.
    Either(T),
}

impl<T: Real> Crossing<T> {
    /// The value.
    fn value(&self) -> T {
        let (Self::Rising(value) | Self::Falling(value) | Self::Either(value)) = *self;
        value
    }

    /// Whether leaving this side of zero is an event.
    fn counts_from(&self, is_above: bool) -> bool {
        match self {
            Self::Rising(_) => !is_above,
            Self::Falling(_) => is_above,
            Self::Either(_) => true,
        }
    }
}

/// An event of a [`Trajectory`].
///
/// ```
/// # use clebsch::{Clebsch, Crossing, Event};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// let mut walls = stepper.trajectory(start).events(100, |state| {
///     let x = state.configuration().x;
///     [Crossing::Rising(x - 9.0), Crossing::Rising(x - 4.0)]
/// });
/// let Some(Event { number, time, state }) = walls.next().transpose()? else { panic!("there are walls") };
/// assert_eq!(number, 1);
/// assert!((time - 4.0 / 3.0).abs() < 1e-15 && (state.configuration().x - 4.0).abs() < 1e-15);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Event<S: Clebsch, M: Method<S> = Declared> {
    /// Which of the functions has crossed zero, counted from 0.
    pub number: usize,
    /// When, from the start of the trajectory. Where the time matters it is that of the state.
    pub time: S::Scalar,
    /// The last state before the crossing, to the last places of the time.
    pub state: State<S, M>,
}

impl<S: Clebsch, M: Method<S>> Copy for Event<S, M> {}

impl<S: Clebsch, M: Method<S>> Clone for Event<S, M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Clebsch, M: Method<S>> PartialEq for Event<S, M> {
    fn eq(&self, other: &Self) -> bool {
        self.number == other.number && self.time == other.time && self.state == other.state
    }
}

impl<S: Clebsch, M: Method<S>> Debug for Event<S, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Event");
        shown.field("number", &self.number).field("time", &self.time).field("state", &self.state).finish()
    }
}

/// A crossing with its state.
type FoundState<S, M> = Found<State<S, M>, <S as Clebsch>::Scalar>;
/// The crossings of a function in a step, at most two.
type FoundInStep<S, M> = [Option<FoundState<S, M>>; 2];
/// The end of a step with the values there.
type End<S, M, const K: usize> = (State<S, M>, [<S as Clebsch>::Scalar; K]);

/// The events of a [`Trajectory`] in the order of their times, made by [`events`](Trajectory::events). After an error, and
/// after the most steps, it yields nothing more.
///
/// ```
/// # use clebsch::{Clebsch, Crossing};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// let mut never = stepper.trajectory(start).events(100, |state| [Crossing::Falling(state.configuration().x + 1.0)]);
/// assert!(never.next().is_none());
/// assert_eq!((never.steps_left(), never.state().configuration().x), (0, 150.0));
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Events<'a, S: Clebsch, G, const K: usize, M: Method<S> = Declared, U = NoInputs> {
    stepper: &'a Stepper<S, M>,
    function: G,
    /// The end of a step before the next event.
    node: State<S, M>,
    clock: Clock<S::Scalar>,
    /// The values there; `None` where they are not known yet.
    values: Option<[S::Scalar; K]>,
    /// The values one step before, where that is of the full size.
    before: Option<[S::Scalar; K]>,
    /// On which side of zero the functions are, up to the last event.
    is_above: [bool; K],
    /// The end of the step from the node, with its values, once it has been searched.
    next: Option<End<S, M, K>>,
    /// The part of the step from the node after which the sides are known.
    known_from: [S::Scalar; K],
    /// The sizes of the values in the last step.
    sizes: [S::Scalar; K],
    /// The crossings in this step that have not been yielded, at most two of each function.
    found: [FoundInStep<S, M>; K],
    /// The event that has been yielded last, since the last state was set.
    yielded: Option<Event<S, M>>,
    /// The event at which a state was set, until its side is known.
    set_at: Option<usize>,
    steps_left: usize,
    has_ended: bool,
    inputs: U,
    /// The input of the step from the node, once it has been asked for.
    input: Option<S::Input>,
}

impl<'a, S: Clebsch<Scalar: Real>, M: Method<S>, U: Inputs<S, M>> Trajectory<'a, S, M, U> {
    /// The events in at most `steps` steps: the crossings of zero of the K numbers that `function` computes from a state.
    ///
    /// A crossing shows by the signs at the ends of a step. Its time is then found to the last places. Steps of a
    /// fraction of h from the end before, as by [`Stepper::step_for`], shrink a bracket around it. An event so has the
    /// order of the method, and its conserved momenta are exact. Two crossings in one step show where the parabola through three ends
    /// comes near zero. Choose steps that resolve the functions.
    ///
    /// There are three ways to go on after an event:
    ///
    /// * stop, by dropping the iterator;
    /// * go on, by asking for the next event: the steps are those without the event, to the last bit;
    /// * change the motion, by [`go_on_from`](Events::go_on_from) a state, such as that of a [kick](Stepper::kick).
    ///
    /// ```
    /// # use clebsch::{Clebsch, Crossing};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<2>, x: Vector2| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     potential  = |x| self.mass * self.gravity * x.y,
    /// # )]
    /// # struct Ball { mass: f64, gravity: f64 }
    /// # use nalgebra::Vector2;
    /// // dropped from 1.25 m; the floor returns 0.8 of the velocity
    /// let stepper = Ball { mass: 0.5, gravity: 10.0 }.into_stepper(0.01)?;
    /// let start = stepper.state(Vector2::new(0.0, 1.25), Vector2::new(0.3, 0.0))?;
    /// let mut bounces = stepper.trajectory(start).events(1000, |state| [Crossing::Falling(state.configuration().y)]);
    /// let mut times = Vec::new();
    /// while let Some(event) = bounces.next().transpose()? {
    ///     times.push(event.time);
    ///     if times.len() == 3 {
    ///         break;
    ///     }
    ///     let back = -1.8 * event.state.momentum().y;
    ///     bounces.go_on_from(stepper.kick(&event.state, Vector2::new(0.0, back))?);
    /// }
    /// // 0.5 s down, then 0.8 s and 0.64 s of flight
    /// let exact = [0.5, 1.3, 1.94];
    /// assert!(times.iter().zip(exact).all(|(time, exact)| (time - exact).abs() < 1e-14));
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// Source: the bracket shrinks by the method of I. F. D. Oliveira and R. H. C. Takahashi, *An enhancement of the
    /// bisection method average performance preserving minmax optimality*, ACM Trans. Math. Softw. 47 (2020), article 5. It takes
    /// at most two evaluations more than bisection, and a few on smooth functions.
    ///
    /// # Errors
    /// Each event may be an error. [`Error::EventNotFinite`] is for a value that is not finite. [`Error::EventGrazes`] is for a function that
    /// touches zero, so that rounding decides whether it crosses. [`Error::EventStays`] comes after [`go_on_from`](Events::go_on_from).
    /// The others are those of [`Stepper::step`].
    pub fn events<G, const K: usize>(self, steps: usize, function: G) -> Events<'a, S, G, K, M, U>
    where
        G: FnMut(&State<S, M>) -> [Crossing<S::Scalar>; K],
    {
        let Self { stepper, state, has_failed, inputs, .. } = self;
        Events {
            stepper,
            function,
            node: state,
            clock: Clock::at(state.time.now()),
            values: None,
            before: None,
            is_above: [false; K],
            next: None,
            known_from: [Zero::zero(); K],
            sizes: [Zero::zero(); K],
            found: [[None; 2]; K],
            yielded: None,
            set_at: None,
            steps_left: steps,
            has_ended: has_failed,
            inputs,
            input: None,
        }
    }
}

impl<S: Clebsch, G, M: Method<S>, U, const K: usize> Events<'_, S, G, K, M, U> {
    /// The last state that is known to be good: that of the last event, or the end of a step after it. After an error it
    /// is the state before the step that failed.
    pub fn state(&self) -> &State<S, M> {
        self.yielded.as_ref().map_or(&self.node, |event| &event.state)
    }

    /// The time of [`state`](Self::state), from the start of the trajectory. Where the time matters it is that of the state.
    pub fn time(&self) -> S::Scalar {
        self.yielded.as_ref().map_or_else(|| self.clock.now(), |event| event.time)
    }

    /// How many steps may still be made. Each state that was set takes one.
    pub fn steps_left(&self) -> usize {
        self.steps_left
    }

    /// Goes on from another state at the time of the last event, such as that of a [kick](Stepper::kick) there. The next step starts
    /// from it, and other events of the last step are searched anew.
    ///
    /// The function of that event leaves zero to either side: a ball that bounces goes back, a burn at a pericentre goes on. If it
    /// does neither within a part ∛ε of a step, the next item is [`Error::EventStays`]. A ball that bounces ever lower
    /// comes to rest in this way.
    pub fn go_on_from(&mut self, state: State<S, M>) {
        if let Some(event) = self.yielded.take() {
            self.clock = Clock::at(event.time);
            self.set_at = Some(event.number);
        }
        if size_of::<S::Time>() > 0 {
            self.clock = Clock::at(state.time.now());
        }
        (self.node, self.input) = (state, None);
        (self.values, self.before, self.next) = (None, None, None);
        self.found = [[None; 2]; K];
        self.has_ended = false;
    }
}

impl<S, M: Method<S>, G, U, const K: usize> Events<'_, S, G, K, M, U>
where
    S: Clebsch<Scalar: Real>,
    G: FnMut(&State<S, M>) -> [Crossing<S::Scalar>; K],
    U: Inputs<S, M>,
{
    /// The input of the step from the node.
    fn input_of_step(&mut self) -> S::Input {
        *self.input.get_or_insert_with(|| self.inputs.input(&self.node))
    }

    /// The functions at a state, all of them finite.
    fn look(&mut self, state: &State<S, M>) -> Result<[Crossing<S::Scalar>; K], Error> {
        let crossings = (self.function)(state);
        match crossings.iter().position(|crossing| !Scalar::is_finite(crossing.value())) {
            None => Ok(crossings),
            Some(event) => Err(Error::EventNotFinite { event }),
        }
    }

    /// The state at a part of the step from the node, and the value of function k there.
    fn part(&mut self, part: S::Scalar, k: usize) -> Result<(State<S, M>, S::Scalar), Error> {
        let input = self.input_of_step();
        let state = self.stepper.step_for_with(&self.node, part * self.stepper.h, &input)?;
        Ok((state, self.look(&state)?[k].value()))
    }

    /// The values at the node, and on which side of zero they are.
    fn values_at_node(&mut self) -> Result<[S::Scalar; K], Error> {
        if let Some(values) = self.values {
            return Ok(values);
        }
        let node = self.node;
        let crossings = self.look(&node)?;
        let mut values = crossings.map(|crossing| crossing.value());
        self.known_from = [Zero::zero(); K];
        let set_at = self.set_at.take();
        for k in 0..K {
            if set_at == Some(k) || values[k].is_zero() {
                // it has the side that it takes a little later
                self.known_from[k] = S::Scalar::EPSILON.powf(S::Scalar::from_ratio(1, 3));
                values[k] = self.part(self.known_from[k], k)?.1;
                let is_above = values[k] > Zero::zero();
                // a motion that passes through is beyond by a part ∛ε of a step, one that bounces no more by its square
                let is_beyond = is_above == self.is_above[k];
                let is_small = values[k].abs() <= S::Scalar::EPSILON.sqrt() * self.sizes[k];
                if set_at == Some(k) && (values[k].is_zero() || is_beyond && is_small) {
                    return Err(Error::EventStays { event: k });
                }
                self.is_above[k] = is_above;
            } else if values[k].abs() > S::Scalar::EPSILON.sqrt() * self.sizes[k] {
                // a smaller value may be rounding of another event at the same time, which is still to come
                self.is_above[k] = values[k] > Zero::zero();
            }
        }
        self.values = Some(values);
        Ok(values)
    }

    /// One step from the node, and the crossings in it; `false` where no step is left.
    fn search(&mut self) -> Result<bool, Error> {
        let values = self.values_at_node()?;
        let Some(left) = self.steps_left.checked_sub(1) else { return Ok(false) };
        let input = self.input_of_step();
        let next = self.stepper.step_with(&self.node, &input)?;
        let ends = self.look(&next)?;
        for k in 0..K {
            self.found[k] = self.crossings(k, values[k], &ends[k])?;
            self.sizes[k] = larger(values[k].abs(), ends[k].value().abs());
        }
        self.next = Some((next, ends.map(|end| end.value())));
        self.steps_left = left;
        Ok(true)
    }

    /// The crossings of function k in the step from the node, from the values at both ends.
    fn crossings(&mut self, k: usize, value: S::Scalar, end: &Crossing<S::Scalar>) -> Result<FoundInStep<S, M>, Error> {
        let (is_above, node) = (self.is_above[k], self.node);
        let start = self.known_from[k];
        let (one, after) = (S::Scalar::one(), end.value());
        if is_above != (after > Zero::zero()) {
            if !end.counts_from(is_above) {
                return Ok([None, None]);
            }
            if is_above != (value > Zero::zero()) {
                // it has crossed already, at another event
                return Ok([Some(Found { part: Zero::zero(), state: node }), None]);
            }
            let found = root([(start, value), (one, after)], |part| self.part(part, k))?;
            return Ok([Some(self.located(found, start, k)?), None]);
        }
        if is_above != (value > Zero::zero()) {
            return Ok([None, None]);
        }
        let third = match &self.before {
            Some(before) => (-one, before[k]),
            None => {
                let middle = S::Scalar::from_ratio(1, 2);
                (middle, self.part(middle, k)?.1)
            }
        };
        let Some((middle, between)) = dip([(start, value), (one, after), third], k, |part| Ok(self.part(part, k)?.1))?
        else {
            return Ok([None, None]);
        };
        let mut found = [None, None];
        let brackets = [[(start, value), (middle, between)], [(middle, between), (one, after)]];
        for (number, bracket) in brackets.into_iter().enumerate() {
            if end.counts_from(is_above == (number == 0)) {
                let crossing = root(bracket, |part| self.part(part, k))?;
                found[number] = Some(self.located(crossing, bracket[0].0, k)?);
            }
        }
        Ok(found)
    }

    /// The crossing with its state; `None` is the start of its bracket.
    fn located(
        &mut self,
        found: Option<FoundState<S, M>>,
        start: S::Scalar,
        k: usize,
    ) -> Result<FoundState<S, M>, Error> {
        match found {
            Some(found) => Ok(found),
            None if start.is_zero() => Ok(Found { part: start, state: self.node }),
            None => Ok(Found { part: start, state: self.part(start, k)?.0 }),
        }
    }

    /// The next event of the step from the node.
    fn take_found(&mut self) -> Option<Event<S, M>> {
        let all =
            self.found.iter().enumerate().flat_map(|(k, both)| both.iter().flatten().map(move |found| (k, found)));
        let first = all.reduce(|first, other| if other.1.part < first.1.part { other } else { first });
        let (number, found) = first.map(|(k, found)| (k, *found))?;
        let [first, second] = self.found[number];
        self.found[number] = if first.is_some() { [None, second] } else { [None, None] };
        self.is_above[number] = !self.is_above[number];
        let time = self.clock_after(found.part * self.stepper.h, &found.state).now();
        Some(Event { number, time, state: found.state })
    }

    /// The time after a step of this size to a state.
    fn clock_after(&self, size: S::Scalar, state: &State<S, M>) -> Clock<S::Scalar> {
        M::Scheme::now(&state.left).map_or_else(|| self.clock.after_step(size), Clock::at)
    }

    /// Goes on from the end of the step, once all of its events have been told.
    fn pass(&mut self) {
        if let Some((next, values)) = self.next.take() {
            (self.node, self.input) = (next, None);
            self.clock = self.clock_after(self.stepper.h, &next);
            self.before = self.values;
            self.values = Some(values);
            self.known_from = [Zero::zero(); K];
            self.is_above = values.map(|value| value > Zero::zero());
            self.yielded = None;
        }
    }
}

impl<S, M: Method<S>, G, U, const K: usize> Iterator for Events<'_, S, G, K, M, U>
where
    S: Clebsch<Scalar: Real>,
    G: FnMut(&State<S, M>) -> [Crossing<S::Scalar>; K],
    U: Inputs<S, M>,
{
    type Item = Result<Event<S, M>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        while !self.has_ended {
            if let Some(event) = self.take_found() {
                self.yielded = Some(event);
                return Some(Ok(event));
            }
            self.pass();
            match self.search() {
                Ok(has_step) => self.has_ended = !has_step,
                Err(error) => {
                    self.has_ended = true;
                    return Some(Err(error));
                }
            }
        }
        None
    }
}

impl<S: Clebsch, G, M: Method<S>, U, const K: usize> Debug for Events<'_, S, G, K, M, U> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Events");
        shown.field("state", self.state()).field("time", &self.time()).field("steps_left", &self.steps_left);
        shown.finish_non_exhaustive()
    }
}

impl<S: Clebsch, G: Clone, M: Method<S>, U: Clone, const K: usize> Clone for Events<'_, S, G, K, M, U> {
    fn clone(&self) -> Self {
        Self { function: self.function.clone(), inputs: self.inputs.clone(), ..*self }
    }
}
