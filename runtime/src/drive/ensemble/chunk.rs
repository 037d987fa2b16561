//! The bodies that share the lanes of one state.

use crate::scheme::{Held, Scheme, time_after};
use crate::{Body, Clebsch, Error, Failure, Mask, Method, Scalar, Space, State, Stepper, Time};
use alloc::vec::Vec;
use core::ops::Range;
use num_traits::Zero;

/// Chunks that take turns: while one waits for a result, the processor works on another.
pub const TOGETHER: usize = 4;

/// Steps after which chunks whose bodies have all failed are noticed.
const TURNS: u64 = 1024;

/// As many bodies as there are lanes, or fewer: then the last one is in the lanes that are left too.
#[derive(Debug)]
pub struct Chunk<X> {
    /// The number of the first body.
    first: usize,
    state: X,
    /// The lanes of bodies that are stepped, one bit for each. The momenta of the others are NaN, which ends their solve at once.
    live: u16,
    failed: Vec<Failed<X>>,
}

/// A body that stays where it is.
#[derive(Debug)]
struct Failed<X> {
    failure: Failure,
    /// The last state that it reached, in its lane.
    state: X,
}

impl<S: Clebsch, M: Method<S>> Chunk<State<S, M>> {
    /// From one body or more, at most one for each lane, the first with this number. The error is that of the first body that is refused.
    pub fn new(stepper: &Stepper<S, M>, first: usize, bodies: &[Body<S>]) -> Result<Self, Failure> {
        let body = |lane: usize| bodies[lane.min(bodies.len() - 1)];
        let q = S::Configuration::side_by_side(|lane| body(lane).0);
        let mu = S::Momentum::side_by_side(|lane| body(lane).1);
        match stepper.state(q, mu) {
            Ok(state) => Ok(Self { first, state, live: u16::MAX >> (16 - bodies.len()), failed: Vec::new() }),
            Err(error) => {
                let refusal = |(lane, body)| alone(stepper, body).err().map(|error| (lane, error));
                let (lane, error) = bodies.iter().enumerate().find_map(refusal).unwrap_or((0, error));
                Err(Failure { body: first + lane, step: 0, error })
            }
        }
    }

    /// One step of each body; `step` have been made.
    #[inline(always)]
    pub fn step(&mut self, stepper: &Stepper<S, M>, step: u64) {
        // this stepper has made the data of the last step
        if let Ok(next) = stepper.attempt_with(&self.state, &self.state.left, &S::Input::origin()) {
            // quicker than to look at each number; where the sum overflows, `part` looks at each
            let finite = (next.configuration.sum() + next.held.sum() + next.time.now()).finite();
            let sound = if S::MAY_LEAVE_ORBIT { stepper.sound(&next) } else { finite };
            if sound.bits() & self.live == self.live {
                let State { time, configuration, held, left, h: _ } = next;
                self.state = State { time, configuration, held, left, h: self.state.h };
                return;
            }
        }
        self.part(stepper, step);
    }

    /// The step in which some bodies fail.
    #[cold]
    #[inline(never)]
    fn part(&mut self, stepper: &Stepper<S, M>, step: u64) {
        let (mut next, stepped) = stepper.step_each(&self.state);
        for lane in (0..S::Scalar::LANES).filter(|&lane| !stepped.lane(lane)) {
            if self.live >> lane & 1 == 1 {
                // by construction: the step has failed in this lane
                let error = stepper.failure(&self.state, lane).unwrap_or(Error::InLane { lane });
                let failure = Failure { body: self.first + lane, step, error };
                self.failed.push(Failed { failure, state: self.state });
                self.live &= !(1 << lane);
            }
            let undefined = Held::<S, M>::filled(S::Scalar::zero() / S::Scalar::zero());
            next.held.set_lane(lane, &undefined.lane(lane));
        }
        next.time = time_after::<S, M>(self.state.time, (stepper.h, 1), &next.left);
        self.state = next;
    }

    /// The state that has, in this lane, the last that the body reached.
    pub fn state_of(&self, lane: usize) -> &State<S, M> {
        self.failed
            .iter()
            .find(|failed| failed.failure.body == self.first + lane)
            .map_or(&self.state, |failed| &failed.state)
    }

    /// Puts a body into a lane, at the present time.
    pub fn put(&mut self, lane: usize, mut state: State<S, M>) {
        state.time = self.state.time;
        self.failed.retain(|failed| failed.failure.body != self.first + lane);
        self.live |= 1 << lane;
        self.state.take_lane(lane, &state);
    }

    /// The bodies that stay.
    pub fn failures(&self) -> impl Iterator<Item = Failure> + '_ {
        self.failed.iter().map(|failed| failed.failure)
    }

    /// `steps` steps of a few chunks, which take turns, by the one stepper or by one each; `first` have been made.
    #[inline]
    pub fn advance(chunks: &mut [Self], steppers: &[Stepper<S, M>], first: u64, steps: u64) {
        let mut first = first;
        let end = first.saturating_add(steps);
        while first < end {
            let next = first.saturating_add(TURNS).min(end);
            if chunks.iter().all(|chunk| chunk.live == 0) {
                return Self::wait(chunks, steppers, end - first);
            }
            Self::together(chunks, steppers, first..next);
            first = next;
        }
    }

    /// The time goes on where all bodies have failed, for those that are put in their place.
    #[cold]
    fn wait(chunks: &mut [Self], steppers: &[Stepper<S, M>], steps: u64) {
        let waits = |chunk: &Self| size_of::<S::Time>() == 0 || M::Scheme::now(&chunk.state.left).is_some();
        if chunks.iter().any(waits) {
            return;
        }
        for (number, chunk) in chunks.iter_mut().enumerate() {
            let stepper = if let [stepper] = steppers { Some(stepper) } else { steppers.get(number) };
            if let Some(stepper) = stepper {
                let time = (0..steps).fold(chunk.state.time, |time, _| time.after_step(stepper.h));
                chunk.state.time = time;
            }
        }
    }

    #[inline]
    fn together(chunks: &mut [Self], steppers: &[Stepper<S, M>], numbers: Range<u64>) {
        match steppers {
            [stepper] => numbers.for_each(|step| chunks.iter_mut().for_each(|chunk| chunk.step(stepper, step))),
            each => {
                let mut together = |step| chunks.iter_mut().zip(each).for_each(|(chunk, own)| chunk.step(own, step));
                numbers.for_each(&mut together);
            }
        }
    }
}

/// A state with the same body in all lanes, checked.
pub fn alone<S: Clebsch, M: Method<S>>(stepper: &Stepper<S, M>, (q, mu): &Body<S>) -> Result<State<S, M>, Error> {
    stepper.state(S::Configuration::side_by_side(|_| *q), S::Momentum::side_by_side(|_| *mu))
}

/// A state with the body of one lane in all lanes.
pub fn in_all_lanes<S: Clebsch, M: Method<S>>(state: &State<S, M>, lane: usize) -> State<S, M> {
    let now = Scalar::lane(state.time.now(), lane);
    State {
        time: Time::at(S::Scalar::from_lanes(|_| now)),
        configuration: repeated(&state.configuration, lane),
        held: repeated(&state.held, lane),
        left: repeated(&state.left, lane),
        h: repeated(&state.h, lane),
    }
}

/// One lane of a value in all lanes.
fn repeated<T: Scalar, V: Space<T>>(value: &V, lane: usize) -> V {
    V::side_by_side(|_| value.lane(lane))
}
